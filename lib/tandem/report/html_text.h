/// Text that is safe inside HTML and SVG, and pages with holes.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace tandem {

/// For element content and for attribute values in double quotes. Control characters that HTML does not know become
/// U+FFFD.
[[nodiscard]] std::string escape_html(std::string_view text);

/// Standard alphabet, padded. Source: RFC 4648, section 4.
[[nodiscard]] std::string base64(std::string_view bytes);

/// `page` with every {{name}} replaced by its value, taken as it is: escape what comes from outside. Values are not
/// searched again. Throws std::logic_error for a name without a value.
[[nodiscard]] std::string fill_template(std::string_view page,
                                        const std::map<std::string, std::string, std::less<>>& values);

}  // namespace tandem
