// SPDX-License-Identifier: MIT
// The clients that speak the Foxglove protocol: which channels each knows, and which it subscribes to. Private to
// module web; the caller serializes all calls.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "mavloom/base/result.hpp"
#include "mavloom/http/session.hpp"
#include "mavloom/observe/hop.hpp"
#include "web/channels.hpp"
#include "web/clients/drops.hpp"
#include "web/clients/foxglove.hpp"
#include "web/report/pages.hpp"
#include "web/report/reports.hpp"

namespace mavloom::web {

[[nodiscard]] http::SessionOptions viewer_options();

class Viewers {
public:
    Viewers(const Channels& channels, Pages& traffic) : channels_(channels), traffic_(traffic) {}

    void add(const std::shared_ptr<http::Session>& session, MonoTime now);
    void remove(const http::Session& session);
    // The client sent a request, or something else. It gets a status for each part that cannot be done.
    void take(const http::Session& session, const SetupResult<foxglove::Request>& request, MonoTime now);
    // The client has read something, so that there may be room for more advertisements and pages.
    void send_more(http::Session& session, MonoTime now);
    // A channel was added.
    void advertise_to_all(MonoTime now);
    // Channels were forgotten. Their ids, in their order.
    void unadvertise(std::span<const std::uint32_t> channels, MonoTime now);
    // The channel has a new latest frame.
    void publish(const Channel& channel, MonoTime now);
    // Whether a client subscribes to the report.
    [[nodiscard]] bool wants(Report report) const { return subscribers_.contains(channel_of(report)); }
    // Keeps the text of a report for new subscribers. Not for Report::traffic, here and in `publish`.
    void note(Report report, std::shared_ptr<const std::string> text, WallTime time) {
        texts_[static_cast<std::size_t>(report)] = {std::move(text), time};
    }
    // The same, and sends it.
    void publish(Report report, std::shared_ptr<const std::string> text, ReportTime now);
    // The pages of Report::traffic may have new texts. Begins to send them, as fast as each client reads.
    void publish_traffic(MonoTime now);
    // Lets the writers send what was queued.
    void flush(MonoTime now);
    // The requests that could not be done.
    [[nodiscard]] std::vector<observe::NamedCount> refused() const;

private:
    struct Viewer {
        std::shared_ptr<http::Session> session;
        std::unordered_map<std::uint32_t, std::uint32_t> subscriptions{};  // the channel of each
        std::uint32_t advertised = 0;                                      // the channels up to this id
        PageReader traffic{};
        Drops drops{};
        bool has_new = false;
    };
    struct Subscriber {
        Viewer* viewer;
        std::uint32_t id;  // of the subscription
    };
    struct Manner {  // of queueing messages of a channel
        std::uint8_t block_class;
        bool is_replaceable;  // by a newer message of the channel
    };

    void advertise(Viewer& viewer, MonoTime now);
    void subscribe(Viewer& viewer, const std::vector<foxglove::Subscription>& all, MonoTime now);
    [[nodiscard]] SetupResult<void> subscribe(Viewer& viewer, foxglove::Subscription wanted, MonoTime now);
    void unsubscribe(Viewer& viewer, const std::vector<std::uint32_t>& ids, MonoTime now);
    // Returns whether there was such a subscription.
    bool unsubscribe(Viewer& viewer, std::uint32_t id);
    static void send_status(Viewer& viewer, foxglove::Level level, std::string_view text, MonoTime now);
    void unadvertise(Viewer& viewer, std::span<const std::uint32_t> channels, MonoTime now);
    void send(Manner manner, Subscriber to, MonoTime now);
    static void send_text(Viewer& viewer, std::string_view text, MonoTime now);

    struct Text {
        std::shared_ptr<const std::string> text{};
        WallTime time{};
    };

    [[nodiscard]] std::optional<Manner> manner_of(std::uint32_t channel) const;
    void send_latest(std::uint32_t channel, Subscriber to, MonoTime now);
    void send_pages(Viewer& viewer, MonoTime now);

    const Channels& channels_;
    Pages& traffic_;
    std::array<Text, reports.size()> texts_{};  // by Report
    std::unordered_map<const http::Session*, std::unique_ptr<Viewer>> all_;
    std::unordered_map<std::uint32_t, std::vector<Subscriber>> subscribers_;  // by channel
    std::vector<std::uint8_t> message_;                                       // scratch memory
    std::uint64_t bad_messages_ = 0, unknown_ops_ = 0, refused_subscriptions_ = 0, unknown_subscriptions_ = 0;
};

}  // namespace mavloom::web
