/// The command line of a program, parsed by CLI11. Only command_line.cpp includes CLI11, which takes seconds to
/// compile. Tested in tests/apps/common/command_line_test.cpp.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace tandem {

/// The variable that an option sets. It keeps its value if the user does not give the option. It has to outlive
/// parse().
using OptionTarget = std::variant<int*, std::uint64_t*, float*, double*, std::string*, std::optional<std::string>*,
                                  std::vector<int>*, std::vector<std::string>*>;

/// An option that option() or flag() declared. Its functions return it, so that calls can be chained. It is valid as
/// long as the CommandLine of the program.
class CommandOption {
  public:
    CommandOption required() const;
    CommandOption shows_default() const;               ///< the value of the variable now, in --help
    CommandOption separated_by_commas() const;         ///< a list as one word
    CommandOption shows_type(const char* name) const;  ///< in --help, instead of the type of the variable
    CommandOption needs(const CommandOption& other) const;
    CommandOption excludes(const CommandOption& other) const;
    /// The values that are allowed, ends included. For a list: each of its values.
    CommandOption within(int least, int most) const;
    CommandOption within(double least, double most) const;
    CommandOption at_least_zero() const;
    CommandOption above_zero() const;
    CommandOption one_of(std::vector<std::string> words) const;

    /// After CommandLine::parse().
    [[nodiscard]] bool is_given() const;

  private:
    friend class CommandLine;
    explicit CommandOption(CLI::Option& option) : option_(&option) {}

    CLI::Option* option_;
};

class CommandLine {
  public:
    CommandLine(const std::string& description, const std::string& program);

    /// names: "--size", "-o,--output", or without hyphens "SCENE" for an argument that is found by its place.
    CommandOption option(const std::string& names, const OptionTarget& target, const std::string& help);
    /// An option without a value. "!--no-plans" sets false.
    CommandOption flag(const std::string& names, bool* target, const std::string& help);
    /// --version, which prints `version`.
    void version(const std::string& version);
    /// The end of --help.
    void footer(const std::string& text);

    /// Declares a command, such as info in `tandem-gltf info`. Then the user has to give one of the commands. The
    /// result is valid as long as this object.
    CommandLine command(const std::string& name, const std::string& help);
    [[nodiscard]] std::vector<CommandLine> commands();
    /// Whether the user gave this command; after parse().
    [[nodiscard]] bool is_given() const;

    /// Sets the variables. Returns nothing if the program shall run, and otherwise its exit status: exit_done after
    /// --help or --version, exit_bad_input after a message on standard error about wrong usage.
    [[nodiscard]] std::optional<int> parse(int argc, char** argv);

  private:
    explicit CommandLine(CLI::App& command);

    std::shared_ptr<CLI::App> owned_;  ///< none for a command
    CLI::App* app_;
};

}  // namespace tandem
