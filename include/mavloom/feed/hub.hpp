// SPDX-License-Identifier: MIT
// Hub: one loop thread that serves all open endpoints of the process, whatever their dialects. The loop thread writes
// received frames into channels, sends queued frames and reconnects. The hub runs as long as a shared pointer to it
// exists. Any thread may call it. Calls wait for the loop thread, which never waits for a caller. A forked child must
// neither use nor destroy the parent's hub (fork.hpp); there, `get` creates a new one.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <type_traits>

#include "mavloom/feed/channel.hpp"
#include "mavloom/feed/sources.hpp"

namespace mavloom::feed {

class HubLinks;
class LoopCalls;
class Outbox;

// Counters of one endpoint: totals over all its peers, including those that are gone.
struct EndpointStats {
    link::LinkCounters links;
    link::EndpointCounters endpoint;
    Totals ring;
    std::uint64_t peers = 0;
    // Frames from readers of the ring that this endpoint fills, and those of them that reached no peer.
    std::uint64_t answers = 0, unheard_answers = 0;
    Losses losses;
    std::map<MessageId, Channel::CrcErrors> crc_errors;
    std::string failure;  // why the endpoint is not connected; empty if it is, or if nothing has failed yet
};

class Hub {
public:
    // Returns the hub that is running, or a new one.
    [[nodiscard]] static SetupResult<std::shared_ptr<Hub>> get();
    // Ends the loop threads of all hubs, also of those that were replaced by a new one, and closes their channels.
    // Later calls on a stopped hub fail or do nothing.
    static void stop_all();

    Hub(const Hub&) = delete;
    Hub& operator=(const Hub&) = delete;
    ~Hub();

    struct Opened {
        link::EndpointId endpoint;
        std::uint16_t port = 0;
        std::string name;
        bool is_ring = false;
    };
    // Opens an endpoint. `channel` receives its frames, from the first one on. On return, everything that can be opened
    // without waiting is open. With `required=true`, waits up to 5 s for the far side and fails if it is absent. A
    // lossless ring pauses while `reader` has no room (Channel::hold_for).
    [[nodiscard]] SetupResult<Opened> open(const endpoint::Endpoint& endpoint, const std::shared_ptr<Channel>& channel,
                                           const ChannelReader& reader);

    // The calls below take the id of an endpoint that is open.

    // Returns the endpoint that carries frames back to the router of a ring, and opens it at the first call.
    [[nodiscard]] SetupResult<link::EndpointId> inlet(link::EndpointId ring);
    // Opens the inlet of the ring `ring`, which this endpoint fills. Frames that programs send to the socket
    // RUN/`ring`.in then go to every peer of the endpoint. Fails with `in_use` if that socket is already served. The
    // inlet closes with the endpoint. `mode` sets the permissions of the socket.
    [[nodiscard]] SetupResult<void> serve_inlet(link::EndpointId endpoint, const std::string& ring, unsigned mode);
    // Closes an endpoint and returns its last counters. Queued frames are sent first, for at most one second; other
    // endpoints are served meanwhile.
    EndpointStats close(link::EndpointId endpoint);
    [[nodiscard]] EndpointStats stats(link::EndpointId endpoint);
    // Why no frame was heard on the endpoint, and what to check.
    [[nodiscard]] std::string silence_reason(link::EndpointId endpoint);
    // Queues a copy of the frame for every peer of the endpoint. Waits while too many frames are queued. Returns false
    // if the loop thread has ended.
    bool send(link::EndpointId endpoint, const wire::FrameView& frame);
    // Bytes that were sent to the endpoint and not yet handed to the kernel.
    [[nodiscard]] std::size_t queued_bytes(link::EndpointId endpoint);

private:
    explicit Hub(Sources sources);

    void run();
    void send_queued();
    void stop();
    // Runs `work`, which returns a SetupResult, on the loop thread. Fails if that thread has ended.
    template <class Work>
    [[nodiscard]] std::invoke_result_t<Work> on_loop(Work work);
    [[nodiscard]] SetupResult<void> wait_for_far_side(const Opened& opened);

    const std::unique_ptr<HubLinks> links_;  // used by the loop thread only, except for `wake`
    const std::unique_ptr<LoopCalls> calls_;
    const std::unique_ptr<Outbox> outbox_;
    std::atomic<bool> stopping_{false};
    std::mutex joining_;  // two threads may stop one hub
    std::thread thread_;
};

}  // namespace mavloom::feed
