#include "tandem/scene/animation.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tandem {

namespace {

using Value = std::array<double, 4>;

/// Which keys surround a time, and where between them, in [0, 1].
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
        const double angle = std::acos(cosine);
        weight_a = std::sin((1 - fraction) * angle) / std::sin(angle);
        weight_b = std::sin(fraction * angle) / std::sin(angle);
    }
    Value result;
    for (std::size_t i = 0; i < 4; ++i) result[i] = weight_a * a[i] + weight_b * b[i];
    return result;
}

Value sample(const AnimationChannel& channel, double time) {
    const std::size_t width = channel.path == AnimatedPath::rotation ? 4 : 3;
    const bool cubic = channel.interpolation == Interpolation::cubic;
    const auto group = [&](std::size_t key, std::size_t part) {
        Value v{};
        const std::size_t at = (cubic ? 3 * key + part : key) * width;
        for (std::size_t i = 0; i < width; ++i) v[i] = double{channel.values[at + i]};
        return v;
    };
    const KeySpan span = find_keys(channel.times, time);
    const Value a = group(span.first, 1);
    if (span.first == span.second || channel.interpolation == Interpolation::step) return a;
    const Value b = group(span.second, 1);
    const double t = span.fraction;
    if (cubic) {
        const Value out_tangent = group(span.first, 2);
        const Value in_tangent = group(span.second, 0);
        const double t2 = t * t;
        const double t3 = t2 * t;
        Value v{};
        for (std::size_t i = 0; i < width; ++i) {
            v[i] = (2 * t3 - 3 * t2 + 1) * a[i] + span.seconds * (t3 - 2 * t2 + t) * out_tangent[i] +
                   (3 * t2 - 2 * t3) * b[i] + span.seconds * (t3 - t2) * in_tangent[i];
        }
        return v;
    }
    if (channel.path == AnimatedPath::rotation) return slerp(a, b, t);
    Value v{};
    for (std::size_t i = 0; i < width; ++i) v[i] = (1 - t) * a[i] + t * b[i];
    return v;
}

}  // namespace

std::vector<Transform> parents_from_nodes(const Scene& scene, double time) {
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

}  // namespace tandem
