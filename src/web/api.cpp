// SPDX-License-Identifier: MIT
#include "web/api.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "mavloom/message/format.hpp"
#include "web/json.hpp"

namespace mavloom::web {

namespace {

// The name of the value; the number itself if it has none.
Json named(const dialect::Dialect& dialect, std::string_view name, std::uint64_t value) {
    const auto* const all = dialect.find_enum(name);
    const auto* const entry = all == nullptr ? nullptr : all->find(value);
    return entry == nullptr ? Json(value) : Json(entry->name);
}

Json system_of(const observe::Vehicle& vehicle, const dialect::Dialect& dialect) {
    return {{"sys", vehicle.source.system.value},
            {"comp", vehicle.source.component.value},
            {"type", named(dialect, "MAV_TYPE", vehicle.type)},
            {"autopilot", named(dialect, "MAV_AUTOPILOT", vehicle.autopilot)},
            {"mode", vehicle.mode.empty() ? Json() : Json(vehicle.mode)},
            {"armed", vehicle.is_armed},
            {"status", named(dialect, "MAV_STATE", vehicle.status)},
            {"time_us", unix_us(vehicle.last_heartbeat)}};
}

std::string instance_json(const observe::LatestRow& row) {
    const auto instance = row.instance();
    if (!instance) return "null";
    const auto* const number = std::get_if<std::int64_t>(&*instance);
    return number != nullptr ? fmt::format("{}", *number) : text_of(Json(std::get<std::string>(*instance)));
}

struct Message {
    std::string topic;
    observe::TrafficRow traffic;
    observe::LatestRow row;
};

void append_message(message::TextBuffer& out, const Message& one, WallTime now) {
    const auto& [topic, traffic, row] = one;
    const auto& message = *row.message;
    fmt::format_to(std::back_inserter(out),
                   R"({{"topic":{},"sys":{},"comp":{},"id":{},"name":"{}","instance":{},"frames":{},"hz":{:.1f},)"
                   R"("time_us":{},"fields":{{)",
                   text_of(topic), row.traffic.source.system.value, row.traffic.source.component.value,
                   message.id().value, message.name, instance_json(row), traffic.count, traffic.recent_rate_hz(now),
                   unix_us(row.traffic.last));
    message::append_json_fields(out, message, row.payload());
    out.append(std::string_view("}}"));
}

// The messages of some channels behind the id `last`, which moves.
std::vector<Message> copy_some(const Channels& channels, std::uint32_t& last) {
    std::size_t left = 100;
    std::vector<Message> some;
    for (auto at = channels.all().upper_bound(last); at != channels.all().end() && left != 0; ++at, --left) {
        const auto& channel = at->second;
        last = channel.id;
        if (const auto* const row = channel.latest(); row != nullptr && channel.of == nullptr)
            some.push_back({channel.topic, channel.traffic, *row});
    }
    return some;
}

}  // namespace

std::string systems_json(std::span<const observe::Vehicle> vehicles, const dialect::Dialect& dialect) {
    Json all = Json::array();
    for (const auto& vehicle : vehicles) all.push_back(system_of(vehicle, dialect));
    return text_of(all) + "\n";
}

std::string messages_json(const Channels& channels, std::mutex& mutex, WallTime now) {
    message::TextBuffer out;
    out.push_back('[');
    std::uint32_t last = 0;
    for (bool more = true; more;) {
        std::vector<Message> some;
        {
            const std::lock_guard lock(mutex);
            some = copy_some(channels, last);
            more = last < channels.newest();
        }
        for (const auto& one : some) {
            out.append(std::string_view(out.size() == 1 ? "\n" : ",\n"));
            append_message(out, one, now);
        }
    }
    out.append(std::string_view("\n]\n"));
    return fmt::to_string(out);
}

std::string routes_json(std::span<const RoutesOf> routers) {
    std::string all;
    for (const auto& of : routers) {
        const Json error = of.error.empty() ? Json() : Json(of.error);
        all += fmt::format(R"({}{{"router":{},"error":{},"routes":[{}]}})", all.empty() ? "" : ",\n",
                           text_of(of.router), text_of(error), fmt::join(of.routes, ",\n"));
    }
    return "[" + all + "]\n";
}

}  // namespace mavloom::web
