#include "hard/corpus/ray_batches.h"

#include <stdexcept>

namespace tandem::hard {

Scene scene_of(const std::vector<Sphere>& spheres, const std::vector<Box>& boxes) {
    Scene scene;
    scene.name = "hard case";
    scene.materials.push_back({"grey", {}});
    scene.nodes.push_back({.name = "eye", .camera = PerspectiveCamera{}});
    const auto add = [&](const Vec3d& place, Shape shape) {
        Node node{.name = "primitive " + std::to_string(scene.nodes.size() - 1)};
        node.trs.translation = place;
        node.geometry.push_back({shape, 0, {}});
        scene.nodes.push_back(std::move(node));
    };
    for (const Sphere& sphere : spheres) add(widen(sphere.centre), SphereShape{widen(sphere.radius)});
    for (const Box& box : boxes) {
        const Vec3d middle = (widen(box.lower) + widen(box.upper)) * 0.5;
        const Vec3d size = widen(box.upper) - widen(box.lower);
        if (narrow(middle - size * 0.5) != box.lower || narrow(middle + size * 0.5) != box.upper) {
            throw std::logic_error("a box of the corpus that no double places exactly");
        }
        add(middle, BoxShape{size});
    }
    return scene;
}

std::vector<Sphere> shell(Random& random, const Vec3d& centre, double radius, int count) {
    std::vector<Sphere> spheres;
    spheres.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
        spheres.push_back({narrow(centre + test::any_unit(random) * radius), static_cast<float>(0.02 * radius)});
    }
    return spheres;
}

}  // namespace tandem::hard
