/// How different two pictures look to a person who flips between them.
///
/// LDR-FLIP: P. Andersson, J. Nilsson, T. Akenine-Moeller, M. Oskarsson, K. Astroem, M. D. Fairchild, "FLIP: A
/// Difference Evaluator for Alternating Images", Proceedings of the ACM on Computer Graphics and Interactive
/// Techniques 3 (2), High-Performance Graphics 2020. Both pictures are blurred as the eye blurs them, by a contrast
/// sensitivity of its own for lightness and for each pair of colours; what is left is compared in CIELAB with Hunt's
/// adjustment, and made larger where edges and points differ. Computed in double.
#pragma once

#include <vector>

#include "tandem/images/display.h"
#include "tandem/images/image.h"

namespace tandem {

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

/// Of linear pictures as PNG and PPM files with this display show them on a screen, which takes every file for sRGB:
/// what is compared is the light that leaves it. Clamped, but not rounded to levels. A NaN is black. Symmetric. Throws
/// InputError if the sizes differ or are zero, or if there are not more than 0 and at most 1000 pixels to the degree.
[[nodiscard]] FlipDifference flip(const FloatImage& a, const FloatImage& b, const FlipOptions& options = {});

/// The errors as colours, from black (0) over violet and orange to pale yellow (1). They are what a screen is given:
/// write them with TransferFunction::linear.
[[nodiscard]] FloatImage flip_map(const FlipDifference& difference);

}  // namespace tandem
