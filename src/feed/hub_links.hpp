// SPDX-License-Identifier: MIT
// HubLinks: the endpoints of a hub, and the channel that each of them fills. Loop thread only, except for `wake`.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

#include "mavloom/feed/hub.hpp"

namespace mavloom::feed {

class HubLinks : private link::LinkHandler {
public:
    explicit HubLinks(Sources sources);

    // Any thread: ends the sleep of `turn`.
    void wake() noexcept { sources_.wake(); }
    // Receives and sends; sleeps until the deadline if there is nothing to do.
    void turn(MonoTime deadline);
    void send(link::EndpointId to, const wire::FrameView& frame) { links().send(to, frame); }
    // Closes all channels, so that readers get no more frames. Called when the loop ends.
    void close_channels();

    // See Hub, which calls these on the loop thread.
    [[nodiscard]] SetupResult<Hub::Opened> open(const endpoint::Endpoint& endpoint,
                                                const std::shared_ptr<Channel>& channel, const ChannelReader& reader);
    void remove(link::EndpointId endpoint);
    [[nodiscard]] SetupResult<link::EndpointId> inlet(link::EndpointId ring);
    [[nodiscard]] SetupResult<void> serve_inlet(link::EndpointId endpoint, const std::string& ring, unsigned mode);
    [[nodiscard]] EndpointStats stats(link::EndpointId endpoint);
    [[nodiscard]] std::string silence_reason(link::EndpointId endpoint);
    [[nodiscard]] std::size_t queued_bytes(link::EndpointId endpoint) { return links().queued_bytes(endpoint); }

    // Returns success if the far side was reached, and the error if it was not. Returns nullopt while the outcome is
    // unknown.
    [[nodiscard]] std::optional<SetupResult<void>> far_side(const Hub::Opened& opened);
    // True if all frames were sent, or if there is no peer to receive them.
    [[nodiscard]] bool is_flushed(link::EndpointId endpoint);

private:
    struct OpenLink {
        std::shared_ptr<Channel> channel;
        bool is_ring = false, is_lossless = false;
        // For a ring that is read: the endpoint that carries frames to its router.
        std::optional<link::EndpointId> inlet{};
        // For a ring that this endpoint fills: receives frames from the ring's readers.
        std::optional<link::EndpointId> served_inlet{};
        std::uint64_t unheard_answers = 0;
    };

    void on_frame(const link::RxFrame& rx) override;
    void on_link_up(LinkId link, link::EndpointId endpoint, std::string_view name) override;
    void on_link_down(LinkId link, link::EndpointId endpoint, std::string_view why) override;
    void on_bad_checksum(LinkId link, link::EndpointId endpoint, MessageId id) override;

    void maintain_recorders();
    [[nodiscard]] link::Links& links() noexcept { return sources_.links(); }
    // Null for an endpoint without a channel, such as a served inlet.
    [[nodiscard]] OpenLink* find(link::EndpointId endpoint) noexcept;
    [[nodiscard]] bool is_up(link::EndpointId endpoint) const;
    [[nodiscard]] SetupResult<link::EndpointId> open_inlet_of(link::EndpointId ring);
    [[nodiscard]] link::EndpointId sends_through(link::EndpointId endpoint);
    void pass_answer(const link::RxFrame& rx);
    void add_live_counters(link::EndpointId endpoint, EndpointStats& stats);
    [[nodiscard]] std::uint64_t frames_in(link::EndpointId endpoint);

    // sources_ refers to dialects that the channels in open_ own, so open_ is destroyed after it.
    std::unordered_map<link::EndpointId, OpenLink> open_;
    // Maps each served inlet to the endpoint that fills its ring.
    std::unordered_map<link::EndpointId, link::EndpointId> filled_from_;
    Sources sources_;
    MonoTime maintain_due_{};  // when to look after the recorders
};

}  // namespace mavloom::feed
