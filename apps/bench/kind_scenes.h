/// Small scenes of one kind of primitive each, with rays that are easy or hard for float arithmetic.
#pragma once

#include <string>
#include <vector>

#include "tandem/compile/prepared_scene.h"
#include "tandem/math/ray.h"

namespace tandem::bench {

enum class Difficulty { easy, hard };

struct KindScene {
    std::string kind;  ///< "sphere", ...
    Difficulty difficulty;
    PreparedScene scene;
    std::vector<Ray<float>> rays;
};

/// 64 primitives of the kind in a cube, and rays towards random points of their bounds.
/// easy: the cube is [-1, 1]^3, primitives are about 0.25 in size, rays start 3 from the centre.
/// hard: the cube is [-1, 1]^3 about (1000, 1000, 1000), primitives are about 0.0025 in size, rays start 3000 away.
/// The same on every machine.
[[nodiscard]] KindScene make_kind_scene(const std::string& kind, Difficulty difficulty, std::size_t ray_count);

[[nodiscard]] std::vector<std::string> primitive_kinds();

}  // namespace tandem::bench
