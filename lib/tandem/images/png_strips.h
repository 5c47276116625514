/// The pixels of a PNG file, compressed by ISA-L (fast_deflate.h) in strips of rows, which several threads may share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tandem/images/image.h"

namespace tandem {

/// The rows after the filter "sub", as a stream of zlib (RFC 1950). The strips are the same however many threads
/// compress them, and each is compressed independently of those before it. A strip has about 256 KiB of pixels, so this
/// costs less than a thousandth of the size.
class PngStrips {
  public:
    /// The image must outlive the object. Needs FastDeflate::is_available().
    explicit PngStrips(const ByteImageView& image);

    [[nodiscard]] std::size_t count() const { return strips_.size(); }
    /// Compresses a strip; different ones at the same time. Throws as FastDeflate::compress() does.
    void compress(std::size_t strip);
    /// Ends the stream, once all strips are compressed.
    void finish();
    /// A strip's part of the stream, from finish() on.
    [[nodiscard]] std::span<const std::uint8_t> bytes(std::size_t strip) const { return strips_[strip].bytes; }

  private:
    struct Strip {
        std::size_t first_row, rows;
        std::vector<std::uint8_t> bytes{};
        std::size_t length = 0;     ///< of what was compressed
        std::uint32_t adler32 = 1;  ///< of the same
    };

    ByteImageView image_;
    std::vector<Strip> strips_;
};

}  // namespace tandem
