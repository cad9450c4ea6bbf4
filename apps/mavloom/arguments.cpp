// SPDX-License-Identifier: MIT
#include "arguments.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "mavloom/base/shown.hpp"

namespace mavloom::app {

namespace {

// The check of `members` describes itself as {a,b}, behind the placeholder: "WHICH:{usual,free}".
std::vector<std::string> choices_in(const std::string& type_name) {
    const auto begin = type_name.find(":{");
    if (begin == std::string::npos || !type_name.ends_with('}')) return {};
    return CLI::detail::split(type_name.substr(begin + 2, type_name.size() - begin - 3), ',');
}

DeclaredOption declared(const CLI::Option& option) {
    DeclaredOption out;
    out.description = option.get_description();
    out.is_positional = option.get_positional();
    if (out.is_positional) out.names.push_back(option.get_name());
    for (const auto& name : option.get_snames()) out.names.push_back("-" + name);
    for (const auto& name : option.get_lnames()) out.names.push_back("--" + name);
    out.is_required = option.get_required();
    if (option.get_items_expected_max() == 0) return out;
    const auto type_name = option.get_type_name();
    out.placeholder = type_name.substr(0, type_name.find(":{"));
    if (out.is_positional && out.placeholder == "TEXT") out.placeholder = option.get_name();
    out.choices = choices_in(type_name);
    out.is_repeatable = option.get_items_expected_max() > 1;
    return out;
}

DeclaredCommand declared(const CLI::App& command) {
    DeclaredCommand out{command.get_name(), command.get_description(), command.get_footer()};
    for (const auto* option : command.get_options())
        if (!option->get_group().empty()) out.options.push_back(declared(*option));  // without a group it is hidden
    for (const auto* sub : command.get_subcommands([](const CLI::App*) { return true; }))
        out.subcommands.push_back(declared(*sub));
    return out;
}

}  // namespace

Option Option::required() { return Option(option_->required()); }
Option Option::capture_default_str() { return Option(option_->capture_default_str()); }
Option Option::default_str(const std::string& text) { return Option(option_->default_str(text)); }
Option Option::expected(int fewest, int most) { return Option(option_->expected(fewest, most)); }
Option Option::one_value_each() { return Option(option_->allow_extra_args(false)); }
Option Option::delimiter(char separator) { return Option(option_->delimiter(separator)); }
Option Option::range(int lowest, int highest) {
    return Option(option_->check(CLI::Range(lowest, highest).description("")));
}
Option Option::members(const std::vector<std::string>& words) {
    const auto check = [words](const std::string& value) {
        if (std::ranges::find(words, value) != words.end()) return std::string();
        return fmt::format("{} is not one of {}", in_quotes(value), fmt::join(words, ", "));
    };
    return Option(option_->check(CLI::Validator(check, fmt::format("{{{}}}", fmt::join(words, ",")))));
}
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

DeclaredCommand Arguments::program() const {
    const CLI::App* top = command_;
    while (top->get_parent() != nullptr) top = top->get_parent();
    return declared(*top);
}

}  // namespace mavloom::app
