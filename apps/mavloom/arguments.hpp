// SPDX-License-Identifier: MIT
// The interface with which a command declares its arguments: a thin layer over CLI11.
// Only arguments.cpp and main.cpp include CLI11, because its headers add six seconds to the compilation of each file.
// Both classes are handles and may be copied freely. The CLI11 objects behind them live until the command has run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "manual/declared.hpp"

namespace CLI {  // NOLINT(readability-identifier-naming): CLI11's name
class App;
class Option;
}  // namespace CLI

namespace mavloom::app {

class Option {
public:
    explicit Option(CLI::Option* option) : option_(option) {}

    Option required();
    Option capture_default_str();
    Option default_str(const std::string& text);
    Option expected(int fewest, int most);
    // For an option that may be repeated: it takes one value each time, so that an argument may follow it.
    Option one_value_each();
    Option delimiter(char separator);
    Option range(int lowest, int highest);
    Option members(const std::vector<std::string>& words);
    Option excludes(Option other);
    Option needs(Option other);

private:
    CLI::Option* option_;
};

class Arguments {
public:
    explicit Arguments(CLI::App* command) : command_(command) {}

    // A name without dashes is positional. `placeholder` stands for the value in the help. The variable must live until
    // the command has run.
    Option add_option(const std::string& name, const std::string& placeholder, std::string& value,
                      const std::string& description);
    Option add_option(const std::string& name, const std::string& placeholder, std::vector<std::string>& values,
                      const std::string& description);
    Option add_option(const std::string& name, const std::string& placeholder, int& value,
                      const std::string& description);
    Option add_option(const std::string& name, const std::string& placeholder, std::size_t& value,
                      const std::string& description);
    Option add_option(const std::string& name, const std::string& placeholder, std::uint8_t& value,
                      const std::string& description);
    Option add_flag(const std::string& name, bool& value, const std::string& description);

    Arguments add_subcommand(const std::string& name, const std::string& description);
    void require_subcommand();
    void fallthrough();
    [[nodiscard]] bool parsed() const;

    void footer(const std::string& text);

    // Returns the declarations of the whole program. Call it after all commands are declared.
    [[nodiscard]] DeclaredCommand program() const;

private:
    CLI::App* command_;
};

}  // namespace mavloom::app
