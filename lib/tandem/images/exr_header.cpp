#include "tandem/images/exr_header.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <string_view>
#include <utility>

#include "tandem/images/decode_checks.h"

namespace tandem {

namespace {

static_assert(std::endian::native == std::endian::little, "EXR is little endian");

constexpr std::uint32_t magic = 20000630;
constexpr std::uint32_t tiled_flag = 0x200;
constexpr std::uint32_t deep_flag = 0x800;
constexpr std::uint32_t multipart_flag = 0x1000;

/// Lines per compressed block, by compression number: none, RLE, ZIPS, ZIP, PIZ, PXR24, B44, B44A, DWAA, DWAB. Later
/// ones have no larger blocks than the last.
constexpr std::uint64_t lines_by_compression[] = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
constexpr std::size_t compressions = std::size(lines_by_compression);

/// A block of lines or a tile, which is decompressed at once, may always have this many bytes.
constexpr std::uint64_t most_block_bytes = std::uint64_t{64} << 20;

/// Sizes of OpenEXR's attribute types; other types may have any size. OpenEXR reads this many bytes whatever size the
/// file gives, and parses what follows a wrong size as the next attribute.
constexpr std::pair<std::string_view, std::uint32_t> value_sizes[] = {{"box2f", 16},
                                                                      {"box2i", 16},
                                                                      {"chromaticities", 32},
                                                                      {"compression", 1},
                                                                      {"deepImageState", 1},
                                                                      {"double", 8},
                                                                      {"envmap", 1},
                                                                      {"float", 4},
                                                                      {"int", 4},
                                                                      {"keycode", 28},
                                                                      {"lineOrder", 1},
                                                                      {"m33d", 72},
                                                                      {"m33f", 36},
                                                                      {"m44d", 128},
                                                                      {"m44f", 64},
                                                                      {"rational", 8},
                                                                      {"tiledesc", 9},
                                                                      {"timecode", 8},
                                                                      {"v2d", 16},
                                                                      {"v2f", 8},
                                                                      {"v2i", 8},
                                                                      {"v3d", 24},
                                                                      {"v3f", 12},
                                                                      {"v3i", 12}};

/// The claims of the header of one part.
struct Part {
    std::string_view type;
    std::uint64_t width = 0;
    std::uint64_t height = 0;
    std::uint64_t channels = 0;
    std::uint64_t pixel_bytes = 0;
    std::uint64_t tile_width = 0;
    std::uint64_t tile_height = 0;
    std::uint64_t chunk_count = 0;  ///< from the optional attribute
    std::size_t compression = compressions - 1;
};

/// Reads bytes in order; throws at the end.
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
    /// A string up to a zero byte.
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
        if (header.number() != magic) fail("it does not start with OpenEXR's magic number");
        const std::uint32_t flags = header.number();
        const bool multipart = (flags & multipart_flag) != 0;
        std::string_view attribute = header.text();
        const Part first = read_part(header, attribute);
        const auto is_tiled = [&](const Part& part) {
            return multipart ? part.type.starts_with("tiled") : (flags & tiled_flag) != 0;
        };
        if ((!multipart && (flags & deep_flag) != 0) || first.type.starts_with("deep")) {
            fail("its pixels are deep, with many samples each; flatten it first");
        }
        check_part(first, is_tiled(first));
        if (!multipart) return;
        // the other parts are not used, but OpenEXR reads their headers and tables
        for (attribute = header.text(); !attribute.empty(); attribute = header.text()) {
            const Part part = read_part(header, attribute);
            check_part(part, is_tiled(part) || part.type == "deeptile");
        }
    }

  private:
    [[noreturn]] void fail(const char* reason) const { fail_decoding(name_, "EXR", reason); }

    /// Reads a header, from the name of its first attribute.
    Part read_part(Cursor& header, std::string_view attribute) const {
        Part part;
        for (; !attribute.empty(); attribute = header.text()) {
            const std::string_view type = header.text();
            const std::uint32_t size = header.number();
            const std::string_view bytes = header.take(size);
            check_value_size(type, size);
            Cursor value(bytes, name_);
            if (attribute == "type") part.type = bytes;
            if (attribute == "dataWindow") read_window(value, part);
            if (type == "chlist") read_channels(value, part);
            if (attribute == "chunkCount") part.chunk_count = value.number();
            if (attribute == "compression") part.compression = static_cast<unsigned char>(value.take(1)[0]);
            if (attribute == "tiles") {
                part.tile_width = value.number();
                part.tile_height = value.number();
            }
            if (type == "preview") check_preview(value, size);
        }
        return part;
    }

    void check_value_size(std::string_view type, std::uint32_t size) const {
        for (const auto& [known, known_size] : value_sizes) {
            if (type == known && size != known_size) fail("an attribute of its header is not of its size");
        }
        if (type == "floatvector" && size % sizeof(float) != 0) fail("an attribute of its header is not of its size");
        // OpenEXR 3.1 reads four bytes too many
        if (type == "idmanifest") fail("its header has a manifest of ids, which OpenEXR cannot read");
    }

    void read_window(Cursor& value, Part& part) const {
        std::int64_t corner[4];
        for (std::int64_t& c : corner) c = static_cast<std::int32_t>(value.number());
        if (corner[2] < corner[0] || corner[3] < corner[1]) fail("its data window is empty");
        part.width = static_cast<std::uint64_t>(corner[2] - corner[0] + 1);
        part.height = static_cast<std::uint64_t>(corner[3] - corner[1] + 1);
    }

    /// If there are several lists, OpenEXR combines them.
    void read_channels(Cursor& value, Part& part) const {
        constexpr std::uint32_t half = 1;
        constexpr std::size_t after_type = 12;  // linearity, sampling
        for (; !value.text().empty(); ++part.channels) {
            part.pixel_bytes += value.number() == half ? 2 : 4;
            value.take(after_type);
        }
        if (!value.empty()) fail("its list of channels is not of its size");
    }

    void check_preview(Cursor& value, std::uint32_t size) const {
        const std::uint64_t width = value.number(), height = value.number();
        if (width > size || height > size || 8 + 4 * width * height != size) fail("its preview is not of its size");
    }

    void check_part(const Part& part, bool tiled) {
        if (part.width == 0 || part.channels == 0) fail("its header has no data window or no channels");
        check_size(name_, "EXR", part.width, part.height);
        // every value has at least two bytes before compression
        const std::uint64_t pixels = part.width * part.height;
        check_data(name_, "EXR", bytes_.size(), pixels * part.channels * 2 / most_deflate_ratio);

        std::uint64_t block_width = part.width;
        std::uint64_t block_height = lines_by_compression[std::min(part.compression, compressions - 1)];
        if (tiled) {
            block_width = part.tile_width;
            block_height = part.tile_height;
            if (block_width == 0 || block_height == 0) fail("its tiles have no size");
            if (block_width * block_height > std::uint64_t{1} << 31) fail("its tiles are too large");
        }
        const std::uint64_t block_bytes = block_width * block_height * part.pixel_bytes;
        if (block_bytes > most_block_bytes + bytes_.size() * most_deflate_ratio) {
            fail("its tiles or blocks of lines are too large");
        }
        // the offset of every block is in the file
        const auto blocks = [](std::uint64_t edge, std::uint64_t block) { return (edge + block - 1) / block; };
        chunks_ += std::max(part.chunk_count, blocks(part.width, block_width) * blocks(part.height, block_height));
        check_data(name_, "EXR", bytes_.size(), chunks_ * sizeof(std::uint64_t));
    }

    std::span<const std::byte> bytes_;
    const std::string& name_;
    std::uint64_t chunks_ = 0;  ///< of all parts so far
};

}  // namespace

void check_exr_header(std::span<const std::byte> bytes, const std::string& name) { HeaderCheck(bytes, name).run(); }

}  // namespace tandem
