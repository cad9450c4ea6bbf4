// SPDX-License-Identifier: MIT
#include "mavloom/view/snapshot.hpp"

#include <algorithm>
#include <tuple>

namespace mavloom::view {

namespace {

auto order_of(const Row& row) {
    const auto& its = row.its;
    const auto name = its.message == nullptr ? std::string_view() : its.message->name;
    return std::tuple(its.traffic.link, its.traffic.source, name, its.traffic.id, its.instance_number);
}

Row row_of(const observe::LatestRow& its, Now now, Rates rates) {
    Row row{its, rates == Rates::average ? its.traffic.rate_hz() : its.traffic.recent_rate_hz(now.wall), its.share()};
    row.its.link = nullptr;
    return row;
}

void add_totals(Snapshot& to, const Row& row) {
    const auto& its = row.its.traffic;
    to.hz += row.hz;
    to.bytes_per_s += row.hz * static_cast<double>(its.bytes) / static_cast<double>(its.count);
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
        add_totals(shown, shown.rows.emplace_back(row_of(its, now, rates)));
    }
    std::ranges::sort(shown.rows, {}, order_of);
    shown.vehicles = inspector.vehicles(now.wall);
    std::ranges::sort(shown.vehicles, {}, &observe::Vehicle::source);
    shown.hops = inspector.hops();
    shown.alarms = inspector.alarms();
    return shown;
}

}  // namespace mavloom::view
