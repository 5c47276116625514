// The kernels that are linked when Tandem is built: their machine code is what a link at load would give. No GPU.
#include <cuda_runtime_api.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <tuple>

#include "cuda/cubin_facts.h"
#include "cuda/machine_code.h"
#include "cuda/scene_kernels.h"
#include "cuda/toy_input.h"
#include "support/compiled_tiers.h"
#include "tandem/base/error.h"
#include "tandem/base/whole_file.h"
#include "tandem/effects/names.h"

namespace tandem::cuda {
namespace {

using namespace tandem::test;

/// What is in a kernel's machine code.
struct Code {
    int ffma = 0, dfma = 0, mufu = 0;
    int registers = 0, stack_bytes = 0;
    friend bool operator==(const Code&, const Code&) = default;
    friend void PrintTo(const Code& code, std::ostream* out) {
        *out << fmt::format("{} FFMA, {} DFMA, {} MUFU, {} registers, {} bytes of stack", code.ffma, code.dfma,
                            code.mufu, code.registers, code.stack_bytes);
    }
};

Code code_of(std::span<const std::byte> cubin, const std::string& kernel) {
    const CubinFacts facts = cubin_facts(cubin, kernel).value();
    return {count(facts.code, Operation::ffma), count(facts.code, Operation::dfma), count(facts.code, Operation::mufu),
            facts.registers, facts.stack_bytes};
}

/// Tests link the kernel with all effects for this one: the link takes seconds, and other tracers bring it no other
/// effect.
constexpr auto linked_with_all_effects = Structure::few;

class CompiledKernels : public ::testing::Test {
  protected:
    void SetUp() override {
        if (TANDEM_COMPILED_ARCHITECTURE == 0) GTEST_SKIP() << "the build is for PTX alone";
    }
    /// `name`: with its folder, under the build folder.
    static Code compiled(const std::string& name, const std::string& kernel) {
        return code_of(read_file(fmt::format("{}/{}_{}.cubin", TANDEM_BINARY_DIR, name, TANDEM_COMPILED_ARCHITECTURE)),
                       kernel);
    }
};

TEST_F(CompiledKernels, OfExactTiersFuseOnlyWhatIsWritten) {
    const Code strict = compiled("tests/cuda/compiled_toy_strict", "toy_kernel");
    EXPECT_EQ(strict.ffma, 1);
    EXPECT_EQ(strict.mufu, 0);
    EXPECT_GT(compiled("tests/cuda/compiled_toy_fast", "toy_kernel").ffma, 1);
}

TEST_F(CompiledKernels, HaveTheMachineCodeOfALinkAtLoad) {
    if (!why_jit_unavailable().empty()) GTEST_SKIP() << why_jit_unavailable();
    const std::string release = fmt::format("nvJitLink {}.{},", CUDART_VERSION / 1000, CUDART_VERSION % 1000 / 10);
    if (!jit_version().starts_with(release))
        GTEST_SKIP() << jit_version() << " is not of the release that built Tandem";

    const auto expect_equal = [](Tier tier, std::size_t variant) {
        if (!is_compiled(tier)) return;
        const std::string name = fmt::format("{}_few_{}", variants[variant].name, to_string(tier));
        const LinkedFacts facts = facts_of_any_scene(variants[variant].effects, ConstantMemoryTracer::kinds);
        const JitInput input = render_input(tier, Structure::few, facts, TANDEM_COMPILED_ARCHITECTURE);
        EXPECT_EQ(compiled("cuda/compiled_" + name, input.kernel), code_of(link(input), input.kernel)) << name;
    };
#define TANDEM_TIER(name, promise) expect_equal(Tier::name, 0);
#include "tandem/render/tiers.def"
#undef TANDEM_TIER
    // `direct` has the same instructions, but from PTX the assembler spills 8 bytes more than nvJitLink does
    expect_equal(Tier::strict, variant_count - 1);
}

/// The kinds of primitives of the kernel for any scene, with triangles and quads (`faces`) or without.
std::uint32_t kinds_of(Structure structure, bool faces) {
    if (structure == Structure::few) return ConstantMemoryTracer::kinds;
    if (structure == Structure::instanced) return InstancedTracer::kinds;
    return faces ? PrimitiveKinds::all : PrimitiveKinds::bodies;
}

/// Linked once for all tests of the program.
Code linked(Tier tier, Structure structure, const KernelVariant& variant, bool faces = true) {
    static std::map<std::tuple<Tier, Structure, LinkedFacts>, Code> known;
    const LinkedFacts facts = facts_of_any_scene(variant.effects, kinds_of(structure, faces));
    const JitInput input = render_input(tier, structure, facts, TANDEM_COMPILED_ARCHITECTURE);
    const auto [place, is_new] = known.try_emplace({tier, structure, facts});
    if (is_new) place->second = code_of(link(input), input.kernel);
    const Code& code = place->second;
    const int most = input.registers > 0 ? input.registers : 255;  // of a thread, on every GPU
    EXPECT_LE(code.registers, most) << to_string(tier) << " " << variant.name;
    return code;
}

TEST_F(CompiledKernels, OfTiersThatAreNotCompiledCanBeLinked) {
    if (!why_jit_unavailable().empty()) GTEST_SKIP() << why_jit_unavailable();
    if (is_compiled(Tier::strict) && is_compiled(Tier::precise) && is_compiled(Tier::fast))
        GTEST_SKIP() << "all tiers are compiled";
    const auto expect_kernels = [](Tier tier) {
        if (is_compiled(tier)) return;
        for (const Structure structure : {Structure::few, Structure::loop, Structure::bvh, Structure::instanced}) {
            if (tier == Tier::fast && structure == Structure::instanced) continue;  // has the kernel of strict
            for (const KernelVariant& variant : variants) {
                if (!variant.effects.empty() && structure != linked_with_all_effects) continue;
                EXPECT_GT(linked(tier, structure, variant).registers, 0) << to_string(tier) << " " << variant.name;
            }
        }
    };
#define TANDEM_TIER(name, promise) expect_kernels(Tier::name);
#include "tandem/render/tiers.def"
#undef TANDEM_TIER
}

// The limits in cuda/CMakeLists.txt are those of a link at load.
TEST_F(CompiledKernels, HaveTheRegistersOfALinkAtLoad) {
    const auto expect_within = [](Tier tier) {
        if (!is_compiled(tier)) return;
        for (const KernelVariant& variant : variants) {
            if (!variant.effects.has_any(synchronising_effects)) continue;  // launch bounds limit the others
            const LinkedFacts facts = facts_of_any_scene(variant.effects, ConstantMemoryTracer::kinds);
            const int most = render_input(tier, Structure::few, facts, TANDEM_COMPILED_ARCHITECTURE).registers;
            const std::string name = fmt::format("cuda/compiled_{}_few_{}", variant.name, to_string(tier));
            const Code code = compiled(name, "tandem_render");
            EXPECT_LE(code.registers, most) << name;
            if (code.stack_bytes == 0) continue;          // `direct` in fast spills nothing and needs fewer
            EXPECT_GT(code.registers, most - 8) << name;  // they are allocated in eights
        }
    };
#define TANDEM_TIER(name, promise) expect_within(Tier::name);
#include "tandem/render/tiers.def"
#undef TANDEM_TIER
}

TEST_F(CompiledKernels, OfExactTiersFuseLessThanFast) {
    if (!is_compiled(Tier::strict)) GTEST_SKIP() << "only " TANDEM_COMPILED_TIERS;
    const bool can_link = why_jit_unavailable().empty();
    if (!is_compiled(Tier::fast) && !can_link) GTEST_SKIP() << why_jit_unavailable();
    // Where margins cover fused operations, the exact tiers use them and fast does not: for intervals in hierarchies,
    // and for few primitives without effects (kernel/certain_light.h).
    struct Scenes {
        const char* name;
        Structure structure;
        bool faces;
    };
    for (const Scenes& scenes : {Scenes{"few", Structure::few, true},
                                 {"loop", Structure::loop, true},
                                 {"loop_bodies", Structure::loop, false}}) {
        for (const KernelVariant& variant : variants) {
            if (scenes.structure == Structure::few && variant.effects.empty()) continue;
            const bool stays_ptx = scenes.structure == Structure::loop && !variant.effects.empty();
            if (stays_ptx && (!can_link || variant.effects == all_effects)) continue;  // their links take longest
            if (!is_compiled(Tier::fast) && !variant.effects.empty() && scenes.structure != linked_with_all_effects)
                continue;
            const std::string name = fmt::format("cuda/compiled_{}_{}_", variant.name, scenes.name);
            const bool is_machine_code = is_compiled(Tier::fast) && scenes.structure == Structure::few;
            if (!is_machine_code && !can_link) continue;
            const Code fast = is_machine_code ? compiled(name + "fast", "tandem_render")
                                              : linked(Tier::fast, scenes.structure, variant, scenes.faces);
            const Code strict = stays_ptx ? linked(Tier::strict, scenes.structure, variant, scenes.faces)
                                          : compiled(name + "strict", "tandem_render");
            EXPECT_LT(strict.ffma, fast.ffma) << name;
        }
    }
}

TEST(CompiledCode, IsThereForEverySceneOfATierThatIsCompiled) {
    const auto expect_code = [](Tier tier, Structure structure, bool faces, std::size_t variant) {
        const bool draws_as_strict = tier == Tier::fast && structure == Structure::instanced;
        EXPECT_EQ(compiled_code(tier, structure, faces, variant).empty(),
                  !is_compiled(draws_as_strict ? Tier::strict : tier))
            << to_string(tier) << " " << variants[variant].name;
    };
    for (const Structure structure : {Structure::few, Structure::loop, Structure::bvh, Structure::instanced}) {
        for (const bool faces : {false, true}) {
            for (std::size_t variant = 0; variant < variant_count; ++variant) {
#define TANDEM_TIER(name, promise) expect_code(Tier::name, structure, faces, variant);
#include "tandem/render/tiers.def"
#undef TANDEM_TIER
            }
        }
    }
}

/// What the function throws; "" if nothing.
template <class Function>
std::string error_of(const Function& function) {
    try {
        function();
    } catch (const EnvironmentError& error) {
        return error.what();
    }
    return "";
}

TEST(CompiledCode, OfATierThatIsNotCompiledIsAnErrorThatSaysWhatToDo) {
    if (is_compiled(Tier::precise)) GTEST_SKIP() << "the tier precise is compiled";
    using ::testing::HasSubstr;
    constexpr int no_gpu_of_this_kind = 1;
    SceneKernels kernels(no_gpu_of_this_kind);
    const std::string error = error_of([&] { (void)kernels.compiled(Tier::precise, DeviceSceneView{}, 0); });
    EXPECT_THAT(error, HasSubstr("no kernels compiled ahead of time for the tier precise (TANDEM_COMPILED_TIERS)"));
    EXPECT_THAT(error, HasSubstr("build with precise in TANDEM_COMPILED_TIERS"));

    // and where the link fails, which the first call must not make the second forget
    for (int call = 0; call < 2; ++call) {
        EXPECT_THAT(error_of([&] { (void)kernels.find(Tier::precise, DeviceSceneView{}, LinkedFacts{}); }),
                    HasSubstr("(TANDEM_COMPILED_TIERS), and none can be linked for the scene: "));
    }
}

TEST(CompiledCode, IsTheLeastThatHasTheEffects) {
    const auto chosen = [](EffectMask effects) { return variants[variant_for(variants, effects)].name; };
    EXPECT_STREQ(chosen({}), "plain");
    EXPECT_STREQ(chosen(Effect::shadows | Effect::lens | Effect::area_lights | Effect::emission), "direct");
    EXPECT_STREQ(chosen(Effect::textures | Effect::normal_maps | Effect::environment_light), "direct");
    for (const Effect one : {Effect::reflection, Effect::refraction, Effect::indirect, Effect::microfacets}) {
        EXPECT_STREQ(chosen(Effect::shadows | one), "full") << to_string(one);
    }
}

TEST(CompiledCode, IsShorterWithFewerFacts) {
    if (!is_compiled(Tier::strict)) GTEST_SKIP() << "only " TANDEM_COMPILED_TIERS;
    const auto bytes = [](std::size_t variant, bool faces) {
        return compiled_code(Tier::strict, Structure::bvh, faces, variant).size();
    };
    for (std::size_t variant = 0; variant < variant_count; ++variant) {
        EXPECT_LT(bytes(variant, false), bytes(variant, true)) << variants[variant].name;
    }
    EXPECT_LT(bytes(0, true), bytes(2, true));
    EXPECT_LT(bytes(1, true), bytes(2, true));  // both stay PTX
}

}  // namespace
}  // namespace tandem::cuda
