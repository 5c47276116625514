#include "tandem/images/png_strips.h"

#include <zlib.h>

#include <algorithm>

#include "tandem/images/fast_deflate.h"

namespace tandem {

namespace {

constexpr std::size_t strip_bytes = std::size_t{1} << 18;
constexpr std::size_t band_bytes = std::size_t{1} << 16;  ///< filtered and compressed at once: they stay in the cache

constexpr std::uint8_t filter_sub = 1;
/// Deflate with a window of 32 KiB, compressed by the fastest method.
constexpr std::uint8_t zlib_header[] = {0x78, 0x01};

/// Applies the filter "sub" to a row: the filter's number, then each byte minus that of the pixel before.
void filter_row(const std::uint8_t* row, std::size_t bytes, std::uint8_t* to) {
    constexpr std::size_t pixel = 3;
    to[0] = filter_sub;
    std::copy_n(row, pixel, to + 1);
    for (std::size_t i = pixel; i < bytes; ++i) to[1 + i] = static_cast<std::uint8_t>(row[i] - row[i - pixel]);
}

/// Kept by the thread, because new memory would cost more than the compression of a strip.
struct Tools {
    FastDeflate deflate;
    std::vector<std::uint8_t> band;
};

std::size_t rows_in(std::size_t bytes, std::size_t row_bytes) { return std::max<std::size_t>(1, bytes / row_bytes); }

}  // namespace

PngStrips::PngStrips(const ByteImageView& image) : image_(image) {
    const auto height = static_cast<std::size_t>(image.height);
    const std::size_t rows = rows_in(strip_bytes, 3 * static_cast<std::size_t>(image.width));
    for (std::size_t first = 0; first < height; first += rows) {
        strips_.push_back({first, std::min(rows, height - first)});
    }
}

void PngStrips::compress(std::size_t strip) {
    thread_local Tools tools;
    Strip& mine = strips_[strip];
    const bool is_last = strip + 1 == strips_.size();
    const std::size_t row_bytes = 3 * static_cast<std::size_t>(image_.width), filtered_bytes = 1 + row_bytes;
    const std::size_t most_rows = std::min(mine.rows, rows_in(band_bytes, row_bytes));
    tools.band.resize(std::max(tools.band.size(), most_rows * filtered_bytes));
    tools.deflate.begin();
    if (strip == 0) mine.bytes.assign(std::begin(zlib_header), std::end(zlib_header));
    for (std::size_t row = 0; row < mine.rows; row += most_rows) {
        const std::size_t rows = std::min(most_rows, mine.rows - row);
        for (std::size_t y = 0; y < rows; ++y) {
            const std::size_t at = (mine.first_row + row + y) * row_bytes;
            filter_row(&image_.values[at], row_bytes, &tools.band[y * filtered_bytes]);
        }
        const std::span<const std::uint8_t> band = std::span(tools.band).first(rows * filtered_bytes);
        using Then = FastDeflate::Then;
        const bool is_end = row + rows == mine.rows;
        const auto ready = tools.deflate.compress(band, !is_end ? Then::more : is_last ? Then::end : Then::piece);
        mine.bytes.insert(mine.bytes.end(), ready.begin(), ready.end());
        mine.adler32 = FastDeflate::adler32(mine.adler32, band);
        mine.length += band.size();
    }
}

void PngStrips::finish() {
    std::uint32_t sum = 1;
    for (const Strip& strip : strips_) {
        sum = static_cast<std::uint32_t>(adler32_combine(sum, strip.adler32, static_cast<z_off_t>(strip.length)));
    }
    for (const unsigned int shift : {24U, 16U, 8U, 0U}) {
        strips_.back().bytes.push_back(static_cast<std::uint8_t>(sum >> shift));
    }
}

}  // namespace tandem
