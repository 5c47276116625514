/// FLIP: how different two images look to a person who flips between them.
///
/// LDR-FLIP: P. Andersson, J. Nilsson, T. Akenine-Moeller, M. Oskarsson, K. Astroem, M. D. Fairchild, "FLIP: A
/// Difference Evaluator for Alternating Images", Proceedings of the ACM on Computer Graphics and Interactive
/// Techniques 3 (2), High-Performance Graphics 2020. Both images are blurred as by the eye, with separate contrast
/// sensitivities for lightness, red-green and blue-yellow. The results are compared in CIELAB with Hunt's adjustment,
/// and differences of edges and points are amplified. Computed in double, with the same bits on every machine.
#pragma once

#include <memory>
#include <vector>

#include "tandem/images/display.h"
#include "tandem/images/image.h"

namespace tandem {

namespace flip_detail {
struct Seen;
}

struct FlipOptions {
    double pixels_per_degree =
        67;  ///< of the visual angle: a 4K screen of 0.7 m width at 0.7 m distance, as the paper's
    Display display{};
};

struct FlipDifference {
    int width = 0;
    int height = 0;
    std::vector<double> errors;  ///< by pixel, from 0 (cannot be told apart) to 1
    double mean = 0;
};

/// A linear image that others are compared with. The comparisons share the half of the work that is about this image.
/// May be used by several threads at once.
class FlipReference {
  public:
    /// Throws as flip().
    explicit FlipReference(const FloatImage& image, const FlipOptions& options = {});
    /// flip() of both.
    [[nodiscard]] FlipDifference difference(const FloatImage& image) const;

  private:
    FlipOptions options_;
    int width_, height_;
    std::shared_ptr<const flip_detail::Seen> seen_;
};

/// Compares linear images as a screen shows them in PNG and PPM files with this display, interpreting every file as
/// sRGB. Values are clamped, but not rounded to levels. A NaN is black. Symmetric. Throws InputError if the sizes
/// differ or are zero, or if the number of pixels per degree is not above 0 and at most 1000.
[[nodiscard]] FlipDifference flip(const FloatImage& a, const FloatImage& b, const FlipOptions& options = {});

/// The errors as colours, from black (0) over violet and orange to pale yellow (1). The values are already meant for
/// the screen: write them with TransferFunction::linear.
[[nodiscard]] FloatImage flip_map(const FlipDifference& difference);

}  // namespace tandem
