#include "cpu/size_layers.h"

#include <gtest/gtest.h>

#include <vector>

namespace tandem {
namespace {

/// Spheres of one radius in a row from the origin to x.
struct Row {
    std::size_t count;
    float radius, x;
};

std::vector<SizeLayer> layers_of(const std::vector<Row>& rows) {
    std::vector<Sphere> spheres;
    for (const Row& row : rows) {
        for (std::size_t i = 1; i <= row.count; ++i) {
            spheres.push_back({{row.x * static_cast<float>(i) / static_cast<float>(row.count), 0, 0}, row.radius});
        }
    }
    SceneView scene{};
    scene.spheres = spheres.data();
    scene.sphere_count = static_cast<std::uint32_t>(spheres.size());
    return divide_by_size(scene);
}

// The hierarchy of a sphere of 1000 km needs a padding of 1.9 m, so that primitives below 7.6 m are tiny.
TEST(SizeLayers, AreMadeIfManyPrimitivesAreTinyBesideTheScene) {
    EXPECT_EQ(layers_of({{100, 1, 10}}).size(), 1U);
    EXPECT_EQ(layers_of({{100, 1, 10}, {1, 1e6F, 0}}).size(), 2U);
    EXPECT_EQ(layers_of({{100, 5, 10}, {1, 1e6F, 0}}).size(), 1U) << "not tiny";
    EXPECT_EQ(layers_of({{1, 1, 10}, {63, 1e6F, 0}}).size(), 2U);
    EXPECT_EQ(layers_of({{1, 1, 10}, {64, 1e6F, 0}}).size(), 1U) << "not many";
    EXPECT_EQ(layers_of({{100, 1, 9e5F}, {1, 1e6F, 0}}).size(), 1U) << "as far apart as the scene is large";
    EXPECT_EQ(layers_of({{100, 1, 10}, {100, 1e6F, 0}, {100, 1e12F, 0}}).size(), 3U);
}

TEST(SizeLayers, HoldEveryPrimitiveOnce) {
    const std::vector<SizeLayer> layers = layers_of({{100, 1, 10}, {100, 1e6F, 0}, {100, 1e12F, 0}});
    ASSERT_EQ(layers.size(), 3U);
    for (const float size : {0.0F, 1.0F, 2.0F, 7.0F, 8.0F, 2e6F, 7.6e6F, 8e6F, 2e12F, 1e18F}) {
        int holders = 0;
        for (const SizeLayer& layer : layers) holders += layer.sizes.contains({{0, 0, 0}, {0, size, 0}}) ? 1 : 0;
        EXPECT_EQ(holders, 1) << size;
    }
    EXPECT_EQ(layers[0].bounds.upper.x, 1e12F);
    EXPECT_EQ(layers[1].bounds.upper.x, 1e6F);
    EXPECT_EQ(layers[2].bounds.upper.x, 11);
}

}  // namespace
}  // namespace tandem
