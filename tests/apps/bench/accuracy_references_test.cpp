#include "accuracy/references.h"

#include <gtest/gtest.h>

#include <fstream>

#include "loop_backend.h"
#include "support/input_error.h"
#include "support/temporary_folder.h"
#include "tandem/base/whole_file.h"
#include "tandem/images/image_io.h"

namespace tandem::bench {
namespace {

using test::contains;
using test::input_error;

class References : public testing::Test {
  protected:
    [[nodiscard]] DescribedReference make() { return make_reference(scene, backend, options); }

    test::TemporaryFolder folder;
    AccuracyScene scene = load_accuracy_scene("named:paper", {12, 10});
    LoopBackend backend{"cpu", false, true};
    ReferenceOptions options{{12, 10}, 4, 7, folder.file("kept"), false};
};

TEST_F(References, AreTwoIndependentImagesWithMetadata) {
    const DescribedReference made = make();
    EXPECT_FALSE(made.reference.is_exact());
    EXPECT_GT(made.reference.noise_floor(), 0) << "the seeds differ";
    EXPECT_TRUE(contains(made.description, "4 samples"));
    const auto a = read_metadata(reference_path(scene, options, 'a'));
    const auto b = read_metadata(reference_path(scene, options, 'b'));
    ASSERT_TRUE(a && b);
    EXPECT_EQ(a->samples, 4);
    EXPECT_EQ(a->tier, "precise");
    EXPECT_EQ(a->sampler, "sobol");
    EXPECT_EQ(a->limits, "255,255,255");
    EXPECT_EQ(a->film_sha256.size(), 64U);
    EXPECT_EQ(a->scene_hash, b->scene_hash);
    EXPECT_NE(a->seed, b->seed);
    EXPECT_NE(a->seed, 7U);
}

TEST_F(References, AreReadIfTheyAreThere) {
    const FloatImage first = make().reference.first();
    // a value that no rendering gives shows where the image is from
    const std::string path = reference_path(scene, options, 'a');
    const auto metadata = read_metadata(path);
    FloatImage changed = first;
    changed.pixels[3] = {5, 6, 7};
    write_image(path, changed, *metadata);
    EXPECT_EQ(make().reference.first().pixels[3].y, 6.0F);
    options.rebuild = true;
    EXPECT_EQ(make().reference.first().pixels[3].y, first.pixels[3].y);
}

TEST_F(References, OfAnotherRenderAreRefused) {
    const Vec3f kept = make().reference.first().pixels[40];
    const auto refused = [&] { return input_error([&] { (void)make(); }); };
    options.samples = 5;
    EXPECT_TRUE(contains(refused(), "samples is '4' there, but '5' here"));
    EXPECT_TRUE(contains(refused(), "--rebuild-references"));
    options.samples = 4;
    options.seed = 8;
    EXPECT_TRUE(contains(refused(), "seed"));
    options.seed = 7;
    options.filter = PixelFilter::tent;
    EXPECT_NE(make().reference.first().pixels[40].x, kept.x) << "beside those of box, in files of their own";
    const auto tent = read_metadata(reference_path(scene, options, 'b'));
    ASSERT_TRUE(tent);
    EXPECT_EQ(tent->filter, "tent");
    options.filter = PixelFilter::box;
    EXPECT_EQ(make().reference.first().pixels[40].x, kept.x);
    scene.scene.materials[0].phong.diffuse.x += 0.1F;
    EXPECT_TRUE(contains(refused(), "scene"));
    const std::string path = reference_path(scene, options, 'a');
    scene = load_accuracy_scene("named:paper", {12, 10});
    auto older = read_metadata(path);
    older->version = "0.0.1";
    write_image(path, read_image(path).image, *older);
    (void)make();  // of an earlier version
    std::filesystem::remove(path + ".txt");
    EXPECT_TRUE(contains(refused(), "no metadata"));
    write_file(path, "PF\nnonsense", Durability::written);
    EXPECT_TRUE(contains(refused(), path));
}

TEST_F(References, SayWhenTheFolderCannotBeMade) {
    write_file(folder.file("file"), "x", Durability::written);
    options.folder = folder.file("file") + "/in-a-file";
    EXPECT_TRUE(contains(input_error([&] { (void)make(); }), "in-a-file"));
}

TEST_F(References, OfAClosedFormNeedNoRendering) {
    scene = load_accuracy_scene("closed:furnace/50", {12, 10});
    const DescribedReference made = make();
    EXPECT_TRUE(made.reference.is_exact());
    EXPECT_EQ(made.reference.mean().pixels[17].x, 1.0F);
    EXPECT_FALSE(std::filesystem::exists(options.folder));
    EXPECT_TRUE(contains(made.description, "e / (1 - r)"));
}

}  // namespace
}  // namespace tandem::bench
