/// The correct answer for a ray, and which parts of it may be judged.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/shapes/hit.h"
#include "tandem/math/ray.h"

namespace tandem::hard {

/// The parts of an answer that are judged; see exact_answers().
enum Judged : std::uint8_t { judged_hit = 1, judged_primitive = 2, judged_t = 4, judged_all = 7 };

struct Answer {
    std::uint32_t primitive = no_primitive;
    float t = 0;        ///< correctly rounded; 0 for a miss
    double wide_t = 0;  ///< the same, rounded to double
    std::uint8_t judged = judged_all;
};

/// The correct answers by brute force in exact arithmetic on the prepared scene, on all cores. Rays that are not
/// traceable miss.
///
/// For spheres and boxes all decisions are judged: their numbers and those of the ray are floats, so there is one
/// correct decision. If two surfaces are within 2^-48 of each other the primitive is not judged, unless the two are
/// equal by the same arithmetic (boxes with a face in one plane, equal spheres) or t is correctly rounded (triangles
/// and quads): then the lowest id is correct. For ellipsoids and parallelepipeds the ray is transformed by a matrix of
/// doubles: if solids 2^-30 smaller and larger give different results, the decision, or t, is not judged.
[[nodiscard]] std::vector<Answer> exact_answers(const PreparedScene& scene, std::span<const Ray<float>> rays);

}  // namespace tandem::hard
