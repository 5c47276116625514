// Group M: lights. This file has punctual lights and the choice among several; area lights are in group_m_surfaces.cpp,
// occluders in group_m_obstacles.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hard/corpus/functions.h"
#include "hard/corpus/groups.h"
#include "hard/corpus/lit_scenes.h"
#include "hard/corpus/pictures.h"
#include "hard/corpus/ray_batches.h"
#include "support/light_shares.h"
#include "tandem/base/error.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/lights/punctual_light.h"
#include "tandem/scene/icosphere.h"
#include "tandem/scene/light_cone.h"

namespace tandem::hard {

namespace {

using test::any_turn;
using test::any_unit;

/// Box, camera and light from one direction under one rotated root: N = L = V, and the highlight is 1 for every
/// exponent.
Score turned_highlight(const Subject& subject, Random& random, std::size_t) {
    Score score;
    for (const float shininess : {1.0F, 1e4F, 1e6F, 8e6F, 1e8F}) {
        for (int turn = 0; turn < 6; ++turn) {
            Scene scene = dark_scene({0, 0, 0}, 1e-3);
            add_shape(scene, BoxShape{{2, 2, 1}}, {0, 0, -3}, add_material(scene, mirror_lobe("lobe", shininess)));
            add_lamp(scene, {.kind = LightKind::directional, .casts_shadows = turn % 2 == 0}, {0, 0, 0});
            for (Node& node : scene.nodes) node.parent = static_cast<std::int32_t>(scene.nodes.size());
            const double scale = std::exp2(random.uniform(-3.0, 3.0));
            scene.nodes.push_back({.name = "root", .trs = {{1, 2, 3}, any_turn(random), Vec3d{1, 1, 1} * scale}});
            const PreparedScene prepared = prepare(scene);
            with_oracle(subject, [&](Backend& backend, const std::string& name) {
                const FilmMean film = mean_of(backend, prepared, square_film(subject, 4, 1), score);
                score.decide(!(std::abs(film.mean - 1) <= 2e-5),
                             [&] { return fmt::format("{}: n = {} gives {}", name, shininess, film.mean); });
            });
        }
    }
    return score;
}

/// A scene of one lit plane with these emissive spheres above it, in their order.
PreparedScene emissive_spheres(const std::vector<double>& radii) {
    Scene scene = dark_scene({0, 0, 1}, 0.1);
    const std::uint32_t lamp = add_material(scene, emissive("lamp", 1));
    for (std::size_t i = 0; i < radii.size(); ++i) {
        add_shape(scene, SphereShape{radii[i]}, {static_cast<double>(i), 0, 10}, lamp);
    }
    return prepare(scene);
}

/// All 64-bit numbers are distributed, each light's probability is the share of its numbers, and it is at least an
/// eighth of an equal share and at least seven eighths of the light's share of the power.
void judge_shares(const PreparedScene& scene, const std::vector<double>& powers, const std::string& what,
                  Score& score) {
    const std::vector<AreaLight>& lights = scene.area_lights;
    const auto count = static_cast<std::uint32_t>(lights.size());
    score.decide(lights.size() != powers.size() || lights.back().range_last != ~std::uint64_t{0},
                 [&] { return fmt::format("{}: {} lights, which leave numbers over", what, count); });
    double total = 0;
    for (const double power : powers) total += power;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint64_t first = i == 0 ? 0 : lights[i - 1].range_last + 1;
        const Exact numbers = Exact(lights[i].range_last) - Exact(first) + 1;
        const Exact off = Exact(lights[i].probability) / numbers * pow(Exact(2), 64) - 1;
        const double wanted = 7.0 / 8 * powers[i] / total + 1.0 / 8 / count;
        const bool is_right = abs(off) <= 0x1p-52 && std::abs(lights[i].probability / wanted - 1) <= 1e-9 &&
                              choose_area_light(lights.data(), count, first) == i &&
                              choose_area_light(lights.data(), count, lights[i].range_last) == i &&
                              probability_of(lights.data(), count, lights[i].primitive) == lights[i].probability;
        score.decide(!is_right, [&] {
            return fmt::format("{}: light {} is drawn with {} in place of {}", what, i, lights[i].probability, wanted);
        });
    }
}

/// Powers of 1 : 1 to 1 : 10^16, the weak one first, last and among others; a mesh of 20480 triangles.
Score area_shares(Random&, std::size_t) {
    Score score;
    for (const double ratio : {1.0, 1e-2, 1e-6, 2e-8, 1e-9, 1e-12, 1e-16}) {
        for (int place = 0; place < 4; ++place) {
            std::vector<double> radii(4, 1.0), powers;
            radii[static_cast<std::size_t>(place)] = std::sqrt(ratio);
            const PreparedScene scene = emissive_spheres(radii);
            for (const Sphere& sphere : scene.spheres) powers.push_back(widen(sphere.radius) * widen(sphere.radius));
            judge_shares(scene, powers, fmt::format("1 : {}, at {}", ratio, place), score);
        }
    }
    judge_shares(emissive_spheres({2}), {1}, "one sphere", score);
    Scene mesh = dark_scene({0, 0, 3}, 1);
    mesh.meshes = {icosphere(5)};
    add_shape(mesh, MeshShape{0}, {0, 0, 0}, add_material(mesh, emissive("lamp", 1)));
    const PreparedScene prepared = prepare(mesh);
    std::vector<double> areas;
    for (const Triangle& face : prepared.triangles) {
        const Vec3d twice = cross(widen(face.v1) - widen(face.v0), widen(face.v2) - widen(face.v0));
        areas.push_back(std::sqrt(dot(twice, twice)));
    }
    judge_shares(prepared, areas, "a mesh", score);
    return score;
}

/// The probability of the second of two lights, over all numbers.
Score light_choice_shares(Random& random, std::size_t calls) {
    Score score;
    const auto judge = [&](float first, float second) {
        const double right = double{second} / (double{first} + double{second});
        const double strict = test::chance_of_second<float>(first, second);
        const double precise = test::chance_of_second<double>(double{first}, double{second});
        for (const double chance : {strict, precise}) {
            score.decide(!(std::abs(chance / right - 1) <= 1e-7),
                         [&] { return fmt::format("{} : {} is taken with {}, not {}", first, second, chance, right); });
        }
    };
    for (const float ratio : {1e-12F, 1e-8F, 1e-7F, 1e-6F, 1e-2F, 1.0F, 1e6F}) judge(1, ratio);
    for (std::size_t i = 0; i < calls / 50; ++i) {
        judge(static_cast<float>(std::exp2(random.uniform(-20.0, 20.0))),
              static_cast<float>(std::exp2(random.uniform(-20.0, 20.0))));
    }
    return score;
}

/// If a light below an opaque sheet casts shadows, no term of Phong's model shows it from above. A light above the
/// sheet shows, and so does one without shadows, as in the paper.
Score behind_sheets(const Subject& subject, Random& random, std::size_t) {
    Score score;
    constexpr Vec3f corners[4] = {{-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4}};
    // Punctual lights
    const auto try_one = [&](LightKind kind, bool double_sided, bool triangles, bool below, bool shadows) {
        Scene scene = dark_scene({0, 0, 0}, 0.5);
        Material lobe = mirror_lobe("lobe", 8);
        lobe.phong.diffuse = {0.5F, 0.5F, 0.5F};
        lobe.sides = double_sided ? FaceSides::double_sided : FaceSides::single_sided;
        add_sheet(scene, corners, add_material(scene, lobe), triangles);
        // the camera looks at the origin from (-6, 1, 0); the lamp is at its mirror image
        scene.nodes[0].camera = PerspectiveCamera{0.3};
        scene.nodes[0].trs = {{-6, 1, 0}, {0, -std::sqrt(0.5), 0, std::sqrt(0.5)}, {1, 1, 1}};
        const double height = below ? -0.5 : 0.5;
        Node& lamp = add_lamp(scene, {.kind = kind, .outer_cone = 1.2, .casts_shadows = shadows}, {6, height, 0});
        const double angle = std::atan2(height, 6.0);
        // towards the origin: -z rotated to -x, then pitched up or down
        lamp.trs.rotation = Quaternion{0, std::sqrt(0.5), 0, std::sqrt(0.5)};
        if (kind != LightKind::point) {
            const double half = angle / 2;
            const Quaternion pitch = {-std::sin(half), 0, 0, std::cos(half)};
            const double s = std::sqrt(0.5);
            lamp.trs.rotation = {s * pitch.x, s * pitch.w, -s * pitch.x, s * pitch.w};
        }
        for (Node& node : scene.nodes) node.parent = static_cast<std::int32_t>(scene.nodes.size());
        scene.nodes.push_back({.name = "root", .trs = {{0, 0, 0}, any_turn(random), {1, 1, 1}}});
        const PreparedScene prepared = prepare(scene);
        with_oracle(subject, [&](Backend& backend, const std::string& name) {
            const FilmMean film = mean_of(backend, prepared, square_film(subject, 16, 2), score);
            const bool is_dark = film.mean == 0;
            const bool wanted = below && shadows;
            score.leaks += wanted && !is_dark;
            score.decide(is_dark != wanted, [&] {
                return fmt::format("{}: light of kind {} {} a sheet{}{}: {}", name, static_cast<int>(kind),
                                   below ? "below" : "above", double_sided ? ", double-sided" : "",
                                   shadows ? "" : ", without shadows", film.mean);
            });
        });
    };
    for (const LightKind kind : {LightKind::point, LightKind::spot, LightKind::directional}) {
        for (const bool double_sided : {false, true}) {
            for (const bool triangles : {false, true}) {
                for (const bool below : {false, true}) try_one(kind, double_sided, triangles, below, true);
            }
        }
        try_one(kind, false, false, true, false);
    }
    // An emissive ball in place of the lamp: no path from above hits what is below the sheet
    for (const bool indirect : {false, true}) {
        for (const bool double_sided : {false, true}) {
            Scene scene = dark_scene({0, 0, 0}, 0.5);
            scene.nodes[0].camera = PerspectiveCamera{0.3};
            scene.nodes[0].trs = {{-6, 1, 0}, {0, -std::sqrt(0.5), 0, std::sqrt(0.5)}, {1, 1, 1}};
            Material lobe = mirror_lobe("lobe", 8);
            lobe.phong.diffuse = {0.5F, 0.5F, 0.5F};
            lobe.sides = double_sided ? FaceSides::double_sided : FaceSides::single_sided;
            add_sheet(scene, corners, add_material(scene, lobe));
            add_shape(scene, SphereShape{0.1}, {6, -0.5, 0}, add_material(scene, emissive("lamp", 100)));
            scene.indirect_light = indirect;
            const PreparedScene prepared = prepare(scene);
            with_oracle(subject, [&](Backend& backend, const std::string& name) {
                const FilmMean film = mean_of(backend, prepared, square_film(subject, 16, 2), score);
                score.leaks += film.mean != 0;
                score.decide(film.mean != 0, [&] {
                    return fmt::format("{}: a ball below a sheet{}: {}", name, indirect ? ", indirect" : "", film.mean);
                });
            });
        }
    }
    return score;
}

/// The light of a spot on a plane below it, over kd: the integral of cos f^2 over the plane, by rings. Without
/// fall-off.
double spot_total(double inner, double outer, double height) {
    constexpr int steps = 20000;
    double sum = 0;
    const auto versine = [](double a) { return 2 * std::sin(a / 2) * std::sin(a / 2); };
    for (int i = 0; i < steps; ++i) {
        const double angle = outer * (i + 0.5) / steps;
        const double share = std::min(1.0, (versine(outer) - versine(angle)) / (versine(outer) - versine(inner)));
        const double cosine = std::cos(angle);
        sum += cosine * share * share * 2 * std::numbers::pi * std::tan(angle) / (cosine * cosine);
    }
    return sum * (outer / steps) * height * height;
}

/// The whole light of cones from 0.3 down to 10^-6 radians.
Score narrow_spots(const Subject& subject, Random&, std::size_t) {
    Score score;
    for (const double outer : {0.3, 1e-2, 1e-3, 3e-4, 1e-4, 1e-5, 1e-6}) {
        for (const double part : {0.0, 0.5, 0.95}) {
            const double ymag = 1.1 * std::tan(outer);
            Scene scene = dark_scene({0, 2, 0}, ymag, downward());
            add_shape(scene, BoxShape{{4, 1, 4}}, {0, -0.5, 0}, add_material(scene, lambertian_material("diffuse", 1)));
            add_lamp(scene, {.kind = LightKind::spot, .inner_cone = part * outer, .outer_cone = outer}, {0, 1, 0},
                     downward());
            const PreparedScene prepared = prepare(scene);
            const double right = spot_total(part * outer, outer, 1);
            with_oracle(subject, [&](Backend& backend, const std::string& name) {
                const FilmMean film = mean_of(backend, prepared, square_film(subject, 48, 8), score);
                const double total = film.mean * 4 * ymag * ymag;
                score.decide(!(std::abs(total / right - 1) <= 0.01), [&] {
                    return fmt::format("{}: a spot of {} rad, inner {}, brings {} of its light", name, outer,
                                       part * outer, total / right);
                });
            });
        }
    }
    return score;
}

/// The intensity of a spot at a point against the definition, in all lanes.
Score spot_shares(Random& random, std::size_t calls) {
    using Spots = EffectSet<EffectMask(Effect::spot_lights).bits()>;
    Score score;
    for (std::size_t i = 0; i < calls; ++i) {
        const double outer = std::pow(10.0, random.uniform(-6.0, 0.1));
        const double inner = outer * random.uniform(0.0, 0.9);
        const LightCone cone = light_cone(inner, outer);
        const Vec3d axis = any_unit(random);
        const PunctualLight light = {axis,      cone.height,        cone.scale, narrow(any_unit(random)),
                                     {1, 1, 1}, PunctualKind::spot, 0,          0};
        const double angle = outer * random.uniform(0.0, 0.95);
        const Vec3d towards = axis * std::cos(angle) + test::any_across(random, axis) * std::sin(angle);
        const Vec3d point = widen(light.position) + towards * std::exp2(random.uniform(-10.0, 10.0));
        const auto square = [](const Exact& x) { return Exact(x * x); };
        const auto away = [&](int k) { return Exact(point[k]) - Exact(light.position[k]); };
        const Exact length = sqrt(square(away(0)) + square(away(1)) + square(away(2)));
        const Exact axis_length = sqrt(square(Exact(axis.x)) + square(Exact(axis.y)) + square(Exact(axis.z)));
        const Exact cosine =
            (away(0) * Exact(axis.x) + away(1) * Exact(axis.y) + away(2) * Exact(axis.z)) / length / axis_length;
        Exact share = (cosine - cos(Exact(outer))) / (cos(Exact(inner)) - cos(Exact(outer)));
        if (share > 1) share = 1;
        const float value = light_at<Spots, float>(light, point).intensity.x;
        const Vec3<Double<Packet>> points = {Double<Packet>(point.x), Double<Packet>(point.y), Double<Packet>(point.z)};
        const float in_packet = light_at<Spots, Packet>(light, points).intensity.x[1];
        const auto line = [&] { return fmt::format("a spot of {} rad, at {} of it: {}", outer, angle / outer, value); };
        score.decide(!same_bits(value, in_packet), line);
        score.measure(ulps_from(value, Exact(share * share)), line);
    }
    return score;
}

/// Lights exactly at the shaded point, with and without fall-off: no light, no NaN, and the ambient light stays.
Score at_the_light(const Subject& subject, Random&, std::size_t) {
    Score score;
    constexpr Vec3f corners[4] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    for (const LightKind kind : {LightKind::point, LightKind::spot}) {
        for (const bool falls_off : {true, false}) {
            for (const bool shadows : {true, false}) {
                for (const float shininess : {0.0F, 8.0F}) {
                    Scene scene = dark_scene({0, 0, 1}, 1e-200);  // all of the film is one point
                    Material material = bright("bright");
                    material.phong = {{0.5F, 0.5F, 0.5F}, {0.5F, 0.5F, 0.5F}, {0.5F, 0.5F, 0.5F}, shininess};
                    add_sheet(scene, corners, add_material(scene, material));
                    scene.environment.ambient = {1, 1, 1};
                    add_lamp(scene, {.kind = kind, .inverse_square = falls_off, .casts_shadows = shadows}, {0, 0, 0});
                    const PreparedScene prepared = prepare(scene, {.origin = Vec3d{0, 0, 0}});
                    with_oracle(subject, [&](Backend& backend, const std::string& name) {
                        const FilmMean film = mean_of(backend, prepared, square_film(subject, 5, 2), score);
                        score.nans += film.invalid;
                        score.decide(!(std::abs(film.mean - 0.5) <= 1e-6), [&] {
                            return fmt::format("{}: a light {} at the point leaves {} of the ambient light", name,
                                               falls_off ? "that falls off" : "without fall-off", film.mean);
                        });
                    });
                }
            }
        }
    }
    return score;
}

/// Kernels read floats: colour times intensity and the cone of a spot must not overflow or vanish.
Score beyond_float(Random&, std::size_t) {
    Score score;
    const auto judge = [&](const LightSource& light, bool is_good, const std::string& what) {
        Scene scene = dark_scene({0, 0, 1}, 1);
        add_shape(scene, SphereShape{0.3}, {0, 0, 0}, add_material(scene, lambertian_material("diffuse", 0.5F)));
        add_lamp(scene, light, {0, 0, 2});
        bool taken = true;
        try {
            (void)prepare(scene);
        } catch (const InputError& error) {
            taken = std::string(error.what()).find("lamp") == std::string::npos;
        }
        score.decide(taken != is_good, [&] { return fmt::format("{} is {}", what, taken ? "taken" : "refused"); });
    };
    judge({.colour = {1e30F, 0, 0}, .intensity = 1e30F}, false, "1e30 times 1e30");
    judge({.colour = {0, 0, 3e38F}, .intensity = 2}, false, "3e38 times 2");
    judge({.colour = {1e-30F, 1, 0}, .intensity = 3e38F}, true, "1 times 3e38");
    judge({.colour = {1e30F, 0, 0}, .intensity = 1e8F}, true, "1e30 times 1e8");
    judge({.kind = LightKind::spot, .outer_cone = 1e-200}, false, "a spot of 1e-200 rad");
    judge({.kind = LightKind::spot, .outer_cone = 1e-12}, true, "a spot of 1e-12 rad");
    return score;
}

/// Lights that contribute nothing, among three that do: with indirect light, where one light is sampled, the same bits.
Score without_effect(const Subject& subject, Random&, std::size_t) {
    Score score;
    const auto scene_with = [&](bool more) {
        Scene scene = dark_scene({0, 2, 0}, 0.8, downward());
        const std::uint32_t lambertian = add_material(scene, lambertian_material("diffuse", 0.7F));
        add_shape(scene, BoxShape{{4, 1, 4}}, {0, -0.5, 0}, lambertian);
        add_shape(scene, SphereShape{0.3}, {0.2, 0.3, 0.1}, lambertian);
        scene.indirect_light = true;
        const auto nothing = [&] {
            if (!more) return;
            add_lamp(scene, {.kind = LightKind::spot, .outer_cone = 0.3}, {0.3, -3, 0.2}, downward());
            add_lamp(scene, {.kind = LightKind::spot, .outer_cone = 0.3, .inverse_square = true}, {0, 3, 0},
                     {std::sqrt(0.5), 0, 0, std::sqrt(0.5)});  // upward
        };
        nothing();
        add_lamp(scene, {.colour = {1, 0.2F, 0}, .intensity = 0.4F}, {1, 2, 0.5});
        nothing();
        add_lamp(scene, {.colour = {0, 0.3F, 1}, .intensity = 0.1F}, {-1, 1, 0.5});
        add_lamp(scene, {.kind = LightKind::directional, .intensity = 1e-6F}, {0, 0, 0}, downward());
        nothing();
        return prepare(scene);
    };
    const Film right = picture_of(subject.backend, scene_with(false), small_picture(subject), score);
    compare_bits(picture_of(subject.backend, scene_with(true), small_picture(subject), score), right,
                 "more lights, without effect", score);
    std::size_t lit = 0;
    for (const Vec3d& sum : right.sums()) lit += sum.x > 0;
    score.decide(lit < right.pixel_count() / 2, "the scene is dark");
    return score;
}

}  // namespace

std::vector<HardCase> light_cases() {
    return {
        {"M1", "A highlight under a rotated directional light; n up to 10^8",
         "the length of a direction in float counts n times: off by 92 % at 10^8", "closed form: N = L = V",
         RenderCase{turned_highlight}},
        {"M2", "Probabilities of area lights, 1 : 10^16, and of 20480 triangles",
         "a 24-bit number is compared with sums in float: a weak light gets 60 times its share, or nothing",
         "every number belongs to a light, and each probability is that of its numbers", FunctionCase{area_shares}},
        {"M3", "The choice of one light per vertex, 1 : 10^12",
         "one number for all lights runs out of bits: weak lights get 1.19 of their share, or nothing",
         "the probability, over all possible numbers", FunctionCase{light_choice_shares}},
        {"M4", "Lights behind open surfaces",
         "Phong's highlight depends only on the mirrored direction, and the shadow ray leaves on the light's side",
         "rule: a light with shadows does not shine through", RenderCase{behind_sheets}},
        {"M5", "The total flux of spot lights from 0.3 to 10^-6 radians",
         "the cosine of the angle in float keeps no digit: from 0 to 1.65 of the flux", "closed form",
         RenderCase{narrow_spots}},
        {"M6", "The fall-off in a spot light's cone, down to 10^-6 radians", "1 - cos cancels", "MPFR",
         FunctionCase{spot_shares}},
        {"M7", "A light exactly at the shaded point",
         "1 / 0 times 0 is NaN, and the sample loses its ambient light too", "rule: no light, no NaN",
         RenderCase{at_the_light}},
        {"M8", "Colour times intensity, and cones, beyond float", "every sample is infinite or NaN",
         "rule: refused with a reason", FunctionCase{beyond_float}},
        {"M9", "Lights that contribute nothing", "they change the number that selects among the others",
         "metamorphosis: equal bits", RenderCase{without_effect}},
    };
}

}  // namespace tandem::hard
