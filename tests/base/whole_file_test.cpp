#include "tandem/base/whole_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <thread>

#include "images/sample_images.h"
#include "support/temporary_folder.h"
#include "support/thrown_message.h"
#include "tandem/base/error.h"

namespace tandem {
namespace {

using namespace test;
using Names = std::vector<std::string>;

TEST(WholeFile, WritesReadsAndReplaces) {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.bin");
    for (const auto durability : {Durability::written, Durability::synced}) {
        for (const std::string& content : {std::string("first"), std::string(100'000, '\0'), std::string()}) {
            write_file(path, content, durability);
            EXPECT_EQ(text_of(read_file(path)), content);
        }
    }
    EXPECT_EQ(folder.names(), Names{"a.bin"});
}

TEST(WholeFile, FollowsTheUmask) {
    const TemporaryFolder folder;
    const mode_t before = ::umask(027);
    write_file(folder.file("a"), "x");
    ::umask(before);
    struct stat status = {};
    ASSERT_EQ(::stat(folder.file("a").c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777U, 0640U);
}

TEST(WholeFile, AFailedRenameLeavesNoTemporary) {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder.file("target/full"));
    const auto message = thrown_message<InputError>([&] { write_file(folder.file("target"), "x"); });
    EXPECT_NE(message.find(folder.file("target")), std::string::npos) << message;
    EXPECT_EQ(folder.names(), Names{"target"});
}

/// No file of this process can grow beyond `bytes` while it lives: a full disk that needs no disk.
class FileSizeLimit {
  public:
    explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
        ::getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit limit = {bytes, before_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() {
        ::setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

  private:
    rlimit before_ = {};
    void (*handler_)(int);
};

TEST(WholeFile, NoSpaceLeavesTheOldFileWhole) {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.bin");
    write_file(path, "old");
    std::string message;
    {
        const FileSizeLimit limit(1000);
        message = thrown_message<EnvironmentError>([&] { write_file(path, std::string(5000, 'n')); });
    }
    EXPECT_NE(message.find(path), std::string::npos) << message;
    EXPECT_NE(message.find("File too large"), std::string::npos) << message;
    EXPECT_EQ(folder.names(), Names{"a.bin"});
    EXPECT_EQ(text_of(read_file(path)), "old");
}

TEST(WholeFile, AMissingFolderIsNamed) {
    const TemporaryFolder folder;
    const std::string path = folder.file("none/a.bin");
    const auto reason = [&](auto action) { return thrown_message<InputError>(action); };
    EXPECT_NE(reason([&] { write_file(path, "x"); }).find("No such file or directory"), std::string::npos);
    EXPECT_NE(reason([&] { check_can_write(path); }).find(folder.file("none")), std::string::npos);
    EXPECT_FALSE(reason([&] { check_can_write(folder.file("")); }).empty());
    EXPECT_FALSE(reason([&] { (void)read_file(path); }).empty());
    EXPECT_NO_THROW(check_can_write(folder.file("a.bin")));
    EXPECT_TRUE(folder.names().empty());
}

TEST(WholeFile, AReadOnlyPlaceIsAnInputError) {
    const TemporaryFolder folder;
    std::string place = folder.file("closed");
    std::filesystem::create_directory(place);
    std::filesystem::permissions(place, std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
    if (::geteuid() == 0) place = "/proc/self";  // the superuser may write everywhere but there
    const auto message = thrown_message<InputError>([&] { write_file(place + "/a.bin", "x"); });
    EXPECT_NE(message.find("cannot write '" + place + "/a.bin': "), std::string::npos) << message;
}

TEST(WholeFile, OnlyRegularFilesAreRead) {
    const TemporaryFolder folder;
    const auto pipe = folder.file("pipe");
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_FALSE(thrown_message<InputError>([&] { (void)read_file(pipe); }).empty());
    EXPECT_FALSE(thrown_message<InputError>([&] { (void)read_file(folder.file("")); }).empty());
    EXPECT_FALSE(thrown_message<InputError>([] { (void)read_file("/dev/zero"); }).empty());
}

TEST(WholeFile, WritersOfOneTargetDoNotMix) {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.bin");
    std::vector<std::thread> writers;
    for (char letter = 'a'; letter < 'e'; ++letter) {
        writers.emplace_back([&, letter] {
            for (int i = 0; i < 20; ++i) write_file(path, std::string(20'000, letter), Durability::written);
        });
    }
    for (std::thread& writer : writers) writer.join();
    const Bytes bytes = read_file(path);
    ASSERT_EQ(bytes.size(), 20'000U);
    EXPECT_EQ(bytes, Bytes(20'000, bytes.front()));
    EXPECT_EQ(folder.names(), Names{"a.bin"});
}

}  // namespace
}  // namespace tandem
