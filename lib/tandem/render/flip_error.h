/// The FLIP between a film and the image that it converges to, estimated from the film alone.
#pragma once

#include <vector>

#include "tandem/images/display.h"
#include "tandem/render/allotment.h"
#include "tandem/render/tiled_film.h"

namespace tandem {

/// The expected sums of FLIP over the pixels of each tile, and how they fall with the number of samples. `all`: the
/// film of all samples, with the plane variance; `fresh`: of each tile, the film of its last samples, some of them but
/// not all. Every tile must have samples. The same bits on every machine.
///
/// A parametric bootstrap: the FLIP between the truth and the truth with the film's noise is taken to be that between
/// an estimate of the truth and the same with noise like the film's. (B. Efron, R. Tibshirani, "An Introduction to
/// the Bootstrap", 1993, section 6.5.)
/// - The estimate of the truth is the film, smoothed where its values spread no more than their noise does: in a window
///   of 5 x 5 pixels with the mean m and the variance s^2 of values and the mean v of the variances of their noise, the
///   value x becomes m + max(0, 1 - v / s^2) (x - m). (J.-S. Lee, "Digital Image Enhancement and Noise Filtering by Use
///   of Local Statistics", IEEE PAMI 2 (2), 1980.) Noise in both images would hide differences of edges and points. In
///   windows of 9 x 9 and then of 17 x 17 pixels whose s^2 is not significantly above v, the value becomes m, and the
///   variance of the pixel's noise v. Otherwise the little noise that a smooth region kept would be clipped next to
///   white, as the film's is, and the variance estimated from few samples is inaccurate.
/// - The noise of a pixel is a random combination of the differences between the means of fresh and of other samples,
///   of the pixel and its eight neighbours: so the channels are correlated as in the film. Each channel is scaled to
///   the variance of the pixel's mean, or to v.
/// Two such films give the estimate. Their differences in blocks of 16 x 16 pixels, which are about independent, give
/// its variance and that of the film at hand; `squares` is such that estimate_error() has the interval of both. A third
/// film, with the first one's noise at twice as many samples, gives the exponent.
[[nodiscard]] std::vector<TileErrors> flip_errors(const TiledFilm& all, const std::vector<Film>& fresh,
                                                  const Display& display);

}  // namespace tandem
