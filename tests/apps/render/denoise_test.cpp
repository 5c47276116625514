// --denoise: which pixels, planes and metadata the files get, and what the program says, with a stub in the place of
// the library.
#include <gtest/gtest.h>

#include "render/render_report.h"
#include "render/render_sequence.h"
#include "run_render.h"
#include "support/gradient_backend.h"
#include "support/temporary_folder.h"
#include "tandem/film/plane_image.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {
namespace {

using namespace test;

class Denoise : public testing::Test {
  protected:
    Denoise() {
        options.job.width = 12;
        options.job.height = 9;
        options.job.samples = 4;
        options.write.durability = Durability::written;
        options.denoiser = std::make_shared<Denoiser>(TANDEM_STUB_DENOISER);
    }
    FrameRecord render(const std::string& name) {
        options.output = folder.file(name);
        FrameRecord last;
        EXPECT_EQ(render_sequence(scene, backend, options, interrupted, [&](const FrameRecord& r) { last = r; }), 1U);
        return last;
    }

    TemporaryFolder folder;
    Scene scene = named_scene("paper");
    GradientBackend backend;
    SequenceOptions options;
    std::atomic<bool> interrupted{false};
};

TEST_F(Denoise, TheFileHasTheFilteredPixelsAndSaysSo) {
    const FrameRecord record = render("a.pfm");
    const Film film = gradient_film(options.job);
    EXPECT_EQ(record.metadata.film_sha256, film_hash(film)) << "of the film before";
    EXPECT_EQ(record.metadata.denoised, "Open Image Denoise 2.3.4");
    EXPECT_NE(
        frame_line(record).find("denoised by Open Image Denoise 2.3.4; the hash is that of the film before denoising"),
        std::string::npos);
    const DecodedImage file = read_image(folder.file("a.pfm"));
    EXPECT_EQ(file.metadata, record.metadata);
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.pfm", "a.pfm.txt"})) << "no planes that nobody asked for";

    RenderJob with_planes = options.job;
    with_planes.planes = denoiser_planes;
    const std::vector<float> albedo = plane_images(gradient_film(with_planes))[0].values;
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        EXPECT_FLOAT_EQ(file.image.pixels[i].y, film.mean(i).y / 2 + albedo[3 * i + 1]) << i;
    }
}

TEST_F(Denoise, ThePlanesOfTheFileAreThoseThatWereAskedFor) {
    options.job.planes = FilmPlane::depth;
    EXPECT_EQ(render("a.pfm").metadata.planes, "depth");
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.depth.pfm", "a.depth.pfm.txt", "a.pfm", "a.pfm.txt"}));
}

TEST_F(Denoise, EightBitsWorkToo) {
    const FrameRecord record = render("a.png");
    EXPECT_EQ(read_image(folder.file("a.png")).metadata, record.metadata);
}

TEST_F(Denoise, FilesAreKeptOnlyIfTheyWereDenoisedAlike) {
    EXPECT_FALSE(render("a.png").skipped);
    EXPECT_TRUE(render("a.png").skipped);
    options.denoiser.reset();
    EXPECT_FALSE(render("a.png").skipped);
    EXPECT_TRUE(render("a.png").metadata.denoised.empty());
}

TEST_F(Denoise, ACheckpointIsOfTheFilmBefore) {
    options.checkpoint = CheckpointOptions{.file = folder.file("a.checkpoint"), .every = 1000};
    options.output = folder.file("a.pfm");
    backend.on_submit = [&](const RenderJob&) { interrupted = true; };
    options.job.width = 1100;
    EXPECT_EQ(render_sequence(scene, backend, options, interrupted, [](const FrameRecord&) {}), 0U);
    interrupted = false;
    backend.on_submit = [](const RenderJob&) {};
    options.checkpoint->resume = true;
    EXPECT_EQ(render("a.pfm").metadata.film_sha256, film_hash(gradient_film(options.job)));
}

TEST(DenoiseProgram, DenoisesAndDoesNotVerifyWhatItDenoised) {
    const TemporaryFolder folder;
    const std::string image = "'" + folder.file("a.png") + "'";
    const Finished render =
        tandem_render("named:paper --size 16x14 --spp 2 --denoise --denoiser '" TANDEM_STUB_DENOISER "' -o " + image);
    EXPECT_EQ(render.status, 0) << render.printed;
    EXPECT_NE(
        render.printed.find("denoised by Open Image Denoise 2.3.4; the hash is that of the film before denoising"),
        std::string::npos)
        << render.printed;
    const Finished verify = tandem_render("verify " + image);
    EXPECT_EQ(verify.status, 2);
    EXPECT_NE(verify.printed.find("was denoised by Open Image Denoise 2.3.4"), std::string::npos) << verify.printed;
}

TEST(DenoiseProgram, WithoutTheLibraryStatusThreeAndWhatToInstall) {
    const TemporaryFolder folder;
    const Finished render = tandem_render("named:paper --size 16x14 --denoise --denoiser /nowhere/oidn.so -o '" +
                                          folder.file("a.png") + "'");
    EXPECT_EQ(render.status, 3) << render.printed;
    EXPECT_NE(render.printed.find("Install Open Image Denoise"), std::string::npos) << render.printed;
    EXPECT_TRUE(folder.names().empty());
    EXPECT_EQ(tandem_render("named:paper --denoiser /nowhere/oidn.so -o '" + folder.file("a.png") + "'").status, 2);
}

}  // namespace
}  // namespace tandem
