/// Makes text from a file safe for messages.
#pragma once

#include <algorithm>
#include <string>

namespace tandem::gltf {

/// Replaces control characters by question marks: a name in a file must not break a line or control the terminal. UTF-8
/// is kept.
[[nodiscard]] inline std::string printable(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](char c) { return (c >= 0 && c < 0x20) || c == 0x7F; }, '?');
    return text;
}

}  // namespace tandem::gltf
