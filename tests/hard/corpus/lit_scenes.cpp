#include "hard/corpus/lit_scenes.h"
#include "tandem/backends/make_backend.h"
#include "tandem/compile/prepared_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tandem::hard {

Scene dark_scene(const Vec3d& eye, double ymag, const Quaternion& turn) {
    Scene scene;
    scene.name = "light";
    scene.environment = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    scene.nodes.push_back({.name = "eye", .trs = {eye, turn, {1, 1, 1}}, .camera = OrthographicCamera{ymag}});
    return scene;
}

Quaternion downward() { return {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)}; }

Material lambertian_material(const std::string& name, float reflectance) {
    return {name, {{0, 0, 0}, Vec3f{1, 1, 1} * reflectance, {0, 0, 0}, 1}};
}
Material mirror_lobe(const std::string& name, float shininess) {
    return {name, {{0, 0, 0}, {0, 0, 0}, {1, 1, 1}, shininess}};
}
Material emissive(const std::string& name, float radiance) {
    Material material = lambertian_material(name, 0);
    material.optics.emission = Vec3f{1, 1, 1} * radiance;
    return material;
}
Material bright(const std::string& name) { return {name, {{1, 1, 1}, {0, 0, 0}, {0, 0, 0}, 1}}; }

std::uint32_t add_material(Scene& scene, Material material) {
    scene.materials.push_back(std::move(material));
    return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

void add_shape(Scene& scene, const Shape& shape, const Vec3d& at, std::uint32_t material, const Quaternion& turn) {
    Node node{.name = "shape " + std::to_string(scene.nodes.size()), .trs = {at, turn, {1, 1, 1}}};
    node.geometry.push_back({shape, material, {}});
    scene.nodes.push_back(std::move(node));
}

void add_sheet(Scene& scene, const Vec3f (&corner)[4], std::uint32_t material, bool as_triangles) {
    Mesh mesh{.name = "sheet", .positions = {corner[0], corner[1], corner[2], corner[3]}};
    if (as_triangles) {
        mesh.triangles = {0, 1, 2, 0, 2, 3};
    } else {
        mesh.quads = {0, 1, 2, 3};
    }
    scene.meshes.push_back(std::move(mesh));
    add_shape(scene, MeshShape{static_cast<std::uint32_t>(scene.meshes.size() - 1)}, {0, 0, 0}, material);
}

Node& add_lamp(Scene& scene, const LightSource& light, const Vec3d& at, const Quaternion& turn) {
    scene.nodes.push_back({.name = "lamp", .trs = {at, turn, {1, 1, 1}}, .light = light});
    return scene.nodes.back();
}

FilmMean mean_of(Backend& backend, const PreparedScene& scene, const RenderJob& job, Score& score) {
    const RenderResult result = backend.render(backend.load(scene, job.tier), job);
    score.seconds += result.stats.seconds.render;
    double sum = 0, squares = 0;
    for (const Vec3d& pixel : result.film.sums()) {
        const double value = pixel.x / job.samples;
        sum += value;
        squares += value * value;
    }
    const auto count = static_cast<double>(result.film.pixel_count());
    const double mean = sum / count;
    return {mean, std::sqrt(std::max(0.0, squares / count - mean * mean) / count),
            result.stats.counters.invalid_samples};
}

void judge_mean(Score& score, const FilmMean& film, double right, double slack, double most, const std::string& what) {
    score.nans += film.invalid;
    const bool is_right = std::abs(film.mean - right) <= 5 * film.error + slack * right && film.error <= most * right;
    score.decide(!is_right, [&] { return fmt::format("{}: {} +- {}, not {}", what, film.mean, film.error, right); });
}

RenderJob square_film(const Subject& subject, int edge, int samples) {
    return {.width = edge, .height = edge, .samples = samples, .seed = 7, .frame = 0, .tier = subject.tier};
}

void with_oracle(const Subject& subject, const std::function<void(Backend& backend, const std::string& name)>& judge) {
    judge(subject.backend, subject.name);
    if (subject.tier == Tier::fast) return;
    const auto oracle = make_backend("oracle");
    judge(*oracle, "oracle");
}

}  // namespace tandem::hard
