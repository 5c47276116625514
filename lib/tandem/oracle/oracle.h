/// The reference renderer: brute force over all primitives in extended precision, without an acceleration structure,
/// Embree, or the formulas of lib/tandem/kernel/shapes and lib/tandem/kernel/bsdf. It shares the camera rays and the
/// random numbers with the backends, so that it renders the same samples, and the bounds of primitives: it leaves out
/// those far from a line. tests/agree/oracle_bounds_test.cpp compares with trying all.
#pragma once

#include <memory>

#include "tandem/compile/prepared_scene.h"
#include "tandem/math/ray.h"
#include "tandem/render/backend.h"

namespace tandem {

struct OracleHit {
    long double t = 0;
    std::uint32_t primitive = no_primitive;
};

/// The nearest hit in front of the origin of a ray from `source`; at equal t the lower id wins. Rays that are not
/// traceable miss. Tries every primitive; the backend leaves out those whose bounding ball the line misses.
[[nodiscard]] OracleHit oracle_trace(const PreparedScene& scene, const Ray<float>& ray, const RaySource& source = {});

[[nodiscard]] std::unique_ptr<Backend> make_oracle_backend(const BackendOptions& options);

}  // namespace tandem
