/// Encodes a PNG file on several threads.
#pragma once

#include <cstddef>
#include <optional>

#include "tandem/images/image_codecs.h"
#include "tandem/images/png_strips.h"

namespace tandem {

/// encode_png() in parts. The bytes do not depend on the number of threads.
class PngEncoder {
  public:
    /// As encode_png(). The pixels must outlive the object.
    PngEncoder(const ByteImageView& image, ImageMetadata metadata, int level);

    /// 1 unless ISA-L compresses.
    [[nodiscard]] std::size_t part_count() const { return strips_ ? strips_->count() : 1; }
    /// Encodes one part; any thread may do so, different parts at the same time.
    void encode(std::size_t part);
    /// The file, once all parts are encoded. Call once.
    [[nodiscard]] Bytes finish();

  private:
    ByteImageView image_;
    ImageMetadata metadata_;
    int level_;
    std::optional<PngStrips> strips_;
    Bytes whole_;  ///< without strips
};

}  // namespace tandem
