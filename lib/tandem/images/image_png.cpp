#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstring>
#include <new>
#include <stdexcept>

#include "tandem/images/decode_checks.h"
#include "tandem/images/fast_deflate.h"
#include "tandem/images/image_codecs.h"
#include "tandem/images/png_encoder.h"
#include "tandem/images/texel_rows.h"
#include "tandem/images/texels.h"
#include "tandem/images/tone_curve.h"

namespace tandem {

namespace {

/// libpng reports errors by longjmp, which skips destructors. So every function that calls setjmp() is small, has only
/// plain local variables, and keeps objects with destructors in a PngFile.
struct PngFile {
    png_structp png = nullptr;
    png_infop info = nullptr;
    std::array<char, 256> error{};
    Bytes written;
    std::span<const std::byte> unread;
};

PngFile& file_of(png_structp png, png_voidp pointer) {
    if (pointer == nullptr) png_error(png, "no file");
    return *static_cast<PngFile*>(pointer);
}

[[noreturn]] void on_error(png_structp png, png_const_charp message) {
    if (auto* file = static_cast<PngFile*>(png_get_error_ptr(png))) {
        std::strncpy(file->error.data(), message, file->error.size() - 1);
    }
    png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

void on_write(png_structp png, png_bytep data, std::size_t size) {
    PngFile& file = file_of(png, png_get_io_ptr(png));
    const auto* start = reinterpret_cast<const std::byte*>(data);
    bool full = false;
    try {
        file.written.insert(file.written.end(), start, start + size);
    } catch (const std::bad_alloc&) {
        full = true;
    }
    if (full) png_error(png, "out of memory");
}

void on_read(png_structp png, png_bytep data, std::size_t size) {
    PngFile& file = file_of(png, png_get_io_ptr(png));
    if (file.unread.size() < size) png_error(png, "the file is cut off");
    std::memcpy(data, file.unread.data(), size);
    file.unread = file.unread.subspan(size);
}

struct PngWriter : PngFile {
    PngWriter() {
        png = png_create_write_struct(PNG_LIBPNG_VER_STRING, static_cast<PngFile*>(this), on_error, on_warning);
        info = png != nullptr ? png_create_info_struct(png) : nullptr;
        if (info == nullptr) throw std::bad_alloc();
        png_set_write_fn(png, static_cast<PngFile*>(this), on_write, nullptr);
    }
    ~PngWriter() { png_destroy_write_struct(&png, &info); }
    PngWriter(const PngWriter&) = delete;
    PngWriter& operator=(const PngWriter&) = delete;

    /// What comes before the pixels.
    bool write_header(const ByteImageView& image, const std::vector<png_text>& texts, bool is_srgb) {
        if (setjmp(png_jmpbuf(png)) != 0) return false;
        png_set_IHDR(png, info, static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height), 8,
                     PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
        if (is_srgb) png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
        if (!texts.empty()) png_set_text(png, info, texts.data(), static_cast<int>(texts.size()));
        png_write_info(png, info);
        return true;
    }
    /// The pixels, compressed by zlib, and what comes after them.
    bool write_rows(const std::vector<png_bytep>& rows, int level) {
        if (setjmp(png_jmpbuf(png)) != 0) return false;
        png_set_compression_level(png, level);
        png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
        if (level == 1) png_set_compression_strategy(png, Z_RLE);
        png_write_image(png, const_cast<png_bytepp>(rows.data()));
        png_write_end(png, nullptr);
        return true;
    }
    bool write_chunk(const char* type, std::span<const std::uint8_t> bytes) {
        if (setjmp(png_jmpbuf(png)) != 0) return false;
        png_write_chunk(png, reinterpret_cast<png_const_bytep>(type), bytes.data(), bytes.size());
        return true;
    }
};

struct PngReader : PngFile {
    explicit PngReader(std::span<const std::byte> bytes) {
        unread = bytes;
        png = png_create_read_struct(PNG_LIBPNG_VER_STRING, static_cast<PngFile*>(this), on_error, on_warning);
        info = png != nullptr ? png_create_info_struct(png) : nullptr;
        if (info == nullptr) throw std::bad_alloc();
        png_set_read_fn(png, static_cast<PngFile*>(this), on_read);
    }
    ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;

    /// Reads up to the pixels, which are then RGB of 8 or 16 bits.
    bool read_header() {
        if (setjmp(png_jmpbuf(png)) != 0) return false;
        png_read_info(png, info);
        png_set_expand(png);
        png_set_gray_to_rgb(png);
        png_set_strip_alpha(png);
        return finish_header();
    }
    /// The same for RGBA pixels of 8 bits. Texts and profiles, which may unpack to far more than the image, are
    /// skipped.
    bool read_texel_header() {
        if (setjmp(png_jmpbuf(png)) != 0) return false;
        png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
        png_read_info(png, info);
        unpacked_bytes = png_get_rowbytes(png, info) * height();
        return true;
    }
    /// `shrinks`: rows of an interlaced image come as they are in the file.
    bool start_texels(bool shrinks) {
        if (setjmp(png_jmpbuf(png)) != 0) return false;
        png_set_expand(png);
        png_set_scale_16(png);
        png_set_gray_to_rgb(png);
        png_set_add_alpha(png, 0xFF, PNG_FILLER_AFTER);
        if (!shrinks) png_set_interlace_handling(png);
        png_read_update_info(png, info);
        return true;
    }
    bool read_rows(TexelRows& rows, png_bytep row) {
        if (setjmp(png_jmpbuf(png)) != 0) return false;
        for (std::size_t y = 0; y < height(); ++y) {
            png_read_row(png, row, nullptr);
            rows.add(row);
        }
        png_read_end(png, info);
        return true;
    }
    /// Every 2^shift-th pixel of every 2^shift-th row of an interlaced image.
    bool read_pixels_apart(Texels& texels, png_bytep row, unsigned shift) {
        if (setjmp(png_jmpbuf(png)) != 0) return false;
        const auto columns_of = static_cast<png_uint_32>(width()), rows_of = static_cast<png_uint_32>(height());
        const png_uint_32 mask = (1U << shift) - 1;
        const int last_pass = shift >= 3 ? 0 : shift == 2 ? 2 : 4;  // later passes have other pixels
        for (int pass = 0; pass <= last_pass; ++pass) {
            const png_uint_32 columns = PNG_PASS_COLS(columns_of, pass);
            const png_uint_32 rows = columns == 0 ? 0 : PNG_PASS_ROWS(rows_of, pass);
            for (png_uint_32 i = 0; i < rows; ++i) {
                png_read_row(png, row, nullptr);
                const png_uint_32 y = PNG_ROW_FROM_PASS_ROW(i, pass);
                if ((y & mask) != 0) continue;
                for (png_uint_32 k = 0; k < columns; ++k) {
                    const png_uint_32 x = PNG_COL_FROM_PASS_COL(k, pass);
                    if ((x & mask) != 0) continue;
                    std::memcpy(&texels.texels[std::size_t{y >> shift} * texels.width + (x >> shift)],
                                row + std::size_t{k} * TexelRows::channels, TexelRows::channels);
                }
            }
        }
        return true;
    }

    bool read_pixels(const std::vector<png_bytep>& rows) {
        if (setjmp(png_jmpbuf(png)) != 0) return false;
        png_read_image(png, const_cast<png_bytepp>(rows.data()));
        png_read_end(png, info);
        return true;
    }

    std::size_t unpacked_bytes = 0;  ///< of all rows as they are in the file

    [[nodiscard]] std::size_t work() const { return std::max(width() * height(), unpacked_bytes / 2); }
    [[nodiscard]] bool is_interlaced() const { return png_get_interlace_type(png, info) != PNG_INTERLACE_NONE; }
    [[nodiscard]] std::size_t width() const { return png_get_image_width(png, info); }
    [[nodiscard]] std::size_t height() const { return png_get_image_height(png, info); }
    [[nodiscard]] std::size_t row_bytes() const { return png_get_rowbytes(png, info); }

    [[nodiscard]] bool is_tagged_srgb() const { return png_get_valid(png, info, PNG_INFO_sRGB) != 0; }

    [[nodiscard]] MetadataText texts() const {
        png_textp texts = nullptr;
        int count = 0;
        png_get_text(png, info, &texts, &count);
        MetadataText result;
        for (int i = 0; i < count; ++i) result.emplace_back(texts[i].key, texts[i].text);
        return result;
    }

  private:
    bool finish_header() {
        png_set_interlace_handling(png);
        png_read_update_info(png, info);
        return true;
    }
};

/// libpng allocates memory by the length that a chunk claims, so all lengths are compared with the available bytes.
void check_chunk_lengths(std::span<const std::byte> bytes, const std::string& name) {
    constexpr std::size_t signature = 8, around_data = 12;  // length, type and checksum
    for (std::size_t at = signature; at < bytes.size();) {
        if (bytes.size() - at < around_data) return;  // libpng reports the error if it gets here
        const std::size_t length = png_get_uint_32(reinterpret_cast<png_const_bytep>(&bytes[at]));
        if (std::memcmp(&bytes[at + 4], "IEND", 4) == 0) return;  // what follows is not part of the image
        if (length > bytes.size() - at - around_data) {
            fail_decoding(name, "PNG", "the file is cut off, or the length of a chunk is wrong");
        }
        at += around_data + length;
    }
}

template <class Byte>
std::vector<png_bytep> rows_of(Byte* values, std::size_t row_bytes, std::size_t height) {
    std::vector<png_bytep> rows(height);
    for (std::size_t y = 0; y < height; ++y) rows[y] = const_cast<png_bytep>(values + y * row_bytes);
    return rows;
}

/// Encodes an image whose pixels `write` passes to libpng; false if that fails.
template <class Write>
Bytes encode(const ByteImageView& image, const ImageMetadata& metadata, const Write& write) {
    MetadataText text = to_text(metadata);
    std::vector<png_text> texts;
    for (auto& [key, value] : text) {
        png_text entry = {};
        entry.compression = PNG_TEXT_COMPRESSION_NONE;
        entry.key = key.data();
        entry.text = value.data();
        entry.text_length = value.size();
        texts.push_back(entry);
    }
    PngWriter writer;
    const bool is_srgb = metadata.transfer == to_string(TransferFunction::srgb);
    if (!writer.write_header(image, texts, is_srgb) || !write(writer)) {
        throw std::runtime_error(std::string("libpng cannot encode the image: ") + writer.error.data());
    }
    return std::move(writer.written);
}

}  // namespace

PngEncoder::PngEncoder(const ByteImageView& image, ImageMetadata metadata, int level)
    : image_(image), metadata_(std::move(metadata)), level_(level) {
    const bool has_pixels = image.width > 0 && image.height > 0;  // libpng refuses others
    if (level == 1 && has_pixels && FastDeflate::is_available()) strips_.emplace(image);
}

void PngEncoder::encode(std::size_t part) {
    if (strips_) return strips_->compress(part);
    const auto rows = rows_of(image_.values.data(), 3 * static_cast<std::size_t>(image_.width),
                              static_cast<std::size_t>(image_.height));
    whole_ = tandem::encode(image_, metadata_, [&](PngWriter& writer) { return writer.write_rows(rows, level_); });
}

Bytes PngEncoder::finish() {
    if (!strips_) return std::move(whole_);
    strips_->finish();
    return tandem::encode(image_, metadata_, [&](PngWriter& writer) {
        for (std::size_t strip = 0; strip < strips_->count(); ++strip) {
            if (!writer.write_chunk("IDAT", strips_->bytes(strip))) return false;
        }
        return writer.write_chunk("IEND", {});
    });
}

Bytes encode_png(const ByteImageView& image, const ImageMetadata& metadata, int level) {
    PngEncoder encoder(image, metadata, level);
    for (std::size_t part = 0; part < encoder.part_count(); ++part) encoder.encode(part);
    return encoder.finish();
}

DecodedImage decode_png(std::span<const std::byte> bytes, const std::string& name) {
    check_chunk_lengths(bytes, name);
    PngReader reader(bytes);
    if (!reader.read_header()) fail_decoding(name, "PNG", reader.error.data());
    const std::size_t width = reader.width();
    const std::size_t height = reader.height();
    const std::size_t row_bytes = reader.row_bytes();
    check_size(name, "PNG", width, height);
    check_data(name, "PNG", bytes.size(), row_bytes * height / most_deflate_ratio);
    std::vector<std::uint8_t> raw(row_bytes * height);
    if (!reader.read_pixels(rows_of(raw.data(), row_bytes, height))) fail_decoding(name, "PNG", reader.error.data());

    DecodedImage result;
    result.format = ImageFormat::png;
    result.metadata = metadata_from_text(reader.texts());
    if (result.metadata) {
        result.display = display_of(*result.metadata);
    } else if (reader.is_tagged_srgb()) {
        result.display.transfer = TransferFunction::srgb;
    }
    const bool deep = png_get_bit_depth(reader.png, reader.info) == 16;
    result.image = {static_cast<int>(width), static_cast<int>(height), {}};
    if (!deep) {
        result.image = to_float({result.image.width, result.image.height, std::move(raw)}, result.display);
        return result;
    }
    result.image.pixels.resize(width * height);
    const std::vector<float> values = values_of_levels(65535, result.display);
    const auto level = [&](std::size_t i) { return values[std::size_t{raw[2 * i]} << 8 | raw[2 * i + 1]]; };
    for (std::size_t i = 0; i < width * height; ++i) {
        result.image.pixels[i] = {level(3 * i), level(3 * i + 1), level(3 * i + 2)};
    }
    return result;
}

namespace {

/// Reads the header and checks what it claims.
void open_texels(PngReader& reader, std::span<const std::byte> bytes, const std::string& name) {
    check_chunk_lengths(bytes, name);
    if (!reader.read_texel_header()) fail_decoding(name, "PNG", reader.error.data());
    check_texture_size(name, "PNG", reader.width(), reader.height());
    check_data(name, "PNG", bytes.size(), reader.unpacked_bytes / most_deflate_ratio);
    check_work(name, "PNG", bytes.size(), reader.work());
}

}  // namespace

TexelSize png_texel_size(std::span<const std::byte> bytes, const std::string& name) {
    PngReader reader(bytes);
    open_texels(reader, bytes, name);
    return {static_cast<std::uint32_t>(reader.width()), static_cast<std::uint32_t>(reader.height()), reader.work()};
}

Texels decode_png_texels(std::span<const std::byte> bytes, const std::string& name, unsigned shift) {
    PngReader reader(bytes);
    open_texels(reader, bytes, name);
    const auto width = static_cast<std::uint32_t>(reader.width()), height = static_cast<std::uint32_t>(reader.height());
    const bool shrinks = shift > 0;
    if (!reader.start_texels(shrinks)) fail_decoding(name, "PNG", reader.error.data());
    const std::size_t row_bytes = reader.row_bytes();
    if (row_bytes != TexelRows::channels * std::size_t{width}) {
        fail_decoding(name, "PNG", "libpng cannot convert its pixel format");
    }
    bool good = false;
    Texels result;
    if (reader.is_interlaced()) {
        result = {shrunk_edge(width, shift), shrunk_edge(height, shift), {}};
        result.texels.resize(std::size_t{result.width} * result.height);
        std::vector<std::uint8_t> row(row_bytes);
        auto* raw = reinterpret_cast<std::uint8_t*>(result.texels.data());
        good = shrinks ? reader.read_pixels_apart(result, row.data(), shift)
                       : reader.read_pixels(rows_of(raw, row_bytes, height));
    } else {
        TexelRows rows(width, height, shift);
        std::vector<std::uint8_t> row(row_bytes);
        good = reader.read_rows(rows, row.data());
        result = rows.take();
    }
    if (!good) fail_decoding(name, "PNG", reader.error.data());
    return result;
}

}  // namespace tandem
