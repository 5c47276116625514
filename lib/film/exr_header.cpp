#include "tandem/film/exr_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "tandem/film/decode_checks.h"

namespace tandem {

namespace {

static_assert(std::endian::native == std::endian::little, "EXR is little endian");

constexpr std::uint32_t magic = 20000630;
constexpr std::uint32_t deep_or_multipart = 0x800 | 0x1000;

/// Runs over bytes; whatever goes past the end throws.
class Cursor {
  public:
    Cursor(std::string_view bytes, const std::string& name) : rest_(bytes), name_(name) {}

    [[nodiscard]] bool empty() const { return rest_.empty(); }

    std::string_view take(std::size_t size) {
        if (size > rest_.size()) fail_decoding(name_, "EXR", "its header is cut off");
        const std::string_view taken = rest_.substr(0, size);
        rest_.remove_prefix(size);
        return taken;
    }
    std::uint32_t number() {
        std::uint32_t value = 0;
        std::memcpy(&value, take(sizeof(value)).data(), sizeof(value));
        return value;
    }
    /// Up to a zero byte.
    std::string_view text() {
        const std::string_view taken = take(std::min(rest_.find('\0'), rest_.size()));
        take(1);
        return taken;
    }

  private:
    std::string_view rest_;
    const std::string& name_;
};

class HeaderCheck {
  public:
    HeaderCheck(std::span<const std::byte> bytes, const std::string& name) : bytes_(bytes), name_(name) {}

    void run() {
        Cursor header({reinterpret_cast<const char*>(bytes_.data()), bytes_.size()}, name_);
        if (header.number() != magic) fail("it does not begin as one");
        if ((header.number() & deep_or_multipart) != 0) fail("it is not a flat picture in one part");
        for (std::string_view attribute = header.text(); !attribute.empty(); attribute = header.text()) {
            const std::string_view type = header.text();
            const std::uint32_t size = header.number();
            Cursor value(header.take(size), name_);
            if (attribute == "dataWindow") read_window(value);
            if (attribute == "channels") read_channels(value);
            if (attribute == "tiles") tile_pixels_ = std::uint64_t{value.number()} * value.number();
            if (type == "preview") check_preview(value, size);
        }
        if (width_ == 0 || channels_ == 0) fail("its header has no data window or no channels");
        check_size(name_, "EXR", width_, height_);
        // every value has two bytes at least, before compression
        const std::size_t most_values = std::max(width_ * height_, tile_pixels_);
        if (most_values > std::uint64_t{1} << 32) fail("its tiles are too large");
        check_data(name_, "EXR", bytes_.size(), most_values * channels_ * 2 / most_deflate_ratio);
    }

  private:
    [[noreturn]] void fail(const char* reason) const { fail_decoding(name_, "EXR", reason); }

    void read_window(Cursor& value) {
        std::int64_t corner[4];
        for (std::int64_t& c : corner) c = static_cast<std::int32_t>(value.number());
        if (corner[2] < corner[0] || corner[3] < corner[1]) fail("its data window is empty");
        width_ = static_cast<std::uint64_t>(corner[2] - corner[0] + 1);
        height_ = static_cast<std::uint64_t>(corner[3] - corner[1] + 1);
    }

    void read_channels(Cursor& value) {
        constexpr std::size_t after_name = 16;  // type, linearity, sampling
        for (channels_ = 0; !value.text().empty(); ++channels_) value.take(after_name);
    }

    void check_preview(Cursor& value, std::uint32_t size) const {
        const std::uint64_t width = value.number(), height = value.number();
        if (width > size || height > size || 8 + 4 * width * height != size) fail("its preview is not of its size");
    }

    std::span<const std::byte> bytes_;
    const std::string& name_;
    std::uint64_t width_ = 0;
    std::uint64_t height_ = 0;
    std::uint64_t channels_ = 0;
    std::uint64_t tile_pixels_ = 0;
};

}  // namespace

void check_exr_header(std::span<const std::byte> bytes, const std::string& name) { HeaderCheck(bytes, name).run(); }

}  // namespace tandem
