#include "tandem/render/tiled_film.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>
#include <utility>

#include "tandem/base/error.h"

namespace tandem {

namespace {

constexpr int most_samples = 1 << 24;

/// Takes a number from 1 to `most` from the start of the text.
std::optional<int> take_number(std::string_view& text, int most) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || value < 1 || value > most) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return value;
}

/// Takes the word from the start of the text.
bool take(std::string_view& text, std::string_view word) {
    if (!text.starts_with(word)) return false;
    text.remove_prefix(word.size());
    return true;
}

/// Appends " 64*5" or " 64" to the samples. False if the text has another form, or more than `most` tiles.
bool take_run(std::string_view& text, std::size_t most, std::vector<int>& samples) {
    if (!take(text, " ")) return false;
    const std::optional<int> value = take_number(text, most_samples);
    const std::optional<int> count = value && take(text, "*") ? take_number(text, 1 << 30) : std::optional(1);
    if (!value || !count || static_cast<std::size_t>(*count) > most - samples.size()) return false;
    samples.insert(samples.end(), static_cast<std::size_t>(*count), *value);
    return true;
}

}  // namespace

std::vector<int> TiledFilm::samples() const {
    std::vector<int> all(tiles_.size());
    std::transform(tiles_.begin(), tiles_.end(), all.begin(), [](const Film& tile) { return tile.samples(); });
    return all;
}

void TiledFilm::add(std::size_t index, const Film& later) {
    const FilmWindow window = grid_.tile(index);
    Film& tile = tiles_[index];
    if (tile.samples() > 0) {
        tile.add(later);
        return;
    }
    Film first(window.width, window.height, later.samples(), planes_);
    copy_window(first, 0, 0, later, {0, 0, window.width, window.height});
    tile = std::move(first);
}

Film TiledFilm::whole(PlaneMask wanted) const {
    const std::vector<int> all = samples();
    const int most = *std::max_element(all.begin(), all.end());
    Film film(grid_.width, grid_.height, most, wanted);
    std::vector<std::uint32_t> of_pixels;
    const bool is_uniform = std::all_of(all.begin(), all.end(), [&](int n) { return n == most; });
    if (!is_uniform) of_pixels.resize(film.pixel_count());
    for (std::size_t i = 0; i < tiles_.size(); ++i) {
        const FilmWindow window = grid_.tile(i);
        copy_window(film, window.left, window.top, tiles_[i], {0, 0, window.width, window.height});
        for (int y = is_uniform ? window.height : 0; y < window.height; ++y) {
            const std::size_t row = static_cast<std::size_t>(window.top + y) * static_cast<std::size_t>(grid_.width);
            std::fill_n(of_pixels.begin() + static_cast<std::ptrdiff_t>(row) + window.left, window.width,
                        static_cast<std::uint32_t>(all[i]));
        }
    }
    if (!is_uniform) film.set_samples(std::move(of_pixels));
    return film;
}

std::string tile_samples_text(int edge, const std::vector<int>& samples) {
    std::string text = fmt::format("{}:", edge);
    for (auto at = samples.begin(); at != samples.end();) {
        const auto end = std::find_if(at, samples.end(), [&](int other) { return other != *at; });
        text += end - at > 1 ? fmt::format(" {}*{}", *at, end - at) : fmt::format(" {}", *at);
        at = end;
    }
    return text;
}

TileSamples parse_tile_samples(std::string_view text, int width, int height) {
    std::string_view rest = text;
    const std::optional<int> edge = take_number(rest, 65536);
    TileSamples tiles{{width, height, edge.value_or(1)}, {}};
    const std::size_t count = tiles.grid.count();
    bool is_good = edge && take(rest, ":");
    while (is_good && !rest.empty()) is_good = take_run(rest, count, tiles.samples);
    if (!is_good || tiles.samples.size() != count) {
        throw InputError(
            fmt::format("the samples of the tiles are '{}', but must look like \"32: 64*5 128\" (edge of a tile, then "
                        "samples of the tiles) for a film of {} x {} pixels",
                        text.substr(0, 60), width, height));
    }
    return tiles;
}

}  // namespace tandem
