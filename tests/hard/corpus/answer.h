/// What is right for a ray, and which of it may be judged.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/shapes/hit.h"
#include "tandem/math/ray.h"

namespace tandem::hard {

/// Parts of an answer that hang on less than any arithmetic should be judged on are not judged; see exact_answers().
enum Judged : std::uint8_t { judged_hit = 1, judged_primitive = 2, judged_t = 4, judged_all = 7 };

struct Answer {
    std::uint32_t primitive = no_primitive;
    float t = 0;        ///< correctly rounded; 0 for a miss
    double wide_t = 0;  ///< the same, rounded to double
    std::uint8_t judged = judged_all;
};

/// The right answers by brute force in exact arithmetic on the scene as it was prepared, on all cores. Rays that are
/// not traceable miss.
///
/// Judged are, for spheres and boxes, all decisions: their numbers are floats and the ray's too, so nothing is in
/// doubt. Two surfaces within 2^-48 of each other leave the primitive open, but not where they are equal by the same
/// arithmetic (boxes with a face in one plane, equal spheres), or from t correctly rounded (triangles and quads): there
/// the lowest id is right. For ellipsoids and parallelepipeds the ray goes through a matrix of doubles: where bodies
/// 2^-30 smaller and larger differ, the decision, or t, is left open.
[[nodiscard]] std::vector<Answer> exact_answers(const PreparedScene& scene, std::span<const Ray<float>> rays);

}  // namespace tandem::hard
