// Group M: occluders of light, and scenes that are hard to prepare.
#include <fmt/format.h>
#include <xmmintrin.h>

#include <algorithm>
#include <cfenv>
#include <cmath>

#include "hard/corpus/groups.h"
#include "hard/corpus/lit_scenes.h"
#include "hard/corpus/pictures.h"
#include "hard/corpus/ray_batches.h"
#include "tandem/base/error.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/render/motion_blur.h"
#include "tandem/scene/icosphere.h"
#include "tandem/scene/named_scenes.h"

namespace tandem::hard {

namespace {

using test::any_turn;

/// Fully masked-out sheets lie exactly on an opaque one, which has the highest or the lowest id: the camera sees it, it
/// blocks the light, and paths through masked sheets elsewhere find a lamp as if there were none.
Score masked_sheets_on_opaque_ones(const Subject& subject, Random& random, std::size_t) {
    Score score;
    // Stacks of masked-out sheets around an opaque one
    Material masked = lambertian_material("masked", 0.5F);
    masked.alpha_mode = AlphaMode::mask;
    masked.alpha = 0;
    masked.sides = FaceSides::double_sided;
    const auto stack = [&](Scene& scene, float height, float half, int before, int behind, bool triangles,
                           std::uint32_t opaque) {
        const Square square(0, height, 0, half);
        // a material each: none is another's copy
        for (int i = 0; i < before; ++i) add_sheet(scene, square.corner, add_material(scene, masked), triangles);
        add_sheet(scene, square.corner, opaque, triangles);
        for (int i = 0; i < behind; ++i) add_sheet(scene, square.corner, add_material(scene, masked), triangles);
    };
    for (const bool triangles : {false, true}) {
        for (const auto& masked_sheets : {std::pair{1, 0}, {0, 1}, {3, 2}, {20, 20}}) {
            const int before = masked_sheets.first, behind = masked_sheets.second;
            for (const float height : {0.25F, 1e-3F, 777.125F}) {
                Scene seen = dark_scene({0, double{height} + 1, 0}, 0.4, downward());
                Scene shadow = dark_scene({0, 0.5 * double{height}, 0}, 0.1 * double{height}, downward());
                seen.environment.ambient = {1, 1, 1};
                Material white = bright("white");
                white.sides = FaceSides::double_sided;
                stack(seen, height, 0.5F, before, behind, triangles, add_material(seen, white));
                stack(shadow, height, 4 * height, before, behind, triangles, add_material(shadow, white));
                add_shape(shadow, BoxShape{{1e4, 1, 1e4}}, {0, -0.5, 0},
                          add_material(shadow, lambertian_material("floor", 1)));
                add_lamp(shadow, {}, Vec3d{0.01, 2, 0.02} * double{height});
                for (Scene* scene : {&seen, &shadow}) {
                    const bool is_seen = scene == &seen;
                    if (is_seen) {  // under any turn the corners are still the same
                        for (Node& node : scene->nodes) node.parent = static_cast<std::int32_t>(scene->nodes.size());
                        scene->nodes.push_back({.name = "root", .trs = {{0, 0, 0}, any_turn(random), {1, 1, 1}}});
                    }
                    const PreparedScene prepared = prepare(*scene);
                    with_oracle(subject, [&](Backend& backend, const std::string& name) {
                        const FilmMean film = mean_of(backend, prepared, square_film(subject, 12, 2), score);
                        score.leaks += film.mean != (is_seen ? 1 : 0);
                        score.decide(film.mean != (is_seen ? 1 : 0), [&] {
                            return fmt::format("{}: {} masked sheets before, {} behind at {}: {} {}", name, before,
                                               behind, height, is_seen ? "the sheet shows" : "under the sheet there is",
                                               film.mean);
                        });
                    });
                }
            }
        }
    }
    // A lamp behind masked-out sheets, which paths find: its light is unchanged
    for (const int sheets : {0, 1, 3}) {
        Scene scene = dark_scene({0, 0.9, 0}, 1e-3, downward());
        add_shape(scene, BoxShape{{40, 1, 40}}, {0, -0.5, 0}, add_material(scene, lambertian_material("floor", 0.6F)));
        const std::uint32_t open = add_material(scene, masked);
        for (int i = 0; i < sheets; ++i) {
            add_sheet(scene, Square(0, 0.3F + 0.1F * static_cast<float>(i), 0, 20).corner, open);
        }
        add_shape(scene, SphereShape{1}, {0, 2, 0}, add_material(scene, emissive("lamp", 5)));
        scene.indirect_light = true;
        const FilmMean film = mean_of(subject.backend, prepare(scene), square_film(subject, 32, 64), score);
        judge_mean(score, film, 0.6F * 5 / 4.0, 1e-4, 0.01, fmt::format("a lamp behind {} masked sheets", sheets));
    }
    return score;
}

/// Texels of alpha k / 255 with that float as the cutoff are opaque in every tier. One level below is masked out.
Score alpha_levels(const Subject& subject, Random&, std::size_t) {
    Score score;
    for (const int above : {0, 1}) {
        Scene scene = dark_scene({0, 0, 1}, 0.5);
        scene.environment.ambient = {1, 1, 1};
        Image levels{.name = "levels", .width = 256, .height = 1};
        for (std::uint32_t k = 0; k < 256; ++k) levels.texels.push_back(0x00FFFFFFU | k << 24);
        scene.images.push_back(levels);
        scene.textures.push_back({0, Wrap::clamp_to_edge, Wrap::clamp_to_edge, Filter::nearest});
        for (std::uint32_t k = 1; k + 1 < 256; ++k) {
            Material material = bright(fmt::format("level {}", k));
            material.diffuse_texture = TextureReference{};
            material.alpha_mode = AlphaMode::mask;
            material.alpha_cutoff = static_cast<float>(k + static_cast<std::uint32_t>(above)) / 255.0F;
            const auto x = static_cast<float>(k) - 127.5F;
            add_sheet(scene, {{x - 0.5F, -1, 0}, {x + 0.5F, -1, 0}, {x + 0.5F, 1, 0}, {x - 0.5F, 1, 0}},
                      add_material(scene, material));
            const float u = (static_cast<float>(k) + 0.5F) / 256;
            scene.meshes.back().texcoords = {{{u, 0.5F}, {u, 0.5F}, {u, 0.5F}, {u, 0.5F}}};
        }
        const PreparedScene prepared = prepare(scene);
        // a pixel for each level, from 1 to 254
        const RenderJob job = {.width = 254, .height = 1, .samples = 3, .seed = 1, .frame = 0, .tier = subject.tier};
        with_oracle(subject, [&](Backend& backend, const std::string& name) {
            const Film film = picture_of(backend, prepared, job, score);
            for (std::size_t i = 0; i < film.pixel_count(); ++i) {
                const bool is_there = film.sums()[i].x > 0;
                score.decide(is_there == (above == 1), [&] {
                    return fmt::format("{}: alpha {} of 255 against a cutoff of {} of 255 is {}", name, i + 1,
                                       i + 1 + static_cast<std::size_t>(above), is_there ? "opaque" : "masked out");
                });
            }
        });
    }
    return score;
}

/// Faces and solids of 10^10 to 10^17 metres, lit by a lamp and a sun: every pixel is finite, and no ray aborts the
/// process.
Score far_out(const Subject& subject, Random& random, std::size_t) {
    Score score;
    for (const double size : {1e10, 2e13, 1e15, 1e17}) {
        for (const bool indirect : {false, true}) {
            Scene scene = dark_scene({0, 0, 3 * size}, size);
            scene.nodes[0].camera = PerspectiveCamera{0.8};
            Material material = lambertian_material("diffuse", 0.5F);
            material.phong.specular = {0.5F, 0.5F, 0.5F};
            material.sides = FaceSides::double_sided;
            const std::uint32_t lambertian = add_material(scene, material);
            const auto place = [&] { return Vec3d{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), 0} * size; };
            for (int i = 0; i < 24; ++i) {
                Vec3f corner[4];
                for (Vec3f& c : corner) c = narrow(place() + Vec3d{0, 0, random.uniform(-0.3, 0.3) * size});
                add_sheet(scene, corner, lambertian, i % 2 == 0);
                add_shape(scene, SphereShape{0.05 * size}, place(), lambertian);
                add_shape(scene, BoxShape{Vec3d{0.1, 0.05, 0.2} * size}, place(), lambertian, any_turn(random));
            }
            scene.indirect_light = indirect;
            add_lamp(scene, {.kind = LightKind::directional}, {0, 0, 0}, {0.3, 0.1, 0, 0.9});
            add_lamp(scene, {}, Vec3d{0.5, 1, 2} * size);
            const Film film = picture_of(subject.backend, prepare(scene), small_picture(subject), score);
            if (subject.tier == Tier::fast) score.nans = 0;  // beyond its numbers samples are left out, and counted
            for (const Vec3d& sum : film.sums()) {
                score.decide(!(sum.x >= 0 && sum.x <= 100), [&] { return fmt::format("{} at size {}", sum.x, size); });
            }
        }
    }
    return score;
}

/// What a transform shrinks to nothing is dropped and counted, at any time of an animation, and changes nothing else;
/// what it flattens is refused.
Score hidden(Random& random, std::size_t) {
    Score score;
    const auto body = [&](int kind) {
        Node node{.name = "hidden", .trs = {{0.3, 0.1, -4}, any_turn(random), {1, 1, 1}}};
        if (kind == 0) node.geometry.push_back({SphereShape{0.5}, 0, {}});
        if (kind == 1) node.geometry.push_back({BoxShape{}, 0, {}});
        if (kind == 2) node.light = LightSource{.kind = LightKind::spot};
        if (kind == 3) node.light = LightSource{.kind = LightKind::directional};
        return node;
    };
    // Objects that are hidden at all times
    for (int kind = 0; kind < 4; ++kind) {
        for (const Vec3d& scale : {Vec3d{0, 0, 0}, Vec3d{1e-60, 1e-60, 1e-60}, Vec3d{0, 0, 1}, Vec3d{1e-60, 0, 0}}) {
            for (const bool by_parent : {false, true}) {
                // a light keeps the direction that a minute scale leaves it
                if (kind >= 2 && scale != Vec3d{0, 0, 0}) continue;
                Scene scene = scene_of({{{0, 0, -5}, 1}, {{1, 1, -6}, 0.5F}});
                const std::string without = scene_hash(prepare(scene, {.origin = Vec3d{0, 0, 0}}));
                Node node = body(kind);
                if (by_parent) {
                    node.parent = static_cast<std::int32_t>(scene.nodes.size());
                    scene.nodes.push_back({.name = "group", .trs = {{0, 0, 0}, any_turn(random), scale}});
                    if (scale == Vec3d{0, 0, 1}) node.trs.scale = {1, 1, 0};
                } else {
                    node.trs.scale = scale;
                }
                scene.nodes.push_back(node);
                std::string problem;
                try {
                    const PreparedScene prepared = prepare(scene, {.origin = Vec3d{0, 0, 0}});
                    if (scene_hash(prepared) != without) problem = "it changes the scene";
                    if (prepared.dropped_primitives != (kind < 2 ? 1 : 0)) problem = "the body is not counted";
                    if (prepared.dropped_lights != (kind < 2 ? 0 : 1)) problem = "the light is not counted";
                } catch (const InputError& error) {
                    problem = error.what();
                }
                score.decide(!problem.empty(), [&] {
                    return fmt::format("kind {} of scale {}, {}, {}: {}", kind, scale.x, scale.y, scale.z, problem);
                });
            }
        }
    }
    // A ball that shrinks to nothing and comes back, in steps of a hundredth
    Scene scene = scene_of({{{0, 0, -5}, 1}, {{1, 1, -6}, 0.5F}});
    AnimationChannel channel;
    channel.node = 2;
    channel.path = AnimatedPath::scale;
    channel.times = {0, 1, 2};
    channel.values = {1, 1, 1, 0, 0, 0, 1, 1, 1};
    scene.animation = {channel};
    for (int i = 0; i <= 200; ++i) {
        bool is_right = false;
        try {
            const PreparedScene prepared = prepare(scene, {.time = i / 100.0});
            is_right = prepared.spheres.size() + prepared.dropped_primitives == 2;
        } catch (const InputError&) {
        }
        score.decide(!is_right, [&] { return fmt::format("at {} s", i / 100.0); });
    }
    return score;
}

/// A frame with motion blur in which scale 0 hides an object at one instant of five: it is missing only there, and is
/// counted once.
Score hidden_for_an_instant(const Subject& subject, Random&, std::size_t) {
    Score score;
    for (int kind = 0; kind < 4; ++kind) {
        Scene scene = dark_scene({0, 0, 3}, 1e-3);
        scene.nodes[0].camera = OrthographicCamera{1e-3, {0, 2, 5}};
        scene.environment.ambient = {1, 1, 1};
        Node node{.name = "comes and goes", .trs = {{0, 0, 0.5}, {0.1, 0.2, 0.3, 1}, {1, 1, 1}}};
        if (kind < 3) {
            const std::uint32_t white = add_material(scene, bright("white"));
            if (kind == 2) {
                node.geometry.push_back({BoxShape{}, white, {}});
            } else {
                node.geometry.push_back({SphereShape{0.5}, white, {}});
            }
            if (kind == 1) node.geometry[0].instances = {Trs{{0, 0, 0}, {}, {1, 0.5, 0.7}}};
        } else {
            add_shape(scene, BoxShape{}, {0, 0, -1}, add_material(scene, lambertian_material("diffuse", 1)));
            node.trs = {{0, 0, 3}, {}, {1, 1, 1}};
            node.light = LightSource{.kind = LightKind::spot};
        }
        AnimationChannel channel;
        channel.node = static_cast<std::uint32_t>(scene.nodes.size());
        channel.path = AnimatedPath::scale;
        channel.times = {0, 1, 2};
        channel.values = {1, 1, 1, 0, 0, 0, 1, 1, 1};
        scene.nodes.push_back(node);
        scene.animation = {channel};
        with_oracle(subject, [&](Backend& backend, const std::string& name) {
            std::string problem;
            try {
                RenderJob job = square_film(subject, 4, 5);
                const RenderResult result = render_frame(backend, scene, {}, job).result;
                const RenderCounters& counters = result.stats.counters;
                score.nans += counters.invalid_samples;
                if (counters.dropped_primitives != (kind < 3 ? 1 : 0)) problem = "the body is not counted";
                if (counters.dropped_lights != (kind < 3 ? 0 : 1)) problem = "the light is not counted";
                for (const Vec3d& sum : result.film.sums()) {
                    if (!(std::abs(sum.x - 4) <= 1e-5)) problem = fmt::format("{} of 4 samples", sum.x);
                }
            } catch (const InputError& error) {
                problem = error.what();
            }
            score.decide(!problem.empty(), [&] { return fmt::format("{}: kind {}: {}", name, kind, problem); });
        });
    }
    return score;
}

/// The same scene and film for any rounding mode and flush-to-zero setting of the caller.
Score callers_state(const Subject& subject, Random&, std::size_t) {
    Score score;
    const auto make = [] {
        Scene scene = named_scene("mixed/64");
        Node root{.name = "tiny", .trs = {{0, 0, 0}, {0.1, 0.2, 0.3, 1}, Vec3d{1, 1, 1} * 1e-40}};
        root.geometry.push_back({SphereShape{3}, 0, {}});
        scene.nodes.push_back(root);
        return scene;
    };
    const PreparedScene scene = prepare(make());
    const Film right = picture_of(subject.backend, scene, small_picture(subject), score);
    const unsigned int saved = _mm_getcsr();
    const auto judge = [&](const std::string& what) {
        Film film;
        std::string hash, problem;
        try {
            const PreparedScene again = prepare(make());
            hash = scene_hash(again);
            film = picture_of(subject.backend, again, small_picture(subject), score);
        } catch (const std::exception& error) {
            problem = error.what();
        }
        std::fesetround(FE_TONEAREST);
        _mm_setcsr(saved);
        score.decide(!problem.empty() || hash != scene_hash(scene), [&] { return what + ": " + problem; });
        if (problem.empty()) compare_bits(film, right, what, score);
    };
    for (const auto& [mode, name] :
         {std::pair{FE_UPWARD, "upward"}, {FE_DOWNWARD, "downward"}, {FE_TOWARDZERO, "to 0"}}) {
        std::fesetround(mode);
        judge(fmt::format("rounding {}", name));
    }
    _mm_setcsr(saved | 0x8040U);
    judge("flush-to-zero");
    return score;
}

/// Thousands of copies of each kind of primitive, with another primitive among them: the hits, ids and films of one.
Score copies(const Subject& subject, Random& random, std::size_t rays) {
    Score score;
    for (int kind = 0; kind < 5; ++kind) {
        const auto make = [&](int count) {
            Scene scene = scene_of({{{0.2F, 0.1F, -6}, 0.7F}});
            if (kind == 4) scene.materials[0].optics.mirror = {0.5F, 0.5F, 0.5F};
            scene.environment = {{0.1F, 0.1F, 0.1F}, {0.2F, 0.2F, 0.2F}, {1, 1, 1}};
            scene.meshes.push_back(icosphere(0));
            scene.meshes.push_back({.name = "sheet",
                                    .positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0.5F}, {-1, 1, 0}},
                                    .quads = {0, 1, 2, 3}});
            Node node{.name = "copies", .trs = {{0, 0, -4}, {0.1, 0.2, 0.3, 1}, {1, 1, 1}}};
            if (kind == 1) node.trs.scale = {1, 0.5, 0.7};
            const Shape shapes[] = {SphereShape{0.5}, SphereShape{0.5}, BoxShape{}, MeshShape{0}, MeshShape{1}};
            node.geometry.push_back({shapes[kind], 0, std::vector<Trs>(static_cast<std::size_t>(count))});
            scene.nodes.push_back(node);
            add_lamp(scene, {}, {1, 2, 1});
            add_lamp(scene, {.kind = LightKind::directional}, {0, 0, 0}, {0.2, 0.1, 0, 1});
            return prepare(scene, {.origin = Vec3d{0, 0, 0}});
        };
        const PreparedScene one = make(1), many = make(1 << 13);
        const auto tried = make_rays(rays / 10, [&] {
            return Ray<float>{{0, 0, 0}, narrow(test::any_unit(random) * 0.4 + Vec3d{0, 0, -1})};
        });
        const auto trace = [&](const PreparedScene& scene) {
            std::vector<Hit> hits(tried.size());
            subject.backend.trace(*subject.backend.load(scene, subject.tier), TraceJob{.rays = tried, .hits = hits});
            return hits;
        };
        const std::vector<Hit> right = trace(one), hits = trace(many);
        for (std::size_t i = 0; i < tried.size(); ++i) {
            // the copies come behind the ball, or before it; their ids are those of the first of them
            const bool met = right[i].primitive != no_primitive;
            const bool same_id = !met ? hits[i].primitive == no_primitive
                                      : many.node_of[hits[i].primitive] == one.node_of[right[i].primitive];
            const bool is_first = !met || std::none_of(many.copies.begin(), many.copies.end(),
                                                       [&](const auto& copy) { return copy.id == hits[i].primitive; });
            score.decide(!same_id || !is_first || bits_of(hits[i].t) != bits_of(right[i].t),
                         [&] { return fmt::format("kind {}: {}", kind, to_literal(tried[i])); });
            if (i > 200) break;
        }
        compare_bits(picture_of(subject.backend, many, small_picture(subject), score),
                     picture_of(subject.backend, one, small_picture(subject), score), fmt::format("kind {}", kind),
                     score);
    }
    return score;
}

}  // namespace

std::vector<HardCase> light_obstacle_cases() {
    return {
        {"M11", "Alpha-masked surfaces exactly on opaque ones",
         "a ray continues behind the masked point, and so misses what lies in its plane",
         "rule: the opaque surface is visible and blocks light; closed form", RenderCase{masked_sheets_on_opaque_ones}},
        {"M12", "Alpha of k / 255 against a cutoff of k / 255",
         "a double is compared with a float: masked out at 254 of 255 levels",
         "rule: opaque, and masked out at one level less", RenderCase{alpha_levels}},
        {"M13", "Faces and solids of 10^10 to 10^17 metres", "squares overflow, a ray is NaN, and Embree aborts",
         "rule: no NaN, no abort", RenderCase{far_out}},
        {"M14", "Solids and lights of scale 0, at one instant or always", "the whole scene is refused",
         "rule: dropped and counted", FunctionCase{hidden}},
        {"M16", "Any rounding mode and flush-to-zero setting of the caller",
         "sizes vanish, and everything that is prepared is rounded differently", "metamorphosis: equal bits",
         RenderCase{callers_state}},
        {"M18", "Copies of one primitive",
         "every ray is tested against all of them; rays that leave one hit the others",
         "metamorphosis: the bits of a single one", RenderCase{copies}},
        {"M20", "Scale 0 at one instant of a frame with motion blur", "one instant makes the whole frame fail",
         "metamorphosis: the frame without that instant", RenderCase{hidden_for_an_instant}},
    };
}

}  // namespace tandem::hard
