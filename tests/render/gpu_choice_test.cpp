#include "tandem/render/gpu_choice.h"

#include <gtest/gtest.h>

#include "support/input_error.h"
#include "support/thrown_message.h"
#include "tandem/backends/make_backend.h"

namespace tandem {
namespace {

using test::contains;
using test::input_error;
using test::thrown_message;

TEST(GpuChoice, IsAllANumberOrAList) {
    EXPECT_EQ(parse_gpus("all"), (GpuChoice{.count = 0}));
    EXPECT_EQ(parse_gpus("1"), GpuChoice{});
    EXPECT_EQ(parse_gpus("4"), (GpuChoice{.count = 4}));
    EXPECT_EQ(parse_gpus("2,0").numbers, (std::vector<int>{2, 0}));
    EXPECT_EQ(parse_gpu_list("0").numbers, std::vector<int>{0});
    EXPECT_EQ(parse_gpu_list("all"), (GpuChoice{.count = 0}));
    for (const char* wrong : {"", "0", "-1", "two", "1,", ",1", "1,,2", "1 ,2", "0,1,0", "99999999999"}) {
        EXPECT_FALSE(input_error([&] { (void)parse_gpus(wrong); }).empty()) << wrong;
    }
    EXPECT_TRUE(contains(input_error([] { (void)parse_gpu_list(""); }), "cuda:1"));
    EXPECT_TRUE(contains(input_error([] { (void)parse_gpu_list("1,1"); }), "GPU 1 is named twice"));
}

TEST(GpuChoice, MissingGpusAreNamedWithThoseThatExist) {
    const std::vector<std::string> two = {"H100", "H200"};
    EXPECT_EQ(chosen_gpus({.count = 0}, two), (std::vector<int>{0, 1}));
    EXPECT_EQ(chosen_gpus({}, two), std::vector<int>{0});
    EXPECT_EQ(chosen_gpus(parse_gpus("1,0"), two), (std::vector<int>{1, 0}));
    const auto message = [](const GpuChoice& choice, const std::vector<std::string>& names) {
        return thrown_message<EnvironmentError>([&] { (void)chosen_gpus(choice, names); });
    };
    EXPECT_EQ(message(parse_gpus("0,2"), two), "there is no GPU 2; this machine has GPU 0 (H100) and GPU 1 (H200)");
    EXPECT_EQ(message(parse_gpu_list("1"), {"H100"}), "there is no GPU 1; this machine has only GPU 0 (H100)");
    EXPECT_EQ(message(parse_gpus("3"), two),
              "3 GPUs are asked for, but this machine has GPU 0 (H100) and GPU 1 (H200)");
    EXPECT_TRUE(contains(message({.count = 0}, {}), "no GPU"));
}

TEST(GpuChoice, BelongsToTheBackendCuda) {
    const BackendOptions two{.gpus = {.count = 2}};
    EXPECT_TRUE(contains(input_error([&] { (void)make_backend("cpu", two); }), "'cpu' has none"));
    EXPECT_TRUE(contains(input_error([&] { (void)make_backend("cuda:0", two); }), "already names"));
    EXPECT_TRUE(contains(input_error([] { (void)make_backend("cuda:x"); }), "cuda:x"));
    EXPECT_TRUE(contains(input_error([] { (void)make_backend("cpu:0"); }), "no backend 'cpu:0'"));
    EXPECT_EQ(why_unavailable("cuda:0,1"), why_unavailable("cuda"));
    EXPECT_EQ(gpu_names().empty(), !why_unavailable("cuda").empty());
}

}  // namespace
}  // namespace tandem
