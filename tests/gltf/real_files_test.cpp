/// Files of other people: the ones beside the checkout, and Debian's assimp-testmodels.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "gltf/files.h"
#include "tandem/backends/make_backend.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"

namespace tandem {
namespace {

using test::contains;
namespace fs = std::filesystem;

/// The folder gltf/ of $TANDEM_SHARED, or of a folder "shared" beside the checkout or beside its parent.
std::optional<fs::path> shared_files() {
    std::vector<fs::path> places = {fs::path(TANDEM_SOURCE_DIR) / "../shared",
                                    fs::path(TANDEM_SOURCE_DIR) / "../../shared"};
    if (const char* named = std::getenv("TANDEM_SHARED")) places.insert(places.begin(), named);
    for (const fs::path& place : places) {
        if (fs::is_directory(place / "gltf")) return place / "gltf";
    }
    return std::nullopt;
}

/// Every file gives a scene, or one sentence that begins with its name.
void import_or_explain(const fs::path& file) {
    try {
        const ImportResult result = import_gltf(file);
        EXPECT_TRUE(validate(result.scene).empty()) << file;
    } catch (const InputError& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.rfind(file.string() + ": ", 0), 0U) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        EXPECT_LT(message.size(), 600U) << message;
    }
}

TEST(RealFiles, BesideTheCheckout) {
    const auto folder = shared_files();
    if (!folder) GTEST_SKIP() << "no folder shared/gltf beside the checkout, and TANDEM_SHARED does not name one";
    const auto box = import_gltf(*folder / "CornellBox.glb");
    EXPECT_EQ(box.scene.nodes.size(), 4U);
    EXPECT_EQ(box.scene.materials.size(), 5U);
    EXPECT_TRUE(contains(test::sentences(box.report), "rendered: triangle mesh at meshes[0].primitives[0] (6 uses)"));
    const auto helmet = import_gltf(*folder / "FlightHelmet/FlightHelmet.gltf");
    EXPECT_EQ(helmet.scene.nodes.size(), 6U);
    EXPECT_TRUE(contains(test::sentences(helmet.report), "rendered: image at images[2] (15 uses)"));
    EXPECT_TRUE(contains(test::sentences(helmet.report), "rendered: metallic-roughness texture at materials[0]"));
    ASSERT_EQ(helmet.scene.images.size(), 15U);
    EXPECT_EQ(helmet.scene.images[0].texels.size(),
              std::size_t{helmet.scene.images[0].width} * helmet.scene.images[0].height);
    const auto fox = import_gltf(*folder / "Fox.glb");
    EXPECT_EQ(fox.scene.nodes.size(), 27U) << "one for the posed mesh";
    EXPECT_TRUE(contains(test::sentences(fox.report), "approximated: skin at nodes["));
    EXPECT_EQ(fox.scene.animation.size(), 21U);
    EXPECT_TRUE(contains(test::sentences(fox.report), "ignored: further animation at animations[1] (2 uses)"));
}

/// `scene` seen from `eye` towards -z, with a light there. The lamps of the file do not shine, and materials have
/// Phong's model: the oracle would draw other points of lamps, and other directions from microfacets.
PreparedScene seen_from(Scene scene, const Vec3d& eye) {
    Node node;
    node.trs.translation = eye;
    node.camera = PerspectiveCamera{0.8};
    node.light = LightSource{};
    scene.nodes.push_back(node);
    PrepareOptions options;
    options.effects.off = Effect::area_lights | Effect::microfacets;
    return prepare(scene, options);
}

RenderResult draw(const std::string& backend, const PreparedScene& scene) {
    RenderJob job;
    job.width = 80;
    job.height = 60;
    job.samples = 1;
    const auto renderer = make_backend(backend);
    return renderer->render(renderer->load(scene, job.tier), job);
}

TEST(RealFiles, AreDrawn) {
    const auto folder = shared_files();
    if (!folder) GTEST_SKIP() << "no folder shared/gltf beside the checkout, and TANDEM_SHARED does not name one";
    const struct {
        const char* file;
        Vec3d eye;
        std::size_t triangles, least_pixels;
    } cases[] = {{"CornellBox.glb", {-278, 273, 800}, 36, 2000},
                 {"FlightHelmet/FlightHelmet.gltf", {0, 0.35, 1.2}, 94722, 500},
                 {"Fox.glb", {0, 40, 200}, 576, 100}};
    for (const auto& c : cases) {
        const PreparedScene scene = seen_from(import_gltf(*folder / c.file).scene, c.eye);
        EXPECT_EQ(scene.triangles.size(), c.triangles) << c.file;
        EXPECT_EQ(scene.dropped_primitives, 0U) << c.file;
        const RenderResult result = draw("cpu", scene);
        EXPECT_EQ(result.stats.counters.invalid_samples, 0U) << c.file;
        std::size_t drawn = 0;  // the background is bluer than it is red; the materials here are grey, red and green
        for (const Vec3d& sum : result.film.sums()) drawn += sum.z <= sum.x || sum.z < sum.y;
        EXPECT_GE(drawn, c.least_pixels) << c.file;
        if (c.triangles > 100) continue;  // for brute force
        const RenderResult expected = draw("oracle", scene);
        for (std::size_t i = 0; i < result.film.pixel_count(); ++i) {
            const Vec3d difference = result.film.sums()[i] - expected.film.sums()[i];
            ASSERT_LE(norm1(difference), 1e-5 * (1 + norm1(expected.film.sums()[i]))) << c.file << ", pixel " << i;
        }
    }
}

TEST(RealFiles, AssimpsTestModels) {
    const fs::path folder = "/usr/share/assimp/models/glTF2";
    if (!fs::is_directory(folder)) GTEST_SKIP() << "the package assimp-testmodels is not installed";
    std::size_t files = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        const std::string extension = entry.path().extension().string();
        if (extension != ".gltf" && extension != ".glb") continue;
        import_or_explain(entry.path());
        ++files;
    }
    EXPECT_GE(files, 20U);
}

}  // namespace
}  // namespace tandem
