/// A request to render a frame.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "tandem/film/film_planes.h"
#include "tandem/kernel/path_limits.h"
#include "tandem/kernel/sampler/pixel_filter.h"
#include "tandem/kernel/sampler/sampler_kind.h"
#include "tandem/render/tier.h"

namespace tandem {

/// A part of the film: pixels from the top left corner of the film.
struct FilmWindow {
    int left = 0, top = 0;
    int width = 0, height = 0;
};

struct RenderJob {
    int width = 1000;   ///< pixels, 1 to 65536
    int height = 900;   ///< pixels, 1 to 65536
    int samples = 100;  ///< per pixel, 1 to 2^24
    std::uint64_t seed = 0;
    std::uint32_t frame = 0;   ///< random numbers differ from frame to frame
    Tier tier = Tier::strict;  ///< must be the tier that the scene was loaded for
    PathLimits limits{};
    Sampler sampler = Sampler::random;  ///< samplers other than random have no variance plane
    PixelFilter filter = PixelFilter::box;
    int first_sample = 0;  ///< films of samples [0, a) and [a, b) add up to one of b samples, except for rounding
    PlaneMask planes{};    ///< the planes of the film beside the colour
    /// The pixels to render, if not all. The film that comes back has the window's size, and its pixels have the bits
    /// that they have in the whole film.
    std::optional<FilmWindow> window{};
};

/// The job's window, or the whole film.
[[nodiscard]] FilmWindow window_of(const RenderJob& job);

/// Formats limits as "8,16,4": reflections, refractions, diffuse bounces.
[[nodiscard]] std::string to_string(const PathLimits& limits);

/// Parses the same. Throws InputError.
[[nodiscard]] PathLimits parse_limits(const std::string& text);

/// Throws InputError that names an invalid field.
void check(const RenderJob& job);

/// The same, and checks that the scene was loaded for the job's tier.
void check(const RenderJob& job, Tier loaded_for);

}  // namespace tandem
