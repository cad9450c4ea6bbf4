// SPDX-License-Identifier: MIT
#include "router/forwarder.hpp"

#include <fmt/format.h>

#include <utility>

#include "mavloom/base/secret_hash.hpp"
#include "mavloom/msg/command_int.hpp"
#include "mavloom/msg/command_long.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/set_mode.hpp"

namespace mavloom::router {

static_assert(link::Links::max_late < route::Engine::echo_window);

namespace {

route::Options engine_options(const config::RouterConfig& config) {
    route::Options options;
    options.dedup = std::chrono::milliseconds(config.dedup_ms);
    options.unknown_component = config.unknown_component;
    options.unknown_target = config.unknown_target;
    options.route_timeout = config.route_timeout;
    if (config.heartbeat)
        options.own = Source{SystemId{config.heartbeat->first}, ComponentId{config.heartbeat->second}};
    options.seed = secret_hash(0);
#ifdef MAVLOOM_MINIMAL
    options.recent_frames = 1u << 13;  // 256 KiB instead of 2 MiB: 2 s at 4,000 frames/s
#endif
    return options;
}

}  // namespace

Forwarder::Forwarder(const dialect::Dialect& dialect, const config::RouterConfig& config, link::LinkAccess& links)
    : links_(links),
      engine_(dialect.wire_table(), engine_options(config)),
      own_messages_(dialect.wire_table(), config,
                    {[this](LinkId link, const wire::FrameView& frame) { return send_own(link, frame); },
                     [this](LinkId link) { return is_answered(link); }}) {}

void Forwarder::configure(const config::RouterConfig& config) {
    engine_.set_options(engine_options(config));
    own_messages_.configure(config);
}

// The router sends its own messages neither to taps nor to the inlet: programs at the inlet read the ring, which does
// not contain these messages.
bool Forwarder::add_link(LinkId link, const RoutedEndpoint& endpoint) {
    const auto before = down_.find(link);
    const auto counts = before == down_.end() ? route::LinkCounters{} : before->second;
    route::LinkPolicy policy = endpoint.policy;
    policy.rank = links_.rank(link);
    if (!engine_.add_link(link, policy, counts)) return false;
    down_.erase(link);
    if (!endpoint.policy.tap && !endpoint.is_inlet)
        own_messages_.add(link, wants_heartbeat(endpoint.endpoint), links_.now());
    return true;
}

void Forwarder::remove_link(LinkId link) {
    if (const auto* const counts = engine_.counters(link)) down_.insert_or_assign(link, *counts);
    engine_.remove_link(link);
    own_messages_.remove(link);
    has_removed_link_ = true;
}

route::Decision Forwarder::decide(const link::RxFrame& rx, std::uint64_t mark) {
    traffic_.add(rx.link, rx.frame, rx.time);
    if (rx.frame.id() == msg::Heartbeat::id) {
        newest_heartbeats_.note(rx.link, rx.frame.source(), rx.frame.payload());
        own_messages_.on_heartbeat(rx.link, rx.frame, links_.now());
    }
    if (!explainer_) [[likely]]
        return engine_.route(rx.frame, mark, rx.info, rx.link, links_.now(), rx.is_repeated);
    const auto decision = engine_.explain(rx.frame, rx.info, rx.link, links_.now(), why_, rx.is_repeated);
    explainer_(rx, decision, why_);
    return decision;
}

void Forwarder::deliver(const link::RxFrame& rx, const route::Decision& decision, const RoutedEndpoint& from) {
    send(rx, decision.links);
    if (decision.verdict != route::Verdict::echo) count_loss(rx, from.policy);
}

// A new signature on a copy would hide from its receiver that it is one.
void Forwarder::send(const link::RxFrame& rx, std::span<const LinkId> links) {
    const std::size_t not_signed = links_.forward(links, rx.frame, rx.is_repeated ? Rank::stranger : rx.rank);
    if (not_signed != 0) [[unlikely]]
        note_not_signed(rx, not_signed);
}

// Only a command without effect is worth a warning. Telemetry is useful unsigned, too.
static bool is_command(MessageId id) {
    return id == msg::CommandLong::id || id == msg::CommandInt::id || id == msg::SetMode::id;
}

void Forwarder::note_not_signed(const link::RxFrame& rx, std::size_t links) {
    not_signed_.add(links);
    if (has_warned_of_unsigned_ || !is_command(rx.frame.id()) || rx.frame.is_signed() || rx.is_repeated) return;
    has_warned_of_unsigned_ = true;
    warnings_.push_back(fmt::format(
        "a command from {}/{} on {} went out unsigned on a link with sign=, because it arrived unverified; a vehicle "
        "that requires signatures ignores it. Let the sender sign with the same key, and set verify=KEYFILE on the "
        "endpoint where its frames arrive; or, if you trust all programs of this machine, set sign_all=true beside "
        "sign=",
        rx.frame.source().system.value, rx.frame.source().component.value, name_of(rx.link)));
}

// Ignores reboots shown by frames that teach no route: those from taps, those that the input filter drops, and signed
// frames that another endpoint has heard.
void Forwarder::count_loss(const link::RxFrame& rx, const route::LinkPolicy& policy) {
    if (rx.loss->count(rx.frame, rx.info).verdict != wire::SequenceTracker::Verdict::reboot) [[likely]]
        return;
    if (!policy.tap && !rx.is_repeated && policy.in.admits(rx.frame.id(), rx.frame.source()))
        engine_.note_reboot(rx.link, rx.frame.source(), links_.now());
}

bool Forwarder::send_own(LinkId link, const wire::FrameView& frame) {
    if (links_.send(std::span(&link, 1), frame) == 0) return false;
    engine_.note_sent(frame, link, links_.now());
    return true;
}

bool Forwarder::is_answered(LinkId link) const {
    const auto* const counters = links_.counters(link);
    return counters != nullptr && counters->frames_in.value() != 0;
}

std::string Forwarder::name_of(LinkId link) const {
    const auto name = links_.link_name(link);
    return name.empty() ? "a link that is gone" : std::string(name);
}

const route::LinkCounters* Forwarder::verdicts(LinkId link) const {
    if (const auto* const counts = engine_.counters(link)) return counts;
    const auto at = down_.find(link);
    return at == down_.end() ? nullptr : &at->second;
}

std::string Forwarder::text_of(const route::RouteConflict& conflict) const {
    const auto first = name_of(conflict.first), second = name_of(conflict.second);
    if (conflict.is_believed)
        return fmt::format(
            "system {} is alive on {} and was learned on {} too: redundant links that need group=, another vehicle "
            "that needs an id of its own, or a sender that claims to be it, which verify= or learn=first prevent",
            conflict.system.value, first, second);
    return fmt::format(
        "system {} is alive on {}, so {}, which claims to be it, gets no commands to its autopilot; for another "
        "vehicle, set another id; for the same one, set trusted=true at the endpoint, or one group= if both links lead "
        "to the same router",
        conflict.system.value, first, second);
}

std::vector<std::string> Forwarder::maintain() {
    if (std::exchange(has_removed_link_, false)) {
        const auto is_there = [&](LinkId link) { return links_.counters(link) != nullptr; };
        traffic_.forget_links_unless(is_there);
        newest_heartbeats_.forget_links_unless(is_there);
        std::erase_if(down_, [&](const auto& link) { return !is_there(link.first); });
    }
    auto warnings = std::exchange(warnings_, {});
    const auto ids = engine_.duplicate_ids();
    for (const auto& id : ids.subspan(std::exchange(duplicate_ids_reported_, ids.size())))
        warnings.push_back(
            fmt::format("{}/{} is heard on {} and on {}: two senders with one id, or redundant links that need group=",
                        id.source.system.value, id.source.component.value, name_of(id.first), name_of(id.second)));
    const auto conflicts = engine_.route_conflicts();
    for (const auto& conflict : conflicts.subspan(std::exchange(route_conflicts_reported_, conflicts.size())))
        warnings.push_back(text_of(conflict));
    return warnings;
}

}  // namespace mavloom::router
