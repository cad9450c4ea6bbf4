// SPDX-License-Identifier: MIT
#include "mavloom/config/config.hpp"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <array>
#include <cctype>

#include "config/keys.hpp"
#include "config/places.hpp"
#include "config/text.hpp"
#include "mavloom/base/suggest.hpp"
#include "mavloom/endpoint/grammar.hpp"
#include "mavloom/net/run_folder.hpp"

namespace mavloom::config {

using namespace detail;

namespace {

constexpr std::array<std::string_view, 7> place_keys{"url", "scheme", "host", "port", "path", "ring", "name"};

constexpr std::string_view variable_prefix = "MAVLOOM_";

std::string upper(std::string_view text) {
    std::string result(text);
    std::ranges::transform(result, result.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return result;
}

std::uint32_t line_in_file(const toml::node& node) { return static_cast<std::uint32_t>(node.source().begin.line); }

// Converts a value to the text of the endpoint grammar: scalars as text, arrays joined by commas, tables as
// KEY:VALUE. Empty if the type has no such text.
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

class Loader {
public:
    Loader(std::string_view file, const Environment& environment) : file_(file), environment_(environment) {}

    SetupResult<Config> load(std::string_view text) {
        const auto root = parse(text);
        if (!root) return tl::unexpected(root.error());
        if (auto done = check_sections(*root); !done) return tl::unexpected(std::move(done.error()));
        if (auto done = check_environment(); !done) return tl::unexpected(std::move(done.error()));
        for (const auto name : config_sections())
            if (auto done = read_section(name, (*root)[name].as_table()); !done)
                return tl::unexpected(std::move(done.error()));
        if (auto done = check_requests(); !done) return tl::unexpected(std::move(done.error()));
        if (const auto* endpoints = (*root)["endpoint"].as_array())
            for (const auto& item : *endpoints)
                if (auto done = read_endpoint(*item.as_table()); !done) return tl::unexpected(std::move(done.error()));
        if (auto done = check_ports(config_, file_); !done) return tl::unexpected(std::move(done.error()));
        if (auto done = check_recordings(config_, file_); !done) return tl::unexpected(std::move(done.error()));
        return std::move(config_);
    }

private:
    [[nodiscard]] tl::unexpected<SetupError> bad(std::uint32_t line, std::string_view what) const {
        return setup_error(SetupCode::bad_input, fmt::format("{}:{}: {}", file_, line, what));
    }

    // The TOML library handles dotted keys recursively, so a key of 50,000 parts would overflow the stack.
    [[nodiscard]] std::uint32_t line_with_endless_key(std::string_view text) const {
        constexpr int most_dots = 1000;
        std::uint32_t line = 1;
        int dots = 0;
        for (const char c : text) {
            if (c == '.' && ++dots > most_dots) return line;
            if (c != '\n') continue;
            ++line;
            dots = 0;
        }
        return 0;
    }

    SetupResult<toml::table> parse(std::string_view text) const {
        if (const auto line = line_with_endless_key(text); line != 0)
            return bad(line, "more than 1000 dots in one line: expected keys like router.dedup_ms");
        try {
            return toml::parse(text, file_);
        } catch (const toml::parse_error& error) {  // the library reports errors only this way
            return bad(static_cast<std::uint32_t>(error.source().begin.line), error.description());
        }
    }

    SetupResult<void> check_sections(const toml::table& root) const {
        std::vector<std::string_view> known(config_sections().begin(), config_sections().end());
        known.push_back("endpoint");
        for (const auto& [key, node] : root) {
            const auto line = line_in_file(node);
            if (std::find(known.begin(), known.end(), key.str()) == known.end()) {
                auto hint = did_you_mean(key.str(), known);
                if (hint.empty()) hint = fmt::format("; there are {}", fmt::join(known, ", "));
                return bad(line, fmt::format("there is no section {}{}", in_quotes(key.str()), hint));
            }
            const bool is_list = key.str() == "endpoint";
            const auto* list = node.as_array();
            const bool good = is_list ? list != nullptr && std::all_of(list->begin(), list->end(),
                                                                       [](const toml::node& n) { return n.is_table(); })
                                      : node.is_table();
            if (!good)
                return bad(line, is_list ? "endpoints are written [[endpoint]], each with its own heading"
                                         : fmt::format("'{}' is a section; write [{}]", key.str(), key.str()));
        }
        return {};
    }

    static std::string variable_name(const ConfigKey& key) {
        return fmt::format("{}{}_{}", variable_prefix, upper(key.section), upper(key.name));
    }

    // A misspelt variable must not be ignored silently. Other variables with this prefix may belong to other
    // programs.
    SetupResult<void> check_environment() {
        std::vector<std::string> names;
        for (const ConfigKey& key : config_keys()) names.push_back(variable_name(key));
        // Compare without the prefix; with it, every name would look similar.
        std::vector<std::string_view> known;
        known.reserve(names.size());
        for (const std::string_view name : names) known.push_back(name.substr(variable_prefix.size()));
        for (const auto& [name, value] : environment_) {
            const bool is_known = name == net::run_variable || std::ranges::find(names, name) != names.end();
            if (!name.starts_with(variable_prefix) || is_known) continue;
            const auto near = nearest(std::string_view(name).substr(variable_prefix.size()), known);
            const auto hint = near.empty() ? std::string()
                                           : fmt::format(", did you mean '{}{}'?", variable_prefix, near);
            auto what = fmt::format("environment: {} sets nothing{}", shown(name), hint);
            if (!near.empty() || is_of_a_section(name)) return setup_error(SetupCode::bad_input, std::move(what));
            config_.notes.push_back(std::move(what));
        }
        return {};
    }

    static bool is_of_a_section(std::string_view name) {
        return std::ranges::any_of(config_sections(), [&](std::string_view section) {
            return name.substr(variable_prefix.size()).starts_with(upper(section) + "_");
        });
    }

    SetupResult<void> check_keys(std::string_view section, const toml::table& table) const {
        std::vector<std::string_view> known;
        for (const ConfigKey& key : config_keys())
            if (key.section == section) known.push_back(key.name);
        for (const auto& [key, node] : table) {
            if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
            auto hint = did_you_mean(key.str(), known);
            if (hint.empty()) hint = fmt::format("; [{}] has {}", section, fmt::join(known, ", "));
            return bad(line_in_file(node), fmt::format("[{}] has no key {}{}", section, in_quotes(key.str()), hint));
        }
        return {};
    }

    // Precedence is default, file, environment: the later one wins.
    SetupResult<void> read_section(std::string_view name, const toml::table* table) {
        if (table != nullptr)
            if (auto done = check_keys(name, *table); !done) return done;
        Section section{std::string(name), {}, {}, table == nullptr ? 0 : line_in_file(*table)};
        for (const ConfigKey& key : config_keys()) {
            if (key.section != name) continue;
            auto setting = read_key(key, table == nullptr ? nullptr : table->get(key.name));
            if (!setting) return tl::unexpected(std::move(setting.error()));
            section.settings.push_back(std::move(*setting));
        }
        config_.sections.push_back(std::move(section));
        return {};
    }

    // A stream request needs a sender id.
    [[nodiscard]] SetupResult<void> check_requests() const {
        if (config_.router.request_streams_hz == 0 || config_.router.heartbeat) return {};
        constexpr std::string_view what =
            "request_streams needs heartbeat = \"SYS/COMP\": the id that the router sends its requests with";
        for (const Section& section : config_.sections)
            for (const Setting& setting : section.settings)
                if (setting.key == "request_streams" && setting.origin == Origin::file) return bad(setting.line, what);
        return setup_error(SetupCode::bad_input, fmt::format("environment: {}", what));
    }

    SetupResult<void> check_heartbeat(const endpoint::Endpoint& endpoint, const std::vector<Setting>& given) const {
        if (!endpoint.options.heartbeat.value_or(false) || config_.router.heartbeat) return {};
        return bad(find(given, "heartbeat")->line, heartbeat_needs_id);
    }

    SetupResult<Setting> read_key(const ConfigKey& key, const toml::node* node) {
        Setting setting{std::string(key.name), std::string(key.default_text), Origin::by_default, 0, {}};
        if (!key.default_text.empty()) (void)key.set(config_, key.default_text);
        if (node != nullptr) {
            const auto text = text_of(*node);
            if (!text) return bad(line_in_file(*node), fmt::format("{} has a value of the wrong type", key.name));
            if (auto done = key.set(config_, *text); !done)
                return bad(line_in_file(*node), fmt::format("{}: {}", key.name, done.error().text));
            setting = {std::string(key.name), *text, Origin::file, line_in_file(*node), {}};
        }
        const auto name = variable_name(key);
        const auto variable = std::find_if(environment_.begin(), environment_.end(),
                                           [&](const auto& v) { return v.first == name; });
        if (variable == environment_.end()) return setting;
        if (auto done = key.set(config_, variable->second); !done)
            return setup_error(SetupCode::bad_input, fmt::format("environment: {}: {}", name, done.error().text));
        return Setting{std::string(key.name), variable->second, Origin::environment, 0, name};
    }

    SetupResult<void> read_endpoint(const toml::table& table) {
        std::vector<Setting> given;
        for (const auto& [key, node] : table) {
            auto text = text_of(node);
            if (!text)
                return bad(line_in_file(node), fmt::format("{} has a value of the wrong type", in_quotes(key.str())));
            given.push_back({std::string(key.str()), std::move(*text), Origin::file, line_in_file(node), {}});
        }
        auto endpoint = place(given, line_in_file(table));
        if (!endpoint) return tl::unexpected(std::move(endpoint.error()));
        for (const Setting& setting : given) {
            if (is_place_of(endpoint->scheme, setting.key)) continue;
            if (auto done = endpoint::set_endpoint_option(*endpoint, setting.key, setting.value); !done)
                return bad(setting.line, done.error().text);
        }
        if (auto good = endpoint::check_options(*endpoint); !good) return bad(line_in_file(table), good.error().text);
        if (auto good = check_heartbeat(*endpoint, given); !good) return good;
        if ((endpoint::set_of(endpoint->scheme) & endpoint::address_schemes) != 0 && endpoint->address.port == 0)
            return bad(line_in_file(table),
                       "with port 0, other programs could not know the port; choose one from 1 to 65535");
        return add_endpoint(std::move(*endpoint), given, line_in_file(table));
    }

    static const Setting* find(const std::vector<Setting>& given, std::string_view key) {
        const auto found = std::find_if(given.begin(), given.end(), [&](const Setting& s) { return s.key == key; });
        return found == given.end() ? nullptr : &*found;
    }

    // True for the keys that give the endpoint's address or path, if its scheme has them.
    static bool is_place_of(endpoint::Scheme scheme, std::string_view key) {
        if (key == "url" || key == "scheme") return true;
        const auto set = endpoint::set_of(scheme);
        if (key == "host" || key == "port") return (set & endpoint::address_schemes) != 0;
        if (key == "path") return scheme == endpoint::Scheme::serial || scheme == endpoint::Scheme::tlog;
        return key == "ring" && scheme == endpoint::Scheme::shm;
    }

    SetupResult<endpoint::Endpoint> place(std::vector<Setting>& given, std::uint32_t line) const {
        const Setting* const url = find(given, "url");
        if (url == nullptr) return place_of_parts(given, line);
        for (const auto key : {"scheme", "host", "port", "path", "ring"})
            if (const auto* part = find(given, key))
                return bad(part->line, fmt::format("'{}' is given beside url, which already contains it", key));
        auto endpoint = endpoint::parse_endpoint(url->value);
        if (!endpoint) return bad(url->line, endpoint.error().text);
        const auto query = endpoint::query_of(url->value);
        if (!query) return endpoint;
        const auto options = endpoint::split_query(*query);
        if (!options) return bad(url->line, options.error().text);
        const auto url_line = url->line;
        for (const auto& option : *options) {
            if (const auto* twice = find(given, option.key))
                return bad(twice->line, fmt::format("'{}' is already set in the url", option.key));
            given.push_back({option.key, option.value, Origin::file, url_line, {}});
        }
        return endpoint;
    }

    SetupResult<endpoint::Endpoint> place_of_parts(const std::vector<Setting>& given, std::uint32_t line) const {
        const Setting* const scheme = find(given, "scheme");
        if (scheme == nullptr) {
            std::vector<std::string_view> known(place_keys.begin(), place_keys.end());
            for (const Setting& setting : given)
                if (const auto hint = did_you_mean(setting.key, place_keys);
                    !hint.empty() && std::find(known.begin(), known.end(), setting.key) == known.end())
                    return bad(setting.line, fmt::format("[[endpoint]] has no key {}{}", in_quotes(setting.key), hint));
            return bad(line, "an endpoint needs url = \"...\", or scheme and the keys for that scheme");
        }
        const auto names = endpoint::scheme_names();
        const auto found = std::find(names.begin(), names.end(), scheme->value);
        if (found == names.end()) {
            auto hint = did_you_mean(scheme->value, names);
            if (hint.empty()) hint = fmt::format("; there are {}", fmt::join(names, ", "));
            return bad(scheme->line, fmt::format("there is no scheme {}{}", in_quotes(scheme->value), hint));
        }
        endpoint::Endpoint endpoint;
        endpoint.scheme = static_cast<endpoint::Scheme>(found - names.begin());
        const bool has_address = (endpoint::set_of(endpoint.scheme) & endpoint::address_schemes) != 0;
        if (has_address) return place_of_address(std::move(endpoint), given, line);
        const auto* path = find(given, endpoint.scheme == endpoint::Scheme::shm ? "ring" : "path");
        if (path == nullptr)
            return bad(line,
                       fmt::format("{} needs {}", scheme->value,
                                   endpoint.scheme == endpoint::Scheme::shm ? "ring = \"NAME\"" : "path = \"...\""));
        if (auto good = endpoint::check_path(endpoint.scheme, path->value); !good)
            return bad(path->line, good.error().text);
        endpoint.path = path->value;
        return endpoint;
    }

    SetupResult<endpoint::Endpoint> place_of_address(endpoint::Endpoint endpoint, const std::vector<Setting>& given,
                                                     std::uint32_t line) const {
        const auto name = endpoint::scheme_name(endpoint.scheme);
        const auto* host = find(given, "host");
        const auto* port = find(given, "port");
        if (host == nullptr || port == nullptr)
            return bad(line, fmt::format("{} needs {}", name, host == nullptr ? "host = \"...\"" : "port = N"));
        auto parsed_host = endpoint::parse_host(host->value, name, port->value);
        if (!parsed_host) return bad(host->line, fmt::format("host: {}", parsed_host.error().text));
        const auto parsed_port = endpoint::parse_port(port->value);
        if (!parsed_port) return bad(port->line, parsed_port.error().text);
        endpoint.address = {std::move(*parsed_host), *parsed_port};
        if (auto good = endpoint::check_address(endpoint.scheme, endpoint.address); !good)
            return bad(host->line, good.error().text);
        return endpoint;
    }

    SetupResult<void> add_endpoint(endpoint::Endpoint endpoint, const std::vector<Setting>& given, std::uint32_t line) {
        Section section{"endpoint", endpoint.label(), {}};
        for (const Section& other : config_.sections)
            if (other.name == "endpoint" && other.label == section.label)
                return bad(line, fmt::format("two endpoints are named {}; give one of them another name = \"...\"",
                                             in_quotes(section.label)));
        for (const auto key : place_keys)
            if (const auto* setting = find(given, key); setting != nullptr && key != "name")
                section.settings.push_back(*setting);
        for (const auto key : endpoint::option_names_for(endpoint.scheme)) {
            const auto* setting = find(given, key);
            section.settings.push_back(setting != nullptr
                                           ? *setting
                                           : Setting{std::string(key),
                                                     std::string(endpoint::default_option_text(endpoint.scheme, key)),
                                                     Origin::by_default,
                                                     0,
                                                     {}});
        }
        config_.sections.push_back(std::move(section));
        config_.endpoints.push_back(std::move(endpoint));
        return {};
    }

    std::string_view file_;
    const Environment& environment_;
    Config config_;
};

}  // namespace

Environment environment_of(const char* const* envp) {
    Environment environment;
    for (; envp != nullptr && *envp != nullptr; ++envp) {
        const std::string_view text(*envp);
        const auto equals = text.find('=');
        if (equals == std::string_view::npos) continue;
        if (text.starts_with(variable_prefix))
            environment.emplace_back(text.substr(0, equals), text.substr(equals + 1));
    }
    return environment;
}

SetupResult<Config> parse_config(std::string_view text, std::string_view file_name, const Environment& environment) {
    return Loader(file_name, environment).load(text);
}

SetupResult<Config> load_config(const std::filesystem::path& file, const Environment& environment) {
    const auto text = read_config_text(file);
    if (!text) return tl::unexpected(text.error());
    return parse_config(*text, file.string(), environment);
}

}  // namespace mavloom::config
