#include "tandem/gltf/report.h"

#include <fmt/format.h>

#include <utility>

#include "tandem/gltf/printable.h"

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
    add({treatment, gltf::printable(std::string(feature)), gltf::printable(std::string(json_path)), 1,
         gltf::printable(std::string(reason))});
}

void ImportReport::add(const ImportReport& other) {
    for (const ImportNote& note : other.notes_) add(note);
}

void ImportReport::add(ImportNote note) {
    const auto [known, is_new] = index_.try_emplace({note.treatment, note.feature, note.reason}, notes_.size());
    if (is_new) {
        notes_.push_back(std::move(note));
    } else {
        notes_[known->second].uses += note.uses;
    }
}

std::string to_string(const ImportNote& note) {
    const std::string uses = note.uses == 1 ? "" : fmt::format(" ({} uses)", note.uses);
    return fmt::format("{}: {} at {}{}: {}", to_string(note.treatment), note.feature, note.json_path, uses,
                       note.reason);
}

}  // namespace tandem
