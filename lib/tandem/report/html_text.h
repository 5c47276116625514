/// Escaping for HTML and SVG, and page templates.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>

namespace tandem {

/// Escapes element content and attribute values in double quotes. Control characters that HTML forbids become U+FFFD.
[[nodiscard]] std::string escape_html(std::string_view text);

/// Standard alphabet, padded. Source: RFC 4648, section 4.
[[nodiscard]] std::string base64(std::string_view bytes);

/// `page` with every {{name}} replaced by its value, which is not escaped: escape untrusted text first. Values are not
/// searched for names. Throws std::logic_error for a name without a value.
[[nodiscard]] std::string fill_template(std::string_view page,
                                        const std::map<std::string, std::string, std::less<>>& values);

}  // namespace tandem
