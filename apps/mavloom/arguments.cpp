// SPDX-License-Identifier: MIT
#include "arguments.hpp"

#include <CLI/CLI.hpp>

namespace mavloom::app {

Option Option::required() { return Option(option_->required()); }
Option Option::capture_default_str() { return Option(option_->capture_default_str()); }
Option Option::default_str(const std::string& text) { return Option(option_->default_str(text)); }
Option Option::expected(int fewest, int most) { return Option(option_->expected(fewest, most)); }
Option Option::one_value_each() { return Option(option_->allow_extra_args(false)); }
Option Option::delimiter(char separator) { return Option(option_->delimiter(separator)); }
Option Option::range(int lowest, int highest) {
    return Option(option_->check(CLI::Range(lowest, highest).description("")));
}
Option Option::members(const std::vector<std::string>& words) { return Option(option_->check(CLI::IsMember(words))); }
Option Option::excludes(Option other) { return Option(option_->excludes(other.option_)); }
Option Option::needs(Option other) { return Option(option_->needs(other.option_)); }

Option Arguments::add_option(const std::string& name, const std::string& placeholder, std::string& value,
                             const std::string& description) {
    return Option(command_->add_option(name, value, description)->type_name(placeholder));
}

Option Arguments::add_option(const std::string& name, const std::string& placeholder, std::vector<std::string>& values,
                             const std::string& description) {
    return Option(command_->add_option(name, values, description)->type_name(placeholder));
}

Option Arguments::add_option(const std::string& name, const std::string& placeholder, int& value,
                             const std::string& description) {
    return Option(command_->add_option(name, value, description)->type_name(placeholder));
}

Option Arguments::add_option(const std::string& name, const std::string& placeholder, std::size_t& value,
                             const std::string& description) {
    return Option(command_->add_option(name, value, description)->type_name(placeholder));
}

Option Arguments::add_option(const std::string& name, const std::string& placeholder, std::uint8_t& value,
                             const std::string& description) {
    return Option(command_->add_option(name, value, description)->type_name(placeholder));
}

Option Arguments::add_flag(const std::string& name, bool& value, const std::string& description) {
    return Option(command_->add_flag(name, value, description));
}

Arguments Arguments::add_subcommand(const std::string& name, const std::string& description) {
    return Arguments(command_->add_subcommand(name, description));
}

void Arguments::require_subcommand() { command_->require_subcommand(1); }
void Arguments::fallthrough() { command_->fallthrough(); }
bool Arguments::parsed() const { return command_->parsed(); }
void Arguments::footer(const std::string& text) { command_->footer(text); }

}  // namespace mavloom::app
