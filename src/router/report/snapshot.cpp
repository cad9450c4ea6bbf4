// SPDX-License-Identifier: MIT
#include "router/report/snapshot.hpp"

#include <algorithm>
#include <span>
#include <utility>

namespace mavloom::router {

namespace {

using link::NamedCount;

constexpr std::size_t systems = 256;

// The router's counters of a link: the verdicts of its frames.
void append(std::vector<NamedCount>& all, const route::LinkCounters& r) {
    all.insert(all.end(), {{"forwarded", r.forwarded.value()},
                           {"nowhere", r.nowhere.value()},
                           {"filtered", r.filtered.value()},
                           {"rate_limited", r.rate_limited.value()},
                           {"duplicate", r.duplicate.value()},
                           {"echo", r.echo.value()},
                           {"unknown_target", r.unknown_target.value()},
                           {"consumed", r.consumed.value()},
                           {"tap", r.tap.value()},
                           {"private_link", r.private_link.value()},
                           {"out_filtered", r.out_filtered.value()},
                           {"out_rate_limited", r.out_rate_limited.value()},
                           {"out_bytes_limited", r.out_bytes_limited.value()}});
}

std::vector<NamedCount> counts_of(const record::RecorderCounters& c) {
    return {{"frames", c.frames.value()},
            {"bytes", c.bytes.value()},
            {"queue_full", c.queue_full.value()},
            {"write_error", c.write_error.value()}};
}

std::vector<NamedCount> counts_of(Router& router) {
    const auto& c = router.engine().counters();
    return {{"heartbeats_sent", router.heartbeats_sent()},
            {"not_signed", router.not_signed()},
            {"unknown_link", c.unknown_link.value()},
            {"unlisted", router.traffic().unlisted()},
            {"routes_learned", c.routes_learned.value()},
            {"routes_expired", c.routes_expired.value()},
            {"routes_evicted", c.routes_evicted.value()},
            {"recent_evicted", c.recent_evicted.value()},
            {"reboots", c.reboots.value()},
            {"duplicate_ids", c.duplicate_ids.value()},
            {"route_conflicts", c.route_conflicts.value()}};
}

void append(auto& all, const auto& more) { all.insert(all.end(), more.begin(), more.end()); }

}  // namespace

void Snapshot::sort() {
    if (std::exchange(is_sorted_, true)) return;
    messages = observe::TrafficTable::sorted(std::move(messages));
    std::ranges::sort(routes, {}, [](const route::RouteInfo& r) { return std::pair(r.source, r.link); });
}

std::shared_ptr<Snapshot> Snapshots::request(Contents contents) {
    const auto fresh = std::ranges::find_if(
        copies_, [&](const Copy& copy) { return copy.contents == contents && !copy.has_begun; });
    if (fresh != copies_.end()) return fresh->to;
    return copies_.emplace_back(contents, std::make_shared<Snapshot>()).to;
}

std::function<bool()> copying(Router& router, std::shared_ptr<const Snapshot> snapshot) {
    return [&router, snapshot = std::move(snapshot)] {
        if (!snapshot->is_complete) router.snapshots().copy_piece(router);
        return !snapshot->is_complete;
    };
}

void Snapshots::copy_piece(Router& router) {
    if (copies_.empty()) return;
    Copy& copy = copies_.front();
    copy.copied = 0;
    if (!std::exchange(copy.has_begun, true)) begin(copy, router);
    copy_links(copy, router);
    if (copy.contents == Contents::all) {
        copy_messages(copy, router);
        copy_unknown_targets(copy, router);
    }
    if (!has_all(copy)) return;
    copy.to->is_complete = true;
    copies_.pop_front();
}

bool Snapshots::has_all(const Copy& copy) noexcept {
    if (copy.link < copy.links.size()) return false;
    return copy.contents != Contents::all ||
           (copy.message == observe::TrafficTable::end && copy.target_system == systems);
}

void Snapshots::begin(Copy& copy, Router& router) {
    Snapshot& to = *copy.to;
    to.dialect = &router.dialect();
    to.uptime = mono_now() - router.started();
    to.counts = counts_of(router);
    copy.links = router.links().link_ids();
    if (copy.contents == Contents::all) {
        to.time = wall_now();
        router.links().refresh_kernel_drops();
        to.messages.reserve(router.traffic().size());
        for (const auto* recorder : router.recorders())
            to.recordings.push_back({recorder->label(), counts_of(recorder->counters())});
    }
    link::add_endpoints(to, router.links());
}

void Snapshots::copy_links(Copy& copy, Router& router) {
    Snapshot& to = *copy.to;
    for (; copy.copied < piece && copy.link < copy.links.size(); ++copy.link) {
        const LinkId id = copy.links[copy.link];
        const auto known = to.links.size();
        link::add_links(to, router.links(), std::span(&id, 1));
        if (to.links.size() == known) continue;  // the link has gone
        auto& link = to.links.back();
        if (const auto* routed = router.verdicts(id)) append(link.counts, *routed);
        copy.copied += rows_per_link + link.sources.size();
        if (copy.contents != Contents::routes) continue;
        const auto routes = router.engine().routes(id, mono_now());
        append(to.routes, routes);
        copy.copied += routes.size();
    }
}

void Snapshots::copy_messages(Copy& copy, const Router& router) {
    if (copy.copied >= piece || copy.message == observe::TrafficTable::end) return;
    const std::size_t most = piece - copy.copied, before = copy.to->messages.size();
    copy.message = router.traffic().copy_rows(copy.message, most, copy.to->messages);
    copy.copied = copy.message == observe::TrafficTable::end ? copy.copied + copy.to->messages.size() - before : piece;
}

void Snapshots::copy_unknown_targets(Copy& copy, const Router& router) {
    for (; copy.copied < piece && copy.target_system < systems; ++copy.target_system) {
        const auto targets = router.engine().unknown_targets(SystemId{static_cast<std::uint8_t>(copy.target_system)});
        append(copy.to->unknown_targets, targets);
        copy.copied += targets.size();
    }
}

}  // namespace mavloom::router
