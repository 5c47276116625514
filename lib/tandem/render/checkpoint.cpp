#include "tandem/render/checkpoint.h"

#include <fmt/format.h>

#include <charconv>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

#include "tandem/base/error.h"
#include "tandem/base/sha256.h"
#include "tandem/base/whole_file.h"
#include "tandem/film/plane_names.h"

namespace tandem {

namespace {

constexpr std::string_view magic = "Tandem checkpoint 1\n";
constexpr std::string_view any_magic = "Tandem checkpoint ";
constexpr std::size_t hash_characters = 64;
constexpr const char* edge_key = "tile_edge";
constexpr const char* samples_key = "tile_samples";

std::string hash_of(std::span<const std::byte> bytes) {
    Sha256 hash;
    hash.update(bytes.data(), bytes.size());
    return hash.hex();
}

/// Samples of tiles as words. The text of images has none for tiles without samples.
std::string join(const std::vector<int>& samples) {
    std::string text;
    for (const int n : samples) text += fmt::format("{} ", n);
    return text;
}

std::string header_of(const Checkpoint& checkpoint) {
    std::string text;
    for (const auto& [key, value] : to_text(checkpoint.frame)) text += fmt::format("{}: {}\n", key, value);
#define TANDEM_COUNTER(name, words) text += fmt::format("{}: {}\n", #name, checkpoint.counters.name);
#include "tandem/render/counters.def"
#undef TANDEM_COUNTER
    text += fmt::format("{}: {}\n{}: {}\n\n", edge_key, checkpoint.film.grid().edge, samples_key,
                        join(checkpoint.film.samples()));
    return text;
}

/// The memory of a film: its sums and planes.
std::span<const std::byte> memory_of(const Film& film) {
    return {reinterpret_cast<const std::byte*>(film.sums().data()), film_bytes(film.pixel_count(), film.plane_mask())};
}

template <class Number>
Number whole_number(const MetadataText& header, std::string_view key) {
    for (const auto& [name, value] : header) {
        Number number = 0;
        if (name == key && std::from_chars(value.data(), value.data() + value.size(), number).ec == std::errc()) {
            return number;
        }
    }
    throw InputError(fmt::format("it has no number '{}'", key));
}

std::vector<int> samples_in(const MetadataText& header, std::size_t tiles) {
    std::vector<int> samples;
    for (const auto& [name, value] : header) {
        if (name != samples_key) continue;
        const char* at = value.data();
        const char* const end = at + value.size();
        int number = 0;
        while (samples.size() < tiles) {
            const auto [stop, error] = std::from_chars(at, end, number);
            if (error != std::errc() || number < 0 || number > 1 << 24 || stop == end || *stop != ' ') break;
            samples.push_back(number);
            at = stop + 1;
        }
    }
    if (samples.size() != tiles) throw InputError("it does not have the samples of every tile");
    return samples;
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
    const int edge = whole_number<int>(header, edge_key);
    const auto in_range = [](int value) { return value >= 1 && value <= 65536; };
    if (!frame || !in_range(frame->width) || !in_range(frame->height) || !in_range(edge)) {
        throw InputError("its description has no film");
    }
    const TileGrid grid{frame->width, frame->height, edge};
    // in the checkpoint each tile has at least a digit and a space
    if (grid.count() > rest.size() + header.back().second.size()) throw InputError("it is too short for its tiles");
    const PlaneMask planes = frame->planes.empty() ? PlaneMask{} : parse_planes(frame->planes);
    Checkpoint checkpoint{*frame, {}, TiledFilm(grid, planes)};
#define TANDEM_COUNTER(name, words) checkpoint.counters.name = whole_number<std::uint64_t>(header, #name);
#include "tandem/render/counters.def"
#undef TANDEM_COUNTER
    const std::vector<int> samples = samples_in(header, grid.count());
    for (std::size_t i = 0; i < grid.count(); ++i) {
        if (samples[i] == 0) continue;
        const FilmWindow window = grid.tile(i);
        const std::size_t bytes = film_bytes(pixel_count(window), planes);
        if (rest.size() < bytes) throw InputError("it is too short for its tiles");
        Film tile(window.width, window.height, samples[i], planes);
        std::memcpy(static_cast<void*>(tile.sums().data()), rest.data(), bytes);
        rest.remove_prefix(bytes);
        checkpoint.film.add(i, tile);
    }
    if (!rest.empty()) throw InputError("it is too long for its tiles");
    return checkpoint;
}

}  // namespace

void write_checkpoint(const std::string& path, const Checkpoint& checkpoint) {
    const std::string header = header_of(checkpoint);
    const std::size_t before = magic.size() + hash_characters;
    std::size_t size = before + header.size();
    for (std::size_t i = 0; i < checkpoint.film.grid().count(); ++i) {
        if (checkpoint.film.samples(i) > 0) size += memory_of(checkpoint.film.tile(i)).size();
    }
    Bytes bytes(size);
    std::byte* to = bytes.data();
    const auto put = [&](const void* from, std::size_t count) {
        std::memcpy(to, from, count);
        to += count;
    };
    put(magic.data(), magic.size());
    to += hash_characters;
    put(header.data(), header.size());
    for (std::size_t i = 0; i < checkpoint.film.grid().count(); ++i) {
        if (checkpoint.film.samples(i) == 0) continue;
        const std::span<const std::byte> tile = memory_of(checkpoint.film.tile(i));
        put(tile.data(), tile.size());
    }
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
