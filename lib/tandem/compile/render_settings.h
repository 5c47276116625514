/// How a scene is rendered, as opposed to what is in it.
#pragma once

namespace tandem {

/// The length of paths is in RenderJob::limits.
struct RenderSettings {
    bool area_lights = true;           ///< sample points of emissive surfaces; without it only paths find them
    bool area_light_shadows = true;    ///< also of the background
    bool roulette = true;              ///< play Russian roulette with long paths, where there is indirect light
    bool solids_are_disjoint = false;  ///< take bodies of glass for apart, even if they touch or hold one another
};

}  // namespace tandem
