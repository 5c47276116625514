// Planes of films: their names, their memory, how films are added, and what files get of them.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "images/sample_images.h"
#include "support/plane_film.h"
#include "support/temporary_folder.h"
#include "support/thrown_message.h"
#include "tandem/base/error.h"
#include "tandem/film/plane_names.h"
#include "tandem/images/image_io.h"
#if TANDEM_HAS_EXR
#include "images/exr_samples.h"
#endif

namespace tandem {
namespace {

using namespace test;

const PlaneMask all = parse_planes("all");

TEST(PlaneNames, AreReadInAnyOrderAndWrittenInOne) {
    EXPECT_EQ(to_string(parse_planes("depth,albedo,depth")), "albedo,depth");
    EXPECT_EQ(parse_planes("variance"), PlaneMask(FilmPlane::variance));
    EXPECT_EQ(parse_planes(to_string(all)), all);
    EXPECT_EQ(to_string(PlaneMask{}), "");
    for (const PlaneInfo& info : plane_infos()) EXPECT_TRUE(all.has(info.plane)) << info.name;
}

TEST(PlaneNames, OthersAreRefusedWithAListOfThoseThereAre) {
    for (const char* text : {"", "albedo,", "Albedo", "albedo depth", "colour"}) {
        const auto message = thrown_message<InputError>([&] { (void)parse_planes(text); });
        EXPECT_NE(message.find("albedo, normal, variance"), std::string::npos) << text << ": " << message;
    }
}

TEST(FilmPlanes, AreNullUnlessAskedForAndCostNoMemory) {
    const Film film(5, 3, 1, FilmPlane::depth | FilmPlane::albedo);
    EXPECT_NE(film.planes().albedo, nullptr);
    EXPECT_NE(film.planes().depth, nullptr);
    EXPECT_EQ(film.planes().normal, nullptr);
    EXPECT_EQ(film.planes().count, nullptr);
    EXPECT_EQ(film_bytes(15, {}), 15 * sizeof(Vec3d));
    EXPECT_LT(film_bytes(1000, FilmPlane::depth), 1000 * (sizeof(Vec3d) + sizeof(float)) + 64);
}

// Whatever is written to one plane, the others and the colour keep: for every size, planes lie apart.
TEST(FilmPlanes, DoNotOverlap) {
    for (const int width : {1, 3, 8, 17}) {
        Film film(width, 1, 2, all);
        fill_planes(film);
        std::vector<std::string> hashes;
        for (const PlaneInfo& info : plane_infos()) hashes.push_back(plane_hash(film, info.plane));
        const std::string colour = film_hash(film);
        EXPECT_EQ(colour, film_hash(Film(width, 1, 2))) << "planes are no part of the film's hash";
        for (const PlaneInfo& changed : plane_infos()) {
            Film other(width, 1, 2, all);
            fill_planes(other);
            const FilmPlanes planes = other.planes();
#define TANDEM_PLANE(name, Value, rule, channels, help)                                 \
    if (changed.plane == FilmPlane::name) {                                             \
        for (std::size_t i = 0; i < other.pixel_count(); ++i) put(planes.name[i], 1e6); \
    }
#include "tandem/film/planes.def"
#undef TANDEM_PLANE
            EXPECT_EQ(film_hash(other), colour);
            for (const PlaneInfo& info : plane_infos()) {
                const std::string& before = hashes[static_cast<std::size_t>(info.plane)];
                EXPECT_EQ(plane_hash(other, info.plane) != before, info.plane == changed.plane)
                    << changed.name << " changed " << info.name << ", width " << width;
            }
        }
    }
}

TEST(FilmPlanes, OfFilmsThatAreAddedFollowTheirRules) {
    Film film = plane_film(4, 3, 5, all, 1);
    const Film first = plane_film(4, 3, 5, all, 1);
    const Film later = plane_film(4, 3, 2, all, 100);
    film.add(later);
    EXPECT_EQ(film.samples(), 7);
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        EXPECT_EQ(film.sums()[i], first.sums()[i] + later.sums()[i]);
        EXPECT_EQ(film.planes().albedo[i], first.planes().albedo[i] + later.planes().albedo[i]);
        EXPECT_EQ(film.planes().variance[i], first.planes().variance[i] + later.planes().variance[i]);
        EXPECT_EQ(film.planes().depth[i], first.planes().depth[i]);
        EXPECT_EQ(film.planes().primitive[i], first.planes().primitive[i]);
        EXPECT_EQ(film.planes().count[i], first.planes().count[i] + later.planes().count[i]);
    }
}

TEST(FilmPlanes, FilmsWithOthersAreNotAdded) {
    Film film(2, 2, 1, FilmPlane::depth);
    const auto message = thrown_message<InputError>([&] { film.add(Film(2, 2, 1, FilmPlane::albedo)); });
    EXPECT_NE(message.find("'albedo'"), std::string::npos) << message;
    EXPECT_NE(message.find("'depth'"), std::string::npos) << message;
    EXPECT_THROW(film.add(Film(2, 1, 1, FilmPlane::depth)), InputError);
}

TEST(PlaneImages, HoldMeansAndTheVarianceOfTheMean) {
    Film film(1, 1, 4, FilmPlane::albedo | FilmPlane::variance);
    film.sums()[0] = {1 + 2 + 3 + 6, 20, 0};
    film.planes().albedo[0] = {1, 2, 3};
    film.planes().variance[0] = {1 + 4 + 9 + 36, 100, 0};
    const std::vector<PlaneImage> images = plane_images(film);
    ASSERT_EQ(images.size(), 2U);
    EXPECT_EQ(images[0].values, (std::vector{0.25F, 0.5F, 0.75F}));
    // deviations -2, -1, 0, 3 from the mean 3: 14 / 3 / 4; no deviation; no light
    EXPECT_EQ(images[1].values, (std::vector{14.0F / 12, 0.0F, 0.0F}));
}

TEST(PlaneImages, VarianceIsNeverNegativeAndOfOneSampleUnknown) {
    Film film(1, 1, 3, FilmPlane::variance);
    const double third = 0.1F;
    film.sums()[0] = {third + third + third, 0, 0};
    film.planes().variance[0] = {third * third * 3 * (1 - 0x1p-50), 0, 0};
    EXPECT_EQ(plane_images(film)[0].values[0], 0);
    EXPECT_TRUE(std::isinf(plane_images(Film(1, 1, 1, FilmPlane::variance))[0].values[0]));
}

TEST(PlaneFiles, PfmsStandBesideThePictureWithItsMetadata) {
    const TemporaryFolder folder;
    const std::string path = folder.file("some.picture.pfm");
    const Film film = plane_film(7, 5, 3, all);
    write_image(path, film, sample_metadata(7, 5));
    EXPECT_EQ(plane_path(path, FilmPlane::normal), folder.file("some.picture.normal.pfm"));
    EXPECT_EQ(folder.names().size(), 2 * (1 + plane_infos().size()));  // each with its metadata
    const std::vector<PlaneImage> images = plane_images(film);
    for (const PlaneImage& image : images) {
        const DecodedImage decoded = read_image(plane_path(path, image.plane));
        ASSERT_TRUE(decoded.metadata) << info_of(image.plane).name;
        EXPECT_EQ(decoded.metadata, read_metadata(path));
        EXPECT_EQ(decoded.metadata->planes, to_string(all));
        const std::size_t channels = info_of(image.plane).channels.size();
        for (std::size_t i = 0; i < film.pixel_count(); ++i) {
            const Vec3f pixel = decoded.image.pixels[i];
            const auto expected = [&](std::size_t channel) {
                const std::size_t at = i * channels + channel % channels;
                return image.numbers.empty() ? image.values[at] : static_cast<float>(image.numbers[at]);
            };
            EXPECT_EQ(pixel, (Vec3f{expected(0), expected(1), expected(2)})) << info_of(image.plane).name << ", " << i;
        }
    }
}

TEST(PlaneFiles, FormatsOfEightBitsAreRefusedWithThoseThatDo) {
    const TemporaryFolder folder;
    for (const char* name : {"a.png", "a.ppm"}) {
        const auto message = thrown_message<InputError>(
            [&] { write_image(folder.file(name), Film(2, 2, 1, FilmPlane::normal | FilmPlane::depth), {}); });
        EXPECT_NE(message.find("normal,depth"), std::string::npos) << message;
        EXPECT_NE(message.find(".exr"), std::string::npos) << message;
    }
    EXPECT_TRUE(folder.names().empty());
}

#if TANDEM_HAS_EXR

TEST(PlaneFiles, AnExrHoldsAllBitForBitUnderTheFieldsNames) {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.exr");
    Film film = plane_film(7, 5, 3, all);
    film.planes().depth[3] = HUGE_VALF;
    film.planes().primitive[4] = 0xFFFFFFFFU;
    write_image(path, film, sample_metadata(7, 5));
    EXPECT_TRUE(same_bits(read_image(path).image, film_to_image(film)));
    EXPECT_EQ(read_metadata(path)->planes, to_string(all));
    const ExrChannels file = read_exr_channels(path);
    std::size_t channels = 3;
    for (const PlaneImage& image : plane_images(film)) {
        const std::vector<std::string>& names = info_of(image.plane).channels;
        channels += names.size();
        for (std::size_t c = 0; c < names.size(); ++c) {
            for (std::size_t i = 0; i < film.pixel_count(); ++i) {
                if (image.numbers.empty()) {
                    ASSERT_EQ(file.floats.at(names[c])[i], image.values[i * names.size() + c]) << names[c];
                } else {
                    ASSERT_EQ(file.numbers.at(names[c])[i], image.numbers[i * names.size() + c]) << names[c];
                }
            }
        }
    }
    EXPECT_EQ(file.floats.size() + file.numbers.size(), channels);
    for (const char* name : {"R", "albedo.R", "N.X", "Z", "variance.B"})
        EXPECT_TRUE(file.floats.contains(name)) << name;
    for (const char* name : {"primitive", "material", "count"}) EXPECT_TRUE(file.numbers.contains(name)) << name;
}

#endif

}  // namespace
}  // namespace tandem
