// Finding nvJitLink and NVRTC, and saying what is wrong when they are not found.
#include "cuda/jit_libraries.h"

#include <cuda_runtime_api.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "cuda/environment.h"
#include "support/temporary_folder.h"

namespace tandem::cuda {
namespace {

const std::string release = std::to_string(CUDART_VERSION / 1000);
const std::string linker_name = "libnvJitLink.so." + release;
const std::string compiler_name = "libnvrtc.so." + release;

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(JitLibraries, AnEmptyFolderIsNamedWithWhatToDo) {
    const test::TemporaryFolder folder;
    const JitLibraries libraries = open_jit_libraries({folder.file("")});
    EXPECT_EQ(libraries.linker, nullptr);
    EXPECT_EQ(libraries.compiler, nullptr);
    EXPECT_TRUE(says(libraries.problem, folder.file(""))) << libraries.problem;
    EXPECT_TRUE(says(libraries.problem, "TANDEM_CUDA_LIBRARIES")) << libraries.problem;
}

TEST(JitLibraries, NoFoldersAreAProblemToo) { EXPECT_NE(open_jit_libraries({}).problem, ""); }

TEST(JitLibraries, AFileThatIsNoLibraryIsPassedOver) {
    const test::TemporaryFolder folder;
    std::ofstream(folder.file(linker_name)) << "not a library";
    const JitLibraries libraries = open_jit_libraries({folder.file("")});
    EXPECT_EQ(libraries.linker, nullptr);
    EXPECT_TRUE(says(libraries.problem, linker_name)) << libraries.problem;
}

TEST(JitLibraries, AnotherReleaseIsNotTakenAndItsVersionIsSaid) {
    const test::TemporaryFolder folder;
    std::filesystem::copy_file(TANDEM_OTHER_RELEASE, folder.file(linker_name));
    const JitLibraries libraries = open_jit_libraries({folder.file("")});
    EXPECT_EQ(libraries.linker, nullptr);
    EXPECT_TRUE(says(libraries.problem, "is of CUDA 1.2")) << libraries.problem;
}

TEST(JitLibraries, ALibraryWithoutTheFunctionsIsNotTaken) {
    const test::TemporaryFolder folder;
    for (const std::string& place : jit_folders()) {
        const std::filesystem::path linker = std::filesystem::path(place) / linker_name;
        if (!place.empty() && std::filesystem::exists(linker)) {
            std::filesystem::create_symlink(linker, folder.file(linker_name));
            break;
        }
    }
    if (folder.names().empty()) GTEST_SKIP() << "no nvJitLink in a folder that is known by name";
    std::filesystem::copy_file(TANDEM_OTHER_RELEASE, folder.file(compiler_name));
    const JitLibraries libraries = open_jit_libraries({folder.file("")});
    EXPECT_NE(libraries.linker, nullptr);
    EXPECT_EQ(libraries.compiler, nullptr);
    EXPECT_TRUE(says(libraries.problem, "lacks nvrtc")) << libraries.problem;
}

TEST(JitLibraries, ALaterFolderServesWhenAnEarlierDoesNot) {
    if (!jit_libraries().problem.empty()) GTEST_SKIP() << jit_libraries().problem;
    const test::TemporaryFolder folder;
    std::filesystem::copy_file(TANDEM_OTHER_RELEASE, folder.file(linker_name));
    std::vector<std::string> folders = jit_folders();
    folders.insert(folders.begin(), folder.file(""));
    const JitLibraries libraries = open_jit_libraries(folders);
    EXPECT_EQ(libraries.problem, "");
    ASSERT_NE(libraries.linker, nullptr);
    EXPECT_EQ(libraries.linker->version, jit_libraries().linker->version);
}

TEST(JitLibraries, TheVariableReplacesTheUsualFolders) {
    const test::EnvironmentVariable variable("TANDEM_CUDA_LIBRARIES", "/one::/two");
    EXPECT_EQ(jit_folders(), (std::vector<std::string>{"/one", "/two"}));
}

TEST(JitLibraries, WithoutTheVariableTheLoadersPathIsFirst) {
    const test::EnvironmentVariable variable("TANDEM_CUDA_LIBRARIES", std::nullopt);
    const std::vector<std::string> folders = jit_folders();
    ASSERT_GE(folders.size(), 2U);
    EXPECT_EQ(folders.front(), "");
    for (std::size_t i = 1; i < folders.size(); ++i) EXPECT_TRUE(folders[i].starts_with('/')) << folders[i];
}

}  // namespace
}  // namespace tandem::cuda
