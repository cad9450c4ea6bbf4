// SPDX-License-Identifier: MIT
#include "mavloom/simserve/scenario.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <numbers>
#include <system_error>

#include "mavloom/base/shown.hpp"
#include "mavloom/base/suggest.hpp"
#include "mavloom/endpoint/grammar.hpp"
#include "simserve/scenario/keys.hpp"
#include "simserve/scenario/time_line.hpp"
#include "simserve/scenario/values.hpp"

namespace mavloom::simserve {

using config::Document;
using config::Entry;
using config::Origin;
using config::Setting;
using config::Table;
using config::Variables;

namespace {

constexpr std::array sections{sim_section, web_section, streams_section};
constexpr std::array lists{vehicle_section, endpoint_section, event_section};
// Keys of [[endpoint]] that only scenarios have.
constexpr std::string_view profile_key = "profile", streams_key = "streams";

std::vector<Variables::Name> variable_names() {
    std::vector<Variables::Name> names;
    for (const auto& key : sim_keys()) names.push_back({sim_section, key.name});
    for (const auto& key : web_keys()) names.push_back({web_section, key.name});
    return names;
}

class Reader {
public:
    Reader(const Document& document, const config::Environment& environment, std::span<const Override> overrides)
        : document_(document), variables_(environment, variable_names()), overrides_(overrides) {}

    SetupResult<Scenario> read() {
        if (auto done = document_.check_tables(sections, lists); !done) return tl::unexpected(std::move(done.error()));
        if (auto done = variables_.check(scenario_.notes); !done) return tl::unexpected(std::move(done.error()));
        scenario_.ring.full = config::WhenFull::evict;
        scenario_.ring.mode = 0600;
        if (auto done = read_section(sim_section, sim_keys()); !done) return tl::unexpected(std::move(done.error()));
        if (auto done = read_section(web_section, web_keys()); !done) return tl::unexpected(std::move(done.error()));
        if (auto done = read_streams(); !done) return tl::unexpected(std::move(done.error()));
        if (auto done = read_vehicles(); !done) return tl::unexpected(std::move(done.error()));
        for (const Table& table : document_.tables)
            if (table.name == endpoint_section)
                if (auto done = read(table); !done) return tl::unexpected(std::move(done.error()));
        for (const Table& table : document_.tables)
            if (table.name == event_section)
                if (auto done = read_event(table); !done) return tl::unexpected(std::move(done.error()));
        return std::move(scenario_);
    }

private:
    template <class Target>
    [[nodiscard]] SetupResult<void> check_keys(const Table& table, std::span<const Key<Target>> keys) const {
        std::vector<std::string_view> known;
        for (const auto& key : keys) known.push_back(key.name);
        return document_.check_keys(table, known);
    }

    SetupResult<void> read_section(std::string_view name, std::span<const Key<Scenario>> keys) {
        const Table* const table = document_.find(name);
        if (table != nullptr)
            if (auto done = check_keys(*table, keys); !done) return done;
        config::Section section{std::string(name), {}, {}, table == nullptr ? 0 : table->line};
        for (const auto& key : keys) {
            auto setting = read_key(name, key, table, scenario_);
            if (!setting) return tl::unexpected(std::move(setting.error()));
            section.settings.push_back(std::move(*setting));
        }
        scenario_.sections.push_back(std::move(section));
        return {};
    }

    // Precedence is default, file, environment, option: the later one wins.
    template <class Target>
    SetupResult<Setting> read_key(std::string_view section, const Key<Target>& key, const Table* table, Target& target) {
        Setting setting{std::string(key.name), std::string(key.default_text), Origin::by_default, 0, {}};
        if (!key.default_text.empty()) (void)key.set(target, key.default_text);
        if (const Entry* const entry = table == nullptr ? nullptr : table->find(key.name)) {
            auto text = document_.text_of(*entry);
            if (!text) return tl::unexpected(std::move(text.error()));
            if (auto done = key.set(target, *text); !done)
                return document_.error(line_of(*entry, done.error().text),
                                       fmt::format("{}: {}", key.name, done.error().text));
            setting = {std::string(key.name), *text, Origin::file, entry->line, {}};
        }
        if (const std::string* const variable = variables_.find({section, key.name})) {
            const auto name = Variables::name_of({section, key.name});
            if (auto done = key.set(target, *variable); !done)
                return setup_error(SetupCode::bad_input, fmt::format("environment: {}: {}", name, done.error().text));
            setting = {std::string(key.name), *variable, Origin::environment, 0, name};
        }
        for (const Override& given : overrides_) {
            if (given.section != section || given.key != key.name) continue;
            if (auto done = key.set(target, given.value); !done)
                return tl::unexpected(std::move(done.error()).within(given.option));
            setting = {std::string(key.name), given.value, Origin::option, 0, std::string(given.option)};
        }
        return setting;
    }

    // The line of the part of a table that the error text begins with, else that of the table.
    static std::uint32_t line_of(const Entry& entry, std::string_view error) {
        for (const Entry& part : entry.entries)
            if (error.starts_with(part.key + ":") || error.starts_with(in_quotes(part.key))) return part.line;
        return entry.line;
    }

    // ---- streams ----

    SetupResult<void> read_streams() {
        const Table* const table = document_.find(streams_section);
        if (table == nullptr) return {};
        config::Section section{std::string(streams_section), {}, {}, table->line};
        for (const Entry& entry : table->entries) {
            auto setting = read_rate(entry, scenario_.rates);
            if (!setting) return tl::unexpected(std::move(setting.error()));
            section.settings.push_back(std::move(*setting));
        }
        scenario_.sections.push_back(std::move(section));
        return {};
    }

    SetupResult<Setting> read_rate(const Entry& entry, std::vector<sim::MessageRate>& rates) {
        auto text = document_.text_of(entry);
        if (!text) return tl::unexpected(std::move(text.error()));
        if (auto done = add_rate(rates, entry.key, *text); !done) return document_.error(entry.line, done.error().text);
        return Setting{entry.key, std::move(*text), Origin::file, entry.line, {}};
    }

    // ---- vehicles ----

    SetupResult<void> read_vehicles() {
        static const Table usual{std::string(vehicle_section), Table::Form::one_of_list, 0, {}};
        bool any = false;
        for (const Table& table : document_.tables) {
            if (table.name != vehicle_section) continue;
            any = true;
            if (auto done = read_vehicle(table); !done) return done;
        }
        return any ? SetupResult<void>{} : read_vehicle(usual);
    }

    SetupResult<void> read_vehicle(const Table& table) {
        if (auto done = check_keys(table, vehicle_keys()); !done) return done;
        ScenarioVehicle vehicle;
        const unsigned next = next_system();
        vehicle.options.system = SystemId{static_cast<std::uint8_t>(std::min(next, 254u))};
        config::Section section{std::string(vehicle_section), {}, {}, table.line};
        for (const auto& key : vehicle_keys()) {
            auto setting = read_key(vehicle_section, key, &table, vehicle);
            if (!setting) return tl::unexpected(std::move(setting.error()));
            section.settings.push_back(std::move(*setting));
        }
        vehicle.has_own_place = find(section, "home").origin != Origin::by_default;
        if (auto done = check_systems(vehicle, section, next); !done) return done;
        if (vehicle.options.motion == sim::Motion::random && vehicle.options.kind != sim::Kind::quad)
            return wrong(section, {"motion", "kind"}, "random motion is for a quad");
        complete(section, vehicle);
        scenario_.sections.push_back(std::move(section));
        scenario_.vehicles.push_back(std::move(vehicle));
        return {};
    }

    // One more than the last vehicle's.
    [[nodiscard]] unsigned next_system() const noexcept {
        if (scenario_.vehicles.empty()) return 1;
        const ScenarioVehicle& last = scenario_.vehicles.back();
        return last.options.system.value + static_cast<unsigned>(last.count);
    }

    static Setting& find(config::Section& section, std::string_view key) {
        return *std::ranges::find(section.settings, key, &Setting::key);
    }

    // Defaults that depend on the other vehicles and on who flies.
    void complete(config::Section& section, ScenarioVehicle& vehicle) const {
        const unsigned first = vehicle.options.system.value, last = first + static_cast<unsigned>(vehicle.count) - 1;
        section.label = first == last ? fmt::format("{}", first) : fmt::format("{} to {}", first, last);
        const auto& home = vehicle.options.home;
        if (Setting& system = find(section, "system"); system.value.empty()) system.value = fmt::format("{}", first);
        if (Setting& place = find(section, "home"); place.value.empty())
            place.value = fmt::format("{},{},{},{}", home.latitude_deg, home.longitude_deg, home.altitude_m,
                                      home.heading_deg);
        Setting& body = find(section, "body");
        if (scenario_.hil && vehicle.options.kind == sim::Kind::plane && body.origin == Origin::by_default) {
            body.value = "gazebo";
            vehicle.options.body.plane = body_of(sim::PlanePreset::gazebo);
        }
    }

    [[nodiscard]] SetupResult<void> check_systems(const ScenarioVehicle& vehicle, config::Section& section,
                                                  unsigned next) {
        const bool is_given = find(section, "system").origin != Origin::by_default;
        const unsigned first = is_given ? vehicle.options.system.value : next;
        const unsigned last = first + static_cast<unsigned>(vehicle.count) - 1;
        if (last > 254)
            return wrong(section, {"count", "system"},
                         fmt::format("the last of {} vehicles from system id {} on would have id {}; there are "
                                     "254",
                                     vehicle.count, first, last));
        for (const ScenarioVehicle& other : scenario_.vehicles) {
            const unsigned begin = other.options.system.value, end = begin + static_cast<unsigned>(other.count);
            if (first < end && begin <= last)
                return wrong(section, {"count", "system"},
                             fmt::format("two vehicles have system id {}; each needs its own", std::max(first, begin)));
        }
        return {};
    }

    // An error at the first of these keys that the file sets.
    [[nodiscard]] tl::unexpected<SetupError> wrong(config::Section& section,
                                                   std::initializer_list<std::string_view> keys,
                                                   std::string_view what) const {
        for (const auto key : keys) {
            const Setting& setting = find(section, key);
            if (setting.origin == Origin::file) return document_.error(setting.line, what);
            if (setting.origin == Origin::option)
                return setup_error(SetupCode::usage, fmt::format("{}: {}", setting.variable, what));
        }
        return document_.error(section.line, what);
    }

    // ---- events ----

    SetupResult<void> read_event(const Table& table) {
        if (auto done = check_keys(table, event_keys()); !done) return done;
        ScenarioEvent event;
        config::Section section{std::string(event_section), {}, {}, table.line};
        for (const auto& key : event_keys()) {
            auto setting = read_key(event_section, key, &table, event);
            if (!setting) return tl::unexpected(std::move(setting.error()));
            section.settings.push_back(std::move(*setting));
        }
        for (const auto key : {"at", "do"})
            if (table.find(key) == nullptr)
                return document_.error(table.line, fmt::format("an event needs the key {}, as in at = \"5s\", do = "
                                                               "\"takeoff 20\"",
                                                               key));
        if (event.system && !has_system(*event.system))
            return document_.error(table.line, fmt::format("there is no vehicle {}", event.system->value));
        const bool counts_flight = scenario_.speed == max_speed && !scenario_.hil;
        if (counts_flight && scenario_.duration && event.at > *scenario_.duration)
            return document_.error(table.line, "the flight ends before this event");
        auto request = request_of_order(event.words, event.system);
        if (!request) return document_.error(table.line, request.error().text);
        section.label = find(section, "at").value;
        scenario_.orders.push_back({event.at, std::move(event.words), std::move(*request), event.system});
        scenario_.sections.push_back(std::move(section));
        return {};
    }

    [[nodiscard]] bool has_system(SystemId system) const {
        return std::ranges::any_of(scenario_.vehicles, [&](const ScenarioVehicle& group) {
            const auto place = system.value - group.options.system.value;
            return place >= 0 && place < static_cast<int>(group.count);
        });
    }

    // ---- endpoints ----

    SetupResult<void> read(const Table& table) {
        Table shared = table;  // without the keys that only scenarios have
        SimEndpoint given;
        std::vector<Setting> own;
        if (const Entry* const entry = table.find(profile_key)) {
            auto setting = read_profile(*entry, given);
            if (!setting) return tl::unexpected(std::move(setting.error()));
            own.push_back(std::move(*setting));
        }
        if (const Entry* const entry = table.find(streams_key)) {
            auto setting = read_own_rates(*entry, given);
            if (!setting) return tl::unexpected(std::move(setting.error()));
            own.push_back(std::move(*setting));
        }
        std::erase_if(shared.entries, [](const Entry& e) { return e.key == profile_key || e.key == streams_key; });
        auto placed = config::read_endpoint(document_, shared, scenario_.sections);
        if (!placed) return tl::unexpected(std::move(placed.error()));
        auto& section = placed->section;
        section.line = table.line;
        section.settings.insert(section.settings.end(), own.begin(), own.end());
        given.endpoint = std::move(placed->endpoint);
        scenario_.endpoints.push_back(std::move(given));
        scenario_.sections.push_back(std::move(section));
        return {};
    }

    SetupResult<Setting> read_profile(const Entry& entry, SimEndpoint& given) {
        auto text = document_.text_of(entry);
        if (!text) return tl::unexpected(std::move(text.error()));
        const auto profile = parse_choice(*text, sim::profile_names);
        if (!profile) return document_.error(entry.line, fmt::format("{}: {}", entry.key, profile.error().text));
        given.profile = static_cast<sim::Profile>(*profile);
        return Setting{entry.key, std::move(*text), Origin::file, entry.line, {}};
    }

    SetupResult<Setting> read_own_rates(const Entry& entry, SimEndpoint& given) {
        auto text = document_.text_of(entry);
        if (!text) return tl::unexpected(std::move(text.error()));
        if (entry.entries.empty())
            return document_.error(entry.line, "streams is a table of rates in Hz, as in {ATTITUDE = 50}");
        for (const Entry& rate : entry.entries)
            if (auto setting = read_rate(rate, given.rates); !setting)
                return tl::unexpected(std::move(setting.error()));
        return Setting{entry.key, std::move(*text), Origin::file, entry.line, {}};
    }

    const Document& document_;
    Variables variables_;
    std::span<const Override> overrides_;
    Scenario scenario_;
};

// A different but repeatable seed for each vehicle.
std::uint64_t seed_of(std::uint64_t seed, SystemId system) noexcept {
    constexpr std::uint64_t odd = 0x9e3779b97f4a7c15;  // 2^64 divided by the golden ratio
    return seed ^ (odd * system.value);
}

// The place number `index` of a square grid that grows north and east of home.
sim::Home on_grid(const sim::Home& home, std::size_t index, std::size_t count) {
    constexpr double distance_m = 5;
    const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
    const std::size_t row = index / columns, column = index % columns;
    return sim::moved(home, distance_m * static_cast<double>(row), distance_m * static_cast<double>(column));
}

}  // namespace

bool is_scenario(const Document& document) noexcept {
    return std::ranges::any_of(document.tables, [](const Table& table) {
        return table.name == sim_section || table.name == streams_section || table.name == vehicle_section ||
               table.name == event_section;
    });
}

SetupResult<Scenario> read_scenario(const Document& document, const config::Environment& environment,
                                    std::span<const Override> overrides) {
    return Reader(document, environment, overrides).read();
}

std::vector<ScenarioVehicle> Scenario::each_vehicle() const {
    std::size_t at_usual_place = 0, next_at_usual_place = 0;
    for (const ScenarioVehicle& group : vehicles) at_usual_place += group.has_own_place ? 0 : group.count;
    std::vector<ScenarioVehicle> all;
    for (const ScenarioVehicle& group : vehicles) {
        for (std::size_t i = 0; i < group.count; ++i) {
            ScenarioVehicle one = group;
            one.count = 1;
            one.options.system = SystemId{static_cast<std::uint8_t>(group.options.system.value + i)};
            one.options.seed = seed_of(seed, one.options.system);
            one.options.home = group.has_own_place ? on_grid(group.options.home, i, group.count)
                                                   : on_grid(group.options.home, next_at_usual_place++, at_usual_place);
            all.push_back(std::move(one));
        }
    }
    return all;
}

std::string Scenario::control_name() const {
    if (!name.empty()) return name;
    return ring.name.empty() ? "sim" : ring.name;
}

// ---- checks ---------------------------------------------------------------------------------------------------------

namespace {

// Takes what it is given, for a vehicle that only shows which parameters it has.
class NoSink final : public sim::Sink {
    void send(LinkId, const wire::FrameView&) override {}
    [[nodiscard]] bool has_room(LinkId) const override { return true; }
};

std::string unknown_parameter(const sim::Vehicle& vehicle, std::string_view name) {
    const auto names = vehicle.parameter_names();
    return fmt::format("a {} has no parameter {}{}", sim::kind_names[static_cast<std::size_t>(vehicle.status().kind)],
                       in_quotes(name), did_you_mean(name, names));
}

SetupResult<void> check_parameter(sim::Vehicle& vehicle, std::string_view name, double value) {
    if (!vehicle.parameter(name)) return setup_error(SetupCode::usage, unknown_parameter(vehicle, name));
    if (name == vehicle.system_parameter())
        return setup_error(SetupCode::usage, fmt::format("{} follows from the key system", name));
    auto set = vehicle.set_parameter(name, value);
    return set ? set : setup_error(SetupCode::usage, fmt::format("{}: {}", name, set.error().text));
}

std::uint32_t line_of_parameter(const Table& table, std::string_view name) {
    const Entry* const parameters = table.find("parameters");
    if (parameters == nullptr) return table.line;
    const auto part = std::ranges::find(parameters->entries, name, &Entry::key);
    return part == parameters->entries.end() ? parameters->line : part->line;
}

SetupResult<void> check_parameters(const Scenario& scenario, const Document& document) {
    auto table = document.tables.begin();
    for (const ScenarioVehicle& group : scenario.vehicles) {
        table = std::find_if(table, document.tables.end(), [](const Table& t) { return t.name == vehicle_section; });
        if (!group.parameters.empty()) {
            NoSink nowhere;
            sim::Vehicle vehicle(group.options, nowhere, {});
            for (const auto& [name, value] : group.parameters)
                if (auto good = check_parameter(vehicle, name, value); !good)
                    return document.error(line_of_parameter(*table, name), good.error().text);
        }
        if (table != document.tables.end()) ++table;
    }
    return {};
}

SetupResult<void> check_endpoints(const Scenario& scenario, const Document& document) {
    config::Config all;  // what the checks of endpoints take
    for (const SimEndpoint& given : scenario.endpoints) all.endpoints.push_back(given.endpoint);
    std::ranges::copy_if(scenario.sections, std::back_inserter(all.sections),
                         [](const config::Section& section) { return section.name == endpoint_section; });
    for (std::size_t i = 0; i < all.endpoints.size(); ++i)
        if (auto good = Simulator::check(all.endpoints[i]); !good)
            return document.error(all.sections[i].line, good.error().text);
    if (auto good = config::check_ports(all, document.file); !good) return good;
    return config::check_key_files(all, document.file);
}

bool are_one_file(const std::string& one, const std::string& other) {
    std::error_code ignored;
    return !one.empty() && !other.empty() &&
           (std::filesystem::equivalent(one, other, ignored) ||
            std::filesystem::absolute(one, ignored).lexically_normal() ==
                std::filesystem::absolute(other, ignored).lexically_normal());
}

// Each of them would destroy the other.
SetupResult<void> check_recordings(const Scenario& s) {
    const auto wrong = [](std::string_view one, std::string_view other, const std::string& path) {
        return setup_error(SetupCode::usage, fmt::format("{} and {} are the same file: {}", one, other, path));
    };
    if (are_one_file(s.recording, s.input_recording)) return wrong("record", "record_input", s.recording);
    if (are_one_file(s.input, s.recording)) return wrong("record", "replay_input", s.input);
    if (are_one_file(s.input, s.input_recording)) return wrong("record_input", "replay_input", s.input);
    return {};
}

}  // namespace

SetupResult<void> check_scenario(const Scenario& scenario, const Document& document) {
    if (scenario.speed == max_speed && !scenario.duration && !scenario.hil)
        return setup_error(SetupCode::usage, "speed max needs the length of the flight: for, or --for 10m");
    if (!scenario.input.empty() && scenario.start_time == WallTime{})
        return setup_error(SetupCode::usage,
                           "replay_input needs the start_time of the session that was recorded, which it stated at its "
                           "end: --start-time 2026-11-29T12:00:00Z");
    if (auto good = check_recordings(scenario); !good) return good;
    if (auto good = check_endpoints(scenario, document); !good) return good;
    return check_parameters(scenario, document);
}

}  // namespace mavloom::simserve
