// Group K: invalid scenes, and scenes at the limits.
#include <fmt/format.h>

#include <clocale>
#include <cmath>
#include <fstream>
#include <locale>

#include "hard/corpus/functions.h"
#include "hard/corpus/gltf_text.h"
#include "hard/corpus/groups.h"
#include "hard/corpus/pictures.h"
#include "hard/corpus/ray_batches.h"
#include "support/temporary_folder.h"
#include "tandem/base/error.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/gltf/import.h"

namespace tandem::hard {

namespace {

using test::any_unit;

constexpr const char* exact = "exact arithmetic";

/// A scene with one of everything.
Scene one_of_each() {
    Scene scene = scene_of({{{0, 0, -5}, 1}}, {{{1, 1, -6}, {2, 2, -5}}});
    scene.nodes.push_back({.name = "lamp", .light = LightSource{}});
    return scene;
}

/// Expects that the scene is refused with a message that contains `part`.
void must_refuse(Score& score, const Scene& scene, const std::string& part, const std::string& what) {
    std::string message;
    try {
        (void)prepare(scene);
    } catch (const InputError& error) {
        message = error.what();
    }
    score.decide(message.find(part) == std::string::npos, fmt::format("{}: '{}'", what, message));
}

/// NaN and infinity in every field that holds a number.
Score not_numbers(Random&, std::size_t) {
    Score score;
    const double nan = std::nan("");
    for (const double bad : {nan, HUGE_VAL, -HUGE_VAL}) {
        const auto f = static_cast<float>(bad);
        const auto refuse = [&](const char* part, const char* what, auto change) {
            Scene scene = one_of_each();
            change(scene);
            must_refuse(score, scene, part, fmt::format("{} of {}", what, bad));
        };
        for (int i = 0; i < 3; ++i) {
            refuse("primitive 0", "a translation", [&](Scene& s) { s.nodes[1].trs.translation[i] = bad; });
            refuse("primitive 0", "a scale", [&](Scene& s) { s.nodes[1].trs.scale[i] = bad; });
            refuse("primitive 1", "a box's size",
                   [&](Scene& s) { std::get<BoxShape>(s.nodes[2].geometry[0].shape).size[i] = bad; });
            refuse("lamp", "a light's colour", [&](Scene& s) { s.nodes[3].light->colour[i] = f; });
            refuse("grey", "a material", [&](Scene& s) { s.materials[0].phong.diffuse[i] = f; });
            refuse("environment", "the sky", [&](Scene& s) { s.environment.top[i] = f; });
            refuse("eye", "a matrix", [&](Scene& s) {
                s.nodes[0].matrix = Transform{};
                s.nodes[0].matrix->linear.row[i].x = bad;
            });
        }
        refuse("primitive 0", "a rotation", [&](Scene& s) { s.nodes[1].trs.rotation.w = bad; });
        refuse("primitive 0", "a radius",
               [&](Scene& s) { std::get<SphereShape>(s.nodes[1].geometry[0].shape).radius = bad; });
        refuse("lamp", "an intensity", [&](Scene& s) { s.nodes[3].light->intensity = f; });
        refuse("eye", "a field of view", [&](Scene& s) { s.nodes[0].camera = PerspectiveCamera{bad}; });
        refuse("grey", "a shininess", [&](Scene& s) { s.materials[0].phong.shininess = f; });
    }
    return score;
}

/// Untraceable rays among traceable ones: they miss, on every lane of a packet.
Score not_rays(const Subject& subject, Random& random, std::size_t count) {
    const PreparedScene scene = prepare(scene_of(shell(random, {0, 0, 0}, 4)), {.origin = Vec3d{0, 0, 0}});
    const float inf = HUGE_VALF, nan = std::nanf("");
    const std::vector<Ray<float>> bad = {
        {{nan, 0, 0}, {0, 0, 1}}, {{0, 0, 0}, {0, nan, 1}},    {{0, inf, 0}, {0, 0, 1}},  {{0, 0, 0}, {0, 0, -inf}},
        {{0, 0, 0}, {0, 0, 0}},   {{0, 0, 2e18F}, {0, 0, -1}}, {{0, 0, 0}, {3e18F, 0, 0}}};
    std::vector<Ray<float>> rays;
    for (std::size_t i = 0; i < count; ++i) {
        rays.push_back(i % 3 == 0 ? bad[i / 3 % bad.size()] : Ray<float>{{0, 0, 0}, narrow(any_unit(random))});
    }
    std::vector<Hit> hits(rays.size(), Hit{5, 5});
    subject.backend.trace(*subject.backend.load(scene, subject.tier), TraceJob{.rays = rays, .hits = hits});
    Score score = score_hits(rays, exact_answers(scene, rays), hits, false);
    return score;
}

/// Radius 0 and below, coordinates beyond 10^18, shininess and reflectances that create energy: refused by name.
Score beyond_limits(Random&, std::size_t) {
    Score score;
    const auto refuse = [&](const char* part, const char* what, auto change) {
        Scene scene = one_of_each();
        change(scene);
        must_refuse(score, scene, part, what);
    };
    const auto radius = [](Scene& s) -> double& { return std::get<SphereShape>(s.nodes[1].geometry[0].shape).radius; };
    refuse("primitive 0", "radius 0", [&](Scene& s) { radius(s) = 0; });
    refuse("primitive 0", "radius -1", [&](Scene& s) { radius(s) = -1; });
    refuse("primitive 0", "radius 1e-46, none in float", [&](Scene& s) { radius(s) = 1e-46; });
    refuse("primitive 0", "radius 2e18", [&](Scene& s) { radius(s) = 2e18; });
    refuse("primitive 0", "a bound beyond 1e18", [&](Scene& s) {
        radius(s) = 5e17;
        s.nodes[1].trs.translation.x = 8e17;
    });
    refuse("lamp", "a light beyond 1e18", [&](Scene& s) { s.nodes[3].trs.translation.y = 1.9e18; });
    refuse("eye", "a camera beyond 1e18", [&](Scene& s) { s.nodes[0].trs.translation.y = 1.9e18; });
    refuse("grey", "a reflectance of 1.5", [&](Scene& s) { s.materials[0].phong.diffuse.x = 1.5F; });
    refuse("grey", "a reflectance of -0.1", [&](Scene& s) { s.materials[0].phong.specular.z = -0.1F; });
    refuse("grey", "a shininess of -1", [&](Scene& s) { s.materials[0].phong.shininess = -1; });
    refuse("grey", "a shininess of 1e30", [&](Scene& s) { s.materials[0].phong.shininess = 1e30F; });
    refuse("primitive 0", "a material that is not there", [&](Scene& s) { s.nodes[1].geometry[0].material = 7; });
    return score;
}

/// Sets a decimal comma during its lifetime: for C++ streams, and for C if such a locale is installed.
class CommaLocale {
  public:
    CommaLocale() : before_(std::locale::global(std::locale(std::locale::classic(), new Comma))) {
        (void)std::setlocale(LC_NUMERIC, "de_DE.UTF-8");
    }
    ~CommaLocale() {
        std::locale::global(before_);
        (void)std::setlocale(LC_NUMERIC, "C");
    }
    CommaLocale(const CommaLocale&) = delete;
    CommaLocale& operator=(const CommaLocale&) = delete;

  private:
    struct Comma : std::numpunct<char> {
        [[nodiscard]] char do_decimal_point() const override { return ','; }
        [[nodiscard]] char do_thousands_sep() const override { return '.'; }
        [[nodiscard]] std::string do_grouping() const override { return "\3"; }
    };
    std::locale before_;
};

/// Numbers in a file: the nearest double of what is written, whatever the locale; what is no JSON number is refused.
Score written_numbers(Random& random, std::size_t calls) {
    Score score;
    const test::TemporaryFolder folder;
    const std::string text = to_gltf(scene_of({{{0, 0, -5}, 1}}));
    const std::string key = "\"radius\"";
    const std::size_t start = text.find_first_of("0123456789", text.find(key) + key.size());
    const std::size_t end = text.find_first_not_of("0123456789.eE+-", start);
    const auto read = [&](const std::string& number) {
        const std::string path = folder.file("scene.gltf");
        std::ofstream(path) << text.substr(0, start) << number << text.substr(end);
        return import_gltf(path).scene;
    };
    const CommaLocale comma;
    for (std::size_t i = 0; i < calls / 50 + 1; ++i) {
        // a decimal number with more digits than any double has
        std::string number = std::to_string(1 + random.below(9)) + ".";
        for (int digit = 0; digit < 25; ++digit) number += static_cast<char>('0' + random.below(10));
        number += "e" + std::to_string(static_cast<int>(random.below(24)) - 12);
        const double right = Exact(number).convert_to<double>();
        double got = 0;
        for (const Node& node : read(number).nodes) {
            for (const Geometry& geometry : node.geometry) got = std::get<SphereShape>(geometry.shape).radius;
        }
        score.decide(got != right, [&] { return fmt::format("{} is read as {:a}", number, got); });
    }
    for (const char* number : {"1e400", "0x1p-3", "1,5", ".5", "1.", "+1", "NaN", "Infinity", "-1", "-0"}) {
        bool refused = false;
        try {
            (void)read(number);
        } catch (const InputError&) {
            refused = true;
        }
        score.decide(!refused, [&] { return fmt::format("a radius of {} is taken", number); });
    }
    return score;
}

/// Two equal lights, and one of twice the intensity: the same bits.
Score equal_lights(const Subject& subject, Random&, std::size_t) {
    const auto lit = [&](int lamps, float intensity) {
        Scene scene = scene_of({{{0, 0, -5}, 1}, {{0, 0, -5}, 1}, {{0, 0, -5}, 1}});
        scene.environment = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
        for (int i = 0; i < lamps; ++i) {
            Node lamp{.name = "lamp", .light = LightSource{.colour = {1, 0.3F, 0.7F}, .intensity = intensity}};
            lamp.trs.translation = {3, 4, 2};
            scene.nodes.push_back(lamp);
        }
        return prepare(scene);
    };
    Score score;
    const Film one = picture_of(subject.backend, lit(1, 2), small_picture(subject), score);
    compare_bits(picture_of(subject.backend, lit(2, 1), small_picture(subject), score), one, "two lights", score);
    return score;
}

/// No primitive, one pixel, and empty jobs.
Score nothing_there(const Subject& subject, Random&, std::size_t) {
    Score score;
    const auto scene = subject.backend.load(prepare(scene_of({})), subject.tier);
    const std::vector<Ray<float>> rays = {{{0, 0, 0}, {0, 0, 1}}, {{1, 2, 3}, {-1, 0, 0}}};
    std::vector<Hit> hits(2, Hit{5, 5});
    subject.backend.trace(*scene, TraceJob{.rays = rays, .hits = hits});
    for (const Hit& hit : hits) score.decide(hit.primitive != no_primitive || hit.t != 0, "a hit in an empty scene");
    subject.backend.trace(*scene, TraceJob{});
    const RenderJob good = {.width = 1, .height = 1, .samples = 1, .tier = subject.tier};
    score.decide(subject.backend.render(scene, good).film.pixel_count() != 1, "a film of one pixel");
    for (RenderJob job : {RenderJob{0, 1, 1}, RenderJob{1, 0, 1}, RenderJob{1, 1, 0}, RenderJob{-1, 1, 1}}) {
        job.tier = subject.tier;
        bool refused = false;
        try {
            (void)subject.backend.render(scene, job);
        } catch (const InputError&) {
            refused = true;
        }
        score.decide(!refused, fmt::format("a film of {} x {} with {} samples", job.width, job.height, job.samples));
    }
    return score;
}

/// Sizes that are subnormal in float.
std::vector<RayBatch> subnormal(Random& random, std::size_t rays) {
    std::vector<RayBatch> batches;
    for (const double size : {1e-40, 1e-43}) {
        std::vector<Sphere> spheres;
        spheres.reserve(64);
        for (int i = 0; i < 64; ++i) {
            spheres.push_back({narrow(any_unit(random) * 20.0 * size), static_cast<float>(3 * size)});
        }
        batches.push_back({scene_of(spheres), make_rays(rays / 2, [&] {
                               const Vec3d origin = any_unit(random) * 60.0 * size;
                               return Ray<float>{narrow(origin), narrow(any_unit(random) * 20.0 - origin * (1 / size))};
                           })});
    }
    return batches;
}

/// Centres on a line, in a plane and in a point: bounds without extent.
std::vector<RayBatch> no_extent(Random& random, std::size_t rays) {
    std::vector<RayBatch> batches;
    for (int dimensions = 0; dimensions < 3; ++dimensions) {
        std::vector<Sphere> spheres;
        std::vector<Box> boxes;
        for (int i = 0; i < 200; ++i) {
            Vec3f place = {0, 0, 0};
            for (int k = 0; k < dimensions; ++k) place[k] = static_cast<float>(random.below(400)) / 8;
            spheres.push_back({place, random.coin() ? 0.125F : 0.25F});
            boxes.push_back({place, place + Vec3f{dimensions > 0 ? 0.25F : 0, dimensions > 1 ? 0.25F : 0, 0}});
        }
        batches.push_back({scene_of(spheres, boxes), make_rays(rays / 3, [&] {
                               const Vec3d target = widen(spheres[random.below(200)].centre) + any_unit(random) * 0.3;
                               const Vec3d origin = any_unit(random) * 40.0;
                               return Ray<float>{narrow(origin), narrow(target - origin)};
                           })});
    }
    return batches;
}

/// Ten spheres per ray, up to ten million; a thousandth of the rays is traced.
std::vector<RayBatch> crowd(Random& random, std::size_t rays) {
    const std::size_t count = std::min<std::size_t>(10 * rays, 10'000'000);
    const auto radius = static_cast<float>(0.6 / std::cbrt(static_cast<double>(count)));
    std::vector<Sphere> spheres;
    for (std::size_t i = 0; i < count; ++i) {
        spheres.push_back(
            {{random.uniform(-1.0F, 1.0F), random.uniform(-1.0F, 1.0F), random.uniform(-1.0F, 1.0F)}, radius});
    }
    return {{scene_of(spheres), make_rays(std::min<std::size_t>(rays, 200), [&] {
                 return Ray<float>{narrow(any_unit(random) * 3.0), narrow(any_unit(random))};
             })}};
}

}  // namespace

std::vector<HardCase> input_cases() {
    return {
        {"K1", "NaN and infinity in every field of a scene", "they reach a ray, and Embree aborts the process",
         "rule: refused with a reason", FunctionCase{not_numbers}},
        {"K2", "Rays that are not finite, too long, or zero", "Embree aborts; on a GPU they hit anything",
         "rule: a miss", RenderCase{not_rays}},
        {"K3", "Two identical lights, three identical spheres", "one of them is lost, or counted twice",
         "metamorphosis: equal bits", RenderCase{equal_lights}},
        {"K4", "Radius 0, positions beyond 10^18, materials that create energy", "they vanish silently",
         "rule: refused with a reason", FunctionCase{beyond_limits}},
        {"K5", "No primitive, one pixel, no sample", "an empty structure; a division by 0", "rule",
         RenderCase{nothing_there}},
        {"K6", "Subnormal sizes", "flush-to-zero makes them zero", exact, RayCase{subnormal}},
        {"K8", "Centres in a plane, on a line, at a point", "bounds without extent", exact, RayCase{no_extent}},
        {"K10", "Numbers in files, in a locale with a decimal comma",
         "they are read as other numbers, or only up to the comma", "MPFR: the nearest double",
         FunctionCase{written_numbers}},
        {"K11", "Ten spheres per ray", "32-bit offsets; a stack that is too short", exact, RayCase{crowd}},
    };
}

}  // namespace tandem::hard
