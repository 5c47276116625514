#include "tandem/gltf/animation.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
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
                    ImportReport& report, FlawLog& flaws)
        : source_(source), node_of_(node_of), scene_(scene), report_(report), flaws_(flaws), budget_(source) {}

    void run() {
        const Json* animations = find(source_.document.json, "animations");
        if (animations == nullptr || animations->empty()) return;
        if ((*animations)[0].is_string()) return;  // left out
        const Json& channels = (*animations)[0]["channels"];
        for (std::size_t c = 0; c < channels.size(); ++c) {
            if (channels[c].is_string()) continue;  // left out
            try {
                read_channel(channels[c], c);
            } catch (const Flaw& flaw) {
                flaws_.leave_out("channel of an animation", flaw);
            }
        }
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
            report_.add(Treatment::ignored, "animation without a node", path, "there is nothing to move");
            return;
        }
        const auto index = node->get<std::size_t>();
        if (!node_of_[index]) {
            report_.add(Treatment::ignored, "animation of a node outside of the scene", path,
                        "the default scene does not reach the node");
            return;
        }
        if (driven_.contains({index, name})) {
            source_.document.fail(
                path, fmt::format("animates the {} of node {} a second time; keep one channel", name, index));
        }
        if (scene_.nodes[*node_of_[index]].matrix) {
            source_.document.fail(path, fmt::format("animates node {}, which has a matrix; give it translation, "
                                                    "rotation and scale instead",
                                                    index));
        }
        AnimationChannel read = read_keys(channel["sampler"].get<std::size_t>(), *animated, path);
        read.node = *node_of_[index];
        driven_.emplace(index, name);
        report_.add(Treatment::rendered, fmt::format("animation of {}", name), path,
                    "at the times of the frames, and while a shutter is open");
        scene_.animation.push_back(std::move(read));
    }

    AnimationChannel read_keys(std::size_t sampler_index, AnimatedPath animated, const std::string& path) {
        const Json& sampler = source_.document.json["animations"][0]["samplers"][sampler_index];
        const auto interpolation = sampler.value("interpolation", std::string("LINEAR"));
        const std::string where = fmt::format("animations[0].samplers[{}]", sampler_index);
        AnimationChannel read;
        read.path = animated;
        read.interpolation = interpolation_from(interpolation);
        const auto input = sampler["input"].get<std::size_t>();
        const auto output = sampler["output"].get<std::size_t>();
        budget_.spend(source_.document, path, element_count(source_, input) + element_count(source_, output));
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
                                   interpolation, groups * read.times.size()));
        }
        const auto unordered =
            std::adjacent_find(read.times.begin(), read.times.end(), [](float a, float b) { return !(a < b); });
        if (read.times.front() < 0 || unordered != read.times.end()) {
            source_.document.fail(where + ".input", "has key times that are negative or not strictly increasing");
        }
        if (is_rotation) mend_rotations(read, groups, where);
        return read;
    }

    /// The middle one of the three groups of a cubic key is the value.
    void mend_rotations(AnimationChannel& channel, std::size_t groups, const std::string& where) {
        for (std::size_t at = groups == 3 ? 4 : 0; at < channel.values.size(); at += 4 * groups) {
            float* q = &channel.values[at];
            if (q[0] != 0 || q[1] != 0 || q[2] != 0 || q[3] != 0) continue;
            q[3] = 1;
            flaws_.replace("rotation key", where + ".output",
                           "is (0, 0, 0, 0), which is not a rotation; Tandem uses (0, 0, 0, 1)");
        }
    }

    const Source& source_;
    const std::vector<std::optional<std::uint32_t>>& node_of_;
    Scene& scene_;
    ImportReport& report_;
    FlawLog& flaws_;
    Budget budget_;
    std::set<std::pair<std::size_t, std::string>> driven_;
};

}  // namespace

void note_length(const Scene& scene, ImportReport& report) {
    float end = 0;
    for (const AnimationChannel& channel : scene.animation) end = std::max(end, channel.times.back());
    constexpr std::int32_t last = std::numeric_limits<std::int32_t>::max();
    if (double{end} <= time_of_frame(scene, last)) return;
    report.add(Treatment::approximated, "length of the animation", "animations[0]",
               fmt::format("its last key is at {} s, but the last possible frame, {}, is at {} s", end, last,
                           time_of_frame(scene, last)));
}

void read_animation(const Source& source, const std::vector<std::optional<std::uint32_t>>& node_of, Scene& scene,
                    ImportReport& report, FlawLog& flaws) {
    AnimationReader(source, node_of, scene, report, flaws).run();
}

}  // namespace tandem::gltf
