// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <unistd.h>

#include "command.hpp"
#include "dialect_print.hpp"
#include "mavloom/base/shown.hpp"
#include "mavloom/config/config.hpp"
#include "mavloom/config/convert.hpp"
#include "mavloom/config/document.hpp"
#include "mavloom/simserve/scenario.hpp"
#include "output.hpp"

namespace mavloom::app {

namespace {

struct CheckOptions {
    std::string file;
    bool json = false;
    bool convert = false;  // the file is a configuration of mavlink-router
};

std::string_view origin_name(config::Origin origin) {
    switch (origin) {
        case config::Origin::by_default: return "default";
        case config::Origin::file: return "file";
        case config::Origin::environment: return "environment";
        case config::Origin::option: return "option";  // not here: `check` has none
    }
    return {};
}

std::string where(const config::Setting& setting, std::string_view file) {
    if (setting.origin == config::Origin::file) return fmt::format("{}:{}", printable(file), setting.line);
    return setting.origin == config::Origin::environment ? setting.variable : "default";
}

void print_text(message::TextBuffer& out, std::span<const config::Section> sections, std::string_view file) {
    for (const auto& section : sections) {
        const auto heading = section.label.empty() ? fmt::format("[{}]", section.name)
                                                   : fmt::format("[[{}]]  {}", section.name, section.label);
        fmt::format_to(fmt::appender(out), "{}\n", heading);
        for (const auto& setting : section.settings)
            fmt::format_to(fmt::appender(out), "  {:<17} = {:<32}  # {}\n", setting.key,
                           setting.value.empty() ? "(not set)" : setting.value, where(setting, file));
    }
}

// Prints one object a line:
// {"section":"router","endpoint":null,"key":"dedup_ms","value":"0","origin":"default",
// "file":null,"line":null,"variable":null}
void print_json(message::TextBuffer& out, std::span<const config::Section> sections, std::string_view file) {
    const auto text = [](std::string_view t) { return t.empty() ? std::string("null") : json_quoted(t); };
    for (const auto& section : sections) {
        for (const auto& setting : section.settings) {
            const bool in_file = setting.origin == config::Origin::file;
            fmt::format_to(fmt::appender(out),
                           "{{\"section\":{},\"endpoint\":{},\"key\":{},\"value\":{},\"origin\":\"{}\",\"file\":{},"
                           "\"line\":{},\"variable\":{}}}\n",
                           json_quoted(section.name), text(section.label), json_quoted(setting.key),
                           text(setting.value), origin_name(setting.origin), in_file ? json_quoted(file) : "null",
                           in_file ? fmt::format("{}", setting.line) : "null", text(setting.variable));
        }
    }
}

Exit print(const CheckOptions& options, std::span<const config::Section> sections) {
    Output output;
    if (options.json) print_json(output.buffer(), sections, options.file);
    else print_text(output.buffer(), sections, options.file);
    return output.flush() == Output::State::failed ? fail(output.error()) : Exit::done;
}

Exit check_router(const Common& common, const CheckOptions& options, const config::Document& document,
                  const dialect::Dialect& dialect) {
    const auto config = config::read_config(document, config::environment_of(environ));
    if (!config) return fail(Exit::bad_input, config.error().text);
    if (const auto checked = config::check_for_router(*config, options.file, dialect); !checked)
        return fail(checked.error());
    for (const auto& note : config->notes) print_notice(common, note);
    for (const auto& warning : config::config_warnings(*config, options.file, dialect)) print_notice(common, warning);
    return print(options, config->sections);
}

Exit check_scenario(const Common& common, const CheckOptions& options, const config::Document& document) {
    auto scenario = simserve::read_scenario(document, config::environment_of(environ), {});
    if (!scenario) return fail(Exit::bad_input, scenario.error().text);
    const auto px4 = config::environment_of(environ, simserve::px4_prefix);
    if (const auto good = simserve::complete_hil(*scenario, document, px4); !good)
        return fail(Exit::bad_input, good.error().text);
    if (const auto checked = simserve::check_scenario(*scenario, document); !checked) return fail(checked.error());
    for (const auto& note : scenario->notes) print_notice(common, note);
    return print(options, scenario->sections);
}

Exit check(const Common& common, const CheckOptions& options) {
    const auto dialect = load_dialect(common);
    if (!dialect) return fail(dialect.error());
    const auto document = config::load_document(options.file);
    if (!document) return fail(Exit::bad_input, document.error().text);
    return simserve::is_scenario(*document) ? check_scenario(common, options, *document)
                                            : check_router(common, options, *document, *dialect);
}

// Prints the settings that cannot be converted. It ignores --quiet, because the user has to know them.
Exit convert(const CheckOptions& options) {
    const auto done = config::convert_mavlink_router_file(options.file);
    if (!done) return fail(of_input_file(done.error()));
    for (const auto& note : done->notes)
        write_stderr_line(fmt::format("{}:{}: [{}]{}{}: {}", options.file, note.line, shown(note.section),
                                      note.key.empty() ? "" : " ", shown(note.key), note.text));
    Output output;
    fmt::format_to(fmt::appender(output.buffer()), "{}", done->toml);
    return output.flush() == Output::State::failed ? fail(output.error()) : Exit::done;
}

}  // namespace

Run declare_check(Arguments command, const Common& common) {
    auto options = std::make_shared<CheckOptions>();
    command.add_option("file", "FILE", options->file, "a router's configuration, or a simulator's scenario (TOML)")
        .required();
    auto json = command.add_flag("--json", options->json, "print one JSON object per line, one for each value");
    command
        .add_flag("--convert", options->convert,
                  "FILE is a configuration of mavlink-router: convert it, and report what cannot be converted")
        .excludes(json);
    command.footer(
        "A file with [sim], [streams] or [[vehicle]] is a scenario of `mavloom sim`.\n"
        "Prints every effective value and its origin: default, FILE:LINE, or an environment variable, for example\n"
        "MAVLOOM_ROUTER_DEDUP_MS for dedup_ms in [router]. If the file has an error, the message names its line and\n"
        "the exit status is 3. Message names are looked up in the built-in definitions and those of --dialect. Key\n"
        "files are read; no port is opened.\n\n"
        "Examples:\n"
        "  mavloom check router.toml\n"
        "  mavloom check scenario.toml\n"
        "  mavloom check --convert main.conf > router.toml");
    return [options, &common] { return options->convert ? convert(*options) : check(common, *options); };
}

}  // namespace mavloom::app
