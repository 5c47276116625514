#include "tandem/film/image_metadata.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <concepts>

#include "tandem/error/error.h"

namespace tandem {

namespace {

constexpr std::string_view prefix = "tandem:";

void add(MetadataText& text, std::string_view name, const std::string& value) {
    if (value.empty()) return;
    const auto printable = [](char c) { return c >= ' ' && c <= '~'; };
    if (!std::all_of(value.begin(), value.end(), printable)) {
        throw InputError(fmt::format("the image metadata '{}' holds characters that are not printable ASCII", name));
    }
    text.emplace_back(fmt::format("{}{}", prefix, name), value);
}

void add(MetadataText& text, std::string_view name, std::integral auto value) {
    add(text, name, fmt::format("{}", value));
}

void parse(const std::string& value, std::string_view, std::string& field) { field = value; }

template <std::integral Integer>
void parse(const std::string& value, std::string_view name, Integer& field) {
    const char* const end = value.data() + value.size();
    const auto [stop, error] = std::from_chars(value.data(), end, field);
    if (error != std::errc() || stop != end) {
        throw InputError(fmt::format("the image metadata '{}{}' is '{}', not a whole number", prefix, name, value));
    }
}

}  // namespace

MetadataText to_text(const ImageMetadata& metadata) {
    MetadataText text;
#define TANDEM_METADATA(type, name) add(text, #name, metadata.name);
#include "tandem/film/metadata_fields.def"
#undef TANDEM_METADATA
    return text;
}

std::optional<ImageMetadata> metadata_from_text(const MetadataText& text) {
    std::optional<ImageMetadata> result;
    for (const auto& [full_key, value] : text) {
        if (!full_key.starts_with(prefix)) continue;
        if (!result) result.emplace();
        const std::string_view key = std::string_view(full_key).substr(prefix.size());
#define TANDEM_METADATA(type, name) \
    if (key == #name) parse(value, key, result->name);
#include "tandem/film/metadata_fields.def"
#undef TANDEM_METADATA
    }
    return result;
}

std::optional<std::pair<std::string, std::string>> parse_metadata_line(std::string_view line) {
    constexpr std::string_view separator = ": ";
    const std::size_t at = line.find(separator);
    if (at == std::string_view::npos) return std::nullopt;
    return std::pair{std::string(line.substr(0, at)), std::string(line.substr(at + separator.size()))};
}

}  // namespace tandem
