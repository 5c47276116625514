// The render kernel as it is linked for sets of effects: what is absent takes no code and no registers. Needs no GPU;
// writes kernel_masks.json beside the test.
#include "cuda/scene_kernels.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "cuda/cubin_facts.h"
#include "tandem/compile/derive.h"
#include "tandem/effects/names.h"

namespace tandem::cuda {
namespace {

constexpr int architecture = TANDEM_LTO_ARCHITECTURE > 90 ? TANDEM_LTO_ARCHITECTURE : 90;
const std::uint32_t spheres = PrimitiveKinds::sphere;

struct LinkedSize {
    int registers = 0, stack_bytes = 0;
    std::size_t code_bytes = 0;
};

class SceneKernel : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!why_jit_unavailable().empty()) GTEST_SKIP() << why_jit_unavailable();
    }

    [[nodiscard]] static LinkedFacts facts(EffectMask effects, std::uint32_t lights = 1,
                                           Sampler sampler = Sampler::random, PixelFilter filter = PixelFilter::box) {
        SceneView scene{};
        scene.sphere_count = 3;
        scene.light_count = lights;
        scene.cutout_kinds = scene.masked_kinds = spheres;  // if the effect is simulated
        return linked_facts(scene, effects, PathLimits{}, sampler, filter);
    }
    /// Linked once for all tests of the program.
    static const std::vector<std::byte>& cubin(const LinkedFacts& facts, Structure structure) {
        static std::map<std::pair<Structure, LinkedFacts>, std::vector<std::byte>> known;
        const auto [place, is_new] = known.try_emplace({structure, facts});
        if (is_new) place->second = link(render_input(Tier::strict, structure, facts, architecture));
        return place->second;
    }
    static LinkedSize linked(const LinkedFacts& facts, Structure structure = Structure::few) {
        const JitInput input = render_input(Tier::strict, structure, facts, architecture);
        const auto of = cubin_facts(cubin(facts, structure), input.kernel);
        return {of->registers, of->stack_bytes, of->code.size()};
    }
    /// How often the whole of a linked cubin, with the functions that its kernel calls, has a constant.
    static int occurrences(std::uint32_t constant, const LinkedFacts& facts, Structure structure) {
        const std::vector<std::byte>& code = cubin(facts, structure);
        int found = 0;
        for (std::size_t at = 0; at + sizeof constant <= code.size(); at += sizeof constant) {
            found += std::memcmp(code.data() + at, &constant, sizeof constant) == 0 ? 1 : 0;
        }
        return found;
    }
    /// Of one that only the Sobol samplers use: the first factor of the nested permutation (kernel/sampler/sobol.h).
    static int sobol_constants(const LinkedFacts& facts, Structure structure) {
        return occurrences(0x3D20ADEAU, facts, structure);
    }
};

/// Of a kernel with a queue.
int most_registers(const LinkedFacts& facts) {
    return render_input(Tier::strict, Structure::few, facts, architecture).registers;
}

TEST_F(SceneKernel, HasNoCodeForAnEffectThatIsAbsent) {
    // what an effect stands on: without that it has no code of its own
    const std::map<Effect, EffectMask> base = {{Effect::absorption, Effect::refraction},
                                               {Effect::nested_media, Effect::refraction},
                                               {Effect::area_lights, Effect::emission},
                                               {Effect::roulette, Effect::indirect},
                                               {Effect::anisotropy, Effect::microfacets}};
    nlohmann::ordered_json table = nlohmann::ordered_json::array();
    const auto write = [&](EffectMask effects) {
        const LinkedSize kernel = linked(facts(effects));
        table.push_back({{"effects", to_string(effects)},
                         {"registers", kernel.registers},
                         {"stack_bytes", kernel.stack_bytes},
                         {"code_bytes", kernel.code_bytes}});
        return kernel;
    };
    (void)write({});
    // For few primitives, a kernel without effects has code that others lack (kernel/certain_pixel.h).
    const auto code_bytes = [&](EffectMask effects) { return linked(facts(effects), Structure::loop).code_bytes; };
    for (std::uint32_t i = 0; i < effect_count; ++i) {
        const auto effect = static_cast<Effect>(i);
        if (host_effects.has(effect)) continue;  // no kernel knows of it
        const auto found = base.find(effect);
        EffectMask without = found == base.end() ? EffectMask() : found->second;
        // kernels for long paths call what those for short ones have inline, so both must be for long ones
        const Effect other = effect == Effect::reflection ? Effect::refraction : Effect::reflection;
        (void)write(without | effect);
        if (synchronising_effects.has(effect)) without = without | other;
        EXPECT_GT(code_bytes(without | effect), code_bytes(without)) << to_string(effect);
    }
    const LinkedSize everything = write(all_effects);
    EXPECT_EQ(everything.registers, most_registers(facts(all_effects)));
    EXPECT_GT(code_bytes(all_effects), 3 * code_bytes({}));
    // What a path carries from vertex to vertex, beside kernels that use the registers that they may. A GPU allocates
    // them in eights, so a kernel with up to seven fewer has no more warps.
    for (const Effect one :
         {Effect::reflection, Effect::refraction, Effect::cutouts, Effect::indirect, Effect::microfacets}) {
        const LinkedSize alone = linked(facts(one));
        EXPECT_LE(alone.registers, most_registers(facts(one))) << to_string(one);
        EXPECT_GT(alone.registers, most_registers(facts(one)) - 8) << to_string(one);
        EXPECT_GT(everything.stack_bytes, 3 * alone.stack_bytes) << to_string(one);
    }
    EXPECT_EQ(queue_blocks(Tier::strict, Structure::loop, linked(facts(Effect::reflection)).code_bytes), 2U);
    EXPECT_EQ(queue_blocks(Tier::strict, Structure::bvh, everything.code_bytes), 1U);
    std::ofstream("kernel_masks.json") << table.dump(2) << "\n";
}

TEST(QueueBlocks, AreTwoOnlyForCodeThatIsKnownToBeSmall) {
    for (const Tier tier : {Tier::fast, Tier::strict, Tier::precise}) {
        EXPECT_EQ(queue_blocks(tier, Structure::bvh, 0), 1U) << "not known, " << to_string(tier);
        EXPECT_EQ(queue_blocks(tier, Structure::loop, 80'000), 2U) << to_string(tier);
        EXPECT_EQ(queue_blocks(tier, Structure::bvh, 160'000), 1U) << to_string(tier);
    }
    for (const Structure structure : {Structure::bvh, Structure::instanced}) {
        EXPECT_EQ(queue_blocks(Tier::strict, structure, 130'000), 2U);
        EXPECT_EQ(queue_blocks(Tier::fast, structure, 130'000), 1U) << "little of its code is rare";
    }
    EXPECT_EQ(queue_blocks(Tier::strict, Structure::loop, 130'000), 1U) << "threads use more of it";
}

TEST(PathsInStages, AreThoseOfIndirectLightAmongFewPrimitives) {
    constexpr std::uint32_t most_across = 1U << 16;
    SceneView scene{};
    scene.indirect_light = 1;
    LinkedFacts facts;
    facts.effects = EffectMask(Effect::indirect).bits();
    for (const Tier tier : {Tier::strict, Tier::precise}) {
        EXPECT_TRUE(renders_in_stages(tier, Structure::loop, facts, scene, most_across, most_across));
    }
    EXPECT_FALSE(renders_in_stages(Tier::fast, Structure::loop, facts, scene, 8, 8));
    for (const Structure structure : {Structure::few, Structure::bvh, Structure::instanced}) {
        EXPECT_FALSE(renders_in_stages(Tier::strict, structure, facts, scene, 8, 8));
    }
    EXPECT_FALSE(renders_in_stages(Tier::strict, Structure::loop, facts, scene, most_across + 1, 8));
    EXPECT_FALSE(renders_in_stages(Tier::strict, Structure::loop, facts, scene, 8, most_across + 1));
    EXPECT_FALSE(renders_in_stages(Tier::strict, Structure::loop, {}, scene, 8, 8)) << "several shadow rays";
    scene.indirect_light = 0;
    EXPECT_FALSE(renders_in_stages(Tier::strict, Structure::loop, facts, scene, 8, 8)) << "effect forced on";
}

TEST(PathsInStages, NeedMoreMemoryInPrecise) {
    const StagedMemory strict = staged_memory(Tier::strict), precise = staged_memory(Tier::precise);
    EXPECT_LT(strict.path_bytes, precise.path_bytes);
    EXPECT_LT(strict.rare_bytes, precise.rare_bytes);
    EXPECT_GT(strict.most_paths, precise.most_paths);
    EXPECT_GT(precise.most_paths, most_queue_threads) << "more than one for each thread";
}

TEST_F(SceneKernel, HasMoreWarpsForReflectedPathsInStages) {
    const EffectMask diffuse = Effect::indirect | Effect::shadows;
    LinkedFacts lit = facts(diffuse), reflected = facts(diffuse | Effect::reflection),
                refracted = facts(diffuse | Effect::refraction);
    const int alone = most_registers(reflected);
    lit.in_stages = reflected.in_stages = refracted.in_stages = 1;
    EXPECT_EQ(most_registers(lit), alone);
    EXPECT_LT(most_registers(reflected), alone);
    EXPECT_LT(most_registers(refracted), alone);
}

TEST_F(SceneKernel, FollowsPathsInStagesIfLinkedSo) {
    LinkedFacts of = facts(Effect::indirect);
    const LinkedSize one_by_one = linked(of, Structure::loop);
    of.in_stages = 1;
    const LinkedSize in_stages = linked(of, Structure::loop);
    EXPECT_LE(in_stages.registers, most_registers(of));
    EXPECT_NE(in_stages.code_bytes, one_by_one.code_bytes);
}

TEST_F(SceneKernel, HasNoCodeForKindsAndLightsThatTheSceneHasNot) {
    SceneView scene{};
    scene.sphere_count = 3;
    const auto bytes = [&](auto change) {
        SceneView changed = scene;
        change(changed);
        return linked(linked_facts(changed, {}, PathLimits{}), Structure::loop).code_bytes;
    };
    const std::size_t plain = bytes([](SceneView&) {});
    EXPECT_GT(bytes([](SceneView& s) { s.box_count = 1; }), plain);
    EXPECT_GT(bytes([](SceneView& s) { s.ellipsoid_count = 1; }), plain);
    EXPECT_GT(bytes([](SceneView& s) { s.triangle_count = 1; }), plain);
    EXPECT_GT(bytes([](SceneView& s) { s.quad_count = 1; }), plain);
    EXPECT_GT(bytes([](SceneView& s) { s.light_count = 1; }), plain);
}

TEST_F(SceneKernel, HasNoCodeForSamplersThatTheJobHasNot) {
    for (const EffectMask effects :
         {EffectMask(), Effect::lens | Effect::shadows, Effect::indirect | Effect::shadows}) {
        for (const Structure structure : {Structure::few, Structure::bvh}) {
            EXPECT_EQ(sobol_constants(facts(effects), structure), 0) << to_string(effects);
            EXPECT_GT(sobol_constants(facts(effects, 1, Sampler::sobol), structure), 0) << to_string(effects);
            LinkedFacts any = facts(effects);
            any.sampler = any_sampler;
            EXPECT_GT(sobol_constants(any, structure), 0) << to_string(effects);
            EXPECT_GT(linked(any, structure).code_bytes, linked(facts(effects), structure).code_bytes);
        }
    }
    EXPECT_LT(linked(facts({}, 1, Sampler::sobol)).code_bytes, linked(facts({}, 1, Sampler::sobol_blue)).code_bytes);
}

TEST_F(SceneKernel, HasNoCodeForFiltersThatTheJobHasNot) {
    // coefficients of kernel/sampler/pixel_filter.h
    const std::uint32_t gaussian = bits_of(14.0505F), window = bits_of(60.1484F);
    const auto with = [](EffectMask effects, PixelFilter filter) { return facts(effects, 1, Sampler::random, filter); };
    for (const EffectMask effects : {EffectMask(), Effect::lens | Effect::shadows, EffectMask(Effect::reflection)}) {
        for (const Structure structure : {Structure::few, Structure::bvh}) {
            const auto has = [&](std::uint32_t constant, const LinkedFacts& facts) {
                return occurrences(constant, facts, structure) > 0;
            };
            EXPECT_FALSE(has(gaussian, facts(effects)) || has(window, facts(effects))) << to_string(effects);
            const LinkedFacts soft = with(effects, PixelFilter::gaussian);
            const LinkedFacts sharp = with(effects, PixelFilter::blackman_harris);
            EXPECT_TRUE(has(gaussian, soft) && !has(window, soft)) << to_string(effects);
            EXPECT_TRUE(has(window, sharp) && !has(gaussian, sharp)) << to_string(effects);
            LinkedFacts any = facts(effects);
            any.filter = any_filter;
            EXPECT_TRUE(has(gaussian, any) && has(window, any)) << to_string(effects);
        }
    }
    // box alone has the faster code for few solids (kernel/certain_pixel.h)
    EXPECT_LT(linked(with({}, PixelFilter::tent)).code_bytes, linked(facts({})).code_bytes);
}

TEST(LinkedFactsOf, LeaveOutWhatAKernelDoesNotAskFor) {
    SceneView scene{};
    scene.sphere_count = 1;
    scene.quad_count = 2;
    scene.light_count = 3;
    const PathLimits limits = {5, 6, 7};
    const LinkedFacts plain = linked_facts(scene, Effect::shadows, limits);
    EXPECT_EQ(plain, (LinkedFacts{.effects = EffectMask(Effect::shadows).bits(),
                                  .kinds = spheres | PrimitiveKinds::quad,
                                  .lights = 3}));
    const LinkedFacts mirrors = linked_facts(scene, Effect::reflection, limits);
    EXPECT_EQ(mirrors.reflection, 5U);
    EXPECT_EQ(mirrors.refraction, 0U);
    const LinkedFacts glass = linked_facts(scene, Effect::refraction, limits);
    EXPECT_EQ(glass.reflection, 5U) << "total internal reflection";
    EXPECT_EQ(glass.refraction, 6U);
    EXPECT_EQ(linked_facts(scene, Effect::indirect, limits).diffuse, 7U);
    EXPECT_EQ(linked_facts(scene, Effect::microfacets, limits).reflection, 5U);
    scene.area_light_kinds = PrimitiveKinds::quad;
    EXPECT_EQ(linked_facts(scene, Effect::area_lights, limits).light_kinds, PrimitiveKinds::quad);
    EXPECT_EQ(linked_facts(scene, Effect::emission, limits).light_kinds, 0U);
    for (const std::uint32_t count : {0U, 1U, 2U}) {
        scene.area_light_count = count;
        EXPECT_EQ(linked_facts(scene, Effect::area_lights, limits).area_lights, count) << "KnownAreaLights";
    }
    scene.several_slots = 1;
    EXPECT_EQ(linked_facts(scene, Effect::textures, limits).several_slots, 1U);
    EXPECT_EQ(linked_facts(scene, Effect::anisotropy, limits).several_slots, 1U);
    EXPECT_EQ(linked_facts(scene, Effect::shadows, limits).several_slots, 0U);
    scene.cutout_kinds = PrimitiveKinds::triangle;
    EXPECT_EQ(linked_facts(scene, Effect::cutouts, limits).cutout_kinds, PrimitiveKinds::triangle);
    EXPECT_EQ(linked_facts(scene, Effect::cutouts, limits).masked_kinds, 0U) << "culled faces";
    EXPECT_EQ(linked_facts(scene, Effect::shadows, limits).cutout_kinds, 0U);
    scene.masked_kinds = PrimitiveKinds::triangle;
    EXPECT_EQ(linked_facts(scene, Effect::cutouts, limits).masked_kinds, PrimitiveKinds::triangle);
    EXPECT_EQ(linked_facts(scene, Effect::shadows, limits).masked_kinds, 0U);
    for (const EffectMask effects : {EffectMask(Effect::cutouts), EffectMask(Effect::shadows)}) {
        const LinkedFacts any = facts_of_any_scene(effects, PrimitiveKinds::all);
        EXPECT_EQ(any.cutout_kinds, effects.has(Effect::cutouts) ? any.kinds : 0U);
        EXPECT_EQ(any.masked_kinds, any.cutout_kinds);
    }
    EXPECT_EQ(linked_facts(scene, {}, limits, Sampler::sobol_blue).sampler,
              static_cast<std::uint32_t>(Sampler::sobol_blue));
    EXPECT_EQ(linked_facts(scene, {}, limits, Sampler::random, PixelFilter::tent).filter,
              static_cast<std::uint32_t>(PixelFilter::tent));
    scene.light_count = 1000;
    EXPECT_EQ(linked_facts(scene, {}, limits).lights, LinkedFacts::any);
}

}  // namespace
}  // namespace tandem::cuda
