// Registers, stack and code of a cubin, against cuobjdump where there is one; and files that are none.
#include "cuda/cubin_facts.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <memory>
#include <string>

#include "cuda/toy_input.h"
#include "support/random.h"
#include "support/temporary_folder.h"
#include "tandem/base/whole_file.h"

namespace tandem::cuda {
namespace {

using namespace tandem::test;

/// What a command writes to its standard output.
std::string output_of(const std::string& command) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(::popen(command.c_str(), "r"), ::pclose);
    std::string text;
    std::array<char, 4096> buffer;
    while (pipe && std::fgets(buffer.data(), buffer.size(), pipe.get()) != nullptr) text += buffer.data();
    return text;
}

class CubinFactsOf : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!why_jit_unavailable().empty()) GTEST_SKIP() << why_jit_unavailable();
        cubin_ = link(toy_input({}));
    }
    std::vector<std::byte> cubin_;
};

TEST_F(CubinFactsOf, AreThoseOfCuobjdump) {
    const std::string tool = TANDEM_CUOBJDUMP;
    if (tool.empty()) GTEST_SKIP() << "there is no cuobjdump in this CUDA toolkit or on PATH";
    const TemporaryFolder folder;
    for (const std::uint32_t effects : {0U, 2U, 31U}) {
        const std::vector<std::byte> cubin = link(toy_input({effects, 3}));
        write_file(folder.file("toy.cubin"), cubin);
        const auto facts = cubin_facts(cubin, "toy_kernel");
        ASSERT_TRUE(facts);
        const std::string usage = output_of(tool + " --dump-resource-usage " + folder.file("toy.cubin"));
        const std::string expected = fmt::format("REG:{} STACK:{} ", facts->registers, facts->stack_bytes);
        EXPECT_NE(usage.find(expected), std::string::npos) << "not '" << expected << "' but " << usage;
    }
}

TEST_F(CubinFactsOf, AKernelThatIsNotThereAreEmpty) {
    EXPECT_TRUE(cubin_facts(cubin_, "toy_kernel"));
    EXPECT_FALSE(cubin_facts(cubin_, "toy"));
    EXPECT_FALSE(cubin_facts(cubin_, "toy_kernel_too"));
    EXPECT_FALSE(cubin_facts(cubin_, ""));
}

/// Facts, if there are any, must point into the file.
void expect_inside(std::span<const std::byte> file, const std::string& reproducer) {
    const auto facts = cubin_facts(file, "toy_kernel");
    if (!facts) return;
    EXPECT_GE(facts->code.data(), file.data()) << reproducer;
    EXPECT_LE(facts->code.data() + facts->code.size(), file.data() + file.size()) << reproducer;
}

TEST_F(CubinFactsOf, ATruncatedFileStayInsideIt) {
    for (std::size_t size = 0; size < cubin_.size(); ++size) {
        const std::vector<std::byte> torn(cubin_.begin(), cubin_.begin() + static_cast<std::ptrdiff_t>(size));
        expect_inside(torn, fmt::format("truncated to {} bytes", size));
    }
    EXPECT_FALSE(cubin_facts(std::span(cubin_).first(cubin_.size() / 2), "toy_kernel"));
}

TEST_F(CubinFactsOf, AnAlteredFileStayInsideIt) {
    for (std::uint64_t seed = 0; seed < 2000; ++seed) {
        Random random(seed);
        std::vector<std::byte> altered = cubin_;
        for (int i = 0; i < 20; ++i) {
            // headers first: the rest is instructions
            const std::uint32_t range = random.coin() ? 64 : static_cast<std::uint32_t>(altered.size());
            altered[random.below(range)] = static_cast<std::byte>(random.below(256));
        }
        expect_inside(altered, fmt::format("Random random({}): 20 bytes altered", seed));
    }
}

TEST(CubinFactsOfNothing, AreEmpty) {
    EXPECT_FALSE(cubin_facts({}, "toy_kernel"));
    const std::vector<std::byte> zeros(1000);
    EXPECT_FALSE(cubin_facts(zeros, "toy_kernel"));
}

}  // namespace
}  // namespace tandem::cuda
