// SPDX-License-Identifier: MIT
#include "web/report/reporter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "web/report/metrics.hpp"

namespace mavloom::web {

namespace {

// About 25 kB of text, so that several fit into a client's queue.
constexpr std::size_t rows_of_page = 100;
// A row that falls silent is sent again at these ages, because its rate falls.
constexpr std::array rate_falls{std::chrono::seconds(2), std::chrono::seconds(5), std::chrono::seconds(10),
                                std::chrono::seconds(20), std::chrono::seconds(60)};

bool has_fallen(MonoTime heard, MonoTime last_turn, MonoTime now) {
    return std::ranges::any_of(rate_falls, [&](auto age) { return heard + age > last_turn && heard + age <= now; });
}

std::string topic_of(const observe::LatestRow& row, const Channel* channel) {
    if (channel != nullptr) return channel->topic;
    const auto& its = row.traffic;
    return fmt::format("/{}/{}/{}", its.source.system.value, its.source.component.value, its.id.value);
}

std::optional<std::string> instance_of(const observe::LatestRow& row) {
    const auto instance = row.instance();
    return instance ? std::optional(message::text_of(*instance)) : std::nullopt;
}

TrafficLine line_of(const observe::LatestRow& row, const Channel* channel, bool has_ended, ReportTime now) {
    const auto age = now.mono - row.heard;
    const auto silent_after = has_ended ? std::nullopt : row.silent_after();
    const bool is_silent = silent_after && age > *silent_after;
    return {.topic = topic_of(row, channel),
            .link = row.link->name,
            .name = row.message == nullptr ? std::string_view() : row.message->name,
            .instance = instance_of(row),
            .source = row.traffic.source,
            .id = row.traffic.id,
            .count = row.traffic.count,
            .bytes = row.traffic.bytes,
            .hz = is_silent ? 0 : row.traffic.recent_rate_hz(now.wall),
            .share = row.share(),
            .gap_min = row.traffic.shortest_gap,
            .gap_max = row.traffic.longest_gap,
            .jitter = row.jitter,
            .age = age,
            .silent_after = silent_after};
}

ReportTime time_now() { return {wall_now(), mono_now()}; }

}  // namespace

Reporter::Reporter(const dialect::Dialect& dialect, observe::Inspector& inspector, const Channels& channels,
                   std::mutex& mutex)
    : dialect_(dialect),
      inspector_(inspector),
      channels_(channels),
      mutex_(mutex),
      pages_([this](std::size_t number, bool all) {
          const auto some = rows(number * rows_of_page, (number + 1) * rows_of_page, all);
          return some.empty() ? std::string() : traffic_json(time_now(), some);
      }) {}

std::string Reporter::make(Report report) {
    const auto now = time_now();
    const auto copy = [&](auto&& read) {
        const std::lock_guard lock(mutex_);
        return read();
    };
    switch (report) {
        case Report::vehicles: return vehicles_json(now, vehicles(), dialect_);
        case Report::links: return links_json(now, copy([&] { return inspector_.hops(); }));
        case Report::alarms: {
            const auto [alarms,
                        evicted] = copy([&] { return std::pair(inspector_.alarms(), inspector_.evicted_alarms()); });
            return alarms_json(now, alarms, evicted);
        }
        case Report::traffic: break;
    }
    return traffic_json(now, all_rows());
}

std::vector<observe::Vehicle> Reporter::vehicles() {
    const std::lock_guard lock(mutex_);
    return inspector_.vehicles(wall_now());
}

std::string Reporter::metrics(std::span<const observe::NamedCount> server) {
    const auto rows = all_rows();
    std::unique_lock lock(mutex_);
    const auto vehicles = inspector_.vehicles(wall_now());
    const auto hops = inspector_.hops();
    const auto alarms = inspector_.alarms();
    lock.unlock();
    return metrics_text(rows, vehicles, hops, alarms, server);
}

// In pieces, so that the thread that receives never waits long.
std::vector<TrafficLine> Reporter::all_rows() {
    std::vector<TrafficLine> all;
    for (std::size_t begin = 0;; begin += rows_of_page) {
        const std::lock_guard lock(mutex_);
        if (begin >= inspector_.latest().rows().size()) return all;
        std::ranges::move(rows(begin, begin + rows_of_page, true), std::back_inserter(all));
    }
}

std::vector<TrafficLine> Reporter::rows(std::size_t begin, std::size_t end, bool all) const {
    const auto& table = inspector_.latest().rows();
    const auto now = time_now();
    std::vector<TrafficLine> lines;
    for (std::size_t i = begin; i < std::min(end, table.size()); ++i) {
        const auto& row = table[i];
        if (row.born == 0) continue;
        if (all || row.number > last_turn_ || has_fallen(row.heard, last_turn_at_, now.mono))
            lines.push_back(line_of(row, channels_.find(row), inspector_.has_ended(row.traffic.link), now));
    }
    return lines;
}

void Reporter::begin_turn() {
    last_turn_ = std::exchange(turn_, inspector_.latest().frames());
    last_turn_at_ = std::exchange(turn_at_, mono_now());
    pages_.begin_turn((inspector_.latest().rows().size() + rows_of_page - 1) / rows_of_page);
}

void Reporter::note_counts(observe::OwnCounts counts) {
    const std::lock_guard lock(mutex_);
    inspector_.note_losses(counts.on_links, wall_now(), mono_now());
    own_counts_ = std::move(counts);
}

// At once, so that the rates belong to the times at which the counts were taken.
void Reporter::set_hops(std::vector<observe::Hop> hops) {
    const auto now = time_now();
    const std::lock_guard lock(mutex_);
    hops.push_back(own_hop());
    inspector_.set_hops(std::move(hops), now.wall, now.mono);
    has_hops_ = true;
}

observe::Hop Reporter::own_hop() const {
    const auto counts = own_counts_.value_or(observe::OwnCounts{.frames = inspector_.latest().frames()});
    observe::Hop hop{.name = "mavloom web",
                     .kind = observe::Hop::Kind::web,
                     .frames_in = counts.frames,
                     .losses = counts.losses,
                     .links = counts.links};
    hop.losses.push_back({"unlisted", inspector_.latest().unlisted() + channels_.left_out(),
                          "frames of messages beyond the limit of topics"});
    return hop;
}

void Reporter::tick() {
    const auto now = time_now();
    const std::lock_guard lock(mutex_);
    if (!has_hops_) inspector_.set_hops({own_hop()}, now.wall, now.mono);
    inspector_.tick(now.wall, now.mono);
}

}  // namespace mavloom::web
