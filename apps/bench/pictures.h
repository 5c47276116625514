/// Pictures of benchmarks: files, and small ones for pages.
#pragma once

#include <span>
#include <string>

#include "tandem/film/film.h"
#include "tandem/images/image.h"
#include "tandem/images/image_metadata.h"
#include "tandem/render/render_job.h"
#include "tandem/report/report.h"

namespace tandem::bench {

/// The metadata of a file, without the hashes: they cost more than the encoding and are in the report.
[[nodiscard]] ImageMetadata describe_picture(const RenderJob& job, const std::string& backend);

/// By the extension; .ppm becomes P3 text, as the paper wrote it. `display`: Scene::display.
void write_picture(const std::string& path, Film film, const ImageMetadata& metadata, const Display& display);

/// A film of colours that Tandem did not render: 3 * width * height floats from the top left.
[[nodiscard]] Film film_of(std::span<const float> rgb, int width, int height);

/// For a page: shrunk by whole steps until it is at most `most_width` pixels wide, each pixel the mean of those it
/// covers. `display`: Scene::display.
[[nodiscard]] Picture small_picture(const FloatImage& image, int most_width, const std::string& caption,
                                    const Display& display);

}  // namespace tandem::bench
