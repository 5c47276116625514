// Acceleration structures only propose: with them and without, the same bits. The hierarchy of the CUDA backend is
// tried here on the host, where every machine can.

#include <gtest/gtest.h>

#include <limits>

#include "support/hard_scenes.h"
#include "tandem/bvh/bvh.h"
#include "tandem/bvh/bvh_tracer.h"
#include "tandem/geometry/few_tracer.h"
#include "tandem/scene/named_scenes.h"
#include "tandem/scene/prepare.h"

namespace tandem {
namespace {

/// A scene with its hierarchy.
struct Structure {
    explicit Structure(PreparedScene prepared) : scene(std::move(prepared)) {
        const SceneView scene_view = view(scene);
        Aabb bounds;
        for (std::uint32_t id = 0; id < primitive_count(scene_view); ++id) {
            bounds = merge(bounds, primitive_bounds(scene_view, id));
        }
        frame = make_structure_frame(bounds);
        bvh = build_bvh(scene_view, frame.margin);
    }
    [[nodiscard]] BvhTracer tracer() const {
        return {view(scene), {bvh.nodes.data(), bvh.entry_spheres.data(), bvh.entry_ids.data(), frame}};
    }
    PreparedScene scene;
    StructureFrame frame;
    Bvh bvh;
};

void expect_same_as_loop(const Structure& structure, const std::vector<Ray<float>>& rays, const std::string& name) {
    const BvhTracer through_bvh = structure.tracer();
    const LoopTracer one_by_one = {view(structure.scene)};
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!is_traceable(rays[i])) continue;
        const Closest<float> a = through_bvh.closest(rays[i], true);
        const Closest<float> b = one_by_one.closest(rays[i], true);
        ASSERT_EQ(a.primitive, b.primitive) << name << ", ray " << i;
        ASSERT_EQ(bits_of(a.t), bits_of(b.t)) << name << ", ray " << i;
    }
}

TEST(Bvh, NeverLosesAHit) {
    for (const test::HardScene& parameters : test::hard_scenes()) {
        const Structure structure(test::make_scene(parameters, 5));
        const SceneView scene = view(structure.scene);
        ASSERT_EQ(find_bvh_defect(structure.bvh, scene, structure.frame.margin), "") << parameters.name;
        expect_same_as_loop(structure, test::make_rays(structure.scene, 20'000, 6), parameters.name);
    }
}

TEST(Bvh, NeverLosesAGrazingHit) {
    // rays that touch spheres at their poles, where the boxes are exactly as wide as the spheres
    const Structure structure(prepare(named_scene("spheres/3000")));
    std::vector<Ray<float>> rays;
    for (std::size_t i = 0; i < structure.scene.spheres.size(); ++i) {
        const Sphere& s = structure.scene.spheres[i];
        const float far = i % 2 == 0 ? 3.0F : 3e5F;
        rays.push_back({{s.centre.x + s.radius * 0.9999999F, s.centre.y, s.centre.z - far}, {0, 0, 1}});
        rays.push_back({{s.centre.x - far, s.centre.y, s.centre.z - s.radius * 0.9999999F}, {1, 1e-25F, 0}});
        rays.push_back({{s.centre.x, s.centre.y + s.radius, s.centre.z}, {-1e-10F, 0, 0}});
    }
    expect_same_as_loop(structure, rays, "poles");
}

TEST(Bvh, BoundsItsDepthForCoincidentPrimitives) {
    PreparedScene scene;
    scene.spheres.assign(5000, Sphere{{1, 2, 3}, 0.5F});
    scene.material_of.assign(5000, 0);
    scene.materials.emplace_back();
    const Structure structure(std::move(scene));
    EXPECT_EQ(find_bvh_defect(structure.bvh, view(structure.scene), structure.frame.margin), "");
    const Closest<float> hit = structure.tracer().closest(Ray<float>{{1, 2, 0}, {0, 0, 1}}, true);
    EXPECT_EQ(hit.primitive, 0U);
    EXPECT_EQ(hit.t, 2.5);
}

TEST(Bvh, BoundsItsDepthForSizesThatHalve) {
    // each sphere half as big and half as far as the one before: surface areas favour splitting off one at a time
    PreparedScene scene;
    float x = 1e15F;
    for (int i = 0; i < 150; ++i, x *= 0.5F) scene.spheres.push_back({{x, 0, 0}, 0.1F * x});
    scene.material_of.assign(scene.spheres.size(), 0);
    scene.materials.emplace_back();
    const Structure structure(std::move(scene));
    EXPECT_EQ(find_bvh_defect(structure.bvh, view(structure.scene), structure.frame.margin), "");
}

TEST(Bvh, HoldsOnePrimitive) {
    PreparedScene scene;
    scene.spheres.push_back({{0, 0, 0}, 1});
    scene.material_of.push_back(0);
    scene.materials.emplace_back();
    const Structure structure(std::move(scene));
    EXPECT_EQ(structure.tracer().closest(Ray<float>{{0, 0, -3}, {0, 0, 1}}, true).t, 2.0);
    EXPECT_EQ(structure.tracer().closest(Ray<float>{{0, 3, -3}, {0, 0, 1}}, true).primitive, no_primitive);
}

TEST(FewTracer, GivesTheBitsOfTheLoop) {
    for (const std::uint32_t boxes : {0U, 1U, 4U}) {
        PreparedScene scene = test::make_scene({"few", 1, 0, 1, 32}, 7 + boxes);
        scene.spheres.resize(8 - boxes);
        scene.boxes.resize(boxes);
        scene.ellipsoids.clear();
        scene.parallelepipeds.clear();
        scene.material_of.resize(scene.spheres.size() + scene.boxes.size());
        const SceneView scene_view = view(scene);
        ASSERT_TRUE(fits_few_tracer(scene_view));
        const FewTracer few = make_few_tracer(scene_view, scene_view);
        const LoopTracer one_by_one = {scene_view};
        for (const Ray<float>& ray : test::make_rays(scene, 50'000, 8)) {
            if (!is_traceable(ray)) continue;
            const Closest<float> a = few.closest(ray, true);
            const Closest<float> b = one_by_one.closest(ray, true);
            ASSERT_EQ(a.primitive, b.primitive);
            ASSERT_EQ(bits_of(a.t), bits_of(b.t));
        }
    }
    EXPECT_FALSE(fits_few_tracer(view(prepare(named_scene("spheres/9")))));
    EXPECT_FALSE(fits_few_tracer(view(prepare(named_scene("mixed/4")))));
    EXPECT_FALSE(fits_few_tracer(view(prepare(named_scene("triangles/1")))));
    EXPECT_FALSE(fits_few_tracer(view(prepare(named_scene("quads/1")))));
}

TEST(BvhDefects, AreFound) {
    Structure structure(prepare(named_scene("mixed/100")));
    const SceneView scene = view(structure.scene);
    const float margin = structure.frame.margin;
    Bvh twice = structure.bvh;
    twice.entry_ids[0] = twice.entry_ids[1];
    EXPECT_NE(find_bvh_defect(twice, scene, margin), "");
    Bvh shrunk = structure.bvh;
    shrunk.nodes[0].xy[0][1] = shrunk.nodes[0].xy[0][0] + 1e-3F;
    EXPECT_NE(find_bvh_defect(shrunk, scene, margin), "");
    Bvh cut = structure.bvh;
    cut.nodes.back().child[0] = 1 << 20;
    EXPECT_NE(find_bvh_defect(cut, scene, margin), "");
}

}  // namespace
}  // namespace tandem
