/// Names of the files of an image sequence.
#pragma once

#include <cstdint>
#include <string>

namespace tandem {

/// A path whose last part may hold one place for the frame number: "%d", "%04d" (any width from 1 to 9) or a run of
/// "#", one for each digit. Numbers are padded with zeros; longer ones are written whole.
class FramePattern {
  public:
    /// Throws InputError if there is more than one place.
    explicit FramePattern(const std::string& path);

    [[nodiscard]] bool has_frame() const { return has_frame_; }
    /// The file of a frame; the path itself where there is no place.
    [[nodiscard]] std::string path(std::uint32_t frame) const;

  private:
    std::string before_;
    std::string after_;
    int digits_ = 0;
    bool has_frame_ = false;
};

}  // namespace tandem
