/// How a scene is rendered, as opposed to what it contains.
#pragma once

namespace tandem {

/// RenderJob::limits bounds the length of paths.
struct RenderSettings {
    bool area_lights = true;           ///< sample points of emissive surfaces; without it only paths find them
    bool area_light_shadows = true;    ///< also of the background
    bool roulette = true;              ///< Russian roulette for long paths of indirect light
    bool solids_are_disjoint = false;  ///< assume that dielectric solids are disjoint
};

}  // namespace tandem
