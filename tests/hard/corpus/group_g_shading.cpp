// Group G: Phong's lobe and the normalisation of vectors.
#include <fmt/format.h>

#include <cmath>

#include "hard/corpus/functions.h"
#include "hard/corpus/groups.h"
#include "hard/corpus/ray_batches.h"
#include "support/exact_geometry.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/bsdf/phong_lobe.h"

namespace tandem::hard {

namespace {

const Vec3f white = {1, 1, 1};

/// Only the highlight: no diffuse reflection, a white light.
template <class Real>
Real highlight(const Real& shininess, const Vec3<Double<Real>>& normal, const Vec3<Double<Real>>& to_light,
               const Vec3<Double<Real>>& to_viewer) {
    const PhongLobe<Real> lobe = {broadcast<Real>(white), shininess};
    return lobe.reflected_about(Real(1.0F), normal, to_light, to_viewer).x;
}

template <class Real>
Vec3<Real> in_all_lanes(const Vec3d& v) {
    return broadcast<Real>(v);
}

/// One ray's value; counts a packet that differs from it.
float on_both(Score& score, float shininess, const Vec3d& normal, const Vec3d& to_light, const Vec3d& to_viewer) {
    using D = Double<Packet>;
    const float one = highlight<float>(shininess, normal, to_light, to_viewer);
    const Packet many = highlight<Packet>(Packet(shininess), in_all_lanes<D>(normal), in_all_lanes<D>(to_light),
                                          in_all_lanes<D>(to_viewer));
    score.decide(!same_bits(one, many[1]), [&] { return fmt::format("a packet differs at n = {}", shininess); });
    return one;
}

/// A viewer near the mirror direction, where cos^n is between 1 and e^-20. For n = 10^8 the cosine is given: the
/// rounding of a dot product in double, times 10^8, would be visible.
Score lobe(Random& random, std::size_t calls) {
    Score score;
    for (std::size_t i = 0; i < calls; ++i) {
        const auto shininess = static_cast<float>(std::pow(10.0, 2 + static_cast<double>(i % 4) * 2));
        const Vec3d normal = test::any_unit(random);
        const Vec3d to_light = normalize(normal + test::any_unit(random) * 0.9);
        const Vec3d mirrored = normal * (2 * dot(normal, to_light)) - to_light;
        const double angle = std::sqrt(random.uniform(0.0, 40.0) / double{shininess});
        const Vec3d to_viewer =
            normalize(mirrored * std::cos(angle) + test::any_across(random, mirrored) * std::sin(angle));
        // the vectors as they are, be they of length 1 or not
        const auto inner = [](const Vec3d& a, const Vec3d& b) {
            return Exact(a.x) * Exact(b.x) + Exact(a.y) * Exact(b.y) + Exact(a.z) * Exact(b.z);
        };
        const bool alone = i % 4 == 3;
        const Exact cosine = alone
                                 ? Exact(std::cos(angle))
                                 : 2 * inner(normal, to_light) * inner(normal, to_viewer) - inner(to_light, to_viewer);
        if (cosine <= 0 || cosine > 1) continue;
        const float value = alone ? specular_lobe<float>(std::cos(angle), shininess)
                                  : on_both(score, shininess, normal, to_light, to_viewer);
        score.measure(ulps_from(value, Exact(pow(cosine, Exact(shininess)))),
                      [&] { return fmt::format("cos = {:a}^{}", cosine.convert_to<double>(), shininess); });
    }
    return score;
}

/// 0 below the horizon of the mirror direction; never more than the light; 0^0 is 1.
Score clamped(Random& random, std::size_t calls) {
    Score score;
    const Vec3d up = {0, 0, 1};
    for (const float shininess : {0.0F, 1e-3F, 2.5F, 1e8F}) {
        for (const double cosine : {-1.0, -1e-9, -0.0, 0.0}) {
            const Vec3d to_viewer = {std::sqrt(1 - cosine * cosine), 0, cosine};
            const float value = on_both(score, shininess, up, up, to_viewer);
            score.decide(!(value == 0), fmt::format("cos = {} gives {} at n = {}", cosine, value, shininess));
        }
        const float beyond = specular_lobe<float>(1.0000002, shininess);
        score.decide(!(beyond == 1), fmt::format("cos = 1.0000002 gives {} at n = {}", beyond, shininess));
    }
    for (std::size_t i = 0; i < calls; ++i) {
        const Vec3d to_viewer = test::any_unit(random);
        const auto shininess = static_cast<float>(std::pow(10.0, random.uniform(-3.0, 8.0)));
        const float value = on_both(score, shininess, test::any_unit(random), test::any_unit(random), to_viewer);
        score.decide(!(value >= 0 && value <= 1), [&] { return fmt::format("a highlight of {}", value); });
        score.nans += std::isnan(value);
    }
    return score;
}

/// n = 0 gives 1 wherever the cosine is positive; n = 1e-3 nearly so.
Score smallest_exponents(Random& random, std::size_t calls) {
    Score score;
    for (std::size_t i = 0; i < calls; ++i) {
        const double cosine = std::exp2(random.uniform(-1000.0, 0.0));
        const float flat = specular_lobe<float>(cosine, 0.0F);
        score.decide(!(flat == 1), [&] { return fmt::format("{}^0 = {}", cosine, flat); });
        const float value = specular_lobe<float>(cosine, 1e-3F);
        score.measure(ulps_from(value, Exact(pow(Exact(cosine), Exact(1e-3F)))),
                      [&] { return fmt::format("{:a}^1e-3 = {}", cosine, value); });
    }
    return score;
}

/// Float vectors of all lengths, from subnormal to 1e38: unit length in float.
Score normalised(Random& random, std::size_t calls) {
    Score score;
    for (std::size_t i = 0; i < calls; ++i) {
        const double scale = std::exp2(random.uniform(-149.0, 126.0));
        const Vec3f v = narrow(Vec3d{1, 2, 3} * (i % 2 == 0 ? scale : 0.0) + test::any_unit(random) * scale);
        if (norm1(v) == 0) continue;
        const Vec3f unit = narrow(normalize(widen(v)));
        const auto many = normalize(widen(in_all(v)));
        const Exact length = sqrt(Exact(v.x) * Exact(v.x) + Exact(v.y) * Exact(v.y) + Exact(v.z) * Exact(v.z));
        const auto line = [&] {
            return fmt::format("normalize({{{:a}, {:a}, {:a}}})", double{v.x}, double{v.y}, double{v.z});
        };
        const bool same = same_bits(narrow(many.x[0]), unit.x) && same_bits(narrow(many.y[1]), unit.y) &&
                          same_bits(narrow(many.z[2]), unit.z);
        score.decide(!same, line);
        for (int k = 0; k < 3; ++k) {
            if (v[k] != 0) score.measure(ulps_from(unit[k], Exact(v[k]) / length), line);
        }
    }
    return score;
}

/// Normals that are a little too long, as a quarter of them are after rounding to float: no NaN, no gain.
Score too_long(Random& random, std::size_t calls) {
    Score score;
    for (std::size_t i = 0; i < calls; ++i) {
        const Vec3d normal = widen(narrow(test::any_unit(random)));
        const float value = on_both(score, static_cast<float>(1e6), normal, normal, normal);
        score.nans += std::isnan(value);
        const auto line = [&] { return fmt::format("a highlight of {} for |n|^2 = {:a}", value, dot(normal, normal)); };
        score.decide(!(value >= 0 && value <= 1), line);
    }
    return score;
}

/// A light at a point of the surface, at the camera, and at the centre of the sphere: no NaN anywhere.
Score light_on_surface(const Subject& subject, Random&, std::size_t) {
    Score score;
    for (const Vec3d& place : {Vec3d{0, 0, 1}, Vec3d{0, 0, 4}, Vec3d{0, 0, 0}, Vec3d{0, 0, 1 + 1e-20}}) {
        Scene scene = scene_of({{{0, 0, 0}, 1}});
        scene.nodes[0].trs.translation = {0, 0, 4};
        Node lamp{.name = "lamp", .light = LightSource{}};
        lamp.trs.translation = place;
        scene.nodes.push_back(lamp);
        const auto resident = subject.backend.load(prepare(scene), subject.tier);
        const RenderJob job = {.width = 33, .height = 33, .samples = 4, .tier = subject.tier};
        const RenderResult result = subject.backend.render(resident, job);
        score.nans += result.stats.counters.invalid_samples;
        score.seconds += result.stats.seconds.render;
        for (const Vec3d& sum : result.film.sums()) {
            score.decide(!(sum.x >= 0 && sum.x <= 4 * 3),
                         [&] { return fmt::format("a pixel of {} with the light at z = {}", sum.x, place.z); });
        }
    }
    return score;
}

}  // namespace

std::vector<HardCase> shading_cases() {
    return {
        {"G1", "cos^n for n from 10^2 to 10^8", "the rounding error of the cosine counts n times: 45 % at 10^6",
         "MPFR, on the same vectors", FunctionCase{lobe}},
        {"G2", "cos of 0, below 0 and above 1",
         "pow of a negative number is NaN; 1.0000002 to the power 10^8 is 5 10^8", "rule: 0 below, 1 above",
         FunctionCase{clamped}},
        {"G3", "n of 0 and 10^-3", "0^0, and logarithms of subnormals", "closed form; MPFR",
         FunctionCase{smallest_exponents}},
        {"G4", "Vectors with lengths from 10^-45 to 10^38", "the square of the length underflows or overflows", "MPFR",
         FunctionCase{normalised}},
        {"G5", "Normals that rounding makes longer than 1", "their acos and sqrt(1 - n.n) are NaN",
         "rule: between 0 and 1", FunctionCase{too_long}},
        {"G6", "A light on the surface, and at the camera", "normalising the zero vector gives NaN, which persists",
         "rule: finite", RenderCase{light_on_surface}},
    };
}

}  // namespace tandem::hard
