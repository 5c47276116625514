// Group M: area lights, and lights at surfaces.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "hard/corpus/groups.h"
#include "hard/corpus/lit_scenes.h"
#include "hard/corpus/pictures.h"
#include "support/polygon_forms.h"
#include "tandem/backends/make_backend.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"

namespace tandem::hard {

namespace {

/// A lamp under a roof, above which is a light 10^6 to 10^15 times as strong. The lamp is the first or the last of the
/// two, with and without indirect light.
Score under_a_roof(const Subject& subject, Random&, std::size_t) {
    Score score;
    for (const double ratio : {1e6, 1e9, 1e12, 1e15}) {
        for (int number = 0; number < 4; ++number) {
            Scene scene = dark_scene({0.5, 1, 0}, 1e-3, downward());
            add_shape(scene, BoxShape{{40, 1, 40}}, {0, -0.5, 0},
                      add_material(scene, lambertian_material("floor", 0.6F)));
            const std::uint32_t lamp = add_material(scene, emissive("lamp", 5));
            // 4 pi 100^2 against 4 pi 0.25^2
            const auto power = static_cast<float>(5 * ratio / 160'000);
            const std::uint32_t sun = add_material(scene, emissive("sun", power));
            const auto add = [&](bool is_lamp) {
                if (is_lamp) add_shape(scene, SphereShape{0.25}, {0, 1, 0}, lamp);
                if (!is_lamp) add_shape(scene, SphereShape{100}, {0, 1000, 0}, sun);
            };
            add(number % 2 == 0);
            add_shape(scene, BoxShape{{40, 0.1, 40}}, {0, 3, 0}, add_material(scene, lambertian_material("roof", 0)));
            add(number % 2 != 0);
            // what paths find are walls that are black, but for the floor, which does not see itself
            scene.indirect_light = number / 2 != 0;
            const double distance2 = 0.5 * 0.5 + 1, distance = std::sqrt(distance2);
            const double right = 0.6F * 5 * (0.25 * 0.25 / distance2) * (1 / distance);
            const FilmMean film = mean_of(subject.backend, prepare(scene), square_film(subject, 24, 64), score);
            judge_mean(score, film, right, 1e-4, 0.05, fmt::format("1 : {}, scene {}", ratio, number));
        }
    }
    return score;
}

/// Folded sheets, whose halves face different sides: at a point below, the light of the halves whose fronts are
/// visible, by Lambert's formula. With indirect light paths hit them too.
Score folded_lights(const Subject& subject, Random&, std::size_t) {
    struct Fold {
        const char* name;
        Vec3f corner[4];
        bool first, second;  ///< whose fronts are seen from the origin
    };
    const Fold folds[] = {
        {"a roof", {{-1, 2, 0}, {0, 1.5F, 1}, {1, 2, 0}, {0, 1.5F, -1}}, true, true},
        {"a trough", {{-1, 1.5F, 0}, {0, 2, 1}, {1, 1.5F, 0}, {0, 2, -1}}, true, true},
        {"the first half to the other side",
         {{-1, 2, 0.2F}, {0, 3, -0.1F}, {1, 2, 0.2F}, {0, 1.8F, -1.5F}},
         false,
         true},
        {"the second half to the other side",
         {{-1, 2, 0.2F}, {0, 1.8F, 1.5F}, {1, 2, 0.2F}, {0, 3, 0.5F}},
         true,
         false},
        {"flat", {{-1, 2, 1}, {1, 2, 1}, {1, 2, -1}, {-1, 2, -1}}, true, true},
    };
    // the back of one half hides the other, emissive half: compare with the oracle or, if backs are culled, with the
    // formula for the whole half
    const Fold half_hidden = {
        "half hidden", {{-1, 2, 0.2F}, {0, 1.2F, -0.3F}, {1, 2, 0.2F}, {0, 2.2F, -1.5F}}, false, true};
    // The scene and the formula of a fold
    const auto scene_of_fold = [](const Fold& fold, FaceSides sides, bool indirect) {
        Scene scene = dark_scene({0, 1, 0}, 1e-4, downward());
        add_shape(scene, BoxShape{{9, 1, 9}}, {0, -0.5, 0}, add_material(scene, lambertian_material("floor", 0.6F)));
        Material lamp = emissive("lamp", 5);
        lamp.sides = sides;
        // seen from below the corners run clockwise
        const Vec3f corner[4] = {fold.corner[0], fold.corner[3], fold.corner[2], fold.corner[1]};
        add_sheet(scene, corner, add_material(scene, lamp));
        scene.indirect_light = indirect;
        return prepare(scene);
    };
    const auto form_of = [](const Fold& fold) {
        const auto half = [&](int a, int b, int c) {
            return test::lambert({0, 0, 0}, {0, 1, 0},
                                 {widen(fold.corner[a]), widen(fold.corner[b]), widen(fold.corner[c])});
        };
        return 0.6F * 5 * ((fold.first ? half(0, 1, 2) : 0) + (fold.second ? half(0, 2, 3) : 0)) / std::numbers::pi;
    };
    // Compare all folds
    const RenderJob job = square_film(subject, 32, 64);
    Score score;
    for (const bool indirect : {false, true}) {
        for (const FaceSides sides : {FaceSides::single_sided, FaceSides::double_sided, FaceSides::culled}) {
            for (const Fold& fold : folds) {
                if (sides == FaceSides::double_sided && !(fold.first && fold.second)) continue;  // one hides the other
                const FilmMean film = mean_of(subject.backend, scene_of_fold(fold, sides, indirect), job, score);
                judge_mean(score, film, form_of(fold), 1e-4, 0.01,
                           fmt::format("{}{}", fold.name, indirect ? ", with indirect light" : ""));
            }
            const PreparedScene prepared = scene_of_fold(half_hidden, sides, indirect);
            const FilmMean film = mean_of(subject.backend, prepared, job, score);
            double right = form_of(half_hidden), slack = 1e-4;
            if (sides != FaceSides::culled) {
                RenderJob fewer = job;
                fewer.tier = Tier::precise;
                const FilmMean oracle = mean_of(*make_backend("oracle"), prepared, fewer, score);
                right = oracle.mean;
                slack = 5 * oracle.error / oracle.mean;
            }
            judge_mean(score, film, right, slack, 0.01, fmt::format("half hidden, sides {}", static_cast<int>(sides)));
        }
    }
    return score;
}

/// An emissive ball and square, half a radius above a face and 1000 to 30000 radii from the origin, found by paths and
/// sampled: the mean over a square below it.
Score above_a_face(const Subject& subject, Random&, std::size_t) {
    constexpr double reach = 0.25;
    const auto mean_below = [](int steps, const auto& form) {
        double sum = 0;
        for (int i = 0; i < steps; ++i) {
            for (int k = 0; k < steps; ++k) {
                sum += form(reach * (2 * (i + 0.5) / steps - 1), reach * (2 * (k + 0.5) / steps - 1));
            }
        }
        return sum / (steps * steps);
    };
    // of a ball that is above the horizon, r^2 d / (d^2 + x^2)^(3/2)
    const double of_ball =
        mean_below(200, [](double x, double z) { return 1.5 / std::pow(1.5 * 1.5 + x * x + z * z, 1.5); });
    const double of_square = mean_below(40, [](double x, double z) {
        return test::lambert({x, 0, z}, {0, 1, 0}, {{-1, 0.5, 1}, {-1, 0.5, -1}, {1, 0.5, -1}, {1, 0.5, 1}}) /
               std::numbers::pi;
    });
    Score score;
    for (const double away : {1024.0, 8192.0, 32768.0}) {
        for (const bool triangles : {false, true}) {
            for (const bool is_ball : {true, false}) {
                const Vec3d at = Vec3d{1, 1, -1} * away;
                const auto square = [&](double height, float half) {
                    return Square(static_cast<float>(at.x), static_cast<float>(at.y + height), static_cast<float>(at.z),
                                  half);
                };
                Scene scene = dark_scene({at.x, at.y + 0.375, at.z}, reach, downward());
                add_sheet(scene, square(0, 64).corner, add_material(scene, lambertian_material("floor", 0.6F)),
                          triangles);
                const std::uint32_t lamp = add_material(scene, emissive("lamp", 5));
                if (is_ball) {
                    add_shape(scene, SphereShape{1}, at + Vec3d{0, 1.5, 0}, lamp);
                } else {
                    const Square up = square(0.5, 1);
                    add_sheet(scene, {up.corner[3], up.corner[2], up.corner[1], up.corner[0]}, lamp, triangles);
                }
                scene.indirect_light = true;
                const PreparedScene prepared = prepare(scene, {.origin = Vec3d{0, 0, 0}});
                const FilmMean film = mean_of(subject.backend, prepared, square_film(subject, 64, 256), score);
                judge_mean(score, film, 0.6F * 5 * (is_ball ? of_ball : of_square), 2e-4, 1e-3,
                           fmt::format("{}, {} radii away", is_ball ? "a ball" : "a square", away));
            }
        }
    }
    return score;
}

/// A lamp in the plane of a sheet does not light it. One that lies exactly on a ceiling, or at the lowest vertex of a
/// solid, is not hidden by it: the floor is lit as without it.
Score at_surfaces(const Subject& subject, Random& random, std::size_t) {
    Score score;
    for (int number = 0; number < 12; ++number) {
        const Vec3d lamp = {random.uniform(-0.3, 0.3), random.uniform(1.5, 2.5), random.uniform(-0.3, 0.3)};
        const Vec3f exact = narrow(lamp);
        const auto floor_with = [&](int what) {
            Scene scene = dark_scene({0, 1, 0}, 0.5, downward());
            Material floor = lambertian_material("floor", 0.8F);
            floor.phong.specular = {0.3F, 0.3F, 0.3F};
            add_sheet(scene, Square(0, 0, 0, 4).corner, add_material(scene, floor));
            const std::uint32_t lambertian = add_material(scene, lambertian_material("diffuse", 0.5F));
            if (what == 1) add_sheet(scene, Square(0, exact.y, 0, 4).corner, lambertian, number % 2 == 0);
            if (what == 2) add_shape(scene, BoxShape{{8, 1, 8}}, {0, double{exact.y} + 0.5, 0}, lambertian);
            if (what == 3) {  // a pyramid on its tip
                Mesh mesh{.name = "tip", .positions = {exact}};
                for (const Vec3f& corner : {Vec3f{1, 1, 1}, Vec3f{-1, 1, 1}, Vec3f{-1, 1, -1}, Vec3f{1, 1, -1}}) {
                    mesh.positions.push_back(exact + corner);
                }
                mesh.triangles = {0, 2, 1, 0, 3, 2, 0, 4, 3, 0, 1, 4, 1, 2, 3, 1, 3, 4};
                scene.meshes.push_back(mesh);
                add_shape(scene, MeshShape{static_cast<std::uint32_t>(scene.meshes.size() - 1)}, {0, 0, 0}, lambertian);
            }
            add_lamp(scene, {.inverse_square = number % 2 == 0}, widen(exact));
            return prepare(scene, {.origin = Vec3d{0, 0, 0}});
        };
        with_oracle(subject, [&](Backend& backend, const std::string& name) {
            const Film right = picture_of(backend, floor_with(0), small_picture(subject), score);
            for (int what = 1; what <= 3; ++what) {
                compare_bits(picture_of(backend, floor_with(what), small_picture(subject), score), right,
                             fmt::format("{}: a lamp upon surface {}", name, what), score);
            }
        });
        // in the plane of the floor, beside what is seen and within it
        for (const double x : {0.2, 1.5, 6.0}) {
            Scene scene = dark_scene({0, 1, 0}, 0.5, downward());
            Material floor = mirror_lobe("floor", static_cast<float>(number));
            floor.phong.diffuse = {1, 1, 1};
            floor.sides = number % 2 == 0 ? FaceSides::single_sided : FaceSides::double_sided;
            add_sheet(scene, Square(0, 0, 0, 4).corner, add_material(scene, floor));
            add_lamp(scene, {}, {x, 0, 0.3});
            const PreparedScene prepared = prepare(scene, {.origin = Vec3d{0, 0, 0}});
            with_oracle(subject, [&](Backend& backend, const std::string& name) {
                const FilmMean film = mean_of(backend, prepared, square_film(subject, 12, 2), score);
                score.decide(film.mean != 0,
                             [&] { return fmt::format("{}: a lamp in the plane, at {}: {}", name, x, film.mean); });
            });
        }
    }
    return score;
}

}  // namespace

std::vector<HardCase> light_surface_cases() {
    return {
        {"M10", "A lamp under a roof, and a light 10^15 times as strong above it",
         "the strong light is sampled every time, and the roof blocks it", "closed form", RenderCase{under_a_roof}},
        {"M15", "Folded emissive quads",
         "the normal of the first half is used for both, and the light of the other half is lost",
         "closed form, Lambertian, for each half", RenderCase{folded_lights}},
        {"M17", "An emissive sphere or square half a radius above a face, far from the origin",
         "rays start above the face, so the weights of the light that they find belong to another point", "closed form",
         RenderCase{above_a_face}},
        {"M19", "Lights in a plane, on a surface, at a vertex", "rounding decides, pixel by pixel",
         "rule: no light in the plane; not blocked by the surface that it lies on", RenderCase{at_surfaces}},
    };
}

}  // namespace tandem::hard
