/// Names of the files of an image sequence.
#pragma once

#include <cstdint>
#include <string>

namespace tandem {

/// A path whose last part may contain one placeholder for the frame number: "%d", "%04d" (any width from 1 to 9) or a
/// run of "#", one for each digit. Numbers are padded with zeros; longer ones are not cut.
class FramePattern {
  public:
    /// Throws InputError if there is more than one placeholder.
    explicit FramePattern(const std::string& path);

    [[nodiscard]] bool has_frame() const { return has_frame_; }
    /// The file of a frame; the path itself if there is no placeholder.
    [[nodiscard]] std::string path(std::uint32_t frame) const;

  private:
    std::string before_;
    std::string after_;
    int digits_ = 0;
    bool has_frame_ = false;
};

}  // namespace tandem
