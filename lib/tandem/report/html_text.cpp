#include "tandem/report/html_text.h"

#include <cstdint>
#include <stdexcept>

namespace tandem {

std::string escape_html(std::string_view text) {
    std::string safe;
    safe.reserve(text.size());
    for (const char c : text) {
        switch (c) {
            case '&':
                safe += "&amp;";
                break;
            case '<':
                safe += "&lt;";
                break;
            case '>':
                safe += "&gt;";
                break;
            case '"':
                safe += "&quot;";
                break;
            case '\'':
                safe += "&#39;";
                break;
            default: {
                const auto byte = static_cast<unsigned char>(c);
                const bool unknown = (byte < 0x20 && c != '\n' && c != '\t' && c != '\r') || byte == 0x7F;
                safe += unknown ? "\uFFFD" : std::string(1, c);
            }
        }
    }
    return safe;
}

std::string base64(std::string_view bytes) {
    static constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t at = 0; at < bytes.size(); at += 3) {
        std::uint32_t group = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const auto byte = at + i < bytes.size() ? static_cast<unsigned char>(bytes[at + i]) : std::uint32_t{0};
            group = group << 8 | byte;
        }
        for (std::size_t i = 0; i < 4; ++i) {
            text += at + i <= bytes.size() ? alphabet[group >> (18 - 6 * i) & 63] : '=';
        }
    }
    return text;
}

std::string fill_template(std::string_view page, const std::map<std::string, std::string, std::less<>>& values) {
    std::string text;
    while (true) {
        const std::size_t open = page.find("{{");
        text += page.substr(0, open);
        if (open == std::string_view::npos) return text;
        const std::size_t close = page.find("}}", open);
        if (close == std::string_view::npos) throw std::logic_error("the template has {{ without }}");
        const std::string_view name = page.substr(open + 2, close - open - 2);
        const auto value = values.find(name);
        if (value == values.end()) throw std::logic_error("the template needs a value for " + std::string(name));
        text += value->second;
        page.remove_prefix(close + 2);
    }
}

}  // namespace tandem
