// SPDX-License-Identifier: MIT
// Forwards received frames: counts the traffic, asks the routing engine, sends the frame on and counts loss. Also sends
// the router's own messages. Private to module router.
//
// One owner thread; time comes from the links. A frame costs no allocation, lock or log line, unless an Explainer is
// set.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "mavloom/base/counter.hpp"
#include "mavloom/config/config.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/link/links.hpp"
#include "mavloom/observe/traffic_table.hpp"
#include "mavloom/route/engine.hpp"
#include "router/endpoints.hpp"
#include "router/newest_heartbeats.hpp"
#include "router/own_messages.hpp"

namespace mavloom::router {

class Forwarder {
public:
    using Explainer =
        std::function<void(const link::RxFrame&, const route::Decision&, std::span<const route::Explanation>)>;

    // `dialect` and `links` must outlive the object.
    Forwarder(const dialect::Dialect& dialect, const config::RouterConfig& config, link::LinkAccess& links);

    // Applies new [router] values. Links, routes and counters stay.
    void configure(const config::RouterConfig& config);
    void explain(Explainer explainer) { explainer_ = std::move(explainer); }

    // Returns false if there are too many links. The router then neither forwards frames from this link nor sends it
    // any.
    [[nodiscard]] bool add_link(LinkId link, const RoutedEndpoint& endpoint);
    void remove_link(LinkId link);
    // Call it first for a link that is closed on purpose; see Engine::close_link.
    void close_link(LinkId link) { engine_.close_link(link); }
    // Call it for an endpoint that is closed on purpose; see Engine::close_endpoint.
    void close_endpoint(const RoutedEndpoint& endpoint) { engine_.close_endpoint(endpoint.policy.endpoint); }
    void set_group_orders(std::span<const route::GroupOrder> orders) { engine_.set_group_orders(orders); }

    // Call these three, in order, for each received frame. `mark_of` prefetches the entry that `decide` needs, so call
    // it early.
    [[nodiscard]] std::uint64_t mark_of(const link::RxFrame& rx) const noexcept { return engine_.mark_of(rx.frame); }
    [[nodiscard]] route::Decision decide(const link::RxFrame& rx, std::uint64_t mark);
    // Sends the frame to the links of `decision`. `from` is the endpoint at which it arrived.
    void deliver(const link::RxFrame& rx, const route::Decision& decision, const RoutedEndpoint& from);

    // When the router's next own message is due; MonoTime::max() if none is.
    [[nodiscard]] MonoTime next_due() const noexcept { return own_messages_.next_due(); }
    void send_due(MonoTime now) { own_messages_.send_due(now); }
    // The verdicts on a link's frames, also while the link is down. Null for a link that is gone.
    [[nodiscard]] const route::LinkCounters* verdicts(LinkId link) const;
    // Call about once a second. Forgets the traffic and verdicts of links that are gone. Returns one warning for each
    // newly found id that two senders use, for each vehicle that was learned on a second link, and for the first
    // command that went out unsigned.
    [[nodiscard]] std::vector<std::string> maintain();

    [[nodiscard]] const route::Engine& engine() const noexcept { return engine_; }
    [[nodiscard]] const observe::TrafficTable& traffic() const noexcept { return traffic_; }
    [[nodiscard]] const NewestHeartbeats& newest_heartbeats() const noexcept { return newest_heartbeats_; }
    [[nodiscard]] std::uint64_t heartbeats_sent() const noexcept { return own_messages_.heartbeats_sent(); }
    // Frames sent unsigned on a link with `sign=`, because they arrived on a link without `verify=`.
    [[nodiscard]] std::uint64_t not_signed() const noexcept { return not_signed_.value(); }

private:
    void send(const link::RxFrame& rx, std::span<const LinkId> links);
    void note_not_signed(const link::RxFrame& rx, std::size_t links);
    void count_loss(const link::RxFrame& rx, const route::LinkPolicy& policy);
    bool send_own(LinkId link, const wire::FrameView& frame);
    [[nodiscard]] bool is_answered(LinkId link) const;
    [[nodiscard]] std::string name_of(LinkId link) const;
    [[nodiscard]] std::string text_of(const route::RouteConflict& conflict) const;

    link::LinkAccess& links_;
    route::Engine engine_;
    OwnMessages own_messages_;
    observe::TrafficTable traffic_;
    NewestHeartbeats newest_heartbeats_;
    std::map<LinkId, route::LinkCounters> down_;  // verdicts of links that are down and may come up again
    Explainer explainer_;
    std::vector<route::Explanation> why_;
    Counter not_signed_;
    bool has_warned_of_unsigned_ = false;
    std::vector<std::string> warnings_;  // for the next maintain()
    std::size_t duplicate_ids_reported_ = 0, route_conflicts_reported_ = 0;
    bool has_removed_link_ = false;  // the tables above may have a link that is gone
};

}  // namespace mavloom::router
