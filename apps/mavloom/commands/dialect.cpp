// SPDX-License-Identifier: MIT
// `mavloom dialect list`, `show NAME` and `check FILE`: lists, shows and checks message definitions.
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <optional>
#include <system_error>

#include "command.hpp"
#include "dialect_print.hpp"
#include "mavloom/base/counted.hpp"
#include "mavloom/base/shown.hpp"
#include "mavloom/base/suggest.hpp"
#include "mavloom/base/text.hpp"

namespace mavloom::app {
namespace {

struct DialectOptions {
    bool json = false;
    std::string name;  // of `show`
    std::string file;  // of `check`
};

// A reader that closes the pipe early is not an error.
Exit write_out(const fmt::memory_buffer& text) {
    const bool whole = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
    if (whole || errno == EPIPE) return Exit::done;
    return fail(Exit::failed, fmt::format("cannot write: {}", std::generic_category().message(errno)));
}

std::optional<MessageId> as_id(std::string_view text) {
    std::uint32_t id = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), id);
    if (failure != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return MessageId{id};
}

std::vector<std::string_view> all_names(const dialect::Dialect& dialect) {
    std::vector<std::string_view> names;
    for (const auto& message : dialect.messages()) names.push_back(message.name);
    for (const auto& e : dialect.enums()) {
        names.push_back(e.name);
        for (const auto& entry : e.entries) names.push_back(entry.name);
    }
    return names;
}

bool show_entry(fmt::memory_buffer& out, const dialect::Dialect& dialect, std::string_view name, bool json) {
    for (const auto& e : dialect.enums()) {
        if (const auto* entry = e.find(name)) {
            (json ? json_entry : print_entry)(out, e, *entry);
            return true;
        }
    }
    return false;
}

// The name as the definitions spell it: ATTITUDE for `attitude`. The same text if there is none.
std::string_view spelling_of(std::string_view name, const dialect::Dialect& dialect) {
    const auto names = all_names(dialect);
    const auto same = std::ranges::find_if(names, [&](std::string_view known) { return same_letters(known, name); });
    return same == names.end() ? name : *same;
}

// Shows a message by name or id, an enum, or an entry of one. Returns false if there is none.
bool show(fmt::memory_buffer& out, const dialect::Dialect& dialect, const DialectOptions& options) {
    const auto id = as_id(options.name);
    const auto name = spelling_of(options.name, dialect);
    if (const auto* message = id ? dialect.find(*id) : dialect.find(name)) {
        (options.json ? json_message : print_message)(out, *message);
        return true;
    }
    if (const auto* e = dialect.find_enum(name)) {
        (options.json ? json_enum : print_enum)(out, *e);
        return true;
    }
    return show_entry(out, dialect, name, options.json);
}

Exit run_list(const Common& common, const DialectOptions& options) {
    const auto dialect = load_dialect(common);
    if (!dialect) return fail(dialect.error());
    fmt::memory_buffer out;
    (options.json ? json_list : print_list)(out, *dialect);
    return write_out(out);
}

Exit run_show(const Common& common, const DialectOptions& options) {
    const auto dialect = load_dialect(common);
    if (!dialect) return fail(dialect.error());
    fmt::memory_buffer out;
    if (show(out, *dialect, options)) return write_out(out);
    return fail(Exit::wrong_use, fmt::format("no message, enum or enum entry '{}'{}", options.name,
                                             did_you_mean(options.name, all_names(*dialect))));
}

struct DialectSummary {
    std::size_t messages = 0, enums = 0, entries = 0, fields = 0;
    std::size_t added = 0, changed = 0;  // compared with the built-in definitions
};

DialectSummary summarize(const dialect::Dialect& dialect) {
    DialectSummary summary;
    summary.messages = dialect.messages().size();
    summary.enums = dialect.enums().size();
    for (const auto& e : dialect.enums()) summary.entries += e.entries.size();
    for (const auto& message : dialect.messages()) {
        summary.fields += message.fields.size();
        const auto* known = dialect::default_dialect().find(message.id());
        if (known == nullptr) ++summary.added;
        else if (known->name != message.name || known->wire != message.wire) ++summary.changed;
    }
    return summary;
}

Exit run_check(const DialectOptions& options) {
    const auto dialect = dialect::Dialect::load(options.file);
    if (!dialect) return fail(Exit::bad_input, dialect.error().text);
    const auto s = summarize(*dialect);
    fmt::memory_buffer out;
    if (options.json) {
        fmt::format_to(
            std::back_inserter(out),
            "{{\"file\":{},\"messages\":{},\"fields\":{},\"enums\":{},\"entries\":{},\"added\":{},\"changed\":{}}}\n",
            json_quoted(options.file), s.messages, s.fields, s.enums, s.entries, s.added, s.changed);
    } else {
        fmt::format_to(std::back_inserter(out),
                       "{}: good; {} with {}, {} with {}\n"
                       "Compared with the built-in definitions: {} new, {} with another name or wire form\n",
                       printable(options.file), counted(s.messages, "message"), counted(s.fields, "field"),
                       counted(s.enums, "enum"), counted(s.entries, "entry", "entries"), counted(s.added, "id"),
                       s.changed);
    }
    return write_out(out);
}

}  // namespace

Run declare_dialect(Arguments command, const Common& common) {
    auto options = std::make_shared<DialectOptions>();
    command.require_subcommand();
    command.footer(
        "Examples: mavloom dialect show ATTITUDE\n"
        "          mavloom dialect show MAV_CMD_NAV_WAYPOINT\n"
        "          mavloom dialect check mine.xml");
    const auto part = [&](const char* name, const char* description, const char* examples) {
        auto added = command.add_subcommand(name, description);
        added.fallthrough();
        added.footer(examples);
        added.add_flag("--json", options->json, "print one JSON object per line");
        return added;
    };
    auto list = part("list", "list all messages: id, name, payload bytes (without..with extensions), file",
                     "Examples: mavloom dialect list\n"
                     "          mavloom dialect list --dialect mine.xml --json");
    auto show = part(
        "show", "show a message (by name or id), an enum, or an enum entry; a command is shown with its parameters",
        "Examples: mavloom dialect show ATTITUDE\n"
        "          mavloom dialect show MAV_CMD_NAV_WAYPOINT --json");
    show.add_option("NAME", "TEXT", options->name, "ATTITUDE, 30, MAV_TYPE, MAV_CMD_NAV_WAYPOINT").required();
    auto check = part("check", "check an XML file and its includes; exit status 3 if there is an error",
                      "Example: mavloom dialect check mine.xml");
    check.add_option("FILE", "TEXT", options->file, "message definitions in MAVLink's XML").required();
    return [&common, options, list, show, check] {
        if (list.parsed()) return run_list(common, *options);
        if (show.parsed()) return run_show(common, *options);
        return check.parsed() ? run_check(*options) : Exit::wrong_use;
    };
}

}  // namespace mavloom::app
