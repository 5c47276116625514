// Embree's own spheres and triangles as another renderer: reads an exported corpus and writes answers.
//
//   tandem-bench hard --export DIR
//   score_embree DIR DIR/plain
//   score_embree DIR DIR/robust robust      # with RTC_SCENE_FLAG_ROBUST
//   tandem-bench hard --check DIR/plain
#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>

#include "common/run_main.h"
#include "embree_native.h"
#include "hard/corpus/exchange.h"
#include "hard/corpus/npy.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/gltf/import.h"

namespace tandem {
namespace {

namespace fs = std::filesystem;

/// Embree as Debian packages it ends the process for other rays: it asserts |origin| and |direction| up to 1.844e18.
bool embree_takes(const Ray<float>& ray) { return is_traceable(ray); }

/// The hits of Embree's own geometry; false if it has none for some primitive of the scene.
bool trace_natively(const PreparedScene& scene, bench::EmbreeFlags flags, const std::vector<Ray<float>>& rays,
                    std::vector<Hit>& hits) {
    const auto trace = [&](const auto& primitives) {
        if (primitives.size() != primitive_count(scene)) return false;
        bench::EmbreeNative(primitives, 0, flags).trace(rays, hits);
        return true;
    };
    return trace(std::span(scene.spheres)) || trace(std::span(scene.triangles));
}

/// False if the scene contains primitives for which Embree has no geometry.
bool answer_batch(const fs::path& folder, const fs::path& answers, bench::EmbreeFlags flags, const std::string& name,
                  std::size_t count) {
    const PreparedScene scene = prepare(import_gltf(folder / (name + ".gltf")).scene, {.origin = Vec3d{0, 0, 0}});
    const std::vector<Ray<float>> rays = hard::read_rays(folder.string(), name, count);
    std::vector<Ray<float>> taken;
    for (const Ray<float>& ray : rays) {
        if (embree_takes(ray)) taken.push_back(ray);
    }
    std::vector<Hit> hits(taken.size());
    if (!trace_natively(scene, flags, taken, hits)) return false;
    std::vector<std::int32_t> ids;
    std::vector<float> t;
    std::size_t next = 0;
    for (const Ray<float>& ray : rays) {
        const bool is_taken = embree_takes(ray);
        const Hit hit = is_taken ? hits[next++] : Hit{};
        ids.push_back(!is_taken                       ? hard::refused_id
                      : hit.primitive == no_primitive ? hard::miss_id
                                                      : static_cast<std::int32_t>(hit.primitive));
        t.push_back(hit.t);
    }
    hard::write_npy((answers / (name + ".id.npy")).string(), ids);
    hard::write_npy((answers / (name + ".t.npy")).string(), t);
    return true;
}

int run(int count, char** words) {
    const bool robust = count == 4 && std::string(words[3]) == "robust";
    if (count != 3 && !robust) throw InputError("usage: score_embree DIR ANSWERS [robust]");
    const bench::EmbreeFlags flags = robust ? bench::EmbreeFlags::robust : bench::EmbreeFlags::plain;
    const fs::path folder(words[1]), answers(words[2]);
    fs::create_directories(answers);
    std::ifstream file(folder / "manifest.json");
    if (!file)
        throw InputError(
            fmt::format("{}: there is no manifest.json here; tandem-bench hard --export writes one", words[1]));
    const nlohmann::json manifest = nlohmann::json::parse(file);
    for (const auto& hard_case : manifest.at("cases")) {
        std::size_t skipped = 0;
        for (const auto& batch : hard_case.at("batches")) {
            skipped += !answer_batch(folder, answers, flags, batch.at("name"), batch.at("rays"));
        }
        if (skipped > 0) {
            fmt::print("{}: skipped {} scenes that are not of spheres or triangles only\n",
                       hard_case.at("id").get<std::string>(), skipped);
        }
    }
    fmt::print("{} answered\n", bench::EmbreeNative::version());
    return exit_done;
}

}  // namespace
}  // namespace tandem

int main(int count, char** words) {
    return tandem::run_main("score_embree", [&] { return tandem::run(count, words); });
}
