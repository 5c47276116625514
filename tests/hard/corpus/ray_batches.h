/// Scenes of single solids, and batches of rays against them.
#pragma once

#include <utility>
#include <vector>

#include "hard/corpus/hard_case.h"
#include "support/aim.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/shapes/box.h"

namespace tandem::hard {

/// A scene that prepare() turns into exactly these primitives: first the spheres, then the boxes, so that their numbers
/// are the ids. It has a camera at the origin and one material. Throws std::logic_error for a box whose centre and size
/// are not doubles.
[[nodiscard]] Scene scene_of(const std::vector<Sphere>& spheres, const std::vector<Box>& boxes = {});

/// `count` small spheres on a shell around `centre`. They make the backend build an acceleration structure, so that its
/// bounds are tested: a scene of one primitive has none (D10).
[[nodiscard]] std::vector<Sphere> shell(Random& random, const Vec3d& centre, double radius, int count = 64);

template <class Make>
std::vector<Ray<float>> make_rays(std::size_t count, Make make) {
    std::vector<Ray<float>> rays;
    rays.reserve(count);
    for (std::size_t i = 0; i < count; ++i) rays.push_back(make());
    return rays;
}

/// Adds two batches: the solids alone, and within a shell. `make` makes a ray.
template <class Make>
void add_batches(std::vector<RayBatch>& batches, Random& random, std::vector<Sphere> spheres,
                 const std::vector<Box>& boxes, double shell_radius, std::size_t rays, Make make) {
    batches.push_back({scene_of(spheres, boxes), make_rays(rays / 2, make)});
    const std::vector<Sphere> around = shell(random, {0, 0, 0}, shell_radius);
    spheres.insert(spheres.end(), around.begin(), around.end());
    batches.push_back({scene_of(spheres, boxes), make_rays(rays - rays / 2, make)});
}

}  // namespace tandem::hard
