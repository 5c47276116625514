/// Automatic exposure.
#pragma once

#include "tandem/images/image.h"

namespace tandem {

/// The exposure of an image in stops (Display::exposure_stops), a multiple of a tenth. The darker result of two rules:
/// - The geometric mean of the luminances becomes middle grey, 0.18. It is the mean between the 10th and the 90th
///   percentile, so that neither a few bright pixels nor a few dark ones decide.
/// - At most a twentieth of the pixels is brighter than white, 1.
///
/// Pixels that are black, or have a channel that is not finite, do not count; if none is left the exposure is 0. The
/// same bits on every machine. Source of the first rule, except for the percentiles: E. Reinhard, M. Stark, P. Shirley,
/// J. Ferwerda, "Photographic Tone Reproduction for Digital Images", SIGGRAPH 2002, section 3.1.
[[nodiscard]] double auto_exposure(const FloatImage& image);

}  // namespace tandem
