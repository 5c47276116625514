/// The program itself, as far as it goes without rendering.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <memory>
#include <string>

#include "support/temporary_folder.h"
#include "tandem/base/version.h"

namespace tandem {
namespace {

struct Finished {
    int status = -1;
    std::string printed;  ///< standard output and standard error
};

Finished tandem_render(const std::string& arguments) {
    const std::string command = std::string("'") + TANDEM_RENDER_PROGRAM + "' " + arguments + " 2>&1";
    std::FILE* pipe = ::popen(command.c_str(), "r");
    Finished run;
    std::array<char, 4096> buffer;
    while (const std::size_t size = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
        run.printed.append(buffer.data(), size);
    }
    const int status = ::pclose(pipe);
    run.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return run;
}

TEST(CommandLine, HelpAndVersion) {
    const Finished help = tandem_render("--help");
    EXPECT_EQ(help.status, 0);
    for (const char* word : {"SCENE", "--frames", "--ppm-text", "--force", "--shutter-instants", "--exposure",
                             "--transfer", "--aov", "albedo", "named:paper"}) {
        EXPECT_NE(help.printed.find(word), std::string::npos) << word;
    }
    const Finished shown = tandem_render("--version");
    EXPECT_EQ(shown.status, 0);
    EXPECT_NE(shown.printed.find(version()), std::string::npos);
}

TEST(CommandLine, BadUsageIsStatusTwoAndNamesTheReason) {
    const test::TemporaryFolder folder;
    const std::string out = " -o '" + folder.file("a.png") + "'";
    using Case = std::pair<std::string, const char*>;
    for (const auto& [arguments, reason] :
         {Case{"", "SCENE"},
          Case{"named:paper", "--output"},
          Case{"named:paper --nonsense" + out, "nonsense"},
          Case{"named:paper --size 10" + out, "--size"},
          Case{"named:paper --size 0x10" + out, "--size"},
          Case{"named:paper --spp 0" + out, "samples"},
          Case{"named:paper --spp many" + out, "--spp"},
          Case{"named:paper --seed -1" + out, "--seed"},
          Case{"named:paper --frame -1" + out, "--frame"},
          Case{"named:paper --frames 3-1" + out, "--frames"},
          Case{"named:paper --frame 1 --frames 1-2" + out, "--frame"},
          Case{"named:paper --frames 0-1" + out, "frame number"},
          Case{"named:paper --tier best" + out, "best"},
          Case{"named:paper --backend abacus" + out, "abacus"},
          Case{"named:nothing" + out, "nothing"},
          Case{"named:paper -o a.jpg", ".png"},
          Case{"named:paper -o '" + folder.file("none/a.png") + "'", "none"},
          Case{"named:paper --threads -1" + out, "--threads"},
          Case{"named:paper --exposure bright" + out, "--exposure is 'bright'"},
          Case{"named:paper --exposure -101" + out, "--exposure is '-101'"},
          Case{"named:paper --exposure ''" + out, "--exposure"},
          Case{"named:paper --transfer gamma" + out, "'gamma'"},
          Case{"named:paper --camera under" + out, "front, back, left"},
          Case{"named:paper --light dim" + out, "--light"},
          Case{"named:paper --aov light" + out, "'light'"},
          Case{"named:paper --aov depth" + out, "a .pfm, with one file for each"},
          Case{"named:paper --aov variance --spp 1 -o '" + folder.file("a.pfm") + "'", "raise --spp"},
          Case{"named:paper --png-level 10" + out, "--png-level"}}) {
        const Finished run = tandem_render(arguments);
        EXPECT_EQ(run.status, 2) << arguments << "\n" << run.printed;
        EXPECT_NE(run.printed.find(reason), std::string::npos) << arguments << "\n" << run.printed;
    }
    EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace tandem
