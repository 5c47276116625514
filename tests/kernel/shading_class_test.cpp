// Hits that need the same code to be shaded have the same class, others have another.
#include "tandem/kernel/shading_class.h"

#include <gtest/gtest.h>

#include <array>
#include <set>

namespace tandem {
namespace {

/// Materials that differ in one property each; the first two only in numbers.
class MaterialClass : public ::testing::Test {
  protected:
    static constexpr std::size_t count = 14;

    MaterialClass() {
        for (PhongMaterial& material : materials_) material.diffuse = {0.5F, 0.25F, 0.125F};
        for (Microfacets& part : microfacets_) part.is_there = 0;
        for (Sheen& part : sheens_) part.is_there = 0;
        materials_[1].diffuse = {0, 0, 1};
        materials_[2].diffuse = materials_[2].specular = {0, 0, 0};
        optics_[3].mirror = {0, 0.5F, 0};
        optics_[4].transmission = 1;
        optics_[5].emission = {0, 0, 2};
        optics_[6].unlit = 1;
        microfacets_[7].is_there = 1;
        sheens_[8].is_there = 1;
        textures_[9].diffuse.texture = 7;
        textures_[10].normal.texture = 7;
        textures_[11].emission.texture = 7;
        textures_[12].metallic_roughness.texture = 7;
        textures_[13].alpha_cutoff = 0.5F;
        scene_.materials = materials_.data();
        scene_.optics = optics_.data();
        scene_.microfacets = microfacets_.data();
        scene_.sheens = sheens_.data();
        scene_.microfacets_count = scene_.sheens_count = count;
        scene_.textures.materials = textures_.data();
    }

    std::array<PhongMaterial, count> materials_{};
    std::array<Optics, count> optics_{};
    std::array<Microfacets, count> microfacets_{};
    std::array<Sheen, count> sheens_{};
    std::array<MaterialTextures, count> textures_{};
    SceneView scene_{};
};

TEST_F(MaterialClass, DependsOnPartsAndTexturesAlone) {
    EXPECT_EQ(material_class(scene_, 0), material_class(scene_, 1)) << "another colour";
    std::set<std::uint32_t> found;
    for (std::uint32_t i = 1; i < count; ++i) {
        EXPECT_TRUE(found.insert(material_class(scene_, i)).second) << "material " << i << " is like one before";
    }
}

TEST_F(MaterialClass, ReadsNoArraysThatTheSceneHasNot) {
    scene_.microfacets = nullptr;
    scene_.sheens = nullptr;
    scene_.microfacets_count = scene_.sheens_count = 0;
    scene_.textures.materials = nullptr;
    EXPECT_EQ(material_class(scene_, 0), material_class(scene_, 13));
    EXPECT_NE(material_class(scene_, 0), material_class(scene_, 4));
}

TEST(KindNumber, IsTheSameWithinAKind) {
    SceneView scene{};
    scene.sphere_count = 2;
    scene.triangle_count = 3;
    scene.quad_count = 1;
    const auto number = [&](std::uint32_t id) { return kind_number<PrimitiveKinds::all>(scene, id); };
    EXPECT_EQ(number(0), number(1));
    EXPECT_EQ(number(2), number(4));
    EXPECT_EQ((std::set<std::uint32_t>{number(0), number(2), number(5)}.size()), 3U);
    EXPECT_LT(number(5), kind_count<PrimitiveKinds::all>());
    EXPECT_EQ(kind_number<PrimitiveKinds::quad>(scene, 0), 0U) << "of a tracer for one kind";
    EXPECT_EQ(kind_count<PrimitiveKinds::quad>(), 1U);
}

}  // namespace
}  // namespace tandem
