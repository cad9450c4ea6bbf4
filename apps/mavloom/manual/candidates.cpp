// SPDX-License-Identifier: MIT
#include "manual/candidates.hpp"

#include <algorithm>
#include <ranges>

#include "mavloom/endpoint/schemes.hpp"

namespace mavloom::app {

namespace {

// Where the words so far lead.
struct CommandLine {
    std::vector<const DeclaredCommand*> commands;  // from the program to the innermost
    const DeclaredOption* open = nullptr;          // the option that takes the next word
    std::vector<std::string> positionals{};        // that were given to the innermost
    bool only_positionals = false;                 // after "--"

    [[nodiscard]] const DeclaredCommand& innermost() const { return *commands.back(); }
};

const DeclaredOption* find_option(const CommandLine& line, std::string_view name) {
    for (const auto* command : line.commands)
        for (const auto& option : command->options)
            if (std::ranges::find(option.names, name) != option.names.end()) return &option;
    return nullptr;
}

void take_option(CommandLine& line, const std::string& word) {
    line.only_positionals = word == "--";
    const auto* const option = find_option(line, word);
    if (option != nullptr && !option->placeholder.empty()) line.open = option;
}

void take(CommandLine& line, const std::string& word) {
    if (line.open != nullptr) return void(line.open = nullptr);
    if (!line.only_positionals && word.starts_with('-')) return take_option(line, word);
    const auto& subs = line.innermost().subcommands;
    const auto sub = std::ranges::find(subs, word, &DeclaredCommand::name);
    if (sub == subs.end()) return void(line.positionals.push_back(word));
    line.commands.push_back(&*sub);
    line.positionals.clear();
}

// Returns the positional argument that takes the next word, or null. The last one may take several words.
const DeclaredOption* next_positional(const CommandLine& line) {
    const DeclaredOption* last = nullptr;
    std::size_t i = 0;
    for (const auto& option : line.innermost().options) {
        if (!option.is_positional) continue;
        last = &option;
        if (i++ == line.positionals.size()) return last;
    }
    return last != nullptr && last->is_repeatable ? last : nullptr;
}

void add(Candidates& out, const std::vector<std::string>& words, const std::string& before = {},
         const std::string& after = {}) {
    for (const auto& word : words) out.all.push_back({before + word + after});
}

void add_endpoints(Candidates& out, const Vocabulary& vocabulary) {
    for (const auto& row : endpoint::scheme_rows)
        out.all.push_back({std::string(row.name) + "://", std::string(row.help)});
    add(out, vocabulary.rings(), "shm://");
    out.and_files = true;
}

// Names are separated by commas; `typed` may have some already.
void add_messages(Candidates& out, const std::string& typed, const std::string& after, const Vocabulary& vocabulary) {
    const auto comma = typed.rfind(',');
    add(out, vocabulary.messages(), comma == std::string::npos ? "" : typed.substr(0, comma + 1), after);
}

// "ATTITUDE.ro"
void add_fields(Candidates& out, const std::string& typed, const Vocabulary& vocabulary) {
    const auto dot = typed.find('.');
    if (dot == std::string::npos) return add_messages(out, typed, ".", vocabulary);
    add(out, vocabulary.fields(typed.substr(0, dot)), typed.substr(0, dot + 1), "=");
}

bool is_in(const CommandLine& line, std::string_view command) {
    return std::ranges::find(line.commands, command, &DeclaredCommand::name) != line.commands.end();
}

void add_names(Candidates& out, const CommandLine& line, const DeclaredOption& option, const Vocabulary& vocabulary) {
    if (is_in(line, "dialect")) return add(out, vocabulary.messages());
    if (is_in(line, "shm")) return add(out, vocabulary.rings());
    if (option.is_positional && (is_in(line, "ctl") || is_in(line, "stat"))) add(out, vocabulary.running());
}

// Adds the words that may follow the action of `ctl`.
void add_arguments(Candidates& out, const CommandLine& line, const Vocabulary& vocabulary) {
    if (!is_in(line, "ctl") || line.positionals.size() != 2) return;
    const auto &program = line.positionals.front(), &action = line.positionals.back();
    if (action == "wait") add(out, {"ready", "armed", "disarmed", "landed", "alt"});
    if (action == "remove" || action == "fault") add(out, vocabulary.links(program));
}

// Adds the words that fit the placeholder of the option.
void add_values(Candidates& out, const CommandLine& line, const DeclaredOption& option, const std::string& typed,
                const Vocabulary& vocabulary) {
    const std::string_view placeholder = option.placeholder;
    if (!option.choices.empty()) return add(out, option.choices);
    if (placeholder == "ENDPOINT" || placeholder == "SOURCE") return add_endpoints(out, vocabulary);
    if (placeholder == "MESSAGE:HZ") return add_messages(out, typed, ":", vocabulary);
    if (placeholder == "MESSAGE.FIELD=VALUE") return add_fields(out, typed, vocabulary);
    if (placeholder.find("MESSAGE") != placeholder.npos || placeholder == "NAMES")
        return add_messages(out, typed, "", vocabulary);
    if (placeholder == "NAME") return add_names(out, line, option, vocabulary);
    if (placeholder == "ACTION") return add(out, vocabulary.actions());
    if (placeholder == "ARGUMENT") return add_arguments(out, line, vocabulary);
    if (placeholder == "COMMAND")
        for (const auto& command : line.commands.front()->subcommands)
            out.all.push_back({command.name, command.description});
    out.and_files = placeholder.find("FILE") != placeholder.npos || placeholder.ends_with(".toml");
}

// Options of the program are accepted only before a command, options of a command also after its subcommands.
void add_options(Candidates& out, const CommandLine& line) {
    const std::size_t program = line.commands.size() > 1 ? 1 : 0;
    for (const auto* command : line.commands | std::views::drop(program))
        for (const auto& option : command->options) {
            const auto& name = option.names.back();
            if (!option.is_positional && std::ranges::find(out.all, name, &Candidate::word) == out.all.end())
                out.all.push_back({name, option.description});
        }
}

void add_free_word(Candidates& out, const CommandLine& line, const std::string& typed, const Vocabulary& vocabulary) {
    for (const auto& sub : line.innermost().subcommands) out.all.push_back({sub.name, sub.description});
    if (const auto* const option = next_positional(line)) add_values(out, line, *option, typed, vocabulary);
}

// "--max-rate=ATT": what follows the name of the option.
void add_after_equals(Candidates& out, const CommandLine& line, const std::string& typed, const Vocabulary& vocabulary) {
    const auto equals = typed.find('=');
    const auto* const option = find_option(line, typed.substr(0, equals));
    if (option == nullptr) return;
    add_values(out, line, *option, typed.substr(equals + 1), vocabulary);
    for (auto& candidate : out.all) candidate.word.insert(0, typed.substr(0, equals + 1));
    out.and_files = false;
}

}  // namespace

Candidates candidates(const DeclaredCommand& program, std::span<const std::string> words, const Vocabulary& vocabulary) {
    CommandLine line{{&program}};
    const std::string typed = words.empty() ? "" : words.back();
    if (!words.empty())
        for (const auto& word : words.first(words.size() - 1)) take(line, word);
    Candidates out;
    const bool is_option = !line.only_positionals && typed.starts_with('-');
    if (line.open != nullptr) add_values(out, line, *line.open, typed, vocabulary);
    else if (is_option && typed.find('=') != typed.npos) add_after_equals(out, line, typed, vocabulary);
    else if (is_option) add_options(out, line);
    else add_free_word(out, line, typed, vocabulary);
    std::erase_if(out.all, [&](const Candidate& candidate) { return !candidate.word.starts_with(typed); });
    return out;
}

}  // namespace mavloom::app
