#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "common/command_line.h"
#include "common/run_main.h"

namespace tandem {
namespace {

/// What parse() returns for a program's words.
std::optional<int> parse(CommandLine& line, std::vector<std::string> words) {
    words.insert(words.begin(), "program");
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    return line.parse(static_cast<int>(pointers.size()), pointers.data());
}

TEST(CommandOption, SetsItsVariableAndKeepsItWhenItIsNotGiven) {
    int count = 3;
    double length = 0.5;
    bool quiet = false, plans = true;
    std::vector<int> levels = {1};
    std::optional<std::string> name;
    CommandLine line("", "program");
    const CommandOption given = line.option("--length", &length, "");
    const CommandOption missing = line.option("--count", &count, "");
    line.option("--levels", &levels, "").separated_by_commas();
    line.option("NAME", &name, "");
    line.flag("--quiet", &quiet, "");
    line.flag("!--no-plans", &plans, "");
    EXPECT_EQ(parse(line, {"--length", "0.25", "--levels", "2,3", "--quiet", "--no-plans", "x"}), std::nullopt);
    EXPECT_TRUE(given.is_given());
    EXPECT_EQ(length, 0.25);
    EXPECT_FALSE(missing.is_given());
    EXPECT_EQ(count, 3);
    EXPECT_EQ(levels, (std::vector{2, 3}));
    EXPECT_TRUE(quiet);
    EXPECT_FALSE(plans);
    EXPECT_EQ(name, "x");
}

TEST(CommandOption, RefusesValuesThatAreNotAllowed) {
    struct Case {
        std::vector<std::string> words;
        bool is_allowed;
    };
    const std::vector<Case> cases = {
        {{"--within", "1"}, true},
        {{"--within", "9"}, true},
        {{"--within", "0"}, false},
        {{"--within", "10"}, false},
        {{"--within", "x"}, false},
        {{"--real", "0.25"}, true},
        {{"--real", "0.26"}, false},
        {{"--zero", "0"}, true},
        {{"--zero", "-1"}, false},
        {{"--above", "0"}, false},
        {{"--above", "1e-9"}, true},
        {{"--word", "b"}, true},
        {{"--word", "c"}, false},
        {{"--unknown", "1"}, false},
        {{"--needs", "1"}, false},
        {{"--not", "1"}, true},
        {{"--zero", "1", "--needs", "1"}, true},
        {{"--zero", "1", "--not", "1"}, false},
    };
    for (const Case& c : cases) {
        int within = 1, zero = 0, other = 0;
        double real = 0, above = 1;
        std::string word;
        CommandLine line("", "program");
        line.option("--within", &within, "").within(1, 9);
        line.option("--real", &real, "").within(0.0, 0.25);
        const CommandOption first = line.option("--zero", &zero, "").at_least_zero();
        line.option("--above", &above, "").above_zero();
        line.option("--word", &word, "").one_of({"a", "b"});
        line.option("--needs", &other, "").needs(first);
        line.option("--not", &other, "").excludes(first);
        EXPECT_EQ(parse(line, c.words), c.is_allowed ? std::nullopt : std::optional<int>(exit_bad_input))
            << c.words[0] << ' ' << c.words[1];
    }
}

TEST(CommandOption, IsMissedIfItIsRequired) {
    std::string scene;
    CommandLine line("", "program");
    line.option("SCENE", &scene, "").required();
    EXPECT_EQ(parse(line, {}), exit_bad_input);
    EXPECT_EQ(parse(line, {"--help"}), exit_done);
}

TEST(CommandLine, WithCommandsNeedsOneOfThem) {
    const auto ask = [](const std::vector<std::string>& words) {
        int value = 0;
        CommandLine line("", "program");
        const CommandLine first = line.command("first", "");
        const CommandLine second = line.command("second", "");
        for (CommandLine command : line.commands()) command.option("--value", &value, "");
        const std::optional<int> status = parse(line, words);
        return status ? "status " + std::to_string(*status)
                      : std::to_string(first.is_given()) + std::to_string(second.is_given()) + std::to_string(value);
    };
    EXPECT_EQ(ask({}), "status 2");
    EXPECT_EQ(ask({"third"}), "status 2");
    EXPECT_EQ(ask({"first", "--value", "5"}), "105");
    EXPECT_EQ(ask({"second"}), "010");
}

}  // namespace
}  // namespace tandem
