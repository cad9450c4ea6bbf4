// SPDX-License-Identifier: MIT
#include "mavloom/config/document.hpp"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "config/text.hpp"
#include "mavloom/base/shown.hpp"
#include "mavloom/base/suggest.hpp"
#include "mavloom/base/text.hpp"
#include "mavloom/net/run_folder.hpp"

namespace mavloom::config {

namespace {

constexpr std::string_view variable_prefix = "MAVLOOM_";

std::uint32_t line_in_file(const toml::node& node) { return static_cast<std::uint32_t>(node.source().begin.line); }

// Scalars as text, arrays joined by commas, tables as KEY:VALUE. Empty if the type has no such text.
std::optional<std::string> text_of(const toml::node& node) {
    if (const auto* text = node.as_string()) return text->get();
    if (const auto* number = node.as_integer()) return fmt::format("{}", number->get());
    if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
    if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
    std::vector<std::string> parts;
    if (const auto* list = node.as_array()) {
        for (const auto& item : *list) {
            auto text = item.is_value() ? text_of(item) : std::nullopt;
            if (!text) return std::nullopt;
            parts.push_back(std::move(*text));
        }
    } else if (const auto* table = node.as_table()) {
        for (const auto& [key, item] : *table) {
            const auto text = item.is_value() ? text_of(item) : std::nullopt;
            if (!text) return std::nullopt;
            parts.push_back(fmt::format("{}:{}", key.str(), *text));
        }
    } else {
        return std::nullopt;  // dates and times
    }
    return fmt::format("{}", fmt::join(parts, ","));
}

// The library sorts keys by name; readers expect the order of the file.
template <class T>
void sort_by_place(std::vector<std::pair<toml::source_position, T>>& items) {
    std::ranges::stable_sort(items, [](const auto& a, const auto& b) {
        return a.first.line != b.first.line ? a.first.line < b.first.line : a.first.column < b.first.column;
    });
}

template <class T>
std::vector<T> in_order(std::vector<std::pair<toml::source_position, T>> placed) {
    sort_by_place(placed);
    std::vector<T> items;
    items.reserve(placed.size());
    for (auto& [position, item] : placed) items.push_back(std::move(item));
    return items;
}

std::vector<Entry> entries_of(const toml::table& table, bool with_tables = true) {
    std::vector<std::pair<toml::source_position, Entry>> entries;
    for (const auto& [key, node] : table) {
        Entry entry{std::string(key.str()), text_of(node), line_in_file(node)};
        if (const auto* inner = node.as_table(); inner != nullptr && with_tables)
            entry.entries = entries_of(*inner, false);
        entries.emplace_back(node.source().begin, std::move(entry));
    }
    return in_order(std::move(entries));
}

bool is_list_of_tables(const toml::array& list) {
    return std::all_of(list.begin(), list.end(), [](const toml::node& node) { return node.is_table(); });
}

std::vector<Table> tables_of(const toml::table& root) {
    using Form = Table::Form;
    std::vector<std::pair<toml::source_position, Table>> tables;
    for (const auto& [key, node] : root) {
        const std::string name(key.str());
        if (const auto* table = node.as_table()) {
            tables.emplace_back(node.source().begin, Table{name, Form::table, line_in_file(node), entries_of(*table)});
        } else if (const auto* list = node.as_array(); list != nullptr && is_list_of_tables(*list)) {
            for (const auto& item : *list)
                tables.emplace_back(item.source().begin,
                                    Table{name, Form::one_of_list, line_in_file(item), entries_of(*item.as_table())});
        } else {
            tables.emplace_back(node.source().begin, Table{name, Form::other, line_in_file(node)});
        }
    }
    return in_order(std::move(tables));
}

// The TOML library handles dotted keys recursively, so a key of 50,000 parts would overflow the stack.
std::uint32_t line_with_endless_key(std::string_view text) {
    constexpr int max_dots = 1000;
    std::uint32_t line = 1;
    int dots = 0;
    for (const char c : text) {
        if (c == '.' && ++dots > max_dots) return line;
        if (c != '\n') continue;
        ++line;
        dots = 0;
    }
    return 0;
}

// The line of the file, counted from 1, without blanks at its ends.
std::string_view line_at(std::string_view text, std::uint32_t line) {
    for (; line > 1 && !text.empty(); --line) text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
    return trimmed(text.substr(0, text.find('\n')));
}

// A heading that only configurations of mavlink-router have, such as [General] or [UdpEndpoint alpha]; 0 if there is
// none, else its line.
std::uint32_t line_of_mavlink_router(std::string_view text) {
    std::uint32_t line = 1;
    for (auto rest = text; !rest.empty(); ++line) {
        const auto here = line_at(rest, 1);
        for (const std::string_view heading : {"[General]", "[UdpEndpoint ", "[UartEndpoint ", "[TcpEndpoint "})
            if (here.substr(0, heading.size()) == heading) return line;
        rest.remove_prefix(std::min(rest.find('\n'), rest.size() - 1) + 1);
    }
    return 0;
}

// Returns whether TOML takes the text as a value.
bool is_value(std::string_view text) {
    try {
        return !toml::parse(fmt::format("x = {}", text)).empty();
    } catch (const toml::parse_error&) {  // the library reports errors only this way
        return false;
    }
}

// The line without a comment at its end.
std::string_view without_comment(std::string_view line) { return trimmed(line.substr(0, line.find(" #"))); }

// A hint for `url = udpin://0.0.0.0:14550`: text needs quotes.
std::string quotes_hint(std::string_view line) {
    constexpr std::string_view begins_a_value = "\"'[{#";
    const auto equals = line.find('=');
    if (equals == std::string_view::npos) return {};
    const auto key = trimmed(line.substr(0, equals)), value = without_comment(line.substr(equals + 1));
    if (key.empty() || value.empty() || begins_a_value.find(value.front()) != std::string_view::npos) return {};
    if (is_value(value)) return {};  // the error is another one, such as a key that is given twice
    return fmt::format("; text is written in quotes: {} = \"{}\"", shown(key), shown(value));
}

std::string upper(std::string_view text) {
    std::string result(text);
    std::ranges::transform(result, result.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return result;
}

}  // namespace

const Entry* Table::find(std::string_view key) const noexcept {
    const auto found = std::ranges::find(entries, key, &Entry::key);
    return found == entries.end() ? nullptr : &*found;
}

const Table* Document::find(std::string_view name) const noexcept {
    const auto found = std::ranges::find(tables, name, &Table::name);
    return found == tables.end() ? nullptr : &*found;
}

tl::unexpected<SetupError> Document::error(std::uint32_t line, std::string_view what) const {
    return setup_error(SetupCode::bad_input, fmt::format("{}:{}: {}", file, line, what));
}

SetupResult<void> Document::check_tables(std::span<const std::string_view> sections,
                                         std::span<const std::string_view> lists) const {
    std::vector<std::string_view> known(sections.begin(), sections.end());
    known.insert(known.end(), lists.begin(), lists.end());
    for (const Table& table : tables) {
        if (std::ranges::find(known, table.name) == known.end()) {
            auto hint = did_you_mean(table.name, known);
            if (hint.empty()) hint = fmt::format("; there are {}", fmt::join(known, ", "));
            return error(table.line, fmt::format("there is no section {}{}", in_quotes(table.name), hint));
        }
        const bool is_list = std::ranges::find(lists, table.name) != lists.end();
        if (table.form == (is_list ? Table::Form::one_of_list : Table::Form::table)) continue;
        return error(table.line,
                     is_list ? fmt::format("{}s are written [[{}]], each with its own heading", table.name, table.name)
                             : fmt::format("'{}' is a section; write [{}]", table.name, table.name));
    }
    return {};
}

SetupResult<void> Document::check_keys(const Table& table, std::span<const std::string_view> known) const {
    const auto heading = table.form == Table::Form::one_of_list ? fmt::format("[[{}]]", table.name)
                                                                : fmt::format("[{}]", table.name);
    for (const Entry& entry : table.entries) {
        if (std::ranges::find(known, entry.key) != known.end()) continue;
        auto hint = did_you_mean(entry.key, known);
        if (hint.empty()) hint = fmt::format("; {} has {}", heading, fmt::join(known, ", "));
        return error(entry.line, fmt::format("{} has no key {}{}", heading, in_quotes(entry.key), hint));
    }
    return {};
}

SetupResult<std::string> Document::text_of(const Entry& entry) const {
    if (!entry.text) return error(entry.line, fmt::format("{} has a value of the wrong type", shown(entry.key)));
    return *entry.text;
}

SetupResult<Document> parse_document(std::string_view text, std::string_view file_name) {
    Document document{std::string(file_name), {}};
    if (text.find('\0') != std::string_view::npos)
        return document.error(
            1, fmt::format("this is not a text file; if it is a recording, mavloom listen {} shows it", file_name));
    if (const auto line = line_with_endless_key(text); line != 0)
        return document.error(line, "more than 1000 dots in one line: expected keys like router.dedup_ms");
    if (const auto line = line_of_mavlink_router(text); line != 0)
        return document.error(line,
                              fmt::format("this is a configuration of mavlink-router; to convert it, type mavloom "
                                          "check --convert {} > router.toml",
                                          file_name));
    try {
        document.tables = tables_of(toml::parse(text, file_name));
        return document;
    } catch (const toml::parse_error& error) {  // the library reports errors only this way
        const auto line = static_cast<std::uint32_t>(error.source().begin.line);
        return document.error(line, fmt::format("{}{}", error.description(), quotes_hint(line_at(text, line))));
    }
}

SetupResult<Document> load_document(const std::filesystem::path& file) {
    const auto text = detail::read_config_text(file);
    if (!text) return tl::unexpected(text.error());
    return parse_document(*text, file.string());
}

// ---- environment ----------------------------------------------------------------------------------------------------

Environment environment_of(const char* const* envp, std::string_view prefix) {
    Environment environment;
    for (; envp != nullptr && *envp != nullptr; ++envp) {
        const std::string_view text(*envp);
        const auto equals = text.find('=');
        if (equals == std::string_view::npos) continue;
        if (text.starts_with(prefix)) environment.emplace_back(text.substr(0, equals), text.substr(equals + 1));
    }
    return environment;
}

std::string Variables::name_of(const Name& name) {
    return fmt::format("{}{}_{}", variable_prefix, upper(name.section), upper(name.key));
}

const std::string* Variables::find(const Name& name) const {
    const auto variable = std::ranges::find(environment_, name_of(name), &Environment::value_type::first);
    return variable == environment_.end() ? nullptr : &variable->second;
}

bool Variables::is_of_a_section(std::string_view variable) const {
    return std::ranges::any_of(known_, [&](const Name& known) {
        return variable.substr(variable_prefix.size()).starts_with(upper(known.section) + "_");
    });
}

// A misspelt variable must not be ignored silently. Other variables with this prefix may belong to other programs.
SetupResult<void> Variables::check(std::vector<std::string>& notes) const {
    std::vector<std::string> names;
    names.reserve(known_.size());
    for (const Name& known : known_) names.push_back(name_of(known));
    // Compare without the prefix; with it, every name would look similar.
    std::vector<std::string_view> known;
    known.reserve(names.size());
    for (const std::string_view name : names) known.push_back(name.substr(variable_prefix.size()));
    for (const auto& [name, value] : environment_) {
        const bool is_known = name == net::run_variable || std::ranges::find(names, name) != names.end();
        if (!name.starts_with(variable_prefix) || is_known) continue;
        const auto near = nearest(std::string_view(name).substr(variable_prefix.size()), known);
        const auto hint = near.empty() ? std::string() : fmt::format(", did you mean '{}{}'?", variable_prefix, near);
        auto what = fmt::format("environment: {} sets nothing{}", shown(name), hint);
        if (!near.empty() || is_of_a_section(name)) return setup_error(SetupCode::bad_input, std::move(what));
        notes.push_back(std::move(what));
    }
    return {};
}

}  // namespace mavloom::config
