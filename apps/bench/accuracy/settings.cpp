#include "accuracy/settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "accuracy/accuracy_scenes.h"
#include "baseline/raster_scene.h"
#include "tandem/base/error.h"
#include "tandem/compile/derive.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/render/pixel_filter_names.h"
#include "tandem/render/render_job.h"
#include "tandem/render/sampler_names.h"

namespace tandem::bench {

namespace {

constexpr std::array axis_names = {"baseline",   "tier",     "effects", "depth", "tessellation",
                                   "rasterised", "denoised", "sampler", "filter"};
constexpr std::array<PathLimits, 3> varied_limits = {PathLimits{0, 0, 0}, PathLimits{2, 4, 1}, unlimited};

void add_samplers(Setting base, SettingPlan& plan) {
    base.axis = Axis::sampler;
    for (const SamplerInfo& info : sampler_infos()) {
        if (info.sampler == base.sampler) continue;
        base.name = info.name;
        base.sampler = info.sampler;
        plan.settings.push_back(base);
    }
}

void add_filters(Setting base, SettingPlan& plan) {
    base.axis = Axis::filter;
    for (const PixelFilterInfo& info : pixel_filter_infos()) {
        if (info.filter == base.filter) continue;
        base.name = info.name;
        base.filter = info.filter;
        plan.settings.push_back(base);
    }
    plan.biases.emplace_back(
        "A filter is a choice of the image, not of its accuracy: another filter has another converged image. So the "
        "error of a filter is measured against references with the same filter, and is noise alone.");
}

void add_effects(const std::vector<EffectNeed>& needs, Setting base, SettingPlan& plan) {
    if (needs.empty()) plan.skipped.emplace_back("Effects: the scene needs none.");
    base.axis = Axis::effects;
    for (const EffectNeed& need : needs) {
        base.name = fmt::format("without {}", to_string(need.effect));
        base.forced = {{}, need.effect};
        plan.settings.push_back(base);
    }
}

void add_depths(const std::vector<EffectNeed>& needs, Setting base, SettingPlan& plan) {
    if (!mask_of(needs).has_any(bouncing_effects)) {
        plan.skipped.emplace_back("Depth: every path of the scene has one vertex.");
        return;
    }
    base.axis = Axis::depth;
    for (const PathLimits& limits : varied_limits) {
        base.name = fmt::format("limits {}", to_string(limits));
        base.limits = limits;
        plan.settings.push_back(base);
    }
}

void add_tessellations(const Scene& scene, const std::vector<int>& levels, Setting base, SettingPlan& plan) {
    if (!tessellated_twin(scene, 0)) {
        plan.skipped.emplace_back(
            "Tessellation: the scene has no sphere, or one with a texture that follows the sphere's own coordinates.");
        return;
    }
    base.axis = Axis::tessellation;
    for (const int level : levels) {
        base.name = fmt::format("{} triangles a sphere", triangles_per_sphere(level));
        base.level = level;
        plan.settings.push_back(base);
    }
}

/// The rasteriser, the rung below ray tracing, and the effects that it leaves out.
void add_rasteriser(const PreparedScene& prepared, const std::vector<EffectNeed>& needs, Setting base,
                    SettingPlan& plan) {
    if (const std::string reason = why_not_rasterised(prepared); !reason.empty()) {
        plan.skipped.push_back(fmt::format("Rasterised: {}.", reason));
        return;
    }
    base.axis = Axis::rasterised;
    base.name = "rasterised";
    plan.settings.push_back(base);
    std::vector<std::string> lacks;
    for (const EffectNeed& need : needs) {
        if (need.effect != Effect::roulette && !rasterised_effects.has(need.effect)) {
            lacks.emplace_back(to_string(need.effect));
        }
    }
    plan.biases.push_back(fmt::format(
        "Rasterised images come without a ray: first hits from a z-buffer, direct light without shadows, spheres of "
        "triangles. The program is plain and runs on the CPU; its time says nothing about a GPU's rasteriser. {}",
        lacks.empty() ? std::string("This scene needs no effect that it leaves out.")
                      : fmt::format("It leaves out what this scene needs: {}.", fmt::join(lacks, ", "))));
}

void add_denoiser(const VariedAxes& axes, Setting base, SettingPlan& plan) {
    if (!axes.no_denoiser.empty()) {
        plan.skipped.push_back(fmt::format("Denoised: not run. {}", axes.no_denoiser));
        return;
    }
    base.axis = Axis::denoised;
    base.name = "denoised (biased)";
    plan.settings.push_back(base);
    plan.biases.emplace_back(
        "Denoised images are biased: their error is smooth, not noise, and cannot be estimated from a single image. "
        "Their time includes the planes of albedo and normals, and the denoiser.");
}

}  // namespace

bool runs_on(const Setting& setting, const std::string& backend) {
    return setting.axis != Axis::rasterised || backend == "cpu";
}

const char* to_string(Axis axis) { return axis_names[static_cast<std::size_t>(axis)]; }

VariedAxes parse_axes(const std::vector<std::string>& names, std::vector<Tier> tiers) {
    if (tiers.empty()) throw InputError("accuracy needs a tier: fast, strict or precise");
    VariedAxes axes{
        .tiers = std::move(tiers), .samplers = false, .effects = false, .depth = false, .tessellation = false};
    axes.filters = axes.rasterised = axes.denoised = false;
    bool varies_tier = false;
    for (const std::string& name : names) {
        if (name == "tier") {
            varies_tier = true;
        } else if (name == "sampler") {
            axes.samplers = true;
        } else if (name == "filter") {
            axes.filters = true;
        } else if (name == "effects") {
            axes.effects = true;
        } else if (name == "depth") {
            axes.depth = true;
        } else if (name == "tessellation") {
            axes.tessellation = true;
        } else if (name == "rasterised") {
            axes.rasterised = true;
        } else if (name == "denoised") {
            axes.denoised = true;
        } else if (name != "samples") {
            throw InputError(
                fmt::format("no axis \"{}\"; there are samples, sampler, filter, tier, effects, depth, "
                            "tessellation, rasterised and denoised",
                            name));
        }
    }
    const auto strict = std::find(axes.tiers.begin(), axes.tiers.end(), Tier::strict);
    if (strict != axes.tiers.end()) std::rotate(axes.tiers.begin(), strict, strict + 1);
    if (!varies_tier) axes.tiers.resize(1);
    return axes;
}

SettingPlan plan_settings(const Scene& scene, const VariedAxes& axes) {
    SettingPlan plan;
    for (const Tier tier : axes.tiers) {
        plan.settings.push_back(
            {.axis = plan.settings.empty() ? Axis::baseline : Axis::tier, .name = to_string(tier), .tier = tier});
    }
    const Setting base = plan.settings.front();
    const PreparedScene prepared = prepare(scene);
    const std::vector<EffectNeed> needs = derive_effects(scene, prepared);
    if (axes.tiers.size() == 1) plan.skipped.emplace_back("Tier: not asked for.");
    axes.samplers ? add_samplers(base, plan) : void(plan.skipped.emplace_back("Sampler: not asked for."));
    axes.filters ? add_filters(base, plan) : void(plan.skipped.emplace_back("Filter: not asked for."));
    axes.effects ? add_effects(needs, base, plan) : void(plan.skipped.emplace_back("Effects: not asked for."));
    axes.depth ? add_depths(needs, base, plan) : void(plan.skipped.emplace_back("Depth: not asked for."));
    axes.tessellation ? add_tessellations(scene, axes.levels, base, plan)
                      : void(plan.skipped.emplace_back("Tessellation: not asked for."));
    axes.rasterised ? add_rasteriser(prepared, needs, base, plan)
                    : void(plan.skipped.emplace_back("Rasterised: not asked for."));
    axes.denoised ? add_denoiser(axes, base, plan) : void(plan.skipped.emplace_back("Denoised: not asked for."));
    return plan;
}

}  // namespace tandem::bench
