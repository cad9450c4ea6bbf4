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
    // Pieces (stage.hpp) that were dropped because queue_bytes were held already, or that were held when the link
    // ended: frames outward; datagrams, messages or reads inward.
    Counter held_dropped;
    // Pieces that met a fault (docs/guide/faults.md), in both directions together.
    Counter fault_blackout, fault_lost, fault_duplicated, fault_corrupted, fault_cut, fault_delayed, fault_stalled;
    Counter fault_reordered, fault_queue;
    void add(const LinkCounters& other) noexcept;
    // Applies a sequence tracker's update to `lost`, `late`, `duplicate`, `resync` and `untracked`.
    void add(const wire::SequenceTracker::Update& update) noexcept;
};

struct LinkCounter : CounterRow<LinkCounters> {
    bool on_page;  // also on the counter page of a ring (docs/formats/ring.md)
};
inline constexpr std::array<LinkCounter, 30> link_counters{{
    {{"frames_in", "good frames that arrived", &LinkCounters::frames_in}, true},
    {{"bytes_in", "bytes of the good frames that arrived", &LinkCounters::bytes_in}, true},
    {{"frames_out", "frames that were sent", &LinkCounters::frames_out}, true},
    {{"bytes_out", "bytes of the frames that were sent", &LinkCounters::bytes_out}, true},
    {{"lost", "frames that the link lost, by gaps in the sequence numbers; late and repeated ones do not count",
      &LinkCounters::lost},
     true},
    {{"late", "frames that arrived late, by the sequence numbers", &LinkCounters::late}, false},
    {{"repeated", "frames that arrived twice, by the sequence numbers", &LinkCounters::duplicate}, false},
    {{"resync", "restarts of the sequence numbers", &LinkCounters::resync}, false},
    {{"untracked", "frames whose loss is not computed, because there are too many senders", &LinkCounters::untracked},
     false},
    {{"crc_error", "frames with a wrong checksum", &LinkCounters::crc_error}, true},
    {{"junk_bytes", "bytes between frames", &LinkCounters::junk_bytes}, true},
    {{"unknown_flags", "frames with unknown incompatibility flags", &LinkCounters::unknown_flags}, false},
    {{"unknown_ids", "frames whose message is not defined; frames_in counts them too", &LinkCounters::unknown_ids},
     false},
    {{"implausible_unknown", "bytes that looked like a frame without definition, but were not accepted as one",
      &LinkCounters::implausible_unknown},
     false},
    {{"bad_signature", "frames that verify= dropped", &LinkCounters::bad_signature}, true},
    {{"queue_bytes", "frames dropped because the queue was full", &LinkCounters::queue_bytes}, true},
    {{"queue_age", "frames dropped because they were queued for too long", &LinkCounters::queue_age}, true},
    {{"frames_not_sent", "frames that the kernel did not send", &LinkCounters::frames_not_sent}, true},
    {{"refused", "frames sent to a closed UDP port", &LinkCounters::refused}, true},
    {{"unconfirmed", "frames not sent to a UDP peer that was heard only once", &LinkCounters::unconfirmed}, false},
    {{"held_dropped", "pieces that link faults had to hold, dropped for lack of room or at the end of the link",
      &LinkCounters::held_dropped},
     true},
    {{"fault_blackout", "pieces that faults dropped in black-outs", &LinkCounters::fault_blackout}, true},
    {{"fault_lost", "pieces that faults dropped at random", &LinkCounters::fault_lost}, true},
    {{"fault_duplicated", "pieces that faults passed twice", &LinkCounters::fault_duplicated}, true},
    {{"fault_corrupted", "pieces of which faults inverted a bit", &LinkCounters::fault_corrupted}, true},
    {{"fault_cut", "frames whose end faults cut off", &LinkCounters::fault_cut}, true},
    {{"fault_delayed", "pieces that faults delayed", &LinkCounters::fault_delayed}, true},
    {{"fault_stalled", "pieces that faults held until a stall ended", &LinkCounters::fault_stalled}, true},
    {{"fault_reordered", "pieces that faults held back, so that later ones overtake them",
      &LinkCounters::fault_reordered},
     true},
    {{"fault_queue", "pieces that faults dropped because the queue of rate: was full", &LinkCounters::fault_queue}, true},
}};
static_assert(sizeof(LinkCounters) == link_counters.size() * sizeof(Counter), "each counter needs a row");

// Counters of an endpoint as a whole rather than of one peer.
struct EndpointCounters {
    Counter kernel_drop;  // from SO_MEMINFO; updated by `refresh_counters()`
    Counter wrong_peer;   // udpout: datagrams from another address
    // Datagrams whose source can be no peer: port 0, a broadcast or multicast address, or one of the process's own.
    Counter bad_source;
    // Bytes of datagrams that came from unknown senders and held no valid frame (with verify=: no correctly signed
    // frame).
    Counter stray_bytes;
    Counter long_datagrams;  // that arrived, of more than 1472 bytes: Ethernet splits these (MTU 1500)
    // New peers turned away, for one of two reasons (docs/guide/queues.md). Either max_peers is reached and no peer may
    // be evicted, or too many new addresses send at once.
    Counter peers_refused;
    Counter peers_limited;    // new peers turned away when they tried again, because too many tried again
    Counter peers_evicted;    // peers that were heard once or were idle, evicted for new ones
    Counter peers_displaced;  // active peers that were evicted for new ones (docs/guide/queues.md)
    Counter http_refused;     // tcpin: HTTP and TLS clients, which were disconnected
    // wsin: handshakes of web pages that origin= does not list, other refused handshakes, and WebSockets that ended
    // because of a message that is no MAVLink: text, too long, in too many fragments, or against the protocol.
    Counter wrong_origin, bad_handshake, bad_message;
    // Datagrams that the kernel rejected, or for which ICMP reported a closed port.
    Counter send_errors;
    Counter reconnects;
    // Sums over links that no longer exist, plus bad signatures of senders that never became peers. Added to the
    // counters of the existing links, they give the endpoint's totals. A link's counters move here after its
    // on_link_down has returned.
    LinkCounters gone;
    Counter gone_queued;  // frames still queued when their link ended
};

// `gone` and `gone_queued` are shown separately.
inline constexpr std::array<CounterRow<EndpointCounters>, 15> endpoint_counters{{
    {"kernel_drop", "datagrams that the kernel dropped because the receive buffer was full",
     &EndpointCounters::kernel_drop},
    {"wrong_peer", "datagrams from an address other than the destination", &EndpointCounters::wrong_peer},
    {"bad_source", "datagrams whose source address cannot belong to a peer", &EndpointCounters::bad_source},
    {"stray_bytes", "bytes of datagrams from unknown addresses without a valid frame", &EndpointCounters::stray_bytes},
    {"long_datagrams", "datagrams of more than 1472 bytes, which Ethernet splits", &EndpointCounters::long_datagrams},
    {"peers_refused", "newcomers that were refused", &EndpointCounters::peers_refused},
    {"peers_limited", "newcomers that tried again while too many did", &EndpointCounters::peers_limited},
    {"peers_evicted", "silent peers that made room for a newcomer", &EndpointCounters::peers_evicted},
    {"peers_displaced", "active peers that made room for a newcomer", &EndpointCounters::peers_displaced},
    {"http_refused", "TCP clients that spoke HTTP or TLS", &EndpointCounters::http_refused},
    {"wrong_origin", "WebSockets of web pages that origin= does not list", &EndpointCounters::wrong_origin},
    {"bad_handshake", "connections without a good WebSocket handshake", &EndpointCounters::bad_handshake},
    {"bad_message", "WebSockets that ended because of a message that cannot be MAVLink", &EndpointCounters::bad_message},
    {"send_errors", "datagrams that met a closed port or that the kernel did not send", &EndpointCounters::send_errors},
    {"reconnects", "connections and devices that were opened again", &EndpointCounters::reconnects},
}};
static_assert(sizeof(EndpointCounters) == (endpoint_counters.size() + 1) * sizeof(Counter) + sizeof(LinkCounters),
              "each counter needs a row");

}  // namespace mavloom::link
