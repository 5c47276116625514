#include "tandem/images/image_metadata.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <concepts>
#include <type_traits>

#include "tandem/base/error.h"

namespace tandem {

namespace {

constexpr std::string_view prefix = "tandem:";

void add(MetadataText& text, std::string_view name, const std::string& value) {
    if (value.empty()) return;
    const auto printable = [](char c) { return c >= ' ' && c <= '~'; };
    if (!std::all_of(value.begin(), value.end(), printable)) {
        throw InputError(fmt::format("the image metadata '{}' contains characters that are not printable ASCII", name));
    }
    text.emplace_back(fmt::format("{}{}", prefix, name), value);
}

template <class Number>
requires std::is_arithmetic_v<Number>
void add(MetadataText& text, std::string_view name, Number value) { add(text, name, fmt::format("{}", value)); }

void parse(const std::string& value, std::string_view, std::string& field) { field = value; }

template <class Number>
requires std::is_arithmetic_v<Number>
void parse(const std::string& value, std::string_view name, Number& field) {
    const char* const end = value.data() + value.size();
    const auto [stop, error] = std::from_chars(value.data(), end, field);
    if (error != std::errc() || stop != end) {
        throw InputError(fmt::format("the image metadata '{}{}' is '{}', not a {}number", prefix, name, value,
                                     std::integral<Number> ? "whole " : ""));
    }
}

}  // namespace

ImageMetadata with_display(ImageMetadata metadata, const Display& display) {
    metadata.transfer = to_string(display.transfer);
    metadata.exposure_stops = display.exposure_stops;
    return metadata;
}

Display display_of(const ImageMetadata& metadata) {
    Display display{TransferFunction::linear, metadata.exposure_stops};
    if (!metadata.transfer.empty()) display.transfer = parse_transfer(metadata.transfer);
    if (!is_exposure(display.exposure_stops)) {
        throw InputError(fmt::format("the image metadata '{}exposure_stops' is {}, not from {} to {}", prefix,
                                     display.exposure_stops, -most_exposure_stops, most_exposure_stops));
    }
    return display;
}

MetadataText to_text(const ImageMetadata& metadata) {
    MetadataText text;
#define TANDEM_METADATA(type, name) add(text, #name, metadata.name);
#include "tandem/images/metadata_fields.def"
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
#include "tandem/images/metadata_fields.def"
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
