#include "tandem/scene/animation.h"

#include <algorithm>
#include <array>

#include "tandem/math/accurate_functions.h"
#include "tandem/math/fp_environment.h"

namespace tandem {

namespace {

using Value = std::array<double, 4>;

/// The keys around a time, and the position between them, in [0, 1].
struct KeySpan {
    std::size_t first;
    std::size_t second;
    double fraction;
    double seconds;  ///< between the two keys
};

KeySpan find_keys(const std::vector<float>& times, double time) {
    const auto after = std::upper_bound(times.begin(), times.end(), time, [](double t, float key) { return t < key; });
    if (after == times.begin()) return {0, 0, 0, 0};
    const auto first = static_cast<std::size_t>(after - times.begin()) - 1;
    if (after == times.end() || time == double{times[first]}) return {first, first, 0, 0};
    const double seconds = double{*after} - double{times[first]};
    return {first, first + 1, (time - double{times[first]}) / seconds, seconds};
}

Value slerp(const Value& a, Value b, double fraction) {
    double cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
    if (cosine < 0) {  // q and -q are one rotation: take the shorter arc
        for (double& x : b) x = -x;
        cosine = -cosine;
    }
    double weight_a = 1 - fraction;
    double weight_b = fraction;
    if (cosine < 1 - 1e-9) {  // nearer than that the arc is a line to within rounding
        const double angle = accurate_acos(cosine);
        weight_a = accurate_sin((1 - fraction) * angle) / accurate_sin(angle);
        weight_b = accurate_sin(fraction * angle) / accurate_sin(angle);
    }
    Value result;
    for (std::size_t i = 0; i < 4; ++i) result[i] = weight_a * a[i] + weight_b * b[i];
    return result;
}

/// The groups of numbers of a key. Only keys of cubic channels have tangents.
enum class KeyPart : std::size_t { in_tangent, value, out_tangent };

Value part_of_key(const AnimationChannel& channel, std::size_t key, KeyPart part) {
    const std::size_t width = channel.path == AnimatedPath::rotation ? 4 : 3;
    const bool cubic = channel.interpolation == Interpolation::cubic;
    Value v{};
    const std::size_t at = (cubic ? 3 * key + static_cast<std::size_t>(part) : key) * width;
    for (std::size_t i = 0; i < width; ++i) v[i] = double{channel.values[at + i]};
    return v;
}

Value sample(const AnimationChannel& channel, double time) {
    const KeySpan span = find_keys(channel.times, time);
    const Value a = part_of_key(channel, span.first, KeyPart::value);
    if (span.first == span.second || channel.interpolation == Interpolation::step) return a;
    const Value b = part_of_key(channel, span.second, KeyPart::value);
    const double t = span.fraction;
    if (channel.interpolation == Interpolation::cubic) {
        const Value out_tangent = part_of_key(channel, span.first, KeyPart::out_tangent);
        const Value in_tangent = part_of_key(channel, span.second, KeyPart::in_tangent);
        const double t2 = t * t;
        const double t3 = t2 * t;
        Value v{};
        for (std::size_t i = 0; i < v.size(); ++i) {
            v[i] = (2 * t3 - 3 * t2 + 1) * a[i] + span.seconds * (t3 - 2 * t2 + t) * out_tangent[i] +
                   (3 * t2 - 2 * t3) * b[i] + span.seconds * (t3 - t2) * in_tangent[i];
        }
        return v;
    }
    if (channel.path == AnimatedPath::rotation) return slerp(a, b, t);
    Value v{};
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = (1 - t) * a[i] + t * b[i];
    return v;
}

/// Whether a key and the next one have the same value. A quaternion and its negative are one rotation.
bool keep_value(const AnimationChannel& channel, std::size_t key) {
    const Value a = part_of_key(channel, key, KeyPart::value);
    const Value b = part_of_key(channel, key + 1, KeyPart::value);
    return a == b || (channel.path == AnimatedPath::rotation && a == Value{-b[0], -b[1], -b[2], -b[3]});
}

/// Whether the value is constant from a key to the next one. Between cubic keys it is a constant plus three independent
/// polynomials, weighted by the difference of the values and the two tangents.
bool stays(const AnimationChannel& channel, std::size_t key) {
    if (!keep_value(channel, key)) return false;
    return channel.interpolation != Interpolation::cubic ||
           (part_of_key(channel, key, KeyPart::value) == part_of_key(channel, key + 1, KeyPart::value) &&
            part_of_key(channel, key, KeyPart::out_tangent) == Value{} &&
            part_of_key(channel, key + 1, KeyPart::in_tangent) == Value{});
}

}  // namespace

bool changes_between(const AnimationChannel& channel, double from, double to) {
    const DefaultFpEnvironment guard;
    for (std::size_t key = 0; key + 1 < channel.times.size(); ++key) {
        const double start = double{channel.times[key]}, end = double{channel.times[key + 1]};
        if (channel.interpolation == Interpolation::step) {
            if (from < end && end < to && !keep_value(channel, key)) return true;
        } else if (start < to && from < end && !stays(channel, key)) {
            return true;
        }
    }
    return false;
}

std::vector<std::size_t> parents_first(const Scene& scene) {
    const std::vector<Node>& nodes = scene.nodes;
    std::vector<std::size_t> order, chain;
    std::vector<bool> known(nodes.size(), false);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        for (std::size_t at = i; !known[at];) {  // climb to a known ancestor, then come back down
            chain.push_back(at);
            known[at] = true;
            if (nodes[at].parent == Node::no_parent) break;
            at = static_cast<std::size_t>(nodes[at].parent);
        }
        order.insert(order.end(), chain.rbegin(), chain.rend());
        chain.clear();
    }
    return order;
}

std::vector<Transform> parents_from_nodes(const Scene& scene, double time) {
    const DefaultFpEnvironment guard;
    std::vector<Trs> poses;
    poses.reserve(scene.nodes.size());
    for (const Node& node : scene.nodes) poses.push_back(node.trs);
    for (const AnimationChannel& channel : scene.animation) {
        const Value v = sample(channel, time);
        Trs& pose = poses[channel.node];
        switch (channel.path) {
            case AnimatedPath::translation:
                pose.translation = {v[0], v[1], v[2]};
                break;
            case AnimatedPath::rotation:
                pose.rotation = {v[0], v[1], v[2], v[3]};
                break;
            case AnimatedPath::scale:
                pose.scale = {v[0], v[1], v[2]};
                break;
        }
    }
    std::vector<Transform> result;
    result.reserve(scene.nodes.size());
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        result.push_back(scene.nodes[i].matrix ? *scene.nodes[i].matrix : to_transform(poses[i]));
    }
    return result;
}

std::vector<Transform> world_from_nodes(const Scene& scene, double time) {
    const DefaultFpEnvironment guard;
    const std::vector<Transform> local = parents_from_nodes(scene, time);
    std::vector<Transform> world(local.size());
    for (const std::size_t at : parents_first(scene)) {
        const std::int32_t parent = scene.nodes[at].parent;
        world[at] = parent == Node::no_parent ? local[at] : world[static_cast<std::size_t>(parent)] * local[at];
    }
    return world;
}

}  // namespace tandem
