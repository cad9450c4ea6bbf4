// SPDX-License-Identifier: MIT
#include "mavloom/router/report.hpp"

#include <utility>

#include "control/json_lines.hpp"
#include "mavloom/message/modes.hpp"
#include "router/report/pieces.hpp"
#include "router/report/snapshot.hpp"

namespace mavloom::router {

namespace {

using control::append_line;
using control::Json;
using Shared = std::shared_ptr<Snapshot>;

AppendRow router_line(const Snapshot& s) {
    return once([&s](std::string& text) {
        append_line(text, {{"kind", "router"}, {"uptime_s", seconds(s.uptime)}}, s.counts);
    });
}

AppendRow endpoint_lines(const Snapshot& s) { return each_of(s.endpoints, control::append_endpoint); }
AppendRow gone_lines(const Snapshot& s) { return each_of(s.endpoints, control::append_gone); }
AppendRow source_lines(const Snapshot& s) { return each_of(s.links, control::append_sources); }

AppendRow link_lines(const Snapshot& s) {
    return each_of(s.links, [&s](std::string& text, const auto& link) { control::append_link(text, s, link); });
}

// The name of the mode in the newest HEARTBEAT; null if it has none.
Json mode_of(const NewestHeartbeats::Beginning* heartbeat) {
    const auto mode = heartbeat == nullptr ? std::string_view() : message::heartbeat_mode(*heartbeat);
    return mode.empty() ? Json() : Json(mode);
}

AppendRow message_lines(const Snapshot& s) {
    return each_of(s.messages, [&s](std::string& text, const observe::TrafficRow& row) {
        const auto* message = s.dialect->find(row.id);
        const auto* link = s.link(row.link);
        if (link == nullptr) return;
        Json line{{"kind", "message"},
                  {"link", link->name},
                  {"sys", row.source.system.value},
                  {"comp", row.source.component.value},
                  {"id", row.id.value},
                  {"name", message == nullptr ? Json() : Json(message->name)},
                  {"frames", row.count},
                  {"bytes", row.bytes},
                  {"rate_hz", row.recent_rate_hz(s.time)}};
        if (message != nullptr && message::has_mode(*message))
            line["mode"] = mode_of(s.heartbeats.find(row.link, row.source));
        append_line(text, std::move(line));
    });
}

AppendRow recording_lines(const Snapshot& s) {
    return each_of(s.recordings, [](std::string& text, const auto& recording) {
        append_line(text, {{"kind", "recording"}, {"endpoint", recording.label}}, recording.counts);
    });
}

AppendRow unknown_target_lines(const Snapshot& s) {
    return each_of(s.unknown_targets, [](std::string& text, const auto& unknown) {
        append_line(text, {{"kind", "unknown_target"},
                           {"sys", unknown.target.system.value},
                           {"comp", unknown.target.component.value},
                           {"frames", unknown.frames}});
    });
}

AppendRow route_lines(const Snapshot& s) {
    return each_of(s.routes, [&s](std::string& text, const route::RouteInfo& route) {
        const auto* link = s.link(route.link);
        append_line(text, {{"kind", "route"},
                           {"sys", route.source.system.value},
                           {"comp", route.source.component.value},
                           {"link", link == nullptr ? std::string_view{} : std::string_view(link->name)},
                           {"age_s", seconds(route.age)},
                           {"frames", route.frames}});
    });
}

Report report_of(Router& router, const Shared& s, std::vector<AppendRow> lists) {
    lists.insert(lists.begin(), once([&s = *s](std::string&) { s.sort(); }));
    lists.push_back(once(control::append_ok));
    return {.copy_more = copying(router, s),
            .next_text = [s, pieces = Pieces(std::move(lists))]() mutable { return pieces(); }};
}

}  // namespace

Report report_links(Router& router) {
    const auto s = router.snapshots().request(Contents::links);
    return report_of(router, s, {link_lines(*s)});
}

Report report_routes(Router& router) {
    const auto s = router.snapshots().request(Contents::routes);
    return report_of(router, s, {route_lines(*s)});
}

Report report_stats(Router& router) {
    const auto s = router.snapshots().request(Contents::all);
    return report_of(router, s,
                     {router_line(*s), endpoint_lines(*s), gone_lines(*s), link_lines(*s), source_lines(*s),
                      message_lines(*s), recording_lines(*s), unknown_target_lines(*s)});
}

}  // namespace mavloom::router
