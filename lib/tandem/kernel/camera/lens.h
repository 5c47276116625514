/// The lens of a camera, as its author says it.
#pragma once

namespace tandem {

/// A thin lens: what lies at `focus_distance`, metres along the axis, is sharp. Radius 0 is a pinhole.
struct Lens {
    double aperture_radius = 0;  ///< metres
    double focus_distance = 1;   ///< metres
    int blades = 0;              ///< corners of the aperture, 3 to 32; 0: round
    double rotation = 0;         ///< of its first corner from the right to above, radians
};

}  // namespace tandem
