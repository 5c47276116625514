/// Names of gtest's parameters.
#pragma once

#include <cctype>
#include <string>

namespace tandem::test {

/// Of any text the letters and digits, which are all that gtest takes.
[[nodiscard]] inline std::string case_name(std::string text) {
    std::erase_if(text, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
    return text;
}

}  // namespace tandem::test
