// SPDX-License-Identifier: MIT
#include "mavloom/view/snapshot.hpp"

#include <algorithm>
#include <span>
#include <tuple>

namespace mavloom::view {

namespace {

auto order_of(const Row& row) {
    const auto& its = row.its;
    const auto name = its.message == nullptr ? std::string_view() : its.message->name;
    return std::tuple(its.traffic.link, its.traffic.source, name, its.traffic.id, its.instance_number);
}

Row row_of(const observe::LatestRow& its) {
    Row row{.its = its, .share = its.share()};
    row.its.link = nullptr;
    return row;
}

void note_silence(std::span<Row> of_sender, MonoTime now) {
    MonoTime heard{};
    for (const auto& row : of_sender) heard = std::max(heard, row.its.heard);
    for (auto& row : of_sender) {
        const auto limit = row.its.silent_after();
        row.is_silent = now - heard >= observe::silence || (limit && now - row.its.heard > *limit);
    }
}

// Of recordings that have ended, nothing is silent. The rows are sorted, so those of one sender are neighbours.
void note_silence(Snapshot& shown, const observe::Inspector& inspector) {
    const auto sender_of = [](const Row& row) { return std::tuple(row.its.traffic.link, row.its.traffic.source); };
    for (auto first = shown.rows.begin(); first != shown.rows.end();) {
        const auto end = std::find_if(first, shown.rows.end(),
                                      [&](const Row& row) { return sender_of(row) != sender_of(*first); });
        if (!inspector.has_ended(first->its.traffic.link)) note_silence(std::span(first, end), shown.now.mono);
        first = end;
    }
}

void note_rates(Snapshot& shown, Rates rates) {
    for (auto& row : shown.rows) {
        const auto& its = row.its.traffic;
        row.hz = rates == Rates::average ? its.rate_hz() : row.is_silent ? 0 : its.recent_rate_hz(shown.now.wall);
        shown.hz += row.hz;
        shown.bytes_per_s += row.hz * static_cast<double>(its.bytes) / static_cast<double>(its.count);
    }
}

}  // namespace

const Row* Snapshot::find(const std::optional<RowKey>& key) const {
    if (!key) return nullptr;
    const auto row = std::ranges::find(rows, *key, &Row::key);
    return row == rows.end() ? nullptr : &*row;
}

const observe::SenderLoss* Snapshot::loss_of(LinkId link, Source source) const {
    const auto loss = std::ranges::find_if(losses,
                                           [&](const auto& one) { return one.link == link && one.source == source; });
    return loss == losses.end() ? nullptr : &*loss;
}

Snapshot take_snapshot(const dialect::Dialect& dialect, const observe::Inspector& inspector, Now now,
                       const std::vector<observe::SenderLoss>& losses, Rates rates) {
    Snapshot shown{.dialect = &dialect, .now = now, .losses = losses, .frames = inspector.latest().frames()};
    shown.rows.reserve(inspector.latest().rows().size());
    for (const auto& its : inspector.latest().rows()) {
        if (its.born == 0) continue;
        shown.links.try_emplace(its.traffic.link, its.link->name);
        shown.rows.push_back(row_of(its));
    }
    std::ranges::sort(shown.rows, {}, order_of);
    note_silence(shown, inspector);
    note_rates(shown, rates);
    shown.vehicles = inspector.vehicles(now.wall);
    shown.hops = inspector.hops();
    shown.alarms = inspector.alarms();
    return shown;
}

}  // namespace mavloom::view
