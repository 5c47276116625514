/// What the accuracy report varies.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "tandem/effects/names.h"
#include "tandem/kernel/path_limits.h"
#include "tandem/kernel/sampler/pixel_filter.h"
#include "tandem/kernel/sampler/sampler_kind.h"
#include "tandem/render/tier.h"
#include "tandem/scene/scene.h"

namespace tandem::bench {

/// What differs from the baseline: the tier strict with independent samples, the filter box, all effects, default
/// limits and analytic shapes. Every setting is rendered with every number of samples.
enum class Axis { baseline, tier, effects, depth, tessellation, rasterised, denoised, sampler, filter };
inline constexpr std::array all_axes = {Axis::baseline, Axis::tier,         Axis::effects,
                                        Axis::depth,    Axis::tessellation, Axis::rasterised,
                                        Axis::denoised, Axis::sampler,      Axis::filter};

[[nodiscard]] const char* to_string(Axis axis);

struct Setting {
    Axis axis = Axis::baseline;
    std::string name;  ///< "strict", "without shadows", "limits 2,4,1", "80 triangles a sphere"
    Tier tier = Tier::strict;
    Sampler sampler = Sampler::random;
    PixelFilter filter = PixelFilter::box;
    ForcedEffects forced{};
    PathLimits limits{};
    std::optional<int> level{};  ///< of tessellation
};

/// Whether a setting is measured on a backend: the rasteriser runs on the CPU alone, and is compared with it.
[[nodiscard]] bool runs_on(const Setting& setting, const std::string& backend);

/// Whether the images of a setting approximate the image of the baseline. Those of another filter approximate another
/// image, from which their errors are measured: they say how noisy an image is, not which filter to choose.
[[nodiscard]] inline bool has_the_image_of_the_baseline(const Setting& setting) {
    return setting.filter == PixelFilter::box;
}

/// The limits of references: paths end by themselves.
inline constexpr PathLimits unlimited{255, 255, 255};

struct VariedAxes {
    std::vector<Tier> tiers;  ///< without strict, the baseline is the first of them
    bool samplers = true;
    bool filters = true;
    bool effects = true;
    bool depth = true;
    bool tessellation = true;
    std::vector<int> levels = {1, 3, 5};  ///< of tessellation
    bool rasterised = true;
    bool denoised = true;
    std::string no_denoiser{};  ///< why there is none; empty if there is one
};

/// "tier,effects": every name but samples, which are always varied, and baseline. Throws InputError that lists them.
[[nodiscard]] VariedAxes parse_axes(const std::vector<std::string>& names, std::vector<Tier> tiers);

struct SettingPlan {
    std::vector<Setting> settings;     ///< the baseline first
    std::vector<std::string> skipped;  ///< what was not varied, in sentences
    std::vector<std::string> biases;   ///< of settings that show less than the scene, in sentences
};

/// The settings of a scene, for frame 0.
[[nodiscard]] SettingPlan plan_settings(const Scene& scene, const VariedAxes& axes);

}  // namespace tandem::bench
