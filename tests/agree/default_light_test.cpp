// The light of files that have none: how bright it makes things, on every backend.
#include "tandem/scene/default_light.h"

#include <gtest/gtest.h>

#include "support/backend_list.h"
#include "tandem/compile/derive.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/scene/camera_node.h"
#include "tandem/scene/framing.h"

namespace tandem {
namespace {

/// A white diffuse object, framed from that view and lit by default.
Scene lit(std::vector<Geometry> geometry, const std::string& view) {
    Scene scene;
    scene.materials = {{"white", {{0.08F, 0.08F, 0.08F}, {0.8F, 0.8F, 0.8F}, {0, 0, 0}, 1}}};
    scene.nodes.resize(1);
    scene.nodes[0].geometry = std::move(geometry);
    scene.nodes.push_back(frame_scene(scene, view, 1).node);
    EXPECT_FALSE(has_light(scene));
    add_default_light(scene, camera_node(scene, view));
    EXPECT_TRUE(has_light(scene));
    return scene;
}

constexpr int edge = 60;

class DefaultLight : public test::ExactBackend {
  protected:
    Film draw(const Scene& scene, const std::string& view) {
        RenderJob job{.width = edge, .height = edge, .samples = 16, .tier = GetParam().tier};
        return backend_->render(load(prepare(scene, {.camera = view})), job).film;
    }

    /// The mean level of a square of 5 x 5 pixels around that part of the film; (0, 0) is its upper left.
    static double level(const Film& film, double x, double y) {
        double sum = 0;
        for (int i = 0; i < 25; ++i) {
            const int at = (static_cast<int>(y * edge) + i / 5 - 2) * edge + static_cast<int>(x * edge) + i % 5 - 2;
            const Vec3d& pixel = film.sums()[static_cast<std::size_t>(at)];
            sum += (pixel.x + pixel.y + pixel.z) / 3 / film.samples() / 25;
        }
        return sum;
    }
};

TEST_P(DefaultLight, ShowsAWhiteBallFromEverySide) {
    for (const char* view : {"auto", "front", "back", "left", "right", "top", "bottom", "three-quarter"}) {
        const Film film = draw(lit({{SphereShape{1}, 0}}, view), view);
        const double bright = level(film, 0.33, 0.3), middle = level(film, 0.5, 0.5), dark = level(film, 0.75, 0.78);
        EXPECT_GT(bright, 0.6) << view << ": the upper left is lit";
        EXPECT_LT(bright, 0.9) << view << ": and not blown out";
        EXPECT_GT(middle, 0.45) << view;
        EXPECT_LT(dark, bright / 2) << view << ": the lower right is in shadow";
        EXPECT_GT(dark, 0.1) << view << ": but not black";
        const double sky = level(film, 0.08, 0.08);
        EXPECT_LT(sky, bright - 0.2) << view << ": the background is not white";
        EXPECT_GT(sky, 0.1) << view;
    }
}

TEST_P(DefaultLight, CastsShadows) {
    // a ball that floats over a floor throws its shadow to the lower right
    const std::vector<Geometry> geometry = {{SphereShape{0.5}, 0, {{.translation = {0, 1, 0}}}},
                                            {BoxShape{{6, 0.1, 6}}, 0}};
    const Scene scene = lit(geometry, "top");
    const Film film = draw(scene, "top");
    double darkest = 1;
    for (double x = 0.1; x < 0.9; x += 0.05) darkest = std::min(darkest, level(film, x, x));
    EXPECT_LT(darkest, 0.6 * level(film, 0.2, 0.8));
    EXPECT_EQ(mask_of(derive_effects(scene, prepare(scene, {.camera = "top"}))),
              Effect::shadows | Effect::directional_lights | Effect::environment_light);
}

TEST_P(DefaultLight, DoesNotLeaveARoomBlack) {
    // six walls around the camera
    Scene scene = lit({{BoxShape{{4, 4, 4}}, 0}}, "front");
    scene.nodes[1].matrix.reset();
    EXPECT_GT(level(draw(scene, "front"), 0.5, 0.5), 0.1);
}

INSTANTIATE_TEST_SUITE_P(Backends, DefaultLight, ::testing::ValuesIn(test::exact_renderers()), test::test_name);

/// A ball, and a lamp of that radiance that is as large.
Scene with_lamp(float radiance) {
    Scene scene;
    scene.materials = {{"white", {}}, {"lamp", {}}};
    scene.materials[1].optics.emission = {radiance, radiance, radiance};
    scene.nodes.resize(2);
    scene.nodes[0].geometry = {{SphereShape{1}, 0}};
    scene.nodes[1].geometry = {{SphereShape{1}, 1}};
    return scene;
}

TEST(HasLight, CountsLampsThatShine) {
    Scene scene = with_lamp(0);
    EXPECT_FALSE(has_light(scene));
    scene.nodes[0].light = LightSource{};
    EXPECT_TRUE(has_light(scene));
    scene.nodes[0].light->intensity = 0;
    EXPECT_FALSE(has_light(scene));
}

TEST(HasLight, CountsEmissionByItsMeanOverAllSurfaces) {
    EXPECT_TRUE(has_light(with_lamp(0.41F)));
    EXPECT_FALSE(has_light(with_lamp(0.39F)));
    Scene small = with_lamp(100);
    small.nodes[1].trs.scale = {0.01, 0.01, 0.01};
    EXPECT_FALSE(has_light(small)) << "an emissive dial";
    small.materials[1].optics.emission = {9000, 9000, 9000};
    EXPECT_TRUE(has_light(small)) << "a lamp";
    Scene unused = with_lamp(100);
    unused.nodes[1].geometry.clear();
    EXPECT_FALSE(has_light(unused));
}

TEST(HasLight, MeasuresSurfacesWhereTheyStand) {
    // a mesh, a box and a quad of one square metre each, stretched and rotated; one of them is emissive
    Scene scene = with_lamp(0);
    scene.meshes.resize(2);
    scene.meshes[0].positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    scene.meshes[0].triangles = {0, 1, 2, 0, 2, 3};
    scene.meshes[1].positions = {{0, 0, 0}, {0.1F, 0, 0}, {0.1F, 0.1F, 0}, {0, 0.1F, 0}};
    scene.meshes[1].quads = {0, 1, 2, 3};
    scene.nodes[0].geometry = {{MeshShape{0}, 0}, {BoxShape{{1, 0.25, 0.2}}, 0}};
    scene.nodes[1].geometry = {{MeshShape{1}, 1}};
    scene.nodes[1].trs = {.rotation = {0.5, 0.5, 0.5, 0.5}, .scale = {5, 20, 7}};
    // 1 + 1 square metres are not emissive, and 1 is: a third of 0.6 is 0.2
    scene.materials[1].optics.emission = {0.59F, 0.59F, 0.59F};
    EXPECT_FALSE(has_light(scene));
    scene.materials[1].optics.emission = {0.61F, 0.61F, 0.61F};
    EXPECT_TRUE(has_light(scene));
}

}  // namespace
}  // namespace tandem
