#include "tandem/gltf/report.h"

#include <fmt/format.h>

#include <algorithm>

namespace tandem {

std::string to_string(Treatment treatment) {
    switch (treatment) {
        case Treatment::rendered:
            return "rendered";
        case Treatment::approximated:
            return "approximated";
        case Treatment::ignored:
            return "ignored";
    }
    return "unknown";
}

void ImportReport::add(Treatment treatment, std::string_view feature, std::string_view json_path,
                       std::string_view reason) {
    const auto same = std::find_if(notes_.begin(), notes_.end(), [&](const ImportNote& note) {
        return note.treatment == treatment && note.feature == feature && note.reason == reason;
    });
    if (same != notes_.end()) {
        ++same->uses;
    } else {
        notes_.push_back({treatment, std::string(feature), std::string(json_path), 1, std::string(reason)});
    }
}

std::string to_string(const ImportNote& note) {
    const std::string uses = note.uses == 1 ? "" : fmt::format(" ({} uses)", note.uses);
    return fmt::format("{}: {} at {}{}: {}", to_string(note.treatment), note.feature, note.json_path, uses,
                       note.reason);
}

}  // namespace tandem
