#include "render/render_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "tandem/effects/names.h"

namespace tandem {

std::string frame_line(const FrameRecord& record) {
    std::string line = fmt::format("frame {}  {}  {}", record.metadata.frame, record.metadata.film_sha256, record.file);
    if (record.skipped) line += "  kept";
    if (!record.metadata.denoised.empty()) {
        line +=
            fmt::format("  denoised by {}; the hash is that of the film before denoising", record.metadata.denoised);
    }
    for (const std::string& clause : in_words(record.counters)) line += "  " + clause;
    if (!record.warning.empty()) line += "  " + record.warning;
    if (record.nan_values > 0) line += fmt::format("  {} values are NaN, written as 0", record.nan_values);
    return line;
}

nlohmann::ordered_json frame_json(const FrameRecord& record) {
    nlohmann::ordered_json json;
#define TANDEM_METADATA(type, name) json[#name] = record.metadata.name;
#include "tandem/images/metadata_fields.def"
#undef TANDEM_METADATA
    json["file"] = record.file;
    json["skipped"] = record.skipped;
    json["variant"] = record.variant;
    json["effects"] = to_string(record.effects);
    json["carried"] = to_string(record.carried);
    if (record.registers > 0) json["registers"] = record.registers;
    if (record.occupancy > 0) json["occupancy"] = record.occupancy;
    if (!record.warning.empty()) json["warning"] = record.warning;
    const FrameSeconds& seconds = record.seconds;
    json["seconds"] = {{"prepare", seconds.prepare},
                       {"build", seconds.backend.build},
                       {"compile", seconds.backend.compile},
                       {"upload", seconds.backend.upload},
                       {"render", seconds.backend.render},
                       {"download", seconds.backend.download},
                       {"hash", seconds.hash},
                       {"denoise", seconds.denoise},
                       {"encode", seconds.encode},
                       {"write", seconds.write}};
#define TANDEM_COUNTER(name, words) json[#name] = record.counters.name;
#include "tandem/render/counters.def"
#undef TANDEM_COUNTER
    json["nan_values"] = record.nan_values;
    return json;
}

}  // namespace tandem
