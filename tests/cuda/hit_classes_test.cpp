// Hits in classes, in a block of one thread. Needs no GPU.
#include "cuda/hit_classes.h"

#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <vector>

#include "cuda/host_lane.h"

namespace tandem::cuda {
namespace {

constexpr std::uint32_t kinds = PrimitiveKinds::all;

/// Primitives with a material each: diffuse, or one that transmits light or emits it, or both.
class HitClassesOf : public ::testing::Test {
  protected:
    enum Look { diffuse, clear, bright, clear_and_bright };

    void add(Look look) {
        Optics optics;
        if (look == clear || look == clear_and_bright) optics.transmission = 1;
        if (look == bright || look == clear_and_bright) optics.emission = {1, 1, 1};
        material_of_.push_back(static_cast<std::uint32_t>(optics_.size()));
        optics_.push_back(optics);
        materials_.push_back({});
    }
    const HitClasses& compared() {
        scene_.materials = materials_.data();
        scene_.optics = optics_.data();
        scene_.material_of = material_of_.data();
        scene_.material_count = static_cast<std::uint32_t>(optics_.size());
        classes_->compare_materials<HostLane>(scene_);
        return *classes_;
    }
    std::uint32_t of(std::uint32_t primitive) const { return classes_->of<kinds>(scene_, primitive); }

    std::vector<PhongMaterial> materials_;
    std::vector<Optics> optics_;
    std::vector<std::uint32_t> material_of_;
    SceneView scene_{};
    std::unique_ptr<HitClasses> classes_ = std::make_unique<HitClasses>();
};

TEST_F(HitClassesOf, AreEqualForAlikeMaterialsOfOneKind) {
    for (const Look look : {diffuse, clear, diffuse, bright, clear}) add(look);
    scene_.sphere_count = 4;
    scene_.triangle_count = 1;
    EXPECT_EQ(compared().rank_count, 3U);
    EXPECT_EQ(of(0), of(2));
    EXPECT_EQ((std::set<std::uint32_t>{of(0), of(1), of(3), of(4)}.size()), 4U) << "the last one is a triangle";
}

TEST_F(HitClassesOf, OfMaterialsWithMostPartsComeFirst) {
    for (const Look look : {bright, diffuse, clear_and_bright, clear, clear_and_bright}) add(look);
    scene_.sphere_count = 4;
    scene_.quad_count = 1;
    (void)compared();
    EXPECT_LT(of(4), of(2)) << "a face before a solid";
    EXPECT_LT(of(2), of(0));
    EXPECT_LT(of(0), of(3)) << "as many parts: in the order of the materials";
    EXPECT_LT(of(3), of(1));
}

TEST_F(HitClassesOf, AreInRangeForAnyNumberOfMaterials) {
    for (std::uint32_t i = 0; i < 3 * HitClasses::most_materials; ++i) add(static_cast<Look>(i % 3));
    scene_.sphere_count = static_cast<std::uint32_t>(optics_.size()) - 1;
    scene_.quad_count = 1;
    (void)compared();
    for (std::uint32_t i = 0; i <= scene_.sphere_count; ++i) EXPECT_LT(of(i), HitClasses::count);
    EXPECT_EQ(of(0), of(3));
    EXPECT_NE(of(0), of(1));
    EXPECT_EQ(of(2 * HitClasses::most_materials), of(2 * HitClasses::most_materials + 1)) << "not compared";
}

}  // namespace
}  // namespace tandem::cuda
