#include "tandem/render/checkpoint.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "tandem/base/error.h"
#include "tandem/base/sha256.h"
#include "tandem/base/whole_file.h"
#include "tandem/film/plane_names.h"

namespace tandem {

namespace {

constexpr std::string_view magic = "Tandem checkpoint 3\n";
constexpr std::string_view any_magic = "Tandem checkpoint ";
constexpr std::size_t hash_characters = 64;
constexpr const char* edge_key = "tile_edge";
constexpr const char* samples_key = "tile_samples";
// of the round of a render to a target, if there is one
constexpr const char* fresh_key = "round_samples";
constexpr const char* begins_key = "round_begins";
constexpr const char* ends_key = "round_ends";
constexpr const char* last_key = "round_is_last";
constexpr const char* was_last_key = "round_was_last";
constexpr const char* seconds_key = "seconds_of_rendering";

std::string hash_of(std::span<const std::byte> bytes) {
    Sha256 hash;
    hash.update(bytes.data(), bytes.size());
    return hash.hex();
}

/// Samples of tiles as words. The text in images cannot describe tiles without samples.
std::string line(const char* key, const std::vector<int>& samples) {
    std::string text = fmt::format("{}: ", key);
    for (const int n : samples) text += fmt::format("{} ", n);
    return text + "\n";
}

std::vector<int> samples_of(const std::vector<Film>& films) {
    std::vector<int> samples;
    samples.reserve(films.size());
    for (const Film& film : films) samples.push_back(film.samples());
    return samples;
}

std::string header_of(const Checkpoint& checkpoint) {
    std::string text;
    for (const auto& [key, value] : to_text(checkpoint.frame)) text += fmt::format("{}: {}\n", key, value);
#define TANDEM_COUNTER(name, words) text += fmt::format("{}: {}\n", #name, checkpoint.counters.name);
#include "tandem/render/counters.def"
#undef TANDEM_COUNTER
    text += fmt::format("{}: {}\n", edge_key, checkpoint.film.grid().edge);
    text += line(samples_key, checkpoint.film.samples());
    if (const auto& round = checkpoint.round) {
        text +=
            line(fresh_key, samples_of(round->fresh)) + line(begins_key, round->begins) + line(ends_key, round->ends);
        text += fmt::format("{}: {}\n{}: {}\n{}: {}\n", last_key, round->is_last ? 1 : 0, was_last_key,
                            round->was_last ? 1 : 0, seconds_key, round->seconds);
    }
    return text + "\n";
}

/// The memory of a film: its sums and planes.
std::span<const std::byte> memory_of(const Film& film) {
    return {reinterpret_cast<const std::byte*>(film.sums().data()), film_bytes(film.pixel_count(), film.plane_mask())};
}

/// The value of a key; empty if there is none.
std::string_view value_of(const MetadataText& header, std::string_view key) {
    const auto found =
        std::find_if(header.begin(), header.end(), [&](const auto& entry) { return entry.first == key; });
    return found != header.end() ? std::string_view(found->second) : std::string_view();
}

template <class Number>
Number number_in(const MetadataText& header, std::string_view key) {
    const std::string_view value = value_of(header, key);
    Number number = 0;
    if (std::from_chars(value.data(), value.data() + value.size(), number).ec == std::errc()) return number;
    throw InputError(fmt::format("it has no number '{}'", key));
}

std::vector<int> samples_in(const MetadataText& header, std::string_view key, std::size_t tiles) {
    std::vector<int> samples;
    const std::string_view value = value_of(header, key);
    const char* at = value.data();
    const char* const end = at + value.size();
    int number = 0;
    while (samples.size() < tiles) {
        const auto [stop, error] = std::from_chars(at, end, number);
        if (error != std::errc() || number < 0 || number > 1 << 24 || stop == end || *stop != ' ') break;
        samples.push_back(number);
        at = stop + 1;
    }
    if (samples.size() != tiles) throw InputError("it does not have the samples of every tile");
    return samples;
}

/// Takes the memory of a film from the start of the text.
Film take_film(std::string_view& rest, const FilmWindow& window, int samples, PlaneMask planes) {
    const std::size_t bytes = film_bytes(pixel_count(window), planes);
    if (rest.size() < bytes) throw InputError("it is too short for its tiles");
    Film film(window.width, window.height, samples, planes);
    std::memcpy(static_cast<void*>(film.sums().data()), rest.data(), bytes);
    rest.remove_prefix(bytes);
    return film;
}

Round take_round(const MetadataText& header, const TileGrid& grid, std::string_view& rest) {
    Round round{std::vector<Film>(grid.count()),
                samples_in(header, begins_key, grid.count()),
                samples_in(header, ends_key, grid.count()),
                number_in<int>(header, last_key) != 0,
                number_in<int>(header, was_last_key) != 0,
                number_in<double>(header, seconds_key)};
    const std::vector<int> samples = samples_in(header, fresh_key, grid.count());
    for (std::size_t i = 0; i < grid.count(); ++i) {
        if (samples[i] > 0) round.fresh[i] = take_film(rest, grid.tile(i), samples[i], FilmPlane::variance);
    }
    return round;
}

/// Takes the lines up to an empty one from the start of the text.
MetadataText take_header(std::string_view& rest) {
    MetadataText header;
    while (true) {
        const std::size_t end = rest.find('\n');
        if (end == std::string_view::npos) throw InputError("its description has no end");
        const std::string_view line = rest.substr(0, end);
        rest.remove_prefix(end + 1);
        if (line.empty()) return header;
        if (auto entry = parse_metadata_line(line)) header.push_back(std::move(*entry));
    }
}

Checkpoint parse(std::string_view rest) {
    const MetadataText header = take_header(rest);
    const std::optional<ImageMetadata> frame = metadata_from_text(header);
    const int edge = number_in<int>(header, edge_key);
    const auto in_range = [](int value) { return value >= 1 && value <= 65536; };
    if (!frame || !in_range(frame->width) || !in_range(frame->height) || !in_range(edge)) {
        throw InputError("its description has no film");
    }
    const TileGrid grid{frame->width, frame->height, edge};
    // each tile has at least a digit and a space there
    if (grid.count() > value_of(header, samples_key).size()) throw InputError("it is too short for its tiles");
    const PlaneMask planes = frame->planes.empty() ? PlaneMask{} : parse_planes(frame->planes);
    Checkpoint checkpoint{*frame, {}, TiledFilm(grid, planes)};
#define TANDEM_COUNTER(name, words) checkpoint.counters.name = number_in<std::uint64_t>(header, #name);
#include "tandem/render/counters.def"
#undef TANDEM_COUNTER
    const std::vector<int> samples = samples_in(header, samples_key, grid.count());
    for (std::size_t i = 0; i < grid.count(); ++i) {
        if (samples[i] > 0) checkpoint.film.add(i, take_film(rest, grid.tile(i), samples[i], planes));
    }
    if (!value_of(header, ends_key).empty()) checkpoint.round = take_round(header, grid, rest);
    if (!rest.empty()) throw InputError("it is too long for its tiles");
    return checkpoint;
}

}  // namespace

void write_checkpoint(const std::string& path, const Checkpoint& checkpoint) {
    std::vector<std::span<const std::byte>> films;
    const auto keep = [&](const Film& film) {
        if (film.samples() > 0) films.push_back(memory_of(film));
    };
    for (std::size_t i = 0; i < checkpoint.film.grid().count(); ++i) keep(checkpoint.film.tile(i));
    if (checkpoint.round) std::for_each(checkpoint.round->fresh.begin(), checkpoint.round->fresh.end(), keep);
    const std::string header = header_of(checkpoint);
    const std::size_t before = magic.size() + hash_characters;
    std::size_t size = before + header.size();
    for (const auto& film : films) size += film.size();
    Bytes bytes(size);
    std::byte* to = bytes.data();
    const auto put = [&](const void* from, std::size_t count) {
        std::memcpy(to, from, count);
        to += count;
    };
    put(magic.data(), magic.size());
    to += hash_characters;
    put(header.data(), header.size());
    for (const auto& film : films) put(film.data(), film.size());
    const std::string hash = hash_of(std::span<const std::byte>(bytes).subspan(before));
    std::memcpy(bytes.data() + magic.size(), hash.data(), hash.size());
    write_file(path, bytes);
}

Checkpoint read_checkpoint(const std::string& path) {
    const Bytes bytes = read_file(path);
    std::string_view rest(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (!rest.starts_with(any_magic)) {
        throw InputError(fmt::format("'{}' is not a checkpoint of tandem-render; name another file", path));
    }
    if (!rest.starts_with(magic)) {
        throw InputError(
            fmt::format("'{}' is a checkpoint of another form than this version of Tandem reads; finish it with the "
                        "version that wrote it, or remove it and begin again",
                        path));
    }
    rest.remove_prefix(magic.size());
    const std::string_view stated = rest.substr(0, hash_characters);
    rest.remove_prefix(stated.size());
    std::string reason = "its checksum does not match its contents";
    if (stated == hash_of(std::as_bytes(std::span(rest)))) {
        try {
            return parse(rest);
        } catch (const InputError& error) {
            reason = error.what();
        }
    }
    throw InputError(fmt::format("the checkpoint '{}' is damaged: {}; remove it and begin again", path, reason));
}

}  // namespace tandem
