// Films in tiles, and their samples as text.
#include "tandem/render/tiled_film.h"

#include <gtest/gtest.h>

#include "support/input_error.h"
#include "support/plane_film.h"
#include "tandem/film/plane_names.h"

namespace tandem {
namespace {

using test::contains;
using test::input_error;

constexpr int width = 37, height = 21;  // no multiples of the edge

/// The tiles of a film, from its windows.
TiledFilm tiles_of(const Film& film, int edge) {
    TiledFilm tiles({film.width(), film.height(), edge}, film.plane_mask());
    for (std::size_t i = 0; i < tiles.grid().count(); ++i) {
        const FilmWindow window = tiles.grid().tile(i);
        Film tile(window.width, window.height, film.samples(), film.plane_mask());
        copy_window(tile, 0, 0, film, window);
        tiles.add(i, tile);
    }
    return tiles;
}

TEST(TiledFilm, OfEqualSamplesIsTheFilmThatItIsFrom) {
    const PlaneMask planes = parse_planes("all");
    const Film film = test::plane_film(width, height, 5, planes);
    for (const int edge : {1, 8, 16, 64}) {
        const Film whole = tiles_of(film, edge).whole();
        EXPECT_EQ(film_hash(whole), film_hash(film)) << edge;
        EXPECT_FALSE(whole.has_own_samples());
        for (const PlaneInfo& info : plane_infos()) {
            EXPECT_EQ(plane_hash(whole, info.plane), plane_hash(film, info.plane)) << edge << " " << info.name;
        }
    }
}

TEST(TiledFilm, DividesEachPixelByItsOwnSamples) {
    const Film film = test::plane_film(width, height, 5, FilmPlane::variance);
    TiledFilm tiles = tiles_of(film, 16);
    tiles.add(1, tiles.tile(1));  // twice the sums and twice the samples: the means stay
    const Film whole = tiles.whole();
    EXPECT_EQ(whole.samples(), 10);
    EXPECT_TRUE(whole.has_own_samples());
    EXPECT_EQ(whole.samples_of(15), 5U);
    EXPECT_EQ(whole.samples_of(16), 10U);
    EXPECT_EQ(whole.samples_of(std::size_t{15} * width + 31), 10U);
    EXPECT_EQ(whole.samples_of(std::size_t{16} * width + 16), 5U);
    EXPECT_NE(film_hash(whole), film_hash(film));
    for (std::size_t i = 0; i < film.pixel_count(); ++i) EXPECT_EQ(whole.mean(i).y, film.mean(i).y) << i;
    Film sum = whole;
    EXPECT_TRUE(contains(input_error([&] { sum.add(film); }), "different numbers of samples"));
}

TEST(TiledFilm, ParsesTheSamplesThatItPrints) {
    const std::vector<int> samples = {64, 64, 64, 128, 64, 1 << 24};
    const std::string text = tile_samples_text(16, samples);
    EXPECT_EQ(text, "16: 64*3 128 64 16777216");
    const TileSamples parsed = parse_tile_samples(text, width, height);
    EXPECT_EQ(parsed.grid, (TileGrid{width, height, 16}));
    EXPECT_EQ(parsed.samples, samples);
}

TEST(TiledFilm, RefusesSamplesOfOtherTiles) {
    for (const char* text :
         {"", "16", "16:", "16: 64*5", "16: 64*7", "16: 0*6", "16: 64*6 ", "16: 64*-6", "0: 64*6", "16: 64*6x",
          "16: 64*99999999999", "16: 16777217*6", "-3: 1", "16:64*6", "16: 1 2 3 4 5 b"}) {
        EXPECT_TRUE(contains(input_error([&] { (void)parse_tile_samples(text, width, height); }), "32: 64*5 128"))
            << text;
    }
}

TEST(CopyWindow, RefusesPixelsThatAreNotThere) {
    const Film from = test::plane_film(8, 6, 1, {});
    Film to(8, 6, 1);
    for (const FilmWindow& window : {FilmWindow{5, 0, 4, 1}, FilmWindow{0, 5, 1, 2}, FilmWindow{-1, 0, 1, 1}}) {
        EXPECT_TRUE(contains(input_error([&] { copy_window(to, 0, 0, from, window); }), "cannot be copied"));
    }
    EXPECT_TRUE(contains(input_error([&] { copy_window(to, 7, 0, from, {0, 0, 2, 1}); }), "cannot be copied"));
    Film other(8, 6, 1, FilmPlane::variance);
    EXPECT_TRUE(contains(input_error([&] { copy_window(other, 0, 0, from, {0, 0, 1, 1}); }), "variance"));
}

}  // namespace
}  // namespace tandem
