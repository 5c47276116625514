/// The common part of PPM and PFM files; internal: a text header of words separated by white space, with comments, and
/// one character of white space before the pixels.
#pragma once

#include <charconv>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "tandem/images/image_metadata.h"

namespace tandem {

class PortableMapHeader {
  public:
    PortableMapHeader(std::span<const std::byte> bytes, const std::string& name, const char* format)
        : text_(reinterpret_cast<const char*>(bytes.data()), bytes.size()), name_(name), format_(format) {}

    /// The next word; comments before it are collected for metadata().
    std::string_view word();
    /// The next word as a number.
    template <class Number>
    Number number(const char* what) {
        const std::string_view token = word();
        Number value{};
        const auto [stop, error] = std::from_chars(token.data(), token.data() + token.size(), value);
        if (error != std::errc() || stop != token.data() + token.size()) fail_number(what, token);
        return value;
    }
    /// Everything after the one character that ends the header.
    std::string_view pixels();

    [[nodiscard]] std::optional<ImageMetadata> metadata() const { return metadata_from_text(comments_); }

  private:
    [[noreturn]] void fail_number(const char* what, std::string_view token) const;
    void skip_blank();

    std::string_view text_;
    std::size_t at_ = 0;
    const std::string& name_;
    const char* format_;
    MetadataText comments_;
};

/// White space as the formats define it, whatever the locale.
[[nodiscard]] constexpr bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

}  // namespace tandem
