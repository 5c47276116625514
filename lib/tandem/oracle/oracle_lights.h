/// What lights bring to a vertex.
#pragma once

#include "tandem/oracle/oracle_reflection.h"

namespace tandem::oracle {

/// Which lobes of a vertex reflect what no path will find.
struct EndingLobes {
    bool diffuse, facets;
};

/// All that a surface reflects of what gives light.
[[nodiscard]] Vector shade(const SceneView& scene, const Vertex& vertex, const EndingLobes& ends, Chance& chance);

}  // namespace tandem::oracle
