#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "tandem/images/decode_checks.h"
#include "tandem/images/image_codecs.h"
#include "tandem/images/portable_map.h"
#include "tandem/images/tone_curve.h"

namespace tandem {

namespace {

/// "0 " to "255 ", padded to four characters, so that a single store writes them.
struct DecimalTable {
    std::array<std::array<char, 4>, 256> text{};
    std::array<std::uint8_t, 256> length{};

    constexpr DecimalTable() {
        for (unsigned int value = 0; value < 256; ++value) {
            std::uint8_t size = 0;
            if (value >= 100) text[value][size++] = static_cast<char>('0' + value / 100);
            if (value >= 10) text[value][size++] = static_cast<char>('0' + value / 10 % 10);
            text[value][size++] = static_cast<char>('0' + value % 10);
            text[value][size++] = ' ';
            length[value] = size;
        }
    }
};

constexpr DecimalTable decimals;

std::string header(const char* magic, const ByteImageView& image, const ImageMetadata& metadata) {
    std::string text = fmt::format("{}\n", magic);
    for (const auto& [key, value] : to_text(metadata)) text += fmt::format("# {}: {}\n", key, value);
    return text + fmt::format("{} {}\n255\n", image.width, image.height);
}

/// Reads decimal numbers separated by white space.
class DecimalReader {
  public:
    explicit DecimalReader(std::string_view text) : at_(text.data()), end_(text.data() + text.size()) {}

    /// False at the end, at anything but digits, and above `most` (at most 65535).
    bool next(std::uint32_t most, std::uint32_t& value) {
        while (at_ != end_ && is_blank(*at_)) ++at_;
        const char* const start = at_;
        value = 0;
        for (; at_ != end_ && *at_ >= '0' && *at_ <= '9'; ++at_) {
            value = value * 10 + static_cast<std::uint32_t>(*at_ - '0');
            if (value > most) return false;
        }
        return at_ != start && (at_ == end_ || is_blank(*at_));
    }

  private:
    const char* at_;
    const char* end_;
};

/// Calls `next(value)` for every value of the image; it returns false at the end.
template <class Next>
void fill(DecodedImage& decoded, std::uint32_t most, const std::string& name, Next next) {
    const std::vector<float> values = values_of_levels(most, decoded.display);
    FloatImage& image = decoded.image;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        std::uint32_t rgb[3];
        for (std::uint32_t& value : rgb) {
            if (!next(value)) {
                fail_decoding(name, "PPM", fmt::format("pixel {} is not three numbers from 0 to {}", i, most));
            }
        }
        image.pixels[i] = {values[rgb[0]], values[rgb[1]], values[rgb[2]]};
    }
}

}  // namespace

Bytes encode_ppm_text(const ByteImageView& image, const ImageMetadata& metadata) {
    const std::string head = header("P3", image, metadata);
    constexpr std::size_t longest_pixel = 12;
    // every entry of the table writes four characters
    Bytes bytes(head.size() + longest_pixel * pixel_count(image) + 4);
    char* const start = reinterpret_cast<char*>(bytes.data());
    char* at = std::copy(head.begin(), head.end(), start);
    const std::uint8_t* value = image.values.data();
    for (std::size_t i = pixel_count(image); i > 0; --i) {
        for (int c = 0; c < 3; ++c, ++value) {
            std::memcpy(at, decimals.text[*value].data(), 4);
            at += decimals.length[*value];
        }
        at[-1] = '\n';
    }
    bytes.resize(static_cast<std::size_t>(at - start));
    return bytes;
}

Bytes encode_ppm(const ByteImageView& image, const ImageMetadata& metadata) {
    const std::string head = header("P6", image, metadata);
    Bytes bytes(head.size() + image.values.size());
    std::memcpy(bytes.data(), head.data(), head.size());
    std::memcpy(bytes.data() + head.size(), image.values.data(), image.values.size());
    return bytes;
}

DecodedImage decode_ppm(std::span<const std::byte> bytes, const std::string& name) {
    PortableMapHeader header(bytes, name, "PPM");
    const std::string_view magic = header.word();
    if (magic != "P3" && magic != "P6") fail_decoding(name, "PPM", "it does not start with P3 or P6");
    const auto width = header.number<std::uint32_t>("width");
    const auto height = header.number<std::uint32_t>("height");
    const auto most = header.number<std::uint32_t>("largest value");
    check_size(name, "PPM", width, height);
    if (most < 1 || most > 65535) {
        fail_decoding(name, "PPM", fmt::format("its largest value is {}, not from 1 to 65535", most));
    }
    const std::string_view pixels = header.pixels();

    DecodedImage result;
    result.metadata = header.metadata();
    if (result.metadata) result.display = display_of(*result.metadata);
    result.image.width = static_cast<int>(width);
    result.image.height = static_cast<int>(height);
    const std::size_t count = pixel_count(result.image);
    if (magic == "P3") {
        result.format = ImageFormat::ppm_text;
        check_data(name, "PPM", pixels.size(), 6 * count - 1);  // at least a digit and a blank for each value
        result.image.pixels.resize(count);
        DecimalReader decimal(pixels);
        fill(result, most, name, [&](std::uint32_t& value) { return decimal.next(most, value); });
        return result;
    }
    const std::size_t value_bytes = most < 256 ? 1 : 2;
    check_data(name, "PPM", pixels.size(), 3 * value_bytes * count);
    result.image.pixels.resize(count);
    const auto* at = reinterpret_cast<const std::uint8_t*>(pixels.data());
    fill(result, most, name, [&](std::uint32_t& value) {
        value = *at++;
        if (value_bytes == 2) value = value << 8 | *at++;
        return value <= most;
    });
    return result;
}

}  // namespace tandem
