#include "render/render_sequence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "support/crowded_scene.h"
#include "support/gradient_backend.h"
#include "support/temporary_folder.h"
#include "support/thrown_message.h"
#include "tandem/base/error.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/images/exposure.h"
#include "tandem/images/tone_curve.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {
namespace {

using namespace test;

class RenderSequence : public testing::Test {
  protected:
    RenderSequence() {
        options.output = folder.file("f##.png");
        options.frames = {3, 8};
        options.job.width = 20;
        options.job.height = 10;
        options.job.samples = 4;
        options.write.durability = Durability::written;
    }

    /// Renders with `backend`; the records are left in `records`.
    std::size_t render() {
        records.clear();
        return render_sequence(scene, backend, options, interrupted,
                               [this](const FrameRecord& record) { records.push_back(record); });
    }

    /// How many frames a run of its own has rendered.
    int rendered() {
        backend.submitted = 0;
        EXPECT_EQ(render(), static_cast<std::size_t>(options.frames.count()));
        return backend.submitted;
    }
    int rendered_of(const FrameRange& frames) {
        options.frames = frames;
        return rendered();
    }

    TemporaryFolder folder;
    Scene scene = named_scene("paper");
    GradientBackend backend;
    SequenceOptions options;
    std::atomic<bool> interrupted{false};
    std::vector<FrameRecord> records;
};

TEST_F(RenderSequence, TakesFewerSamplesWhereRaysAreVeryMuchWork) {
    scene = crowded_scene(2'000);
    options.frames = {0, 1};
    render();
    EXPECT_EQ(records.back().metadata.samples, 4);
    options.fewer_samples = true;
    options.force = true;
    render();
    ASSERT_EQ(records.size(), 2U);
    for (const FrameRecord& record : records) {
        EXPECT_EQ(record.metadata.samples, 2);
        EXPECT_EQ(record.bounds_per_ray, 2'000);
    }
    scene = crowded_scene(100);
    render();
    EXPECT_EQ(records.back().metadata.samples, 4);
    EXPECT_EQ(records.back().bounds_per_ray, 0);
}

TEST_F(RenderSequence, FollowsShortPathsWhereEvenOneSampleIsTooMuch) {
    scene = crowded_scene(5'000);
    scene.images = {{"net", 2, 1, {0xFFFFFFFFU, 0x00FFFFFFU}}};
    scene.textures = {{0, Wrap::repeat, Wrap::repeat, Filter::nearest}};
    scene.materials[0].diffuse_texture = TextureReference{};
    scene.materials[0].alpha_mode = AlphaMode::mask;
    options.frames = {0, 0};
    options.fewer_samples = true;
    options.shorter_paths = true;
    render();
    ASSERT_EQ(records.size(), 1U);
    EXPECT_EQ(records[0].metadata.samples, 1);
    EXPECT_EQ(records[0].metadata.limits, "1,1,0");
    EXPECT_TRUE(records[0].has_short_paths);
    EXPECT_TRUE(records[0].has_opaque_masks);
    EXPECT_EQ(records[0].metadata.scene_hash, scene_hash(prepare(scene, {.effects = {{}, Effect::cutouts}})));
    options.shorter_paths = false;
    options.force = true;
    render();
    EXPECT_EQ(records.back().metadata.limits, to_string(PathLimits{}));
    EXPECT_FALSE(records.back().has_opaque_masks);
}

TEST_F(RenderSequence, WritesEveryFrameAndReportsInOrder) {
    EXPECT_EQ(render(), 6U);
    ASSERT_EQ(records.size(), 6U);
    for (std::uint32_t i = 0; i < 6; ++i) {
        const FrameRecord& record = records[i];
        RenderJob job = options.job;
        job.frame = 3 + i;
        const Film film = gradient_film(job);
        EXPECT_EQ(record.file, folder.file("f0" + std::to_string(3 + i) + ".png"));
        EXPECT_EQ(record.metadata.frame, 3 + i);
        EXPECT_EQ(record.metadata.film_sha256, film_hash(film));
        EXPECT_EQ(record.metadata.scene_hash, scene_hash(prepare(scene, {static_cast<std::int32_t>(3 + i), ""})));
        EXPECT_EQ(record.metadata.backend, "gradient");
        EXPECT_FALSE(record.skipped);
        EXPECT_EQ(record.counters.invalid_samples, 3 + i);
        EXPECT_EQ(record.seconds.backend.build, 0.25);
        EXPECT_EQ(record.seconds.backend.render, 0.5);
        const DecodedImage file = read_image(record.file);
        EXPECT_EQ(file.metadata, record.metadata);
        EXPECT_EQ(tone_map(file.image, scene.display).image.values, tone_map(film, scene.display).image.values);
    }
    EXPECT_EQ(folder.names().size(), 6U);
}

TEST_F(RenderSequence, TwoFramesAreWithTheBackendAtATime) {
    EXPECT_EQ(render(), 6U);
    EXPECT_EQ(backend.most_in_flight, 2);
    EXPECT_EQ(backend.loads, 6);
}

TEST_F(RenderSequence, AStillSceneIsLoadedOnce) {
    scene.animation.clear();
    EXPECT_EQ(render(), 6U);
    EXPECT_EQ(backend.loads, 1);
    EXPECT_EQ(records[0].seconds.backend.build, 0.25);
    EXPECT_EQ(records[1].seconds.backend.build, 0.0);
}

TEST_F(RenderSequence, OneWriterIsEnough) {
    options.writers = 1;
    EXPECT_EQ(render(), 6U);
    EXPECT_EQ(folder.names().size(), 6U);
}

TEST_F(RenderSequence, ASecondRunRendersNothing) {
    EXPECT_EQ(rendered(), 6);
    const std::vector<FrameRecord> first = records;
    EXPECT_EQ(rendered(), 0);
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_TRUE(records[i].skipped);
        EXPECT_EQ(records[i].metadata, first[i].metadata);
    }
}

TEST_F(RenderSequence, FramesWithOtherPlanesAreRenderedAgain) {
    options.output = folder.file("f##.pfm");
    EXPECT_EQ(rendered(), 6);
    options.job.planes = FilmPlane::depth | FilmPlane::normal;
    EXPECT_EQ(rendered(), 6);
    EXPECT_EQ(records[0].metadata.planes, "normal,depth");
    EXPECT_EQ(rendered(), 0);
    // a plane that is gone, and one of another picture
    std::filesystem::remove(folder.file("f04.depth.pfm"));
    std::filesystem::copy_file(folder.file("f05.normal.pfm"), folder.file("f06.normal.pfm"),
                               std::filesystem::copy_options::overwrite_existing);
    EXPECT_EQ(rendered(), 2);
    EXPECT_EQ(rendered(), 0);
}

TEST_F(RenderSequence, ForceRendersAgain) {
    EXPECT_EQ(rendered(), 6);
    options.force = true;
    EXPECT_EQ(rendered(), 6);
}

TEST_F(RenderSequence, WhatChangesThePictureRendersAgain) {
    EXPECT_EQ(rendered(), 6);
    options.job.seed = 1;
    EXPECT_EQ(rendered(), 6) << "seed";
    options.job.samples = 5;
    EXPECT_EQ(rendered(), 6) << "samples";
    options.job.width = 21;
    EXPECT_EQ(rendered(), 6) << "width";
    options.job.height = 11;
    EXPECT_EQ(rendered(), 6) << "height";
    scene.materials[0].phong.diffuse.x = 0.25F;
    EXPECT_EQ(rendered(), 6) << "scene";
    options.frames = {4, 9};
    EXPECT_EQ(rendered(), 1) << "a new frame";
    EXPECT_EQ(rendered(), 0);
}

TEST_F(RenderSequence, PicturesAreWhatTheSceneSays) {
    EXPECT_EQ(rendered(), 6);
    EXPECT_EQ(records[0].metadata.transfer, "linear") << "the paper's scene";
    scene.display = {TransferFunction::srgb, -1.5};
    EXPECT_EQ(rendered(), 6) << "another transfer function";
    EXPECT_EQ(records[0].metadata.transfer, "srgb");
    EXPECT_EQ(records[0].metadata.exposure_stops, -1.5);
    RenderJob job = options.job;
    job.frame = 3;
    const DecodedImage file = read_image(records[0].file);
    EXPECT_EQ(file.display, scene.display);
    EXPECT_EQ(tone_map(file.image, scene.display).image.values,
              tone_map(gradient_film(job), scene.display).image.values);
    EXPECT_EQ(rendered(), 0);
    options.exposure = ExposureChoice{false, 2};
    EXPECT_EQ(rendered(), 6) << "another exposure";
    EXPECT_EQ(read_image(records[5].file).display, (Display{TransferFunction::srgb, 2}));
    options.transfer = TransferFunction::linear;
    EXPECT_EQ(rendered(), 6);
    EXPECT_EQ(read_image(records[5].file).display, (Display{TransferFunction::linear, 2}));
    scene.display = {};
    EXPECT_EQ(rendered(), 0) << "the options go before the scene";
}

TEST_F(RenderSequence, FilesOfFloatsHaveNeitherExposureNorTransferFunction) {
    options.output = folder.file("f#.pfm");
    EXPECT_EQ(rendered(), 6);
    EXPECT_EQ(records[0].metadata.transfer, "linear");
    scene.display = {TransferFunction::srgb, 3};
    options.transfer = TransferFunction::srgb;
    for (const ExposureChoice choice : {ExposureChoice{false, 2}, ExposureChoice{true, 0}}) {
        options.exposure = choice;
        EXPECT_EQ(rendered(), 0);
        EXPECT_EQ(records[0].metadata.exposure_stops, 0);
        EXPECT_EQ(records[0].metadata.exposure_rule, "");
    }
}

class AutomaticExposure : public RenderSequence {
  protected:
    AutomaticExposure() {
        scene.environment.bottom = scene.environment.top = {0, 0, 0};  // the films have no background
        scene.display = {TransferFunction::srgb, 9};
        options.exposure = ExposureChoice{.automatic = true};
    }

    double stops_of(std::uint32_t frame) const {
        RenderJob job = options.job;
        job.frame = frame;
        return auto_exposure(film_to_image(gradient_film(job)));
    }
    void expect_all_have(double stops) const {
        for (const FrameRecord& record : records) {
            EXPECT_EQ(record.metadata.exposure_stops, stops) << record.file;
            EXPECT_EQ(record.metadata.exposure_rule, "auto");
            EXPECT_EQ(read_image(record.file).metadata, record.metadata);
        }
    }
};

TEST_F(AutomaticExposure, IsThatOfTheFirstFrame) {
    ASSERT_NE(stops_of(3), stops_of(4)) << "or the test shows nothing";
    EXPECT_EQ(rendered(), 6);
    expect_all_have(stops_of(3));
    EXPECT_EQ(backend.most_in_flight, 2) << "the others go on two at a time";
    EXPECT_EQ(rendered(), 0);
    expect_all_have(stops_of(3));
}

TEST_F(AutomaticExposure, IsKeptWhenASequenceGoesOn) {
    options.frames = {4, 8};
    (void)render();
    EXPECT_EQ(rendered_of({4, 9}), 1) << "the first frame is there, and the new one is exposed like it";
    expect_all_have(stops_of(4));
    EXPECT_EQ(rendered_of({3, 9}), 7) << "another first frame decides anew";
    expect_all_have(stops_of(3));
    std::filesystem::remove(folder.file("f03.png"));
    EXPECT_EQ(rendered_of({3, 9}), 1) << "it decides the same again";
}

TEST_F(AutomaticExposure, IsNotTakenFromAFileThatSomebodyElseExposed) {
    options.exposure = ExposureChoice{false, 2};
    EXPECT_EQ(rendered(), 6);
    options.exposure = ExposureChoice{.automatic = true};
    EXPECT_EQ(rendered(), 6);
    expect_all_have(stops_of(3));
    options.exposure = ExposureChoice{false, stops_of(3)};
    EXPECT_EQ(rendered(), 0) << "the same pictures";
}

TEST_F(AutomaticExposure, LeavesTheBackgroundOut) {
    scene.environment.bottom = scene.environment.top = {0.5F, 0.75F, 1};
    backend.film = [](const RenderJob& job) {
        Film film(job.width, job.height, job.samples);
        for (std::size_t i = 0; i < film.pixel_count(); ++i) {
            film.sums()[i] = (i < 30 ? Vec3d{1.44, 1.44, 1.44} : Vec3d{0.5, 0.75, 1}) * double(job.samples);
        }
        return film;
    };
    EXPECT_EQ(rendered(), 6);
    expect_all_have(-3);
}

TEST_F(AutomaticExposure, WithMotionBlurIsThatOfTheWholeFrame) {
    for (Node& node : scene.nodes) {
        if (node.camera) shutter_of(*node.camera) = {0, 0.02, 2};
    }
    EXPECT_EQ(rendered(), 2 * 6);
    EXPECT_EQ(records[0].metadata.exposure_rule, "auto");
    EXPECT_EQ(records[0].metadata.exposure_stops, records[5].metadata.exposure_stops);
    EXPECT_NE(records[0].metadata.exposure_stops, 9);
    EXPECT_EQ(rendered(), 0);
}

TEST_F(RenderSequence, WithMotionBlurKeepsWhatHasTheSameShutter) {
    for (Node& node : scene.nodes) {
        if (node.camera) shutter_of(*node.camera) = {0, 0.02, 3};
    }
    EXPECT_EQ(rendered(), 3 * 6) << "instants";
    EXPECT_EQ(backend.most_in_flight, 2);
    EXPECT_EQ(records[0].metadata.samples, 4);
    EXPECT_EQ(records[0].effects, EffectMask(Effect::motion_blur));
    EXPECT_EQ(records[0].seconds.backend.render, 3 * 0.5);
    EXPECT_EQ(records[0].seconds.backend.build, 3 * 0.25);
    EXPECT_EQ(records[0].counters.invalid_samples, 3U * 3);
    const std::vector<FrameRecord> first = records;
    EXPECT_EQ(rendered(), 0);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(records[i].metadata, first[i].metadata);
    set_shutter_instants(scene, 2);
    EXPECT_EQ(rendered(), 2 * 6) << "fewer instants";
    EXPECT_EQ(rendered(), 0);
    for (Node& node : scene.nodes) {
        if (node.camera) shutter_of(*node.camera).close = 0.01;
    }
    EXPECT_EQ(rendered(), 2 * 6) << "another shutter";
    options.effects.off = Effect::motion_blur;
    EXPECT_EQ(rendered(), 6);
    EXPECT_EQ(records[0].metadata.scene_hash, scene_hash(prepare(named_scene("paper"), {3, ""}))) << "none";
}

TEST_F(RenderSequence, AnErrorBetweenInstantsComesOut) {
    for (Node& node : scene.nodes) {
        if (node.camera) shutter_of(*node.camera) = {0, 0.02, 4};
    }
    int instants = 0;
    backend.on_get = [&](const RenderJob&) {
        if (++instants == 6) throw EnvironmentError("the device fell off the bus");
    };
    EXPECT_EQ(thrown_message<EnvironmentError>([this] { render(); }), "the device fell off the bus");
    EXPECT_EQ(backend.in_flight, 0) << "no instant is left with the backend";
    EXPECT_EQ(folder.names(), std::vector<std::string>{"f03.png"});
}

TEST_F(RenderSequence, AnotherBackendKeepsTheFrames) {
    EXPECT_EQ(rendered(), 6);
    GradientBackend other("other");
    std::size_t kept = 0;
    render_sequence(scene, other, options, interrupted, [&](const FrameRecord& record) {
        kept += record.skipped ? 1 : 0;
        EXPECT_EQ(record.metadata.backend, "gradient") << "the one that rendered it";
    });
    EXPECT_EQ(kept, 6U);
    EXPECT_EQ(other.submitted, 0);
}

TEST_F(RenderSequence, AnotherFormatUnderTheSameNameRendersAgain) {
    options.output = folder.file("f#.ppm");
    EXPECT_EQ(rendered(), 6);
    options.write.ppm_text = true;
    EXPECT_EQ(rendered(), 6);
    EXPECT_EQ(rendered(), 0);
}

TEST_F(RenderSequence, PfmFramesAreKeptByTheirSidecars) {
    options.output = folder.file("f#.pfm");
    EXPECT_EQ(rendered(), 6);
    EXPECT_EQ(rendered(), 0);
    std::filesystem::remove(folder.file("f5.pfm.txt"));
    EXPECT_EQ(rendered(), 1);
}

TEST_F(RenderSequence, DamagedAndForeignFilesAreRenderedAgain) {
    EXPECT_EQ(rendered(), 6);
    const Bytes whole = read_file(folder.file("f04.png"));
    write_file(folder.file("f04.png"), std::span(whole).first(whole.size() - 30));
    write_file(folder.file("f06.png"), "not an image");
    write_file(folder.file("f08.png"), encode_png({20, 10, std::vector<std::uint8_t>(600)}, {}, 1));
    EXPECT_EQ(rendered(), 3);
    EXPECT_EQ(read_file(folder.file("f04.png")), whole);
    EXPECT_EQ(rendered(), 0);
}

TEST_F(RenderSequence, AnInterruptFinishesWhatIsInFlight) {
    backend.on_submit = [this](const RenderJob& job) { interrupted = job.frame == 5; };
    EXPECT_EQ(render(), 3U);
    EXPECT_EQ(backend.submitted, 3);
    EXPECT_EQ(backend.in_flight, 0);
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"f03.png", "f04.png", "f05.png"}));
    backend.on_submit = [](const RenderJob&) {};
    interrupted = false;
    EXPECT_EQ(rendered(), 3) << "the same call again goes on";
    EXPECT_EQ(folder.names().size(), 6U);
}

TEST_F(RenderSequence, AnInterruptBeforeTheFirstFrameRendersNothing) {
    interrupted = true;
    EXPECT_EQ(render(), 0U);
    EXPECT_EQ(backend.submitted, 0);
}

TEST_F(RenderSequence, AnErrorOfAWriterComesOut) {
    const std::string place = folder.file("place");
    std::filesystem::create_directory(place);
    options.output = place + "/f##.png";
    backend.on_submit = [&](const RenderJob& job) {
        if (job.frame == 5) std::filesystem::rename(place, place + "-gone");
    };
    const auto message = thrown_message<InputError>([this] { render(); });
    EXPECT_NE(message.find("cannot write '" + place), std::string::npos) << message;
    EXPECT_EQ(backend.in_flight, 0) << "no frame is left with the backend";
}

// A codec does not know the name of its file.
TEST_F(RenderSequence, AnErrorOfAnEncoderNamesTheFile) {
    backend.film = [](const RenderJob& job) { return job.frame == 4 ? Film(0, 0, 1) : gradient_film(job); };
    const auto message = thrown_message<EnvironmentError>([this] { render(); });
    EXPECT_EQ(message.find("cannot encode '" + folder.file("f04.png") + "': libpng"), 0U) << message;
}

TEST_F(RenderSequence, AnErrorOfOneFileNamesItAndTheOthersAreReported) {
    options.writers = 6;
    std::filesystem::create_directory(folder.file("f04.png"));  // no file can take its place
    EXPECT_EQ(thrown_message<InputError>([this] { render(); }).find("cannot write '" + folder.file("f04.png")), 0U);
    EXPECT_EQ(backend.in_flight, 0);
    std::vector<std::string> reported = {folder.file("f04.png")};
    for (const FrameRecord& record : records) {
        EXPECT_TRUE(read_metadata(record.file)) << record.file;
        reported.push_back(record.file);
    }
    EXPECT_GE(records.size(), 1U);
    std::sort(reported.begin(), reported.end());
    std::vector<std::string> present;
    for (const std::string& name : folder.names()) present.push_back(folder.file(name));
    EXPECT_EQ(reported, present) << "every file that was written is reported, and no temporary file is left";
}

TEST_F(RenderSequence, AnErrorOfTheBackendComesOutAndWrittenFramesStay) {
    backend.on_get = [](const RenderJob& job) {
        if (job.frame >= 6) throw EnvironmentError("the device fell off the bus");
    };
    EXPECT_EQ(thrown_message<EnvironmentError>([this] { render(); }), "the device fell off the bus");
    EXPECT_EQ(backend.in_flight, 0);
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"f03.png", "f04.png", "f05.png"}));
    backend.on_get = [](const RenderJob&) {};
    EXPECT_EQ(rendered(), 3);
}

TEST_F(RenderSequence, WhatCannotBeIsSaidBeforeRendering) {
    const auto refused = [this](const std::string& output, const char* reason) {
        options.output = output;
        const auto message = thrown_message<InputError>([this] { render(); });
        EXPECT_NE(message.find(reason), std::string::npos) << output << " gives: " << message;
    };
    refused(folder.file("still.png"), "no placeholder for the frame number");
    refused(folder.file("#-#.png"), "more than one place");
    refused(folder.file("f#.jpg"), ".exr");
    refused(folder.file("none/f#.png"), "no folder");
    options.output = folder.file("f#.png");
    options.job.samples = 0;
    EXPECT_NE(thrown_message<InputError>([this] { render(); }).find("samples"), std::string::npos);
    options.job.samples = 1;
    options.camera = "nobody";
    EXPECT_NE(thrown_message<InputError>([this] { render(); }).find("nobody"), std::string::npos);
    EXPECT_EQ(backend.submitted, 0);
    EXPECT_TRUE(folder.names().empty());
}

TEST_F(RenderSequence, OneFrameNeedsNoPlaceForItsNumber) {
    options.output = folder.file("still.png");
    options.frames = {5, 5};
    EXPECT_EQ(render(), 1U);
    EXPECT_EQ(folder.names(), std::vector<std::string>{"still.png"});
}

}  // namespace
}  // namespace tandem
