// SPDX-License-Identifier: MIT
#include "router/report/snapshot.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "mavloom/msg/heartbeat.hpp"

namespace mavloom::router {

namespace {

using link::NamedCount;

constexpr std::size_t systems = 256;

void append(auto& all, const auto& more) { all.insert(all.end(), more.begin(), more.end()); }

std::vector<NamedCount> counts_of(Router& router) {
    std::vector<NamedCount> all{{"heartbeats_sent", router.heartbeats_sent(), "own heartbeats"},
                                {"not_signed", router.not_signed(),
                                 "frames that sign= sent unchanged, because they were not verified on arrival"},
                                {"unlisted", router.traffic().unlisted(), "frames that no series of messages counts"}};
    append(all, link::counts_in(router.engine().counters(), route::engine_counters));
    return all;
}

// Null for rows of other messages.
const NewestHeartbeats::Beginning* beginning_of(const observe::TrafficRow& row, const NewestHeartbeats& newest) {
    return row.id == msg::Heartbeat::id ? newest.find(row.link, row.source) : nullptr;
}

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
        router.links().refresh_counters();
        to.messages.reserve(router.traffic().size());
        for (const auto* recorder : router.recorders())
            to.recordings.push_back(
                {recorder->label(), link::counts_in(recorder->counters(), record::recorder_counters)});
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
        if (const auto* routed = router.verdicts(id))
            append(link.counts, link::counts_in(*routed, route::link_verdicts));
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
    for (const auto& row : std::span(copy.to->messages).subspan(before))
        if (const auto* const beginning = beginning_of(row, router.newest_heartbeats()))
            copy.to->heartbeats.note(row.link, row.source, *beginning);
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
