/// The light that arrives at a vertex.
#pragma once

#include "tandem/oracle/oracle_reflection.h"

namespace tandem::oracle {

/// The lobes of a vertex that reflect light which no path will find.
struct EndingLobes {
    bool diffuse, facets;
};

/// All light from light sources that a surface reflects.
[[nodiscard]] Vector shade(const BoundedView& scene, const Vertex& vertex, const EndingLobes& ends, Chance& chance);

}  // namespace tandem::oracle
