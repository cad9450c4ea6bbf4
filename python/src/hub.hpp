// SPDX-License-Identifier: MIT
// Hub: the one loop thread behind all links of the process, whatever their dialects.
// It receives, sends and reconnects without ever touching Python. It runs while a link is open. Other threads call the
// public members, which hand the work to the loop thread.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <unordered_map>
#include <vector>

#include "channel.hpp"
#include "mavloom/feed/sources.hpp"
#include "mavloom/wire/frame_writer.hpp"

namespace mavloom::python {

// Totals over all peers of one endpoint, including those that are gone.
struct LinkStats {
    link::LinkCounters links;
    link::EndpointCounters endpoint;
    feed::Totals ring;
    std::uint64_t missed = 0, not_kept = 0, no_peer = 0, peers = 0;
    std::uint64_t answers = 0, unheard_answers = 0;  // of programs that read a ring which this link fills
    Losses losses;
    std::map<MessageId, Channel::CrcErrors> crc_errors;
    std::vector<std::string> hints;
};

class Hub : private link::LinkHandler {
public:
    // Returns the hub that is running, or a new one.
    [[nodiscard]] static SetupResult<std::shared_ptr<Hub>> get();
    // Ends every loop thread and closes its channels. Called when the interpreter exits.
    static void stop_all();
    // Installs the fork handler, so that a forked child begins with nothing open. Call it before anything else.
    static void watch_forks();
    // The number of forks between the first process and this one. An object that was opened under a smaller number must
    // not be used.
    [[nodiscard]] static std::uint64_t forks() noexcept;

    ~Hub() override;

    struct Opened {
        link::EndpointId endpoint;
        std::uint16_t port = 0;
        std::string name;
        bool is_ring = false;
    };
    // Opens an endpoint. `channel` gets its frames, from the first one on. On return, everything that can be opened at
    // once is open. With `required=true`, waits up to 5 s for the far side and fails without it. A lossless ring is
    // held for `reader`.
    [[nodiscard]] SetupResult<Opened> open(const endpoint::Endpoint& endpoint, const std::shared_ptr<Channel>& channel,
                                           const Consumer& reader);
    // Returns the endpoint that carries frames to the router of a ring. Opened at the first call.
    [[nodiscard]] SetupResult<link::EndpointId> inlet(link::EndpointId ring);
    // Opens the way back of the ring `ring`, which this endpoint fills. Frames that programs send to the socket
    // RUN/`ring`.in go to every peer of the endpoint. Fails with `in_use` if that socket is already served. Closed with
    // the endpoint.
    [[nodiscard]] SetupResult<void> serve_inlet(link::EndpointId endpoint, const std::string& ring, unsigned mode);
    // Closes an endpoint and returns its last counters. Queued frames are sent first, for at most one second; other
    // links are served meanwhile.
    LinkStats close(link::EndpointId endpoint);
    [[nodiscard]] LinkStats stats(link::EndpointId endpoint);
    // Queues a frame for every peer of the endpoint. Waits while too many frames are queued.
    void send(link::EndpointId endpoint, const wire::FrameView& frame);

private:
    struct Outgoing {
        link::EndpointId endpoint;
        std::uint16_t size = 0;
        wire::FrameBuffer bytes;
    };
    static constexpr std::size_t most_outgoing = 4096;

    explicit Hub(feed::Sources sources);

    void on_frame(const link::RxFrame& rx) override;
    void on_link_up(LinkId link, link::EndpointId endpoint, std::string_view name) override;
    void on_link_down(LinkId link, link::EndpointId endpoint, std::string_view why) override;
    void on_bad_checksum(LinkId link, link::EndpointId endpoint, MessageId id) override;

    struct Served {
        std::shared_ptr<Channel> channel;
        bool is_ring = false, is_lossless = false;
        std::optional<link::EndpointId> inlet{};         // of a ring that is read: carries frames to its router
        std::optional<link::EndpointId> served_inlet{};  // of a ring that is filled: receives frames of its readers
        std::uint64_t unheard_answers = 0;
    };
    struct Wait {
        std::function<bool()> over;
        MonoTime limit;
        bool* ended;
    };

    void run();
    void turn(MonoTime deadline);
    void end_waits();
    [[nodiscard]] link::Links& links() noexcept { return sources_.links(); }
    [[nodiscard]] SetupResult<Opened> open_now(const endpoint::Endpoint& endpoint,
                                               const std::shared_ptr<Channel>& channel, const Consumer& reader);
    [[nodiscard]] bool is_up(link::EndpointId endpoint);
    // Returns nullopt if the far side was reached, else the error.
    [[nodiscard]] std::optional<SetupError> wait_for_far_side(const Opened& opened);
    void remove(link::EndpointId endpoint);
    [[nodiscard]] bool is_flushed(link::EndpointId endpoint);
    [[nodiscard]] link::EndpointId way_out(link::EndpointId endpoint);
    [[nodiscard]] SetupResult<link::EndpointId> open_way_out(link::EndpointId ring);
    [[nodiscard]] SetupResult<void> serve_now(link::EndpointId endpoint, const std::string& ring, unsigned mode);
    void pass_answer(const link::RxFrame& rx);
    void send_outgoing();
    void stop();
    [[nodiscard]] Served* served_by(link::EndpointId endpoint) noexcept;
    [[nodiscard]] std::uint64_t frames_in(link::EndpointId endpoint);
    [[nodiscard]] LinkStats stats_now(link::EndpointId endpoint);
    // Runs `work` on the loop thread and waits for it. Returns false if the loop thread has ended.
    bool on_loop(std::function<void()> work);
    // Waits until `over` returns true or `limit` has passed. The loop thread calls `over` after each turn.
    void wait_on_loop(std::function<bool()> over, Nanoseconds limit);

    // Used by the loop thread only. sources_ refers to dialects that the channels in served_ own, so served_ is
    // destroyed after it.
    std::unordered_map<link::EndpointId, Served> served_;
    std::unordered_map<link::EndpointId, link::EndpointId> filled_from_;  // the filled endpoint, by served inlet
    feed::Sources sources_;
    std::vector<Wait> waits_;

    std::mutex mutex_;
    std::condition_variable changed_;
    // Guarded by mutex_:
    std::vector<std::function<void()>> work_;
    std::vector<Outgoing> outgoing_;
    bool ended_ = false;

    std::atomic<bool> stopping_{false};
    std::mutex joining_;  // two threads may stop one hub
    std::thread thread_;
};

}  // namespace mavloom::python
