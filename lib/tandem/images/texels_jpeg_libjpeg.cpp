// The only include of libjpeg, whose headers do not include what they need.
#include <fmt/format.h>

#include <cstddef>
#include <cstdio>

// clang-format off
#include <jpeglib.h>
#include <jerror.h>
// clang-format on

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstring>

#include "tandem/images/decode_checks.h"
#include "tandem/images/texel_rows.h"
#include "tandem/images/texels.h"

namespace tandem {

namespace {

/// Limits of the coefficients of a multi-pass image, which are all in memory: bytes in total, and per byte of its file.
constexpr std::size_t most_coefficients = std::size_t{1} << 28, coefficients_per_byte = 64;
/// Bytes of coefficients that a pass processes in the time of one pixel.
constexpr std::size_t coefficients_per_pixel = 32;

/// The number of passes over the image: start-of-scan markers (SOS), counted without decoding. A forged file can start
/// very many passes, with a few bytes each.
std::size_t count_passes(std::span<const std::byte> bytes) {
    const auto byte = [&](std::size_t i) { return std::to_integer<unsigned>(bytes[i]); };
    std::size_t passes = 0;
    for (std::size_t at = 2; at + 4 <= bytes.size();) {
        const unsigned marker = byte(at + 1);
        const bool stands_alone =
            marker == 0x00 || marker == 0x01 || marker == 0xFF || (marker >= 0xD0 && marker <= 0xD8);
        if (byte(at) != 0xFF || stands_alone) {  // within coded data
            ++at;
            continue;
        }
        if (marker == 0xD9) break;  // the end
        if (marker == 0xDA) ++passes;
        at += 2 + std::size_t{byte(at + 2)} * 256 + byte(at + 3);
    }
    return passes;
}

/// libjpeg reports errors through error_exit(), from which we longjmp; see PngFile. Functions that call setjmp() have
/// only plain local variables.
struct JpegReader {
    jpeg_decompress_struct info{};
    jpeg_error_mgr errors{};
    std::jmp_buf jump{};
    std::array<char, JMSG_LENGTH_MAX> message{};

    JpegReader() {
        info.err = jpeg_std_error(&errors);
        info.client_data = this;
        errors.error_exit = on_error;
        errors.emit_message = on_message;
    }
    ~JpegReader() { jpeg_destroy_decompress(&info); }
    JpegReader(const JpegReader&) = delete;
    JpegReader& operator=(const JpegReader&) = delete;

    [[noreturn]] static void on_error(j_common_ptr info) {
        auto* reader = static_cast<JpegReader*>(info->client_data);
        info->err->format_message(info, reader->message.data());
        std::longjmp(reader->jump, 1);
    }
    /// Warnings, of level -1, mean broken data, except that bytes between the parts of a file are harmless.
    static void on_message(j_common_ptr info, int level) {
        if (level == -1 && info->err->msg_code != JWRN_EXTRANEOUS_DATA) on_error(info);
    }
    bool read_header(std::span<const std::byte> bytes) {
        if (setjmp(jump) != 0) return false;
        jpeg_create_decompress(&info);
        info.client_data = this;
        jpeg_mem_src(&info, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
        jpeg_read_header(&info, TRUE);
        return true;
    }

    /// Sets the size, divided by 2^`halvings`, up to 3.
    bool start(unsigned halvings) {
        if (setjmp(jump) != 0) return false;
        info.out_color_space = JCS_RGB;
        info.dct_method = JDCT_ISLOW;  // gives the same result on every processor
        info.scale_num = 1;
        info.scale_denom = 1U << halvings;
        jpeg_start_decompress(&info);
        return true;
    }
    /// `rgb`, `rgba`: memory for a row.
    bool read_rows(TexelRows& rows, std::uint8_t* rgb, std::uint8_t* rgba) {
        if (setjmp(jump) != 0) return false;
        while (info.output_scanline < info.output_height) {
            JSAMPROW row = rgb;
            jpeg_read_scanlines(&info, &row, 1);
            for (std::size_t x = 0; x < info.output_width; ++x) {
                std::memcpy(rgba + TexelRows::channels * x, rgb + 3 * x, 3);
                rgba[TexelRows::channels * x + 3] = 0xFF;
            }
            rows.add(rgba);
        }
        jpeg_finish_decompress(&info);
        return true;
    }

    /// The memory of all coefficients, in bytes.
    [[nodiscard]] std::size_t coefficient_bytes() const {
        std::size_t blocks = 0;
        for (int i = 0; i < info.num_components; ++i) {
            blocks += std::size_t{info.comp_info[i].width_in_blocks} * info.comp_info[i].height_in_blocks;
        }
        return blocks * DCTSIZE2 * sizeof(JCOEF);
    }
};

/// Reads the header and checks what it claims.
TexelSize open_texels(JpegReader& reader, std::span<const std::byte> bytes, const std::string& name) {
    if (!reader.read_header(bytes)) fail_decoding(name, "JPEG", reader.message.data());
    const std::size_t width = reader.info.image_width, height = reader.info.image_height;
    check_texture_size(name, "JPEG", width, height);
    if (reader.info.jpeg_color_space != JCS_GRAYSCALE && reader.info.jpeg_color_space != JCS_YCbCr &&
        reader.info.jpeg_color_space != JCS_RGB) {
        fail_decoding(name, "JPEG", "its colours are neither grey nor YCbCr");
    }
    if (reader.info.arith_code != 0) fail_decoding(name, "JPEG", "it is not Huffman-coded");
    // a Huffman code takes at least a bit for every block of 8 x 8 pixels
    check_data(name, "JPEG", bytes.size(), (width + 7) / 8 * ((height + 7) / 8) / 8);
    TexelSize size{reader.info.image_width, reader.info.image_height, width * height};
    if (jpeg_has_multiple_scans(&reader.info) != 0) {
        const std::size_t coefficients = reader.coefficient_bytes();
        if (coefficients > std::max(most_coefficients, coefficients_per_byte * bytes.size())) {
            fail_decoding(name, "JPEG",
                          fmt::format("it is progressive and needs {} bytes of memory, too many for a file of its size",
                                      coefficients));
        }
        size.work += count_passes(bytes) * (coefficients / coefficients_per_pixel);
    }
    check_work(name, "JPEG", bytes.size(), size.work);
    return size;
}

}  // namespace

TexelSize jpeg_texel_size(std::span<const std::byte> bytes, const std::string& name) {
    JpegReader reader;
    return open_texels(reader, bytes, name);
}

Texels decode_jpeg_texels(std::span<const std::byte> bytes, const std::string& name, unsigned shift) {
    constexpr unsigned most_halvings = 3;  // the maximum of libjpeg
    JpegReader reader;
    (void)open_texels(reader, bytes, name);
    const unsigned halvings = std::min(shift, most_halvings);
    if (!reader.start(halvings)) fail_decoding(name, "JPEG", reader.message.data());
    const std::size_t width = reader.info.output_width;
    TexelRows rows(reader.info.output_width, reader.info.output_height, shift - halvings);
    std::vector<std::uint8_t> rgb(3 * width), rgba(TexelRows::channels * width);
    if (!reader.read_rows(rows, rgb.data(), rgba.data())) fail_decoding(name, "JPEG", reader.message.data());
    return rows.take();
}

}  // namespace tandem
