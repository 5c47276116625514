/// What an image file says about itself: which film it shows and how that came about.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tandem/images/display.h"

namespace tandem {

/// The fields of metadata_fields.def.
struct ImageMetadata {
#define TANDEM_METADATA(type, name) type name{};
#include "tandem/images/metadata_fields.def"
#undef TANDEM_METADATA

    bool operator==(const ImageMetadata&) const = default;
};

/// With `transfer` and `exposure_stops` of a display.
[[nodiscard]] ImageMetadata with_display(ImageMetadata metadata, const Display& display);

/// What the values of a file with these metadata went through. A file that says nothing is linear: older versions of
/// Tandem wrote it. Throws InputError for what no display has.
[[nodiscard]] Display display_of(const ImageMetadata& metadata);

/// A key as it stands in files ("tandem:seed") and its value.
using MetadataText = std::vector<std::pair<std::string, std::string>>;

/// All fields, in order; text fields that are empty are left out. Throws InputError for a value that does not fit into
/// every format: printable ASCII does.
[[nodiscard]] MetadataText to_text(const ImageMetadata& metadata);

/// From the keys and values of a file, in any order; keys of others are passed over, and fields that are not there keep
/// their defaults. Nothing if there is no key of ours. Throws InputError for a value that is not of the field's type.
[[nodiscard]] std::optional<ImageMetadata> metadata_from_text(const MetadataText& text);

/// "key: value", as in the comments of PPM files. Nothing if the line is not of that form.
[[nodiscard]] std::optional<std::pair<std::string, std::string>> parse_metadata_line(std::string_view line);

}  // namespace tandem
