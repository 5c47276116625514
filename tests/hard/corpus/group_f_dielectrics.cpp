// Group F: mirrors and dielectric interfaces. All directions are unit vectors in double, as in the path loop.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hard/corpus/functions.h"
#include "hard/corpus/groups.h"
#include "hard/corpus/ray_batches.h"
#include "support/exact_geometry.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/bsdf/fresnel.h"
#include "tandem/kernel/bsdf/reflect.h"
#include "tandem/kernel/media/medium_stack.h"
#include "tandem/kernel/spawn_ray.h"
#include "tandem/kernel/traversal/intersect.h"

namespace tandem::hard {

namespace {

using test::any_across;
using test::any_unit;
using test::Big;
using Wide = Double<Packet>;

constexpr double unit = 0x1p-53;  ///< half a unit of the last place of a double of 1

/// A direction onto a surface, from the side of its normal.
struct Incidence {
    Vec3d direction, normal;

    /// sin^2 and cos of the angle between the vectors, whatever their lengths.
    [[nodiscard]] Big sine2() const {
        const test::BigVector d = test::big(direction), n = test::big(normal);
        const test::BigVector across = {d.y * n.z - d.z * n.y, d.z * n.x - d.x * n.z, d.x * n.y - d.y * n.x};
        return test::dot(across, across) / (test::dot(d, d) * test::dot(n, n));
    }
    [[nodiscard]] Big cosine() const {
        const test::BigVector d = test::big(direction), n = test::big(normal);
        return -test::dot(d, n) / sqrt(Big(test::dot(d, d) * test::dot(n, n)));
    }
    [[nodiscard]] std::string text(double eta) const {
        return fmt::format("d = {{{:a}, {:a}, {:a}}}, n = {{{:a}, {:a}, {:a}}}, eta = {:a}", direction.x, direction.y,
                           direction.z, normal.x, normal.y, normal.z, eta);
    }
};

Incidence any_incidence(double sine, double cosine, Random& random) {
    const Vec3d normal = any_unit(random);
    return {normalize(any_across(random, normal) * sine - normal * cosine), normal};
}
Incidence with_sine(double sine, Random& random) {
    return any_incidence(sine, std::sqrt((1 - sine) * (1 + sine)), random);
}
Incidence with_cosine(double cosine, Random& random) {
    return any_incidence(std::sqrt((1 - cosine) * (1 + cosine)), cosine, random);
}

struct Interface {
    bool transmits;
    Vec3d direction;
    double cosine_out, reflectance;
};

/// The result for one ray; a packet that differs counts as wrong.
Interface cross_interface(Score& score, const Incidence& in, double eta) {
    const auto one = refract<float>(in.direction, in.normal, eta);
    const Interface interface = {one.transmits, one.direction, one.cosine_out, fresnel_dielectric<float>(one, eta)};
    const auto many = refract<Packet>(broadcast<Wide>(in.direction), broadcast<Wide>(in.normal), Wide(eta));
    const Wide reflectance = fresnel_dielectric<Packet>(many, Wide(eta));
    const auto differs = [](double a, double b) { return bits_of(a) != bits_of(b); };
    const bool wrong = all(many.transmits) != interface.transmits || any(many.transmits) != interface.transmits ||
                       differs(reflectance[1], interface.reflectance) ||
                       (interface.transmits && (differs(many.direction.x[0], interface.direction.x) ||
                                                differs(many.direction.y[1], interface.direction.y) ||
                                                differs(many.direction.z[2], interface.direction.z)));
    score.decide(wrong, [&] { return "a packet differs: " + in.text(eta); });
    return interface;
}

/// eta sin = 1 + and - 1e-2 to 1e-12. Not judged within 2^-40, where the rounding of the vectors is as large.
Score next_to_total(Random& random, std::size_t calls) {
    Score score;
    for (std::size_t i = 0; i < calls; ++i) {
        const double gap = std::pow(10.0, random.uniform(-12.0, -2.0)) * (random.coin() ? 1 : -1);
        const double eta = random.uniform(1.05, 2.5);
        const Incidence in = with_sine((1 + gap) / eta, random);
        const Big sine2 = Big(eta) * Big(eta) * in.sine2();
        const Interface interface = cross_interface(score, in, eta);
        if (abs(Big(sine2 - 1)) > Big(0x1p-39)) {
            score.decide(interface.transmits != (sine2 < 1), [&] { return in.text(eta); });
        } else {
            ++score.unjudged;
        }
        if (!interface.transmits || sine2 > 1) continue;
        const Big error = abs(Big(Big(interface.cosine_out) - sqrt(Big(1 - sine2))));
        score.decide(error > Big(1e-7),
                     [&] { return fmt::format("cosine {}: {}", interface.cosine_out, in.text(eta)); });
    }
    return score;
}

/// The refracted sine is eta times the incident one, to a float ulp, down to 1e-6 from the normal.
Score near_the_normal(Random& random, std::size_t calls) {
    Score score;
    for (std::size_t i = 0; i < calls; ++i) {
        const double eta = random.uniform(0.4, 2.5);
        const Incidence in = with_sine(std::pow(10.0, random.uniform(-6.0, -0.5)), random);
        const Interface interface = cross_interface(score, in, eta);
        score.decide(!interface.transmits, [&] { return in.text(eta); });
        const Incidence behind = {interface.direction, in.normal};
        const Big right = sqrt(Big(Big(eta) * Big(eta) * in.sine2()));
        score.measure(ulps_from(sqrt(behind.sine2()).convert_to<float>(), right.convert_to<double>()),
                      [&] { return in.text(eta); });
    }
    return score;
}

/// Equal indices: the direction is unchanged to the bit, and nothing is reflected, at every angle.
Score equal_indices(Random& random, std::size_t calls) {
    Score score;
    for (std::size_t i = 0; i < calls; ++i) {
        const Incidence in = with_cosine(i % 3 == 0 ? 0 : std::exp2(random.uniform(-60.0, 0.0)), random);
        const Interface interface = cross_interface(score, in, 1);
        const bool wrong = !interface.transmits || interface.direction != in.direction || interface.reflectance != 0;
        score.decide(wrong, [&] { return in.text(1); });
    }
    return score;
}

/// R is between 0 and 1, exactly 1 at a cosine of 0, and Fresnel's formula rounded to float elsewhere.
Score grazing(Random& random, std::size_t calls) {
    Score score;
    for (std::size_t i = 0; i < calls; ++i) {
        const double eta = random.coin() ? random.uniform(0.3, 3.0) : 1 + std::exp2(random.uniform(-40.0, -2.0));
        const bool along = i % 8 == 0;
        const Vec3d normal = {0, 0, 1};
        const Incidence in =
            along ? Incidence{{1, 0, 0}, normal} : with_cosine(std::exp2(random.uniform(-60.0, -2.0)), random);
        const Interface interface = cross_interface(score, in, eta);
        const double r = interface.reflectance;
        score.decide(!(r >= 0 && r <= 1) || (along && r != 1), [&] { return fmt::format("{}: {}", r, in.text(eta)); });
        score.nans += std::isnan(r);
    }
    return score;
}

/// R against Fresnel's formula, on the given vectors, and R + T against 1.
Score energy(Random& random, std::size_t calls) {
    Score score;
    for (std::size_t i = 0; i < calls; ++i) {
        const double eta = random.uniform(0.3, 3.0);
        const Incidence in = with_cosine(random.uniform(0.01, 1.0), random);
        const Interface interface = cross_interface(score, in, eta);
        const double r = interface.reflectance, t = 1 - r;
        score.decide(!(std::abs(r + t - 1) <= 2 * unit), [&] { return in.text(eta); });
        const Big left = 1 - Big(eta) * Big(eta) * in.sine2();
        if (left < Big(1e-4)) continue;  // next to total reflection: F1
        const Big out = sqrt(left), cosine = in.cosine();
        const Big s = (eta * cosine - out) / (eta * cosine + out), p = (cosine - eta * out) / (cosine + eta * out);
        const Big right = (s * s + p * p) / 2;
        if (right < Big(1e-12)) continue;  // Brewster's angle, and indices that are almost equal: nothing is left
        score.measure(ulps_from(static_cast<float>(r), right.convert_to<double>()), [&] { return in.text(eta); });
    }
    return score;
}

/// 500 mirrors: the direction keeps its length, and an albedo of 0.999 its power.
Score many_mirrors(Random& random, std::size_t calls) {
    Score score;
    for (std::size_t i = 0; i < calls / 500 + 1; ++i) {
        Vec3d direction = any_unit(random);
        double throughput = 1;
        for (int bounce = 0; bounce < 500; ++bounce) {
            direction = reflect(direction, any_unit(random));
            throughput *= 0.999;
            const double off = std::sqrt(dot(direction, direction)) - 1;
            score.decide(!(std::abs(off) <= 4 * unit), [&] { return fmt::format("{} off after {}", off, bounce); });
        }
        score.measure(ulps_from(static_cast<float>(throughput), Exact(pow(Exact(0.999), 500))),
                      [&] { return fmt::format("{}", throughput); });
    }
    return score;
}

/// Entering or leaving, for directions within 1e-9 of the tangent plane: the sign of the exact dot product, unless it
/// is smaller than the rounding of doubles.
Score sides(Random& random, std::size_t calls) {
    Score score;
    for (std::size_t i = 0; i < calls; ++i) {
        SurfacePoint<float> point = {{0, 0, 0}, any_unit(random), 5};
        const double cosine = random.uniform(-1.0, 1.0) * std::pow(10.0, random.uniform(-12.0, -7.0));
        const Vec3f direction = narrow(any_across(random, point.normal) + point.normal * cosine);
        const Big exact = test::dot(test::big(direction), test::big(point.normal));
        if (abs(exact) < Big(4 * unit)) {
            ++score.unjudged;
            continue;
        }
        const bool inside = spawn_ray(point, direction).source.inside;
        score.decide(inside != (exact < 0), [&] {
            return fmt::format("d = {{{:a}, {:a}, {:a}}}, n = {{{:a}, {:a}, {:a}}}", double{direction.x},
                               double{direction.y}, double{direction.z}, point.normal.x, point.normal.y,
                               point.normal.z);
        });
    }
    return score;
}

/// The exact spans of a line inside spheres; a line that misses a sphere has none.
struct Span {
    Big in, out;
    std::uint32_t medium, priority;
};

std::vector<Span> spans_of(const std::vector<Sphere>& spheres, const std::vector<std::uint32_t>& priorities,
                           const Ray<float>& ray) {
    std::vector<Span> spans;
    for (std::uint32_t i = 0; i < spheres.size(); ++i) {
        const test::BigVector o = test::big(widen(ray.origin) - widen(spheres[i].centre));
        const test::BigVector d = test::big(widen(ray.direction));
        const Big a = test::dot(d, d), b = test::dot(o, d), r = spheres[i].radius, c = test::dot(o, o) - r * r;
        const Big discriminant = b * b - a * c;
        if (discriminant <= 0) continue;
        const Big root = sqrt(discriminant);
        spans.push_back({(-b - root) / a, (-b + root) / a, i, priorities[i]});
    }
    return spans;
}

/// The medium at t: among the spans around it that of the highest priority, and among equals the last one entered.
std::uint32_t medium_at(const std::vector<Span>& spans, const Big& t) {
    const Span* best = nullptr;
    for (const Span& span : spans) {
        if (t < span.in || t > span.out) continue;
        if (best == nullptr || span.priority > best->priority ||
            (span.priority == best->priority && span.in >= best->in)) {
            best = &span;
        }
    }
    return best == nullptr ? no_medium : best->medium;
}

/// One crossing of an interface.
struct Event {
    Big t;
    std::uint32_t medium, priority;
    bool enters;
};

/// Nested, crossing and coincident spheres, each of its own medium. Between two crossings the stack must name the same
/// medium as a test of all spheres. If none coincide, the tracer must find the same crossings in order.
Score glass_in_glass(Random& random, std::size_t calls) {
    Score score;
    for (std::size_t i = 0; i < calls; ++i) {
        // Make spheres and a ray
        std::vector<Sphere> spheres;
        std::vector<std::uint32_t> priorities;
        bool coincide = false;
        const std::uint32_t count = 2 + random.below(5);
        for (std::uint32_t k = 0; k < count; ++k) {
            const bool twin = k > 0 && random.below(4) == 0;
            coincide = coincide || twin;
            spheres.push_back(twin ? spheres.back()
                                   : Sphere{random.coin() ? Vec3f{0, 0, 0} : narrow(any_unit(random) * 0.5),
                                            random.uniform(0.3F, 1.0F)});
            priorities.push_back(random.below(3));
        }
        const Vec3f origin = narrow(any_unit(random) * 3.0);
        const Ray<float> ray = {origin, narrow(any_unit(random) * 0.3) - origin};
        const std::vector<Span> spans = spans_of(spheres, priorities, ray);
        // Sort the crossings by t, then by id, as hits are
        std::vector<Event> events;
        for (const Span& span : spans) {
            events.push_back({span.in, span.medium, span.priority, true});
            events.push_back({span.out, span.medium, span.priority, false});
        }
        std::stable_sort(events.begin(), events.end(),
                         [](const Event& a, const Event& b) { return a.t != b.t ? a.t < b.t : a.medium < b.medium; });
        const auto text = [&] { return fmt::format("{} spheres, {}", count, to_literal(ray)); };

        // Follow the crossings on the stack
        MediumStack<float> stack;
        MediumStack<Packet> packet;
        using Word = UInt<Packet>;
        for (std::size_t e = 0; e < events.size(); ++e) {
            const Event& event = events[e];
            const Mask<Packet> all_lanes(true);
            const bool refused =
                event.enters ? stack.enter(event.medium, event.priority, true) : stack.leave(event.medium, true);
            if (event.enters) {
                (void)packet.enter(Word(event.medium), Word(event.priority), all_lanes);
            } else {
                (void)packet.leave(Word(event.medium), all_lanes);
            }
            const bool last = e + 1 == events.size();
            if (!last && events[e + 1].t == event.t) continue;  // coincident interfaces count as one
            const std::uint32_t right = last ? no_medium : medium_at(spans, (event.t + events[e + 1].t) / 2);
            score.decide(refused || stack.current() != right || packet.current()[2] != right, text);
        }

        // Trace the crossings
        if (coincide) continue;
        const PreparedScene prepared = prepare(scene_of(spheres), {.origin = Vec3d{0, 0, 0}});
        const SceneView scene = view(prepared);
        SpawnedRay<float> next = {ray, {}};
        for (const Event& event : events) {
            const auto hit = LoopTracer{scene}.closest(next.ray, next.source, true);
            if (hit.primitive == no_primitive) {
                score.decide(true, text);
                break;
            }
            const SurfacePoint<float> point = surface_point(scene, next.ray, next.source, hit, true);
            const bool enters = dot(point.normal, widen(ray.direction)) < 0;
            score.decide(hit.primitive != event.medium || enters != event.enters, text);
            next = spawn_ray(point, ray.direction);
        }
    }
    return score;
}

/// A glass ball focuses rays near its axis at n r / (2 (n - 1)) from its centre; rays at a height h fall short of that
/// by about (h / r)^2 of it.
Score ball_lens(Random& random, std::size_t calls) {
    Score score;
    const PreparedScene prepared = prepare(scene_of({{{0, 0, 0}, 1}}), {.origin = Vec3d{0, 0, 0}});
    const SceneView scene = view(prepared);
    for (std::size_t i = 0; i < calls; ++i) {
        const double n = random.uniform(1.2, 1.9), height = random.uniform(1e-3, 3e-3);
        const double azimuth = random.uniform(0.0, 6.28);
        SpawnedRay<float> next = {
            {narrow(Vec3d{height * std::cos(azimuth), height * std::sin(azimuth), 4}), {0, 0, -1}}, {}};
        SurfacePoint<float> point{};
        Vec3d direction = {0, 0, -1};
        for (const bool entering : {true, false}) {
            const auto hit = LoopTracer{scene}.closest(next.ray, next.source, true);
            if (hit.primitive == no_primitive) break;
            point = surface_point(scene, next.ray, next.source, hit, true);
            const Vec3d normal = entering ? point.normal : point.normal * -1.0;
            direction = refract<float>(direction, normal, entering ? 1 / n : n).direction;
            next = spawn_ray(point, narrow(direction));
        }
        const Vec3d from = widen(point.position);
        const double across = dot(Vec3d{from.x, from.y, 0}, Vec3d{direction.x, direction.y, 0});
        const double t = -across / (direction.x * direction.x + direction.y * direction.y);
        const double focus = -(from.z + t * direction.z), right = n / (2 * (n - 1));
        score.decide(!(std::abs(focus / right - 1) <= 1e-4),
                     [&] { return fmt::format("n = {}, height {}: {} for {}", n, height, focus, right); });
    }
    return score;
}

/// A normal that is too long by 3 units of float does not lengthen what it mirrors.
Score long_normals(Random& random, std::size_t calls) {
    Score score;
    for (std::size_t i = 0; i < calls; ++i) {
        const Vec3d normal = any_unit(random) * (1 + 3 * 0x1p-24);
        const Vec3d direction = any_unit(random);
        const Vec3d mirrored = reflect(direction, normal);
        const double off = std::sqrt(dot(mirrored, mirrored)) - 1;
        score.decide(!(std::abs(off) <= 4 * unit), [&] { return fmt::format("too long by {}", off); });
        const auto many = reflect(broadcast<Wide>(direction), broadcast<Wide>(normal));
        const bool differs = bits_of(many.x[0]) != bits_of(mirrored.x) || bits_of(many.y[1]) != bits_of(mirrored.y) ||
                             bits_of(many.z[2]) != bits_of(mirrored.z);
        score.decide(differs, "a packet differs");
    }
    return score;
}

}  // namespace

std::vector<HardCase> dielectric_cases() {
    return {
        {"F1", "Near total internal reflection, 10^-2 to 10^-12",
         "1 - eta^2 (1 - cos^2) cancels: 19 % are decided wrongly at 10^-7", "MPFR, on the same vectors",
         FunctionCase{next_to_total}},
        {"F2", "Refraction 10^-6 to 0.3 from the normal", "1 - cos^2 keeps no digit of the angle",
         "MPFR, on the same vectors", FunctionCase{near_the_normal}},
        {"F3", "Equal indices, down to grazing", "the Fresnel formula is 0/0, and rounding bends the direction",
         "rule: the same bits, nothing reflected", FunctionCase{equal_indices}},
        {"F4", "The reflectance at grazing incidence", "rounding gives more than 1, or NaN",
         "rule: between 0 and 1; 1 at a cosine of 0", FunctionCase{grazing}},
        {"F5", "Reflected and transmitted fractions", "two formulas round differently", "MPFR; R + T = 1",
         FunctionCase{energy}},
        {"F6", "500 mirror reflections", "the length of the direction drifts", "closed form",
         FunctionCase{many_mirrors}},
        {"F7", "Entering or leaving, 10^-7 to 10^-12 from the tangent plane",
         "the sign is rounding noise, and glass turns into air", "exact arithmetic", FunctionCase{sides}},
        {"F8", "Dielectrics nested, crossing and in contact", "an exit is taken for an entry",
         "MPFR: every solid is tested between two crossings", FunctionCase{glass_in_glass}},
        {"F9", "The focus of a ball lens", "the errors of two surfaces accumulate", "closed form, paraxial",
         FunctionCase{ball_lens}},
        {"F10", "Reflection at a normal that is too long", "the direction inherits the error", "closed form",
         FunctionCase{long_normals}},
    };
}

}  // namespace tandem::hard
