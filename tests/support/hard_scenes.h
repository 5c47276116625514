/// Random scenes and rays with adversarial sizes and positions, to compare backends ray by ray.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tandem/compile/prepared_scene.h"
#include "tandem/math/ray.h"
#include "tandem/scene/scene.h"

namespace tandem::test {

/// The kinds of primitives in a random scene: solids or faces in turn, or one kind, for which backends have tracers of
/// its own.
enum class HardKinds { solids, faces, spheres, parallelepipeds, triangles };

/// The parameters of a random scene.
struct HardScene {
    std::string name;
    double scale;   ///< edge of the cloud of primitives, metres
    double offset;  ///< distance of the cloud from the world's origin, metres
    double spread;  ///< sizes are scale * 10^-U(0, spread)
    int count;      ///< primitives
    HardKinds kinds = HardKinds::solids;
};

[[nodiscard]] std::vector<HardScene> hard_scenes();

/// Scenes of one kind of primitive.
[[nodiscard]] std::vector<HardScene> scenes_of_one_kind();

[[nodiscard]] PreparedScene make_scene(const HardScene& parameters, std::uint64_t seed);

/// Rays that start near, inside, on and far from the primitives, with directions of length 10^U(-9, 9), aimed at
/// random points of random primitives' bounds or anywhere, some along axes.
[[nodiscard]] std::vector<Ray<float>> make_rays(const PreparedScene& scene, std::size_t count, std::uint64_t seed);

}  // namespace tandem::test
