/// The exposure that suits a picture, where nobody says one.
#pragma once

#include "tandem/images/image.h"

namespace tandem {

/// In stops (Display::exposure_stops), a multiple of a tenth. Two rules, of which the darker one holds:
/// - The geometric mean of the luminances becomes middle grey, 0.18. It is taken between the 10th and the 90th
/// percentile,
///   so that neither a few bright pixels nor a few dark ones decide.
/// - No more than a twentieth of the pixels is brighter than white, 1.
/// Pixels that are black, or have a channel that is not finite, do not count; where none is left the exposure is 0.
/// The same bits on every machine. The first rule is that of E. Reinhard, M. Stark, P. Shirley, J. Ferwerda,
/// "Photographic Tone Reproduction for Digital Images", SIGGRAPH 2002, section 3.1, but for the percentiles.
[[nodiscard]] double auto_exposure(const FloatImage& image);

}  // namespace tandem
