// SPDX-License-Identifier: MIT
#include "mavloom/config/config.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "config/places.hpp"
#include "mavloom/base/shown.hpp"
#include "mavloom/config/document.hpp"
#include "mavloom/config/keys.hpp"

namespace mavloom::config {

using namespace detail;

namespace {

std::vector<Variables::Name> variable_names() {
    std::vector<Variables::Name> names;
    for (const ConfigKey& key : config_keys()) names.push_back({key.section, key.name});
    return names;
}

class Loader {
public:
    Loader(const Document& document, const Environment& environment, Overrides overrides)
        : document_(document), variables_(environment, variable_names()), overrides_(overrides) {}

    SetupResult<Config> load() {
        static constexpr std::array<std::string_view, 1> lists{"endpoint"};
        if (auto done = document_.check_tables(config_sections(), lists); !done)
            return tl::unexpected(std::move(done.error()));
        if (auto done = variables_.check(config_.notes); !done) return tl::unexpected(std::move(done.error()));
        for (const auto name : config_sections())
            if (auto done = read_section(name, document_.find(name)); !done)
                return tl::unexpected(std::move(done.error()));
        if (auto done = check_requests(); !done) return tl::unexpected(std::move(done.error()));
        for (const Table& table : document_.tables)
            if (table.name == lists[0])
                if (auto done = read(table); !done) return tl::unexpected(std::move(done.error()));
        if (auto done = check_ports(config_, document_.file); !done) return tl::unexpected(std::move(done.error()));
        if (auto done = check_recordings(config_, document_.file); !done)
            return tl::unexpected(std::move(done.error()));
        return std::move(config_);
    }

private:
    // Precedence is default, file, environment, option: the later one wins.
    SetupResult<void> read_section(std::string_view name, const Table* table) {
        std::vector<std::string_view> known;
        for (const ConfigKey& key : config_keys())
            if (key.section == name) known.push_back(key.name);
        if (table != nullptr)
            if (auto done = document_.check_keys(*table, known); !done) return done;
        Section section{std::string(name), {}, {}, table == nullptr ? 0 : table->line};
        for (const ConfigKey& key : config_keys()) {
            if (key.section != name) continue;
            auto setting = read_key(key, table == nullptr ? nullptr : table->find(key.name));
            if (!setting) return tl::unexpected(std::move(setting.error()));
            section.settings.push_back(std::move(*setting));
        }
        config_.sections.push_back(std::move(section));
        return {};
    }

    SetupResult<Setting> read_key(const ConfigKey& key, const Entry* entry) {
        Setting setting{std::string(key.name), std::string(key.default_text), Origin::by_default, 0, {}};
        if (!key.default_text.empty()) (void)key.set(config_, key.default_text);
        if (entry != nullptr) {
            auto text = document_.text_of(*entry);
            if (!text) return tl::unexpected(std::move(text.error()));
            if (auto done = key.set(config_, *text); !done)
                return document_.error(entry->line, fmt::format("{}: {}", key.name, done.error().text));
            setting = {std::string(key.name), *text, Origin::file, entry->line, {}};
        }
        const Variables::Name name{key.section, key.name};
        if (const std::string* const variable = variables_.find(name)) {
            const auto variable_name = Variables::name_of(name);
            if (auto done = key.set(config_, *variable); !done)
                return setup_error(SetupCode::bad_input,
                                   fmt::format("environment: {}: {}", variable_name, done.error().text));
            setting = {std::string(key.name), *variable, Origin::environment, 0, variable_name};
        }
        for (const Override& given : overrides_) {
            if (given.section != key.section || given.key != key.name) continue;
            if (auto done = key.set(config_, given.value); !done)
                return tl::unexpected(std::move(done.error()).within(given.option));
            setting = {std::string(key.name), given.value, Origin::option, 0, std::string(given.option)};
        }
        return setting;
    }

    // A stream request needs a sender id.
    [[nodiscard]] SetupResult<void> check_requests() const {
        if (config_.router.request_streams_hz == 0 || config_.router.heartbeat) return {};
        constexpr std::string_view what =
            "request_streams needs heartbeat = \"SYS/COMP\": the id that the router sends its requests with";
        const auto router = std::ranges::find(config_.sections, "router", &Section::name);
        const Setting& given = *std::ranges::find(router->settings, "request_streams", &Setting::key);
        if (given.origin == Origin::file) return document_.error(given.line, what);
        if (given.origin == Origin::option)
            return setup_error(SetupCode::usage,
                               fmt::format("{} needs --heartbeat SYS/COMP, as in 255/191: the id that "
                                           "the router sends its requests with",
                                           given.variable));
        return setup_error(SetupCode::bad_input, fmt::format("environment: {}", what));
    }

    SetupResult<void> read(const Table& table) {
        auto placed = read_endpoint(document_, table, config_.sections);
        if (!placed) return tl::unexpected(std::move(placed.error()));
        auto& [endpoint, section] = *placed;
        if (endpoint.options.heartbeat.value_or(false) && !config_.router.heartbeat)
            return document_.error(std::ranges::find(section.settings, "heartbeat", &Setting::key)->line,
                                   heartbeat_needs_id);
        config_.sections.push_back(std::move(section));
        config_.endpoints.push_back(std::move(endpoint));
        return {};
    }

    const Document& document_;
    Variables variables_;
    Overrides overrides_;
    Config config_;
};

}  // namespace

SetupResult<Config> read_config(const Document& document, const Environment& environment, Overrides overrides) {
    return Loader(document, environment, overrides).load();
}

SetupResult<Config> parse_config(std::string_view text, std::string_view file_name, const Environment& environment,
                                 Overrides overrides) {
    const auto document = parse_document(text, file_name);
    return document ? read_config(*document, environment, overrides) : tl::unexpected(document.error());
}

SetupResult<Config> load_config(const std::filesystem::path& file, const Environment& environment, Overrides overrides) {
    const auto document = load_document(file);
    return document ? read_config(*document, environment, overrides) : tl::unexpected(document.error());
}

}  // namespace mavloom::config
