// Radiance's picture format. Source: G. Ward, "Real Pixels", Graphics Gems II, 1991, and the file format chapter of
// "Rendering with Radiance", 1998.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "tandem/images/decode_checks.h"
#include "tandem/images/image_codecs.h"
#include "tandem/images/portable_map.h"

namespace tandem {

namespace {

constexpr const char* format_name = "Radiance HDR";

using Rgbe = std::array<std::uint8_t, 4>;

struct HdrHeader {
    std::uint32_t width = 0, height = 0;
    bool from_bottom = false, from_right = false;
    double exposure = 1;  ///< the factor of the radiance
};

class HdrReader {
  public:
    HdrReader(std::span<const std::byte> bytes, const std::string& name)
        : text_(reinterpret_cast<const char*>(bytes.data()), bytes.size()), name_(name) {}

    HdrHeader header() {
        HdrHeader header;
        if (!line().starts_with("#?")) fail("it does not start with #?");
        for (std::string_view variable = line(); !variable.empty(); variable = line()) {
            if (variable.starts_with("FORMAT=") && variable != "FORMAT=32-bit_rle_rgbe") {
                fail(fmt::format("its format is '{}'; only 32-bit_rle_rgbe is supported", shown(variable.substr(7))));
            }
            if (variable.starts_with("EXPOSURE=")) header.exposure *= number<double>(variable.substr(9), "exposure");
        }
        if (!(header.exposure > 0 && std::isfinite(header.exposure))) fail("its exposure is not a number above 0");
        read_resolution(line(), header);
        check_size(name_, format_name, header.width, header.height);
        const std::size_t row = std::min(flat_bytes(header.width), fewest_bytes(header.width));
        check_data(name_, format_name, text_.size() - at_, row * header.height);
        return header;
    }

    /// Reads the next row of pixels.
    void row(std::vector<Rgbe>& pixels) {
        const std::size_t width = pixels.size();
        Rgbe start;
        for (std::uint8_t& value : start) value = byte();
        if (start[0] != 2 || start[1] != 2 || start[2] >= 128 || !can_be_packed(width)) {
            pixels[0] = start;
            for (std::size_t x = 1; x < width; ++x) {
                for (std::uint8_t& value : pixels[x]) value = byte();
            }
            if (std::any_of(pixels.begin(), pixels.end(), is_old_run)) {
                fail("it has the run-length encoding from before 1991; convert it with a newer program");
            }
            return;
        }
        if (std::size_t{start[2]} << 8 != (width & ~std::size_t{255}) || start[3] != (width & 255)) {
            fail(fmt::format("a row claims {} pixels, but the header {}", start[2] << 8 | start[3], width));
        }
        for (std::size_t channel = 0; channel < 4; ++channel) {
            for (std::size_t x = 0; x < width;) {
                const std::uint8_t code = byte();
                const bool is_run = code > 128;
                const std::size_t count = is_run ? code - 128U : code;
                if (count == 0 || count > width - x)
                    fail("a run of pixels goes beyond the end of its row, or is empty");
                std::uint8_t value = 0;
                for (std::size_t i = 0; i < count; ++i, ++x) {
                    if (i == 0 || !is_run) value = byte();
                    pixels[x][channel] = value;
                }
            }
        }
    }

    [[noreturn]] void fail(const std::string& reason) const { fail_decoding(name_, format_name, reason); }

  private:
    static bool can_be_packed(std::size_t width) { return width >= 8 && width < 32768; }
    static bool is_old_run(const Rgbe& a) { return a[0] == 1 && a[1] == 1 && a[2] == 1; }
    static std::size_t flat_bytes(std::size_t width) { return 4 * width; }
    /// The size of a row whose runs have the maximum length.
    static std::size_t fewest_bytes(std::size_t width) {
        return can_be_packed(width) ? 4 + 4 * 2 * ((width + 126) / 127) : flat_bytes(width);
    }
    static std::string_view shown(std::string_view text) { return text.substr(0, 32); }

    std::uint8_t byte() {
        if (at_ == text_.size()) fail("its pixels are cut off");
        return static_cast<std::uint8_t>(text_[at_++]);
    }

    std::string_view line() {
        const std::size_t end = text_.find('\n', at_);
        if (end == std::string_view::npos) fail("its header is cut off");
        std::string_view result = text_.substr(at_, end - at_);
        if (result.ends_with('\r')) result.remove_suffix(1);
        at_ = end + 1;
        return result;
    }

    template <class Number>
    Number number(std::string_view text, const char* what) const {
        while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
        while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
        Number value{};
        const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc() || stop != text.data() + text.size()) {
            fail(fmt::format("its {} is '{}', which is not a valid number", what, shown(text)));
        }
        return value;
    }

    /// "-Y height +X width": the order of the rows and of the pixels in them.
    void read_resolution(std::string_view text, HdrHeader& header) const {
        const std::size_t second = text.find_first_of("+-", 1);
        const std::size_t axis = second == std::string_view::npos ? text.size() : second;
        const std::string_view rows = text.substr(0, std::min<std::size_t>(2, text.size())),
                               columns = text.substr(axis);
        if ((rows != "-Y" && rows != "+Y") || !(columns.starts_with("+X") || columns.starts_with("-X"))) {
            fail(fmt::format("its size is '{}'; only images stored row by row are supported, as in -Y 512 +X 1024",
                             shown(text)));
        }
        header.from_bottom = rows == "+Y";
        header.from_right = columns[0] == '-';
        header.height = number<std::uint32_t>(text.substr(2, axis - 2), "height");
        header.width = number<std::uint32_t>(columns.substr(2), "width");
    }

    std::string_view text_;
    std::size_t at_ = 0;
    const std::string& name_;
};

}  // namespace

DecodedImage decode_hdr(std::span<const std::byte> bytes, const std::string& name) {
    HdrReader reader(bytes, name);
    const HdrHeader header = reader.header();
    DecodedImage result;
    result.format = ImageFormat::hdr;
    FloatImage& image = result.image;
    image.width = static_cast<int>(header.width);
    image.height = static_cast<int>(header.height);
    image.pixels.resize(pixel_count(image));

    std::array<double, 256> scales{};  // of the exponents; 0 is black
    for (int e = 1; e < 256; ++e) scales[static_cast<std::size_t>(e)] = std::ldexp(1.0, e - 136) / header.exposure;
    std::vector<Rgbe> row(header.width);
    for (std::size_t y = 0; y < header.height; ++y) {
        reader.row(row);
        const std::size_t at = (header.from_bottom ? header.height - 1 - y : y) * header.width;
        for (std::size_t x = 0; x < header.width; ++x) {
            const auto [r, g, b, e] = row[x];
            const double scale = scales[e];
            const Vec3f pixel = narrow(Vec3d{r * scale, g * scale, b * scale});
            if (!std::isfinite(norm1(widen(pixel)))) reader.fail("its exposure makes a pixel brighter than 3.4e38");
            image.pixels[at + (header.from_right ? header.width - 1 - x : x)] = pixel;
        }
    }
    return result;
}

}  // namespace tandem
