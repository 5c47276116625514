#include "cuda/scene_kernels.h"

#include <fmt/format.h>

#include <exception>
#include <limits>
#include <utility>

#include "cuda/cubin_facts.h"
#include "cuda/specialise.h"
#include "cuda/staged_memory.h"
#include "tandem/base/error.h"
#include "tandem/base/seconds.h"
#include "tandem/kernel/surface_lobes.h"

namespace tandem::cuda {

// Embedded by tandem_add_lto_kernels() and tandem_add_compiled_kernels().
#define TANDEM_TIER(name, promise)                         \
    std::span<const std::byte> linked_short_few_##name();  \
    std::span<const std::byte> linked_short_loop_##name(); \
    std::span<const std::byte> linked_short_bvh_##name();  \
    std::span<const std::byte> linked_long_few_##name();   \
    std::span<const std::byte> linked_long_loop_##name();  \
    std::span<const std::byte> linked_long_bvh_##name();   \
    TANDEM_COMPILED(plain, name)                           \
    TANDEM_COMPILED(direct, name)                          \
    TANDEM_COMPILED(full, name)
#define TANDEM_COMPILED(variant, name)                                    \
    std::span<const std::byte> compiled_##variant##_few_##name();         \
    std::span<const std::byte> compiled_##variant##_loop_##name();        \
    std::span<const std::byte> compiled_##variant##_loop_bodies_##name(); \
    std::span<const std::byte> compiled_##variant##_bvh_##name();         \
    std::span<const std::byte> compiled_##variant##_bvh_bodies_##name();
#include "tandem/render/tiers.def"
#undef TANDEM_COMPILED
#undef TANDEM_TIER

// Scenes of instances: the tier fast has the kernels of strict.
#define TANDEM_INSTANCED_TIER(name)                                \
    std::span<const std::byte> linked_short_instanced_##name();    \
    std::span<const std::byte> linked_long_instanced_##name();     \
    std::span<const std::byte> compiled_plain_instanced_##name();  \
    std::span<const std::byte> compiled_direct_instanced_##name(); \
    std::span<const std::byte> compiled_full_instanced_##name();
TANDEM_INSTANCED_TIER(strict)
TANDEM_INSTANCED_TIER(precise)
#undef TANDEM_INSTANCED_TIER

static_assert(any_sampler == LinkedFacts::any && any_filter == LinkedFacts::any);

namespace {

constexpr const char* kernel_name = "tandem_render";

bool has_hierarchy(Structure structure) { return structure == Structure::bvh || structure == Structure::instanced; }
/// Whether the threads of a warp share pixels.
bool has_hierarchy(const DeviceSceneView& scene) { return has_hierarchy(structure_of(scene)); }

/// The tier whose kernels render.
Tier kernel_tier(Tier tier, Structure structure) {
    return structure == Structure::instanced && tier == Tier::fast ? Tier::strict : tier;
}

std::span<const std::byte> linked_code(Tier tier, Structure structure, bool is_long) {
    if (structure == Structure::instanced) {
        if (tier == Tier::precise) return is_long ? linked_long_instanced_precise() : linked_short_instanced_precise();
        return is_long ? linked_long_instanced_strict() : linked_short_instanced_strict();
    }
    switch (tier) {
#define TANDEM_TIER(name, promise)                                                       \
    case Tier::name:                                                                     \
        switch (structure) {                                                             \
            case Structure::few:                                                         \
                return is_long ? linked_long_few_##name() : linked_short_few_##name();   \
            case Structure::loop:                                                        \
                return is_long ? linked_long_loop_##name() : linked_short_loop_##name(); \
            case Structure::bvh:                                                         \
                return is_long ? linked_long_bvh_##name() : linked_short_bvh_##name();   \
            case Structure::instanced:                                                   \
                break;                                                                   \
        }                                                                                \
        break;
#include "tandem/render/tiers.def"
#undef TANDEM_TIER
    }
    return {};
}

/// Whether kernels with these effects are for long paths. The threads of a block then take pixels from a queue
/// together.
bool has_queue(EffectMask effects) { return effects.has_any(synchronising_effects); }
bool has_queue(const LinkedFacts& facts) { return has_queue(EffectMask::from_bits(facts.effects)); }

/// The most registers of a thread; 0: as the launch bounds of a kernel without a queue say. A multiprocessor has room
/// for 12 warps with 168 registers and for 16 with 128. Long code with doubles is faster with fewer warps and fewer
/// spills; measured for the tier strict by effects (docs/performance/paths.md, "Registers of kernels for long paths").
int most_registers(Tier tier, EffectMask effects, bool in_stages) {
    constexpr int for_12_warps = 168, for_16_warps = 128;
    if (!has_queue(effects)) return 0;
    switch (tier) {
        case Tier::fast:
            return for_16_warps;
        case Tier::precise:
            return for_12_warps;
        case Tier::strict:
            break;
    }
    // measured on whitted.gltf, the one scene with such paths in stages: more warps are worth more than fewer spills
    if (in_stages && effects.has_any(Effect::reflection | Effect::refraction)) return for_16_warps;
    const bool lights_diffuse_paths = effects.has(Effect::indirect) && effects.has(Effect::shadows);
    return lights_diffuse_paths || effects.has_any(effects_of_local_lobes) ? for_12_warps : for_16_warps;
}

/// For a tier that TANDEM_COMPILED_TIERS leaves out. `why_not_linked`: empty if a kernel could be linked for the scene.
EnvironmentError not_compiled(Tier tier, const std::string& why_not_linked) {
    return EnvironmentError(fmt::format(
        "this build has no kernels compiled ahead of time for the tier {0} (TANDEM_COMPILED_TIERS){1}. Choose another "
        "tier, link kernels for the scene (--specialise always), or build with {0} in TANDEM_COMPILED_TIERS",
        to_string(tier), why_not_linked.empty() ? "" : ", and none can be linked for the scene: " + why_not_linked));
}

/// With more lights than this their number is not a constant, since the loop over them would not be unrolled anyway.
constexpr std::uint32_t most_linked_lights = 4;

}  // namespace

LinkedFacts linked_facts(const SceneView& scene, EffectMask effects, const PathLimits& limits, Sampler sampler,
                         PixelFilter filter) {
    LinkedFacts facts;
    facts.sampler = static_cast<std::uint32_t>(sampler);
    facts.filter = static_cast<std::uint32_t>(filter);
    facts.effects = effects.bits();
#define TANDEM_PRIMITIVE(Type, name, names) \
    if (scene.name##_count > 0) facts.kinds |= PrimitiveKinds::name;
#include "tandem/kernel/view/primitives.def"
#undef TANDEM_PRIMITIVE
    if (effects.has(Effect::area_lights)) {
        facts.light_kinds = scene.area_light_kinds;
        const auto known = scene.area_light_count > 1    ? KnownAreaLights::several
                           : scene.area_light_count == 1 ? KnownAreaLights::one
                                                         : KnownAreaLights::unknown;
        facts.area_lights = static_cast<std::uint32_t>(known);
    }
    if (effects.has(Effect::cutouts)) {
        facts.cutout_kinds = scene.cutout_kinds;
        facts.masked_kinds = scene.masked_kinds;
    }
    if (effects.has_any(Effect::textures | Effect::normal_maps | Effect::cutouts | Effect::anisotropy)) {
        facts.several_slots = scene.several_slots;
    }
    facts.lights = scene.light_count <= most_linked_lights ? scene.light_count : LinkedFacts::any;
    const bool glass = effects.has(Effect::refraction);
    if (effects.has_any(effects_of_reflections)) facts.reflection = limits.reflection;
    if (glass) facts.refraction = limits.refraction;
    if (effects.has(Effect::indirect)) facts.diffuse = limits.diffuse;
    return facts;
}

JitInput render_input(Tier tier, Structure structure, const LinkedFacts& facts, int architecture) {
    JitInput input;
    input.code = linked_code(tier, structure, has_queue(facts));
    input.kernel = kernel_name;
    input.facts_name = "tandem_facts";
    input.facts = words_of(facts);
    input.tier = kernel_tier(tier, structure);
    input.registers = most_registers(input.tier, EffectMask::from_bits(facts.effects), facts.in_stages != 0);
    input.architecture = architecture;
    return input;
}

// The functions of a tier that is not compiled do not exist; only discarded statements name them.
std::span<const std::byte> compiled_code(Tier tier, Structure structure, bool faces, std::size_t variant) {
    static_assert(variant_count == 3, "TANDEM_OF_VARIANT and CMakeLists.txt know three");
#define TANDEM_OF_VARIANT(plain, direct, full) (variant == 0 ? (plain) : variant == 1 ? (direct) : (full))
    if (structure == Structure::instanced) {
        if (tier == Tier::precise) {
            if constexpr (TANDEM_IS_COMPILED_precise) {
                return TANDEM_OF_VARIANT(compiled_plain_instanced_precise(), compiled_direct_instanced_precise(),
                                         compiled_full_instanced_precise());
            }
        } else if constexpr (TANDEM_IS_COMPILED_strict) {
            return TANDEM_OF_VARIANT(compiled_plain_instanced_strict(), compiled_direct_instanced_strict(),
                                     compiled_full_instanced_strict());
        }
        return {};
    }
    switch (tier) {
#define TANDEM_TIER(name, promise)                                                                \
    case Tier::name:                                                                              \
        if constexpr (TANDEM_IS_COMPILED_##name) {                                                \
            return TANDEM_OF_VARIANT(TANDEM_COMPILED(plain, name), TANDEM_COMPILED(direct, name), \
                                     TANDEM_COMPILED(full, name));                                \
        }                                                                                         \
        break;
#define TANDEM_COMPILED(variant, name)                                                            \
    (structure == Structure::few ? compiled_##variant##_few_##name()                              \
     : structure == Structure::loop                                                               \
         ? faces ? compiled_##variant##_loop_##name() : compiled_##variant##_loop_bodies_##name() \
     : faces ? compiled_##variant##_bvh_##name()                                                  \
             : compiled_##variant##_bvh_bodies_##name())
#include "tandem/render/tiers.def"
#undef TANDEM_COMPILED
#undef TANDEM_TIER
#undef TANDEM_OF_VARIANT
    }
    return {};
}

// Measured on an H200 (docs/performance/paths.md, "Blocks of kernels for long paths"). Much of the code of exact tiers
// runs on few threads, so it may exceed the caches by more; in a loop over few primitives each thread uses more of it.
unsigned int queue_blocks(Tier tier, Structure structure, std::size_t code_bytes) {
    const std::size_t most = tier == Tier::fast ? 90'000 : has_hierarchy(structure) ? 150'000 : 120'000;
    return code_bytes > 0 && code_bytes <= most ? 2 : 1;
}

bool renders_in_stages(Tier tier, Structure structure, const LinkedFacts& facts, const SceneView& scene,
                       std::uint32_t width, std::uint32_t height) {
    constexpr std::uint32_t most_pixels_across = 1U << 16;  // a pixel is a word (cuda/stored_path.h)
    if (tier == Tier::fast || structure != Structure::loop) return false;
    if (!EffectMask::from_bits(facts.effects).has(Effect::indirect) || scene.indirect_light == 0) return false;
    return width <= most_pixels_across && height <= most_pixels_across;
}

StagedMemory staged_memory(Tier tier) {
    return tier == Tier::precise ? staged_memory_of<double>() : staged_memory_of<float>();
}

SceneKernels::SceneKernels(int architecture) : architecture_(architecture), cache_(kernel_cache_folder()) {}

SceneKernels::Found SceneKernels::find(Tier tier, const DeviceSceneView& scene, const LinkedFacts& facts) {
    const Structure structure = structure_of(scene);
    const auto [place, is_new] = kernels_.try_emplace({tier, structure, facts});
    Found found;
    const auto warn = [&](const std::string& text) {
        if (!text.empty() && !std::exchange(warned_, true)) found.warning = text;
    };
    if (is_new) {
        const Stopwatch watch;
        try {
            const JitInput input = render_input(tier, structure, facts, architecture_);
            const Specialised made = specialise(input, cache_);
            const auto cubin = cubin_facts(made.cubin, kernel_name);
            const std::size_t code_bytes = cubin ? cubin->code.size() : 0;
            const unsigned int blocks = has_queue(facts) ? queue_blocks(input.tier, structure, code_bytes) : 0;
            const StagedMemory staged = facts.in_stages != 0 ? staged_memory(input.tier) : StagedMemory{};
            place->second.reset(new SceneKernel{LoadedCode(made.cubin, kernel_name), blocks, staged,
                                                "rendering with a kernel linked for the scene"});
            if (!made.cache_problem.empty()) warn("kernel cache: " + made.cache_problem);
        } catch (const std::exception& error) {
            if (compiled_code(tier, structure, has_faces(scene.scene), 0).empty()) {
                kernels_.erase(place);
                throw not_compiled(kernel_tier(tier, structure), error.what());
            }
            warn(fmt::format("a kernel compiled ahead of time is used, because none can be linked for the scene: {}",
                             error.what()));
        }
        found.seconds = watch.seconds();
    }
    found.kernel = place->second.get();
    return found;
}

const SceneKernel& SceneKernels::compiled(Tier tier, const DeviceSceneView& scene, std::size_t variant) {
    const Structure structure = structure_of(scene);
    const bool faces = has_faces(scene.scene);
    auto& kernel = compiled_[{tier, structure, faces, variant}];
    if (kernel == nullptr) {
        const EffectMask effects = variants[variant].effects;
        const std::span<const std::byte> code = compiled_code(tier, structure, faces, variant);
        if (code.empty()) throw not_compiled(kernel_tier(tier, structure), why_jit_unavailable());
        const int registers = most_registers(kernel_tier(tier, structure), effects, false);
        // with all effects the code is too large for two blocks
        kernel.reset(
            new SceneKernel{LoadedCode(code, kernel_name, registers), has_queue(effects) ? 1U : 0U, {}, "rendering"});
    }
    return *kernel;
}

std::size_t radiance_bytes(const SceneKernel& kernel, const DeviceSceneView& scene) {
    if (kernel.staged.most_paths > 0) {
        return std::size_t{multiprocessor_count()} * kernel.staged.most_paths * kernel.staged.rare_bytes;
    }
    if (kernel.queue_blocks == 0 || !has_hierarchy(scene)) return 0;
    return std::size_t{multiprocessor_count()} * most_queue_threads * waiting_sets * sizeof(Vec3d);
}

void launch_render(const SceneKernel& kernel, const DeviceSceneView& scene, const PixelJob& job, std::uint32_t height,
                   bool culls_pixels, Vec3d* sums, void* radiances, DeviceCounters* counters, cudaStream_t stream) {
    PixelJob shared = job;
    if (has_hierarchy(scene)) {
        const bool is_instanced = structure_of(scene) == Structure::instanced;
        shared.sharing_threads = sharing_threads(
            job.samples, is_instanced ? std::numeric_limits<std::size_t>::max() : primitive_count(scene.scene));
    }
    const void* function = kernel.code.function();
    const RenderGrid grid = kernel.staged.most_paths > 0
                                ? staged_grid(function, kernel.staged, std::uint64_t{job.width} * height)
                            : kernel.queue_blocks > 0 ? pixel_queue(function, kernel.queue_blocks)
                            : has_hierarchy(scene)    ? shared_pixels(job.width, height, shared.sharing_threads)
                                                      : thread_per_pixel(job.width, height);
    const auto launch = [&](const auto& tracer) {
        kernel.code.launch(kernel.doing, grid, stream, tracer, shared, height, sums, radiances, counters);
    };
    switch (structure_of(scene)) {
        case Structure::few: {
            ConstantMemoryTracer tracer = scene.few;
            tracer.culls_pixels = culls_pixels;
            tracer.certain = make_certain_view(scene.certain, job.camera,
                                               {job.left, job.left + job.width, job.top, job.top + height});
            return launch(tracer);
        }
        case Structure::loop:
            return launch(LoopTracer{scene.scene});
        case Structure::instanced:
        case Structure::bvh:
            break;
    }
    const DeferringBvhTracer tracer = {{scene.scene, counting_bvh(scene, counters)}};
    if (structure_of(scene) == Structure::instanced) {
        return launch(InstancedTracer{{scene.instanced, tracer, scene.instanced_bvh}});
    }
    launch(tracer);
}

}  // namespace tandem::cuda
