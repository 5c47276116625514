#include "tandem/kernel/pixel_culling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/random.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/traversal/intersect.h"

namespace tandem {
namespace {

/// A few spheres and boxes, some of them small, thin or around the camera.
PreparedScene random_scene(test::Random& random) {
    PreparedScene scene;
    const auto anywhere = [&] {
        return Vec3f{random.uniform(-4.0F, 4.0F), random.uniform(-4.0F, 4.0F), random.uniform(-9.0F, 3.0F)};
    };
    const auto size_of = [&](double lower, double upper) { return std::abs(random.log_uniform(lower, upper)); };
    for (std::uint32_t i = 0; i < ConstantMemoryTracer::max_spheres; ++i) {
        scene.spheres.push_back({anywhere(), size_of(-8.0, 2.0)});
    }
    for (std::uint32_t i = 0; i < ConstantMemoryTracer::max_boxes; ++i) {
        const Vec3f lower = anywhere();
        const Vec3f size = {size_of(-8.0, 2.0), size_of(-8.0, 2.0), size_of(-8.0, 2.0)};
        scene.boxes.push_back({lower, lower + size});
    }
    scene.material_of.assign(scene.spheres.size() + scene.boxes.size(), 0);
    scene.materials.emplace_back();
    return scene;
}

constexpr std::uint32_t film_size = 64;

/// Of a film of film_size x film_size, not along the axes. `kind`: 0 pinhole, 1 lens, 2 orthographic.
CameraView random_camera(test::Random& random, int kind) {
    const double turn = random.uniform(-0.5, 0.5), scale = 2.0 / film_size;
    const Vec3d right = {std::cos(turn) * scale, 0.1 * scale, std::sin(turn) * scale};
    const Vec3d down = {0.05 * scale, -scale, 0.02 * scale};
    CameraView camera{};
    camera.origin = {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), 5};
    camera.direction = {0, 0, -1};
    const auto from_middle = [&](const Vec3d& middle) { return middle - (right + down) * (0.5 * film_size); };
    if (kind == 2) {
        camera.orthographic = true;
        camera.origin = from_middle(camera.origin);
        camera.origin_dx = right;
        camera.origin_dy = down;
    } else {
        camera.direction = from_middle(camera.direction);
        camera.direction_dx = right;
        camera.direction_dy = down;
    }
    if (kind == 1) {
        camera.has_lens = true;
        camera.lens_x = {0.05, 0, 0};
        camera.lens_y = {0, 0.05, 0};
        camera.inverse_focus = 0.25;
    }
    return camera;
}

TEST(PixelCulling, KeepsEveryPrimitiveThatACameraRayHits) {
    std::size_t hits = 0, slots_kept = 0, slots_hit = 0;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        test::Random random(seed);
        const PreparedScene prepared = random_scene(random);
        const SceneView scene = view(prepared);
        const ConstantMemoryTracer few = make_constant_memory_tracer(scene, scene);
        const LoopTracer one_by_one = {scene};
        const CameraView camera = random_camera(random, static_cast<int>(seed % 3));
        for (int i = 0; i < 300; ++i) {
            const double reach = std::max(0, i % 4 - 1) * 0.5;  // 0, 0.5, 1: of filters
            const PixelTile tile = {random.below(film_size), random.below(film_size), 1 + random.below(9),
                                    1 + random.below(5), reach};
            const RayBundle bundle = bundle_of_tile(camera, tile, true);
            std::uint32_t slots = 0;
            for (std::uint32_t slot = 0; slot < ConstantMemoryTracer::slot_count; ++slot) {
                if (may_hit(few, bundle, slot)) slots |= 1U << slot;
            }
            const CulledTracer culled = {few, slots};
            std::uint32_t hit_slots = 0;
            for (int sample = 0; sample < 64; ++sample) {
                const std::uint32_t x = tile.x + random.below(tile.width), y = tile.y + random.below(tile.height);
                // corners of the pixel and of the filter too
                const auto offset = [&](float beyond) {
                    return sample < 4 ? (random.coin() ? 0.99999994F + beyond : -beyond)
                                      : random.uniform(-beyond, 1 + beyond);
                };
                const auto beyond = static_cast<float>(reach);
                const float u = offset(beyond), v = offset(beyond), a = random.uniform(0.0F, 1.0F), b = offset(0);
                Ray<float> ray = camera_ray<float>(camera, x, y, u, v);
                if (camera.has_lens) ray = through_lens(camera, ray, a, b);
                const Closest<float> all = one_by_one.closest(ray, NoSource{}, true);
                const Closest<float> same = culled.closest(ray, NoSource{}, true);
                ASSERT_EQ(same.primitive, all.primitive) << "seed " << seed << ", pixel " << x << ", " << y;
                ASSERT_EQ(bits_of(same.t), bits_of(all.t)) << "seed " << seed << ", pixel " << x << ", " << y;
                if (all.primitive == no_primitive) continue;
                ++hits;
                const auto spheres = static_cast<std::uint32_t>(prepared.spheres.size());
                hit_slots |= all.primitive < spheres ? ConstantMemoryTracer::slot_of_sphere(all.primitive)
                                                     : ConstantMemoryTracer::slot_of_box(all.primitive - spheres);
            }
            slots_kept += static_cast<std::size_t>(__builtin_popcount(slots));
            slots_hit += static_cast<std::size_t>(__builtin_popcount(hit_slots));
        }
    }
    EXPECT_GT(hits, 100'000U);
    EXPECT_LT(slots_kept, 4 * slots_hit) << "hidden ones are kept, but few others";
}

TEST(PixelCulling, KeepsWhatIsNotANumber) {
    const RayBundle nowhere = {{NAN, 0, 0}, {0, 0, 1}, 0, 0};
    EXPECT_TRUE(may_hit(nowhere, Sphere{{0, 0, 0}, 1}));
    EXPECT_TRUE(may_hit(nowhere, Box{{0, 0, 0}, {1, 1, 1}}));
    const RayBundle ahead = {{0, 0, -5}, {0, 0, 1}, 0, 0};
    EXPECT_TRUE(may_hit(ahead, Sphere{{1, 0, 0}, 1}));
    EXPECT_FALSE(may_hit(ahead, Sphere{{1.001F, 0, 0}, 1}));
    EXPECT_FALSE(may_hit(ahead, Box{{0.001F, 0, 0}, {1, 1, 1}}));
}

}  // namespace
}  // namespace tandem
