// What link-time constant folding leaves of a kernel. No GPU: the machine code itself is looked at.
#include "cuda/jit_link.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <future>

#include "cuda/cubin_facts.h"
#include "cuda/machine_code.h"
#include "cuda/toy_input.h"
#include "support/thrown_message.h"
#include "tandem/base/error.h"

namespace tandem::cuda {
namespace {

using namespace tandem::test;

/// A linked kernel: the file and what it says.
struct Linked {
    std::vector<std::byte> cubin;
    CubinFacts facts;
};

class JitLink : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!why_jit_unavailable().empty()) GTEST_SKIP() << why_jit_unavailable();
    }
    static Linked linked(const JitInput& input) {
        const auto start = std::chrono::steady_clock::now();
        Linked result{link(input), {}};
        const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
        const auto facts = cubin_facts(result.cubin, input.kernel);
        if (!facts) throw std::runtime_error("the cubin has no facts");
        result.facts = *facts;
        fmt::print("effects {:2}, {} lights, {}: {} registers, {} bytes of code, {} bytes of stack, {:.0f} ms\n",
                   input.facts[0], input.facts[1], to_string(input.tier), facts->registers, facts->code.size(),
                   facts->stack_bytes, time.count());
        return result;
    }
    static Linked linked(std::uint32_t effects) { return linked(toy_input({effects, 3})); }
    static int count_in(const Linked& kernel, Operation operation) { return count(kernel.facts.code, operation); }
};

TEST_F(JitLink, FewerEffectsTakeFewerRegistersAndLessCode) {
    const Linked all = linked(toy_all);
    const Linked none = linked(0);
    EXPECT_LT(none.facts.registers, all.facts.registers);
    EXPECT_LT(none.facts.code.size(), all.facts.code.size() / 2);
    EXPECT_LT(linked(toy_all & ~toy_table).facts.registers, all.facts.registers);
    for (std::uint32_t effect = 1; effect < toy_fused; effect *= 2) {  // one instruction may drown in the padding
        EXPECT_LT(linked(toy_all & ~effect).facts.code.size(), all.facts.code.size()) << "without effect " << effect;
    }
}

TEST_F(JitLink, AnAbsentEffectLeavesNoMark) {
    const Linked root = linked(toy_root), no_root = linked(toy_all & ~(toy_root | toy_quotient));
    EXPECT_GT(count_in(root, Operation::mufu), 0);
    EXPECT_EQ(count_in(no_root, Operation::mufu), 0);

    const Linked quotient = linked(toy_quotient), no_quotient = linked(toy_all & ~toy_quotient);
    EXPECT_GT(count_in(quotient, Operation::dfma), 0);
    EXPECT_EQ(count_in(no_quotient, Operation::dfma), 0);

    const Linked lights = linked(toy_lights), no_lights = linked(toy_all & ~toy_lights);
    EXPECT_GT(count_immediate(lights.facts.code, toy_marker), 0);
    EXPECT_EQ(count_immediate(no_lights.facts.code, toy_marker), 0);
}

TEST_F(JitLink, NumbersAreFoldedAsWellAsBits) {
    const Linked without = linked(toy_input({toy_lights, 0})), with = linked(toy_input({toy_lights, 2}));
    EXPECT_EQ(count_immediate(without.facts.code, toy_marker), 0);
    EXPECT_GT(count_immediate(with.facts.code, toy_marker), 0);
}

TEST_F(JitLink, StrictFusesOnlyWhatIsWritten) {
    // square roots and quotients are left out: their exact forms are made of fused operations
    EXPECT_EQ(count_in(linked(toy_lights | toy_table), Operation::ffma), 0);
    EXPECT_EQ(count_in(linked(toy_lights | toy_table | toy_fused), Operation::ffma), 1);
    EXPECT_GT(count_in(linked(toy_input({toy_lights | toy_table, 3}, Tier::fast)), Operation::ffma), 1);
}

TEST_F(JitLink, TheLinkAndNotTheCompilerDecidesAboutContraction) {
    JitInput input = toy_input({toy_lights, 3});
    input.tier = Tier::fast;  // of code that was compiled with --fmad=false
    EXPECT_GT(count_in(linked(input), Operation::ffma), 0);
}

TEST_F(JitLink, PreciseKeepsToTheSameRulesAsStrict) {
    JitInput strict = toy_input({}), precise = toy_input({});
    precise.tier = Tier::precise;
    EXPECT_EQ(link_options(strict), link_options(precise));
    EXPECT_NE(link_options(strict), link_options(toy_input({}, Tier::fast)));
}

TEST_F(JitLink, OtherKernelsAreLeftOut) {
    const Linked toy = linked(toy_all);
    EXPECT_FALSE(cubin_facts(toy.cubin, "unused_kernel"));
}

TEST_F(JitLink, ServesLaterArchitecturesFromOneLtoIr) {
    JitInput input = toy_input({});
    if (input.architecture >= 120) GTEST_SKIP() << "compiled for none but the latest architecture";
    input.architecture = 120;
    EXPECT_GT(linked(input).facts.registers, 0);
}

TEST_F(JitLink, ThreadsMayLinkAtOnceAndGetTheSameBytes) {
    std::vector<std::future<std::vector<std::byte>>> at_once;
    for (std::uint32_t effects : {0U, 4U, 0U, 4U}) {
        at_once.push_back(std::async(std::launch::async, [=] { return link(toy_input({effects, 3})); }));
    }
    const std::vector<std::byte> none = link(toy_input({0, 3})), lights = link(toy_input({4, 3}));
    EXPECT_NE(none, lights);
    for (std::size_t i = 0; i < at_once.size(); ++i) EXPECT_EQ(at_once[i].get(), i % 2 == 0 ? none : lights);
}

/// What link() says; it must throw.
std::string complaint(const JitInput& input) {
    return thrown_message<std::runtime_error>([&] { (void)link(input); });
}

TEST_F(JitLink, AnUnknownKernelIsAnError) {
    JitInput input = toy_input({});
    input.kernel = "no_such_kernel";
    EXPECT_NE(complaint(input).find("no_such_kernel"), std::string::npos) << complaint(input);
}

TEST_F(JitLink, FactsUnderAnotherNameAreAnError) {
    JitInput input = toy_input({4, 3});
    input.facts_name = "other_facts";
    EXPECT_NE(complaint(input).find("toy_facts"), std::string::npos) << complaint(input);
}

TEST_F(JitLink, FactsOfAnotherSizeAreAnErrorWithTheLinkersLog) {
    JitInput input = toy_input({});
    input.facts.push_back(0);
    EXPECT_NE(complaint(input).find("Size does not match"), std::string::npos) << complaint(input);
}

TEST_F(JitLink, AnUnknownArchitectureIsAnError) {
    JitInput input = toy_input({});
    input.architecture = 1;
    EXPECT_NE(complaint(input).find("architecture"), std::string::npos) << complaint(input);
}

TEST_F(JitLink, CodeThatIsNoFatBinaryIsAnError) {
    JitInput input = toy_input({});
    const std::vector<std::byte> zeros(100);
    input.code = zeros;
    EXPECT_NE(complaint(input), "");
    input.code = {};
    EXPECT_NE(complaint(input), "");
}

}  // namespace
}  // namespace tandem::cuda
