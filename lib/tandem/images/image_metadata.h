/// The metadata of an image file: which film it shows and how it was rendered.
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

/// Sets `transfer` and `exposure_stops` from a display.
[[nodiscard]] ImageMetadata with_display(ImageMetadata metadata, const Display& display);

/// The display of a file with these metadata. A file without a transfer function is linear: older versions of Tandem
/// wrote such files. Throws InputError for invalid values.
[[nodiscard]] Display display_of(const ImageMetadata& metadata);

/// A key as written to files ("tandem:seed"), and its value.
using MetadataText = std::vector<std::pair<std::string, std::string>>;

/// All fields, in order; empty text fields are left out. Throws InputError for values that are not printable ASCII,
/// which every format can store.
[[nodiscard]] MetadataText to_text(const ImageMetadata& metadata);

/// Parses the keys and values of a file, in any order; foreign keys are ignored, and missing fields keep their
/// defaults. Empty if there is no key of Tandem's. Throws InputError for a value that is not of the field's type.
[[nodiscard]] std::optional<ImageMetadata> metadata_from_text(const MetadataText& text);

/// Parses "key: value", as in the comments of PPM files. Empty if the line does not have that form.
[[nodiscard]] std::optional<std::pair<std::string, std::string>> parse_metadata_line(std::string_view line);

}  // namespace tandem
