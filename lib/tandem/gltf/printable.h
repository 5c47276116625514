/// Words of a file inside of sentences of ours.
#pragma once

#include <algorithm>
#include <string>

namespace tandem::gltf {

/// Control characters become question marks: a name in a file must not break a line, or reach the terminal as a
/// command. UTF-8 passes.
[[nodiscard]] inline std::string printable(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](char c) { return (c >= 0 && c < 0x20) || c == 0x7F; }, '?');
    return text;
}

}  // namespace tandem::gltf
