// SPDX-License-Identifier: MIT
// The counters of links and endpoints, and the names under which they are shown. One thread writes; any thread may read
// values.
#pragma once

#include <array>
#include <string_view>

#include "mavloom/base/counter.hpp"
#include "mavloom/wire/sequence.hpp"

namespace mavloom::link {

// Traffic of one link. Every discarded frame or byte has a counter.
struct LinkCounters {
    Counter frames_in, bytes_in, frames_out, bytes_out;
    Counter crc_error, junk_bytes, unknown_flags, implausible_unknown, unknown_ids;
    // With verify=: frames that are unsigned or whose signature is invalid.
    Counter bad_signature;
    Counter queue_bytes, queue_age;  // whole frames dropped from the send queue
    // Loss on the link itself, from the sequence numbers received. Reports of a router show `duplicate` as `repeated`,
    // because there `duplicate` is a verdict of the engine.
    Counter lost, late, duplicate, resync;
    // Frames whose loss is not computed, because the tracker has no room for a further sender.
    Counter untracked;
    Counter frames_not_sent;  // in datagrams that the kernel rejected
    // Frames sent to a closed port. These are frames that an ICMP refusal answered, and frames sent within one second
    // of a refusal while the peer is silent.
    Counter refused;
    // Frames not sent to a UDP peer that was heard only once: its address may be forged (docs/design/security.md).
    Counter unconfirmed;
    void add(const LinkCounters& other) noexcept;
    // Applies a sequence tracker's update to `lost`, `late`, `duplicate`, `resync` and `untracked`.
    void add(const wire::SequenceTracker::Update& update) noexcept;
};

// One counter of a link, with its name in `ctl`, `stat`, the metrics and docs/guide/route.md.
struct LinkCounter {
    std::string_view name;
    Counter LinkCounters::*word;
    bool on_page;  // also on the counter page of a ring (docs/formats/ring.md)
};
inline constexpr std::array<LinkCounter, 20> link_counters{{
    {"frames_in", &LinkCounters::frames_in, true},
    {"bytes_in", &LinkCounters::bytes_in, true},
    {"frames_out", &LinkCounters::frames_out, true},
    {"bytes_out", &LinkCounters::bytes_out, true},
    {"lost", &LinkCounters::lost, true},
    {"late", &LinkCounters::late, false},
    {"repeated", &LinkCounters::duplicate, false},
    {"resync", &LinkCounters::resync, false},
    {"untracked", &LinkCounters::untracked, false},
    {"crc_error", &LinkCounters::crc_error, true},
    {"junk_bytes", &LinkCounters::junk_bytes, true},
    {"unknown_flags", &LinkCounters::unknown_flags, false},
    {"unknown_ids", &LinkCounters::unknown_ids, false},
    {"implausible_unknown", &LinkCounters::implausible_unknown, false},
    {"bad_signature", &LinkCounters::bad_signature, true},
    {"queue_bytes", &LinkCounters::queue_bytes, true},
    {"queue_age", &LinkCounters::queue_age, true},
    {"frames_not_sent", &LinkCounters::frames_not_sent, true},
    {"refused", &LinkCounters::refused, true},
    {"unconfirmed", &LinkCounters::unconfirmed, false},
}};
static_assert(sizeof(LinkCounters) == link_counters.size() * sizeof(Counter), "each counter needs a row");

// Counters of an endpoint as a whole rather than of one peer.
struct EndpointCounters {
    Counter kernel_drop;  // from SO_MEMINFO; updated by `refresh_kernel_drops()`
    Counter wrong_peer;   // udpout: datagrams from another address
    // Datagrams whose source can be no peer: port 0, a broadcast or multicast address, or one of the process's own.
    Counter bad_source;
    // Bytes of datagrams that came from unknown senders and held no valid frame (with verify=: no correctly signed
    // frame).
    Counter stray_bytes;
    // New peers turned away, for one of two reasons (docs/guide/queues.md). Either max_peers is reached and no peer may
    // be evicted, or too many new addresses send at once.
    Counter peers_refused;
    Counter peers_limited;    // new peers turned away when they tried again, because too many tried again
    Counter peers_evicted;    // peers that were heard once or were idle, evicted for new ones
    Counter peers_displaced;  // active peers that were evicted for new ones (docs/guide/queues.md)
    Counter http_refused;     // tcpin: HTTP and TLS clients, which were disconnected
    // Datagrams that the kernel rejected, or for which ICMP reported a closed port.
    Counter send_errors;
    Counter reconnects;
    // Sums over links that no longer exist, plus bad signatures of senders that never became peers. Added to the
    // counters of the existing links, they give the endpoint's totals. A link's counters move here after its
    // on_link_down has returned.
    LinkCounters gone;
    Counter gone_queued;  // frames still queued when their link ended
};

// One counter of an endpoint, with its name. `gone` and `gone_queued` are shown separately.
struct EndpointCounter {
    std::string_view name;
    Counter EndpointCounters::*word;
};
inline constexpr std::array<EndpointCounter, 11> endpoint_counters{{
    {"kernel_drop", &EndpointCounters::kernel_drop},
    {"wrong_peer", &EndpointCounters::wrong_peer},
    {"bad_source", &EndpointCounters::bad_source},
    {"stray_bytes", &EndpointCounters::stray_bytes},
    {"peers_refused", &EndpointCounters::peers_refused},
    {"peers_limited", &EndpointCounters::peers_limited},
    {"peers_evicted", &EndpointCounters::peers_evicted},
    {"peers_displaced", &EndpointCounters::peers_displaced},
    {"http_refused", &EndpointCounters::http_refused},
    {"send_errors", &EndpointCounters::send_errors},
    {"reconnects", &EndpointCounters::reconnects},
}};
static_assert(sizeof(EndpointCounters) == (endpoint_counters.size() + 1) * sizeof(Counter) + sizeof(LinkCounters),
              "each counter needs a row");

}  // namespace mavloom::link
