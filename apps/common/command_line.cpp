#include "common/command_line.h"

#include <CLI/CLI.hpp>
#include <utility>

#include "common/run_main.h"

namespace tandem {

CommandOption CommandOption::required() const {
    option_->required();
    return *this;
}

CommandOption CommandOption::shows_default() const {
    option_->capture_default_str();
    return *this;
}

CommandOption CommandOption::separated_by_commas() const {
    option_->delimiter(',');
    return *this;
}

CommandOption CommandOption::shows_type(const char* name) const {
    option_->type_name(name);
    return *this;
}

CommandOption CommandOption::needs(const CommandOption& other) const {
    option_->needs(other.option_);
    return *this;
}

CommandOption CommandOption::excludes(const CommandOption& other) const {
    option_->excludes(other.option_);
    return *this;
}

CommandOption CommandOption::within(int least, int most) const {
    option_->check(CLI::Range(least, most));
    return *this;
}

CommandOption CommandOption::within(double least, double most) const {
    option_->check(CLI::Range(least, most));
    return *this;
}

CommandOption CommandOption::at_least_zero() const {
    option_->check(CLI::NonNegativeNumber);
    return *this;
}

CommandOption CommandOption::above_zero() const {
    option_->check(CLI::PositiveNumber);
    return *this;
}

CommandOption CommandOption::one_of(std::vector<std::string> words) const {
    option_->check(CLI::IsMember(std::move(words)));
    return *this;
}

bool CommandOption::is_given() const { return !option_->empty(); }

CommandLine::CommandLine(const std::string& description, const std::string& program)
    : owned_(std::make_shared<CLI::App>(description, program)), app_(owned_.get()) {}

CommandLine::CommandLine(CLI::App& command) : app_(&command) {}

CommandOption CommandLine::option(const std::string& names, const OptionTarget& target, const std::string& help) {
    return std::visit([&](auto* value) { return CommandOption(*app_->add_option(names, *value, help)); }, target);
}

CommandOption CommandLine::flag(const std::string& names, bool* target, const std::string& help) {
    return CommandOption(*app_->add_flag(names, *target, help));
}

void CommandLine::version(const std::string& version) { app_->set_version_flag("--version", version); }

void CommandLine::footer(const std::string& text) { app_->footer(text); }

CommandLine CommandLine::command(const std::string& name, const std::string& help) {
    app_->require_subcommand(1);
    return CommandLine(*app_->add_subcommand(name, help));
}

std::vector<CommandLine> CommandLine::commands() {
    std::vector<CommandLine> all;
    for (CLI::App* command : app_->get_subcommands({})) all.push_back(CommandLine(*command));
    return all;
}

bool CommandLine::is_given() const { return app_->parsed(); }

std::optional<int> CommandLine::parse(int argc, char** argv) {
    try {
        app_->parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app_->exit(error) == 0 ? exit_done : exit_bad_input;
    }
    return std::nullopt;
}

}  // namespace tandem
