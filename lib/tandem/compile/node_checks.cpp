#include "tandem/compile/node_checks.h"

#include <fmt/format.h>

#include <algorithm>

#include "tandem/base/error.h"
#include "tandem/math/lengths.h"

namespace tandem {

void fail_at_node(const Scene& scene, std::size_t node, const std::string& what) {
    const std::string& name = scene.nodes[node].name;
    throw InputError(fmt::format("node {}{} has {}", node, name.empty() ? "" : " '" + name + "'", what));
}

bool is_hidden(const Matrix3& m) {
    double largest = 0;
    for (const Vec3d& row : m.row) largest = std::max(largest, max_norm(row));
    if (largest == 0) return true;
    const Matrix3 columns = transpose(m);
    if (largest > 1e-60 && largest < 1e60) {
        // most maps are far from flat and need no divisions: the exact limit below is for squares divided by largest^4
        const Vec3d normal = cross(columns.row[0], columns.row[1]);
        const double largest2 = largest * largest;
        if (dot(normal, normal) > 1e-20 * largest2 * largest2) return false;
    }
    const auto area2 = [&](int i, int k) {
        const Vec3d normal = cross(columns.row[i] / largest, columns.row[k] / largest);
        return dot(normal, normal);
    };
    return std::max({area2(0, 1), area2(1, 2), area2(2, 0)}) <= 1e-30;
}

}  // namespace tandem
