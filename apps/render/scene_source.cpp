#include "render/scene_source.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "tandem/base/error.h"
#include "tandem/gltf/load_scene.h"
#include "tandem/math/turns.h"
#include "tandem/scene/read_environment.h"

namespace tandem {

namespace {

/// Calls visit(name, member) for each member of a source.
template <class Source, class Visit>
void for_each_member(Source& source, Visit visit) {
    visit("scene", source.scene);
    visit("camera", source.camera);
    visit("environment", source.environment);
    visit("rotation", source.rotation);
    visit("intensity", source.intensity);
    visit("default_light", source.default_light);
    visit("indirect", source.indirect);
    visit("instants", source.instants);
}

}  // namespace

OpenedScene open_scene(const SceneSource& source, double aspect) {
    OpenedScene opened;
    const bool has_environment = !source.environment.empty();
    std::optional<EnvironmentImage> environment;
    if (has_environment) {
        EnvironmentFile file = read_environment(source.environment);
        opened.negative_texels = file.negative_texels;
        environment = EnvironmentImage{std::move(file.picture), source.rotation * (pi / 180), source.intensity};
    }
    opened.scene = load_scene(
        source.scene, &opened.import,
        {.camera = source.camera, .aspect = aspect, .default_light = source.default_light && !has_environment});
    if (environment) light_by(opened.scene, *std::move(environment));
    if (source.indirect) {
        opened.scene.indirect_light = true;
        opened.scene.environment.ambient = {0, 0, 0};
    }
    if (source.instants > 0) set_shutter_instants(opened.scene, source.instants);
    return opened;
}

std::string to_json(const SceneSource& source) {
    nlohmann::json all, defaults;
    for_each_member(source, [&](const char* name, const auto& value) { all[name] = value; });
    const SceneSource none;
    for_each_member(none, [&](const char* name, const auto& value) { defaults[name] = value; });
    nlohmann::ordered_json changed;
    for_each_member(source, [&](const char* name, const auto&) {
        if (all[name] != defaults[name]) changed[name] = all[name];
    });
    // ASCII, which every image format can store
    return changed.is_null() ? "{}" : changed.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

SceneSource scene_source_from(const std::string& json) {
    SceneSource source;
    try {
        const nlohmann::json all = nlohmann::json::parse(json);
        for_each_member(source, [&](const char* name, auto& value) {
            if (all.contains(name)) all.at(name).get_to(value);
        });
    } catch (const nlohmann::json::exception& error) {
        throw InputError(fmt::format("'{}' does not say where a scene comes from: {}", json, error.what()));
    }
    return source;
}

}  // namespace tandem
