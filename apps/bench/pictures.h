/// Images of benchmarks: files, and small ones for the pages.
#pragma once

#include <span>
#include <string>

#include "tandem/film/film.h"
#include "tandem/images/image.h"
#include "tandem/images/image_metadata.h"
#include "tandem/render/render_job.h"
#include "tandem/report/report.h"

namespace tandem::bench {

/// The metadata of a file, without the hashes, which cost more than the encoding and are in the report.
[[nodiscard]] ImageMetadata describe_picture(const RenderJob& job, const std::string& backend);

/// Writes an image in the format of the extension; .ppm becomes P3 text, as in the paper. `display`: Scene::display.
void write_picture(const std::string& path, Film film, const ImageMetadata& metadata, const Display& display);

/// A film of colours that Tandem did not render: 3 * width * height floats from the top left.
[[nodiscard]] Film film_of(std::span<const float> rgb, int width, int height);

/// An image for a page: shrunk by a whole factor to at most `most_width` pixels in width, each pixel the mean of those
/// it covers. `display`: Scene::display.
[[nodiscard]] Picture small_picture(const FloatImage& image, int most_width, const std::string& caption,
                                    const Display& display);

}  // namespace tandem::bench
