// SPDX-License-Identifier: MIT
#include "web/clients/viewers.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "mavloom/base/shown.hpp"

namespace mavloom::web {

namespace {

using namespace std::chrono_literals;

// An advertisement repeats the schema of each channel, so many channels are announced piece by piece, as the client
// reads.
constexpr std::size_t advertisement_bytes = 32'768, max_waiting_bytes = 65'536;
constexpr std::size_t max_subscriptions = 20'000, ids_at_once = 4000;
constexpr std::uint8_t report_class = 1;

std::string drops_text(std::uint64_t drops) {
    return fmt::format("this connection is too slow: {} messages were not sent so far, the oldest first", drops);
}

}  // namespace

http::SessionOptions viewer_options() {
    http::SessionOptions options{.accepts = http::Accepts::text, .max_message = std::size_t{1} << 19};
    options.queue.max_age = {60s, 10s, 1s};
    return options;
}

void Viewers::send_text(Viewer& viewer, std::string_view text, MonoTime now) {
    const ByteView bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    viewer.session->push(bytes, essential_class, 0, now, http::Kind::text);
    viewer.has_new = true;
}

void Viewers::add(const std::shared_ptr<http::Session>& session, MonoTime now) {
    auto& viewer = *all_.emplace(session.get(), std::make_unique<Viewer>(Viewer{session})).first->second;
    send_text(viewer, foxglove::server_info(), now);
    send_text(viewer, advertise_reports(), now);
    send_text(viewer, foxglove::advertise(channels_, viewer.advertised, advertisement_bytes), now);
    flush(now);
}

void Viewers::remove(const http::Session& session) {
    const auto at = all_.find(&session);
    if (at == all_.end()) return;
    const auto subscriptions = at->second->subscriptions;
    for (const auto& [id, channel] : subscriptions) unsubscribe(*at->second, id);
    all_.erase(at);
}

void Viewers::take(const http::Session& session, const SetupResult<foxglove::Request>& request, MonoTime now) {
    const auto at = all_.find(&session);
    if (at == all_.end()) return;
    auto& viewer = *at->second;
    if (!request) {
        ++bad_messages_;
        send_status(viewer, foxglove::Level::error, request.error().text, now);
    } else if (!request->unknown_op.empty()) {
        ++unknown_ops_;
        send_status(viewer, foxglove::Level::warning,
                    fmt::format("there is no operation {}; this server has subscribe and unsubscribe",
                                in_quotes(request->unknown_op)),
                    now);
    } else {
        unsubscribe(viewer, request->unsubscribe, now);
        subscribe(viewer, request->subscribe, now);
    }
    flush(now);
}

void Viewers::send_status(Viewer& viewer, foxglove::Level level, std::string_view text, MonoTime now) {
    send_text(viewer, foxglove::status(level, text), now);
}

// One status for all that cannot be had: the client may ask for thousands.
void Viewers::subscribe(Viewer& viewer, const std::vector<foxglove::Subscription>& all, MonoTime now) {
    std::string first;
    std::size_t refused = 0;
    for (const auto wanted : all) {
        const auto done = subscribe(viewer, wanted, now);
        if (!done && ++refused == 1) first = fmt::format("subscription {}: {}", wanted.id, done.error().text);
    }
    refused_subscriptions_ += refused;
    if (refused > 1) first += fmt::format("; {} more were refused", refused - 1);
    if (refused != 0) send_status(viewer, foxglove::Level::error, first, now);
}

// A warning: the server may have ended the subscription with its channel, before it got the request.
void Viewers::unsubscribe(Viewer& viewer, const std::vector<std::uint32_t>& ids, MonoTime now) {
    std::string first;
    std::size_t unknown = 0;
    for (const auto id : ids)
        if (!unsubscribe(viewer, id) && ++unknown == 1) first = fmt::format("there is no subscription {}", id);
    unknown_subscriptions_ += unknown;
    if (unknown > 1) first += fmt::format("; {} more are unknown", unknown - 1);
    if (unknown != 0) send_status(viewer, foxglove::Level::warning, first, now);
}

SetupResult<void> Viewers::subscribe(Viewer& viewer, foxglove::Subscription wanted, MonoTime now) {
    if (!manner_of(wanted.channel))
        return setup_error(SetupCode::bad_input, fmt::format("there is no channel {}", wanted.channel));
    if (viewer.subscriptions.size() == max_subscriptions)
        return setup_error(SetupCode::bad_input, "there are too many subscriptions");
    if (!viewer.subscriptions.emplace(wanted.id, wanted.channel).second)
        return setup_error(SetupCode::bad_input, "this id is in use");
    auto& subscribers = subscribers_[wanted.channel];
    if (std::ranges::find(subscribers, &viewer, &Subscriber::viewer) != subscribers.end()) {
        viewer.subscriptions.erase(wanted.id);
        return setup_error(SetupCode::bad_input, "this channel is subscribed already");
    }
    subscribers.push_back({&viewer, wanted.id});
    send_latest(wanted.channel, {&viewer, wanted.id}, now);
    return {};
}

std::optional<Viewers::Manner> Viewers::manner_of(std::uint32_t channel) const {
    if (const auto* const report = report_of(channel)) return Manner{report_class, *report != Report::traffic};
    const Channel* const found = channels_.find(channel);
    if (found == nullptr) return std::nullopt;
    return Manner{found->kind.block_class, found->kind.is_replaceable};
}

void Viewers::send_latest(std::uint32_t channel, Subscriber to, MonoTime now) {
    if (const auto* const report = report_of(channel)) {
        if (*report == Report::traffic) to.viewer->traffic = {};  // the next turn sends all rows
        const auto& latest = texts_[static_cast<std::size_t>(*report)];
        if (latest.text == nullptr) return;
        foxglove::encode(*latest.text, latest.time, message_);
    } else {
        if (channels_.find(channel)->latest() == nullptr) return;
        foxglove::encode(*channels_.find(channel), message_);
    }
    send(*manner_of(channel), to, now);
}

bool Viewers::unsubscribe(Viewer& viewer, std::uint32_t id) {
    const auto at = viewer.subscriptions.find(id);
    if (at == viewer.subscriptions.end()) return false;
    const auto of_channel = subscribers_.find(at->second);
    std::erase_if(of_channel->second, [&](const Subscriber& one) { return one.viewer == &viewer && one.id == id; });
    if (of_channel->second.empty()) subscribers_.erase(of_channel);
    viewer.subscriptions.erase(at);
    return true;
}

// At most three pieces: a client that has gone takes any number.
void Viewers::advertise(Viewer& viewer, MonoTime now) {
    for (int pieces = 0; pieces < 3; ++pieces) {
        if (viewer.advertised >= channels_.newest() || viewer.session->queued_bytes() >= max_waiting_bytes) return;
        send_text(viewer, foxglove::advertise(channels_, viewer.advertised, advertisement_bytes), now);
    }
}

void Viewers::send_more(http::Session& session, MonoTime now) {
    const auto at = all_.find(&session);
    if (at == all_.end()) return;
    advertise(*at->second, now);
    send_pages(*at->second, now);
    if (std::exchange(at->second->has_new, false)) session.flush();
}

// Subscriptions to such channels end.
void Viewers::unadvertise(Viewer& viewer, std::span<const std::uint32_t> channels, MonoTime now) {
    std::erase_if(viewer.subscriptions,
                  [&](const auto& one) { return std::ranges::binary_search(channels, one.second); });
    auto known = channels.first(
        static_cast<std::size_t>(std::ranges::upper_bound(channels, viewer.advertised) - channels.begin()));
    while (!known.empty()) {
        const auto some = known.first(std::min(known.size(), ids_at_once));
        send_text(viewer, foxglove::unadvertise(some), now);
        known = known.subspan(some.size());
    }
}

void Viewers::unadvertise(std::span<const std::uint32_t> channels, MonoTime now) {
    for (const auto channel : channels) subscribers_.erase(channel);
    for (const auto& [session, viewer] : all_) unadvertise(*viewer, channels, now);
}

void Viewers::advertise_to_all(MonoTime now) {
    for (const auto& [session, viewer] : all_) advertise(*viewer, now);
}

void Viewers::send(Manner manner, Subscriber to, MonoTime now) {
    foxglove::set_subscription(message_, to.id);
    const std::uint64_t key = manner.is_replaceable ? std::uint64_t{to.id} + 1 : 0;
    to.viewer->session->push(message_, manner.block_class, key, now);
    to.viewer->has_new = true;
}

void Viewers::publish(const Channel& channel, MonoTime now) {
    const auto at = subscribers_.find(channel.id);
    if (at == subscribers_.end()) return;
    foxglove::encode(channel, message_);
    for (const auto& subscriber : at->second)
        send({channel.kind.block_class, channel.kind.is_replaceable}, subscriber, now);
}

void Viewers::publish(Report report, std::shared_ptr<const std::string> text, ReportTime now) {
    note(report, std::move(text), now.wall);
    const auto at = subscribers_.find(channel_of(report));
    if (at == subscribers_.end()) return;
    foxglove::encode(*texts_[static_cast<std::size_t>(report)].text, now.wall, message_);
    for (const auto& subscriber : at->second) send(*manner_of(channel_of(report)), subscriber, now.mono);
}

void Viewers::publish_traffic(MonoTime now) {
    const auto at = subscribers_.find(channel_of(Report::traffic));
    if (at == subscribers_.end()) return;
    for (const auto& subscriber : at->second) {
        subscriber.viewer->traffic.begin_turn();
        send_pages(*subscriber.viewer, now);
    }
}

// A client that reads nothing gets no further pages, so they do not fill its queue.
void Viewers::send_pages(Viewer& viewer, MonoTime now) {
    const auto at = subscribers_.find(channel_of(Report::traffic));
    if (at == subscribers_.end()) return;
    const auto subscriber = std::ranges::find(at->second, &viewer, &Subscriber::viewer);
    if (subscriber == at->second.end()) return;
    while (viewer.session->queued_bytes() < max_waiting_bytes) {
        const auto text = viewer.traffic.next(traffic_);
        if (text == nullptr) return;
        foxglove::encode(*text, wall_now(), message_);
        send({report_class, false}, *subscriber, now);
    }
}

void Viewers::flush(MonoTime now) {
    for (const auto& [session, viewer] : all_) {
        if (!std::exchange(viewer->has_new, false)) continue;
        if (const auto drops = viewer->drops.news(*viewer->session, now))
            send_text(*viewer, foxglove::status(foxglove::Level::warning, drops_text(*drops), "drops"), now);
        viewer->has_new = false;
        viewer->session->flush();
    }
}

std::vector<observe::NamedCount> Viewers::refused() const {
    return {{"ws_bad_message", bad_messages_, "messages of viewers that are no request of the Foxglove protocol"},
            {"ws_unknown_op", unknown_ops_, "requests of viewers for an operation that the server does not have"},
            {"ws_refused_subscription", refused_subscriptions_, "subscriptions of viewers that could not be made"},
            {"ws_unknown_subscription", unknown_subscriptions_, "subscriptions that viewers ended, and did not have"}};
}

}  // namespace mavloom::web
