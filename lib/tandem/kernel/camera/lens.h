/// The lens of a camera, as authored.
#pragma once

namespace tandem {

/// A thin lens, in focus at `focus_distance` metres along the axis. Radius 0 is a pinhole.
struct Lens {
    double aperture_radius = 0;  ///< metres
    double focus_distance = 1;   ///< metres
    int blades = 0;              ///< corners of the aperture, 3 to 32; 0: round
    double rotation = 0;         ///< of the first corner, from right towards up, radians
};

}  // namespace tandem
