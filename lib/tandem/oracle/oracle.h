/// The slow right answer: brute force over all primitives in extended precision, no structure, no Embree, none of the
/// formulas of lib/tandem/kernel/shapes and lib/tandem/kernel/bsdf. What it shares with the backends is the camera ray
/// and the random numbers, so that it renders the same samples.
#pragma once

#include <memory>

#include "tandem/math/ray.h"
#include "tandem/render/backend.h"

namespace tandem {

struct OracleHit {
    long double t = 0;
    std::uint32_t primitive = no_primitive;
};

/// Nearest hit in front of the origin of a ray that comes from `source`; ties go to the lower id. Not traceable rays
/// miss.
[[nodiscard]] OracleHit oracle_trace(const PreparedScene& scene, const Ray<float>& ray, const RaySource& source = {});

[[nodiscard]] std::unique_ptr<Backend> make_oracle_backend(const BackendOptions& options);

}  // namespace tandem
