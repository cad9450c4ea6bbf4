// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "info/reports.hpp"
#include "mavloom/base/durations.hpp"
#include "mavloom/observe/loss.hpp"

namespace mavloom::app {

namespace {

using Json = nlohmann::ordered_json;

template <class T>
Json or_null(const std::optional<T>& value) {
    return value ? Json(*value) : Json(nullptr);
}

// Returns the full name of the enum entry, or null if the enum has no such entry.
Json entry_json(const dialect::Dialect& dialect, std::string_view enum_name, std::uint64_t value) {
    const auto* const all = dialect.find_enum(enum_name);
    const auto* const entry = all == nullptr ? nullptr : all->find(value);
    return entry == nullptr ? Json(nullptr) : Json(entry->name);
}

Json when_json(const observe::When& when) { return {{"time_us", unix_us(when.time)}, {"at_s", seconds(when.at)}}; }
Json source_json(Source source) { return {{"sys", source.system.value}, {"comp", source.component.value}}; }

template <class... Parts>
Json joined(Json first, const Parts&... more) {
    (first.update(more), ...);
    return first;
}

template <class Items, class ToJson>
Json array_of(const Items& items, ToJson&& to_json) {
    auto all = Json::array();
    for (const auto& item : items) all.push_back(to_json(item));
    return all;
}

Json fix_json(const std::optional<observe::Fix>& fix) {
    if (!fix) return nullptr;
    return joined(when_json(fix->when), Json{{"lat_deg", fix->lat_deg},
                                             {"lon_deg", fix->lon_deg},
                                             {"alt_m", fix->alt_m},
                                             {"relative_alt_m", or_null(fix->relative_alt_m)}});
}

Json battery_json(const std::optional<observe::BatteryUse>& use) {
    if (!use) return nullptr;
    return {{"first_percent", or_null(use->first.percent)},   {"last_percent", or_null(use->last.percent)},
            {"lowest_percent", or_null(use->lowest_percent)}, {"first_voltage_v", or_null(use->first.voltage_v)},
            {"last_voltage_v", or_null(use->last.voltage_v)}, {"lowest_voltage_v", or_null(use->lowest_voltage_v)}};
}

Json firmware_json(const std::optional<observe::Firmware>& firmware) {
    if (!firmware) return nullptr;
    return {{"version", firmware->text()}, {"git", firmware->git}};
}

Json mode_json(const observe::ModePeriod& period) {
    return joined(when_json(period.begin), Json{{"duration_s", seconds(period.duration)},
                                                {"mode", period.name.empty() ? Json(nullptr) : Json(period.name)},
                                                {"custom_mode", period.custom_mode}});
}
Json armed_json(const observe::ArmedPeriod& period) {
    return joined(when_json(period.begin), Json{{"duration_s", seconds(period.duration)}});
}

Json kind_json(const observe::SenderSummary& sender, const dialect::Dialect& dialect) {
    if (!sender.has_heartbeat) return {{"autopilot", nullptr}, {"type", nullptr}};
    return {{"autopilot", entry_json(dialect, "MAV_AUTOPILOT", sender.autopilot)},
            {"type", entry_json(dialect, "MAV_TYPE", sender.type)}};
}

Json vehicle_json(const observe::SenderSummary& vehicle, const dialect::Dialect& dialect) {
    const auto& journey = vehicle.journey;
    return joined(source_json(vehicle.source), kind_json(vehicle, dialect),
                  Json{{"firmware", firmware_json(vehicle.firmware)},
                       {"modes", array_of(vehicle.modes, mode_json)},
                       {"armed", array_of(vehicle.armed, armed_json)},
                       {"highest_alt_m", or_null(journey.highest_alt_m)},
                       {"highest_relative_alt_m", or_null(journey.highest_relative_alt_m)},
                       {"highest_speed_m_s", or_null(journey.highest_speed_m_s)},
                       {"distance_m", journey.first ? Json(journey.distance_m) : Json(nullptr)},
                       {"first_position", fix_json(journey.first)},
                       {"last_position", fix_json(journey.last)},
                       {"battery", battery_json(vehicle.battery)}});
}

Json message_json(const observe::MessageTotal& message, const observe::Summary& all) {
    return {{"id", message.id.value},
            {"name", message.name.empty() ? Json(nullptr) : Json(message.name)},
            {"count", message.count},
            {"bytes", message.bytes},
            {"rate_hz", all.rate_hz(message)}};
}

Json sender_json(const observe::SenderSummary& sender, const observe::Summary& all, const dialect::Dialect& dialect) {
    const auto& losses = sender.losses;
    return joined(
        source_json(sender.source), kind_json(sender, dialect),
        Json{{"frames", sender.frames},
             {"bytes", sender.bytes},
             {"lost", losses.lost},
             {"loss_percent", 100 * observe::loss_ratio(losses)},
             {"late", losses.late},
             {"duplicate", losses.duplicate},
             {"resync", losses.resync},
             {"messages", array_of(sender.messages, [&](const auto& one) { return message_json(one, all); })}});
}

Json text_json(const observe::TextSummary& text, const dialect::Dialect& dialect) {
    return joined(when_json(text.first), source_json(text.source),
                  Json{{"severity", entry_json(dialect, "MAV_SEVERITY", text.severity)},
                       {"text", text.text},
                       {"count", text.count},
                       {"last_time_us", unix_us(text.last.time)}});
}

Json change_json(const observe::ParameterChange& change) {
    return joined(when_json(change.when), source_json(change.source),
                  Json{{"name", change.name}, {"before", change.before}, {"after", change.after}});
}

Json jump_json(const observe::ClockJump& jump) {
    return joined(when_json(jump.when), Json{{"step_s", seconds(jump.step)}});
}

Json time_json(const std::optional<WallTime>& time) { return time ? Json(unix_us(*time)) : Json(nullptr); }

}  // namespace

std::string info_json(const RecordingInfo& info, const dialect::Dialect& dialect) {
    const auto& all = info.summary;
    auto vehicles = Json::array();
    for (const auto& sender : all.senders)
        if (sender.is_vehicle) vehicles.push_back(vehicle_json(sender, dialect));
    const Json object{
        {"file", info.file},
        {"size", info.size},
        {"begin_us", time_json(all.begin)},
        {"end_us", time_json(all.end)},
        {"duration_s", seconds(all.duration)},
        {"frames", all.frames},
        {"bytes", all.bytes},
        {"junk_bytes", info.lost_bytes},
        {"damaged_places", info.damaged_places},
        {"unknown_flags", info.unknown_flags},
        {"clock_jumps", array_of(all.clock_jumps, jump_json)},
        {"vehicles", std::move(vehicles)},
        {"warnings", array_of(all.texts, [&](const auto& text) { return text_json(text, dialect); })},
        {"parameters", array_of(all.parameters, change_json)},
        {"senders", array_of(all.senders, [&](const auto& sender) { return sender_json(sender, all, dialect); })},
        {"unlisted_frames", all.unlisted_frames},
        {"unlisted_entries", all.unlisted_entries}};
    return object.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace mavloom::app
