#include "tandem/gltf/flaws.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "tandem/gltf/printable.h"

namespace tandem::gltf {

namespace {

/// Whether a flaw there may remove geometry.
bool concerns_geometry(std::string_view json_path) {
    static constexpr std::array<std::string_view, 6> places = {"buffer", "accessors", "meshes",
                                                               "nodes",  "scene",     "extensions.KHR_implicit_shapes"};
    return std::any_of(places.begin(), places.end(), [&](std::string_view p) { return json_path.starts_with(p); });
}

}  // namespace

Flaw::Flaw(const std::filesystem::path& file, std::string json_path, std::string what, std::string root)
    : InputError(fmt::format("{}: {}", file.string(), printable(fmt::format("{}: {}", json_path, what)))),
      json_path_(std::move(json_path)),
      what_is_wrong_(std::move(what)),
      root_(root.empty() ? fmt::format("{}: {}", json_path_, what_is_wrong_) : std::move(root)) {}

void FlawLog::leave_out(std::string_view feature, const Flaw& flaw) { add(Treatment::ignored, feature, flaw); }

void FlawLog::shorten(std::string_view feature, const Flaw& flaw) { add(Treatment::approximated, feature, flaw); }

void FlawLog::add(Treatment treatment, std::string_view feature, const Flaw& flaw) {
    report_.add(treatment, feature, flaw.json_path(), flaw.what_is_wrong());
    if (!first_of_geometry_ && concerns_geometry(flaw.json_path())) first_of_geometry_ = flaw;
}

void FlawLog::replace(std::string_view feature, std::string_view json_path, std::string_view reason) {
    report_.add(Treatment::approximated, feature, json_path, reason);
}

void FlawLog::tolerate(std::string_view feature, std::string_view json_path, std::string_view reason) {
    report_.add(Treatment::rendered, feature, json_path, reason);
}

void FlawLog::refuse_lost_geometry() const {
    if (first_of_geometry_) throw InputError(first_of_geometry_->what());
}

}  // namespace tandem::gltf
