/// EXR files as other programs write them, in memory.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tandem/base/whole_file.h"
#include "tandem/images/image.h"

namespace tandem::test {

enum class ExrLayout { scan_lines, tiles, mip_map, rip_map };
enum class ExrValues { whole, half, single };  ///< the pixel types of EXR: UINT, HALF and FLOAT

struct ExrOptions {
    std::string compression = "zip";
    ExrLayout layout = ExrLayout::scan_lines;  ///< tiles are 4 x 3 pixels
    ExrValues values = ExrValues::half;
    std::vector<std::string> channels = {"R", "G", "B"};  ///< x, y, z of the pixels, and x again for any more
    int left = 0;  ///< of the data window; the display window is 100 x 100 from 0, 0
    int top = 0;
    bool bottom_up = false;  ///< the order of lines or tiles in the file
    int sampling = 1;        ///< the first channel has a value for every so many pixels, in both directions
    bool multipart = false;  ///< a second part follows, with x, y, z exchanged for y, z, x
};

/// Every compression that OpenEXR 3.1 writes.
[[nodiscard]] std::vector<std::string> exr_compressions();

[[nodiscard]] Bytes write_exr(const FloatImage& image, const ExrOptions& options);

/// One sample in every pixel; with `multipart`, as the first of two parts.
[[nodiscard]] Bytes write_deep_exr(bool multipart);

/// All channels of the only part, by name.
struct ExrChannels {
    std::map<std::string, std::vector<float>> floats;           ///< FLOAT
    std::map<std::string, std::vector<std::uint32_t>> numbers;  ///< UINT
};
[[nodiscard]] ExrChannels read_exr_channels(const std::string& path);

/// A ramp of small whole numbers: halves hold them exactly, and lossy compressions nearly.
[[nodiscard]] FloatImage exr_ramp(int width, int height);

}  // namespace tandem::test
