#include "tandem/gltf/animation.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "tandem/gltf/accessor.h"
#include "tandem/gltf/budget.h"

namespace tandem::gltf {

namespace {

Interpolation interpolation_from(const std::string& name) {
    if (name == "STEP") return Interpolation::step;
    return name == "CUBICSPLINE" ? Interpolation::cubic : Interpolation::linear;
}

std::optional<AnimatedPath> animated_path_from(const std::string& name) {
    if (name == "translation") return AnimatedPath::translation;
    if (name == "rotation") return AnimatedPath::rotation;
    if (name == "scale") return AnimatedPath::scale;
    return std::nullopt;
}

class AnimationReader {
  public:
    AnimationReader(const Source& source, const std::vector<std::optional<std::uint32_t>>& node_of, Scene& scene,
                    ImportReport& report)
        : source_(source), node_of_(node_of), scene_(scene), report_(report), budget_(source) {}

    void run() {
        const Json* animations = find(source_.document.json, "animations");
        if (animations == nullptr || animations->empty()) return;
        const Json& channels = (*animations)[0]["channels"];
        for (std::size_t c = 0; c < channels.size(); ++c) read_channel(channels[c], c);
        for (std::size_t a = 1; a < animations->size(); ++a) {
            report_.add(Treatment::ignored, "further animation", fmt::format("animations[{}]", a),
                        "Tandem plays the first animation of a file");
        }
    }

  private:
    void read_channel(const Json& channel, std::size_t number) {
        const std::string path = fmt::format("animations[0].channels[{}]", number);
        const Json& target = channel["target"];
        const auto name = target["path"].get<std::string>();
        if (find_extension(target, "KHR_animation_pointer") != nullptr) return;  // noted as an extension
        if (name == "weights") {
            report_.add(Treatment::ignored, "animation of weights", path, "Tandem does not render morph targets yet");
            return;
        }
        const auto animated = animated_path_from(name);
        if (!animated) {
            source_.document.fail(path + ".target.path",
                                  fmt::format("is '{}'; use translation, rotation, scale or weights", name));
        }
        const Json* node = find(target, "node");
        if (node == nullptr) {
            report_.add(Treatment::ignored, "animation without a node", path, "it has nothing to move");
            return;
        }
        const auto index = node->get<std::size_t>();
        if (!node_of_[index]) {
            report_.add(Treatment::ignored, "animation of a node outside of the scene", path,
                        "the default scene does not reach the node");
            return;
        }
        if (!driven_.emplace(index, name).second) {
            source_.document.fail(path, fmt::format("drives the {} of node {} a second time; keep one", name, index));
        }
        AnimationChannel read = read_keys(channel["sampler"].get<std::size_t>(), *animated, path);
        read.node = *node_of_[index];
        report_.add(Treatment::rendered, fmt::format("animation of {}", name), path,
                    "at the times of the frames, and while a shutter is open");
        scene_.animation.push_back(std::move(read));
    }

    AnimationChannel read_keys(std::size_t sampler_index, AnimatedPath animated, const std::string& path) {
        const tinygltf::AnimationSampler& sampler = source_.model.animations[0].samplers[sampler_index];
        const std::string where = fmt::format("animations[0].samplers[{}]", sampler_index);
        AnimationChannel read;
        read.path = animated;
        read.interpolation = interpolation_from(sampler.interpolation);
        const auto input = static_cast<std::size_t>(sampler.input);
        const auto output = static_cast<std::size_t>(sampler.output);
        budget_.spend(source_.document, path,
                      source_.model.accessors[input].count + source_.model.accessors[output].count);
        read.times = read_accessor(source_, input,
                                   {"SCALAR", Components::floats, "the times of animation keys", where + ".input"});
        const bool is_rotation = animated == AnimatedPath::rotation;
        read.values = read_accessor(
            source_, output,
            {is_rotation ? "VEC4" : "VEC3", Components::normalised, "the values of animation keys", where + ".output"});
        const std::size_t groups = read.interpolation == Interpolation::cubic ? 3 : 1;
        const std::size_t given = read.values.size() / (is_rotation ? 4 : 3);
        if (given != groups * read.times.size()) {
            source_.document.fail(
                where, fmt::format("has {} keys and {} values; {} interpolation needs {}", read.times.size(), given,
                                   sampler.interpolation, groups * read.times.size()));
        }
        const auto unordered =
            std::adjacent_find(read.times.begin(), read.times.end(), [](float a, float b) { return !(a < b); });
        if (read.times.front() < 0 || unordered != read.times.end()) {
            source_.document.fail(where + ".input", "has key times that do not rise strictly from 0 or more");
        }
        return read;
    }

    const Source& source_;
    const std::vector<std::optional<std::uint32_t>>& node_of_;
    Scene& scene_;
    ImportReport& report_;
    Budget budget_;
    std::set<std::pair<std::size_t, std::string>> driven_;
};

}  // namespace

void read_animation(const Source& source, const std::vector<std::optional<std::uint32_t>>& node_of, Scene& scene,
                    ImportReport& report) {
    AnimationReader(source, node_of, scene, report).run();
}

}  // namespace tandem::gltf
