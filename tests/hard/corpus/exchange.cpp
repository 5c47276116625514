#include "hard/corpus/exchange.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "hard/corpus/gltf_text.h"
#include "hard/corpus/npy.h"
#include "tandem/base/error.h"
#include "tandem/base/whole_file.h"

namespace tandem::hard {

namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr int format_version = 2;
constexpr const char* manifest_name = "manifest.json";

void make_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw InputError(fmt::format("{}: cannot create this folder: {}", folder.string(), error.message()));
}

template <class T, class Pick>
std::vector<T> column(const std::vector<Answer>& answers, Pick pick) {
    std::vector<T> numbers;
    numbers.reserve(answers.size());
    for (const Answer& answer : answers) numbers.push_back(pick(answer));
    return numbers;
}

void write_batch(const AnsweredBatch& batch, const fs::path& folder, const std::string& name) {
    write_file((folder / (name + ".gltf")).string(), std::string_view(to_gltf(batch.scene)), Durability::written);
    std::vector<float> numbers;
    for (const Ray<float>& ray : batch.rays) {
        numbers.insert(numbers.end(), {ray.origin.x, ray.origin.y, ray.origin.z});
        numbers.insert(numbers.end(), {ray.direction.x, ray.direction.y, ray.direction.z});
    }
    write_npy((folder / (name + ".rays.npy")).string(), numbers, 6);
    const auto exact = [&](const char* what) { return (folder / "exact" / (name + what)).string(); };
    write_npy(exact(".id.npy"), column<std::int32_t>(batch.answers, [](const Answer& a) {
                  return a.primitive == no_primitive ? miss_id : static_cast<std::int32_t>(a.primitive);
              }));
    write_npy(exact(".t.npy"), column<float>(batch.answers, [](const Answer& a) { return a.t; }));
    write_npy(exact(".t64.npy"), column<double>(batch.answers, [](const Answer& a) { return a.wide_t; }));
    write_npy(exact(".judged.npy"), column<std::uint8_t>(batch.answers, [](const Answer& a) { return a.judged; }));
}

/// The manifest of the folder that contains `answers`.
Json read_manifest(const fs::path& folder) {
    const std::string path = (folder / manifest_name).string();
    const Bytes bytes = read_file(path);
    Json manifest;
    try {
        manifest = Json::parse(reinterpret_cast<const char*>(bytes.data()),
                               reinterpret_cast<const char*>(bytes.data()) + bytes.size());
        if (manifest.at("format") != format_version) {
            throw InputError(fmt::format("{}: its format is not {}; export the corpus again", path, format_version));
        }
        for (const Json& hard_case : manifest.at("cases")) {
            (void)hard_case.at("id").get<std::string>();
            (void)hard_case.at("title").get<std::string>();
            (void)hard_case.at("watertight").get<bool>();
            for (const Json& batch : hard_case.at("batches")) {
                const auto name = batch.at("name").get<std::string>();
                (void)batch.at("rays").get<std::size_t>();
                (void)batch.at("primitives").get<std::size_t>();
                if (name.find('/') != std::string::npos) throw InputError(path + ": names a file in another folder");
            }
        }
    } catch (const Json::exception& error) {
        throw InputError(fmt::format("{}: not the manifest of an exported corpus: {}", path, error.what()));
    }
    return manifest;
}

std::vector<Answer> read_exact(const fs::path& folder, const std::string& name, std::size_t rays) {
    const auto file = [&](const char* what) { return (folder / "exact" / (name + what)).string(); };
    const auto ids = read_npy<std::int64_t>(file(".id.npy"), rays);
    const auto t = read_npy<double>(file(".t64.npy"), rays);
    const auto judged = read_npy<std::int64_t>(file(".judged.npy"), rays);
    std::vector<Answer> answers(rays);
    for (std::size_t i = 0; i < rays; ++i) {
        answers[i] = {ids[i] < 0 ? no_primitive : static_cast<std::uint32_t>(ids[i]), static_cast<float>(t[i]), t[i],
                      static_cast<std::uint8_t>(judged[i])};
    }
    return answers;
}

std::vector<Hit> read_answers(const fs::path& id_file, const fs::path& t_file, std::size_t rays,
                              std::size_t primitives) {
    const auto ids = read_npy<std::int64_t>(id_file.string(), rays);
    const auto t = read_npy<double>(t_file.string(), rays);
    std::vector<Hit> hits(rays);
    for (std::size_t i = 0; i < rays; ++i) {
        if (ids[i] < refused_id || ids[i] >= static_cast<std::int64_t>(primitives)) {
            throw InputError(
                fmt::format("{}: ray {} hits primitive {}, but the scene has {}; -1 is a miss, -2 a ray that "
                            "was refused",
                            id_file.string(), i, ids[i], primitives));
        }
        hits[i] = {static_cast<float>(t[i]), ids[i] == miss_id      ? no_primitive
                                             : ids[i] == refused_id ? refused_primitive
                                                                    : static_cast<std::uint32_t>(ids[i])};
    }
    return hits;
}

}  // namespace

std::size_t export_cases(const std::vector<const HardCase*>& cases, std::size_t rays, const std::string& folder) {
    const fs::path root(folder);
    make_folder(root / "exact");
    Json manifest = {{"format", format_version}, {"cases", Json::array()}};
    for (const HardCase* hard_case : cases) {
        if (!hard_case->has_rays()) continue;
        Json batches = Json::array();
        const std::vector<AnsweredBatch> answered = answered_batches(*hard_case, rays);
        if (!std::all_of(answered.begin(), answered.end(), [](const auto& batch) { return fits_gltf(batch.scene); }))
            continue;
        for (const AnsweredBatch& batch : answered) {
            const std::string name = fmt::format("{}-{}", hard_case->id, batches.size());
            write_batch(batch, root, name);
            batches.push_back(
                {{"name", name}, {"rays", batch.rays.size()}, {"primitives", primitive_count(batch.prepared)}});
        }
        manifest["cases"].push_back({{"id", hard_case->id},
                                     {"title", hard_case->title},
                                     {"why", hard_case->why},
                                     {"oracle", hard_case->oracle},
                                     {"watertight", std::get<RayCase>(hard_case->body).watertight},
                                     {"batches", batches}});
    }
    write_file((root / manifest_name).string(), std::string_view(manifest.dump(1) + "\n"), Durability::written);
    return manifest["cases"].size();
}

std::vector<Ray<float>> read_rays(const std::string& folder, const std::string& batch, std::size_t rays) {
    const auto numbers = read_npy<double>((fs::path(folder) / (batch + ".rays.npy")).string(), rays, 6);
    std::vector<Ray<float>> result(rays);
    for (std::size_t i = 0; i < rays; ++i) {
        const double* n = &numbers[6 * i];
        result[i] = {narrow(Vec3d{n[0], n[1], n[2]}), narrow(Vec3d{n[3], n[4], n[5]})};
    }
    return result;
}

std::vector<CheckedCase> check_answers(const std::string& answers) {
    const fs::path folder = fs::path(answers).lexically_normal();
    const fs::path root = (folder.has_filename() ? folder : folder.parent_path()).parent_path();
    const Json manifest = read_manifest(root);
    std::vector<CheckedCase> result;
    bool any = false;
    for (const Json& hard_case : manifest["cases"]) {
        CheckedCase& checked = result.emplace_back();
        checked.id = hard_case["id"];
        checked.title = hard_case["title"];
        for (const Json& batch : hard_case["batches"]) {
            const std::string name = batch["name"];
            const auto count = batch["rays"].get<std::size_t>();
            const fs::path id_file = folder / (name + ".id.npy"), t_file = folder / (name + ".t.npy");
            for (const fs::path& file : {id_file, t_file}) {
                if (checked.missing.empty() && !fs::exists(file)) checked.missing = file.string();
            }
            if (!checked.missing.empty()) break;
            checked.score.add(score_hits(read_rays(root.string(), name, count), read_exact(root, name, count),
                                         read_answers(id_file, t_file, count, batch["primitives"].get<std::size_t>()),
                                         hard_case["watertight"]));
        }
        any = any || checked.missing.empty();
    }
    if (!any) {
        throw InputError(fmt::format("{}: no case is answered here; the first missing file is {}", answers,
                                     result.empty() ? "manifest.json's" : result.front().missing));
    }
    return result;
}

}  // namespace tandem::hard
