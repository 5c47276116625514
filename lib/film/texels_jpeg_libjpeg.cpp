// The only include of libjpeg, whose headers do not include what they need.
#include <cstddef>
#include <cstdio>

// clang-format off
#include <jpeglib.h>
#include <jerror.h>
// clang-format on

#include <array>
#include <csetjmp>
#include <cstring>

#include "tandem/film/decode_checks.h"
#include "tandem/film/texels.h"

namespace tandem {

namespace {

/// A forged progressive file can ask for a pass over all pixels in a few bytes, again and again.
constexpr int most_passes = 100;

/// libjpeg leaves through error_exit(), from which we jump; see PngFile. The functions that hold a setjmp() have only
/// plain values of their own.
struct JpegReader {
    jpeg_decompress_struct info{};
    jpeg_error_mgr errors{};
    jpeg_progress_mgr progress{};
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
    /// Warnings, of level -1, are about broken data; bytes between the parts of a file are harmless.
    static void on_message(j_common_ptr info, int level) {
        if (level == -1 && info->err->msg_code != JWRN_EXTRANEOUS_DATA) on_error(info);
    }
    static void on_progress(j_common_ptr info) {
        auto* reader = static_cast<JpegReader*>(info->client_data);
        if (reader->info.input_scan_number <= most_passes) return;
        std::strncpy(reader->message.data(), "it has more than 100 passes", reader->message.size() - 1);
        std::longjmp(reader->jump, 1);
    }

    bool read_header(std::span<const std::byte> bytes) {
        if (setjmp(jump) != 0) return false;
        jpeg_create_decompress(&info);
        info.client_data = this;
        progress.progress_monitor = on_progress;
        info.progress = &progress;
        jpeg_mem_src(&info, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
        jpeg_read_header(&info, TRUE);
        return true;
    }

    /// Three bytes a pixel.
    bool read_pixels(std::uint8_t* rows, std::size_t row_bytes) {
        if (setjmp(jump) != 0) return false;
        info.out_color_space = JCS_RGB;
        info.dct_method = JDCT_ISLOW;  // whose result is the same on every processor
        jpeg_start_decompress(&info);
        while (info.output_scanline < info.output_height) {
            JSAMPROW row = rows + info.output_scanline * row_bytes;
            jpeg_read_scanlines(&info, &row, 1);
        }
        jpeg_finish_decompress(&info);
        return true;
    }
};

}  // namespace

Texels decode_jpeg_texels(std::span<const std::byte> bytes, const std::string& name) {
    JpegReader reader;
    if (!reader.read_header(bytes)) fail_decoding(name, "JPEG", reader.message.data());
    Texels result{reader.info.image_width, reader.info.image_height, {}};
    check_texture_size(name, "JPEG", result.width, result.height);
    if (reader.info.jpeg_color_space != JCS_GRAYSCALE && reader.info.jpeg_color_space != JCS_YCbCr &&
        reader.info.jpeg_color_space != JCS_RGB) {
        fail_decoding(name, "JPEG", "its colours are not grey or YCbCr");
    }
    if (reader.info.arith_code != 0) fail_decoding(name, "JPEG", "it is not Huffman-coded");
    // a Huffman code takes at least a bit for every block of 8 x 8 pixels
    const std::size_t blocks = (std::size_t{result.width} + 7) / 8 * ((std::size_t{result.height} + 7) / 8);
    check_data(name, "JPEG", bytes.size(), blocks / 8);
    const std::size_t row_bytes = 3 * std::size_t{result.width};
    std::vector<std::uint8_t> raw(row_bytes * result.height);
    if (!reader.read_pixels(raw.data(), row_bytes)) fail_decoding(name, "JPEG", reader.message.data());
    result.texels.resize(std::size_t{result.width} * result.height);
    for (std::size_t i = 0; i < result.texels.size(); ++i) {
        result.texels[i] = raw[3 * i] | static_cast<std::uint32_t>(raw[3 * i + 1]) << 8 |
                           static_cast<std::uint32_t>(raw[3 * i + 2]) << 16 | 0xFF000000U;
    }
    return result;
}

}  // namespace tandem
