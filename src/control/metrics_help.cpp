// SPDX-License-Identifier: MIT
#include "control/metrics_help.hpp"

#include <algorithm>
#include <array>

namespace mavloom::control {

namespace {

struct Help {
    std::string_view counter, text;
};

// docs/guide/route.md has the long forms.
constexpr std::array helps{
    Help{"frames_in", "good frames that arrived"},
    Help{"bytes_in", "bytes of the good frames that arrived"},
    Help{"frames_out", "frames that were sent"},
    Help{"bytes_out", "bytes of the frames that were sent"},
    Help{"frames", "frames of this kind, from this sender or in this file"},
    Help{"bytes", "bytes of the frames"},
    Help{"lost", "frames that the link lost, by gaps in the sequence numbers"},
    Help{"late", "frames that arrived late, by the sequence numbers"},
    Help{"repeated", "frames that arrived twice, by the sequence numbers"},
    Help{"resync", "restarts of the sequence numbers"},
    Help{"untracked", "frames whose loss is not computed, because there are too many senders"},
    Help{"crc_error", "frames with a wrong checksum"},
    Help{"junk_bytes", "bytes between frames"},
    Help{"unknown_flags", "frames with unknown incompatibility flags"},
    Help{"unknown_ids", "forwarded frames whose message is not defined"},
    Help{"implausible_unknown", "bytes that looked like a frame without definition, but were not accepted as one"},
    Help{"bad_signature", "frames that verify= dropped"},
    Help{"queue_bytes", "frames dropped because the queue was full"},
    Help{"queue_age", "frames dropped because they were queued for too long"},
    Help{"frames_not_sent", "frames that the kernel did not send"},
    Help{"refused", "frames sent to a closed UDP port"},
    Help{"unconfirmed", "frames not sent to a UDP peer that was heard only once"},
    Help{"queued", "frames that were still queued when their links ended"},
    Help{"forwarded", "frames that were sent to at least one other link"},
    Help{"nowhere", "frames that no other link was to get"},
    Help{"filtered", "frames that in_ filters dropped"},
    Help{"rate_limited", "frames over a rate limit"},
    Help{"duplicate", "frames that had arrived before"},
    Help{"echo", "frames that came back on a link they were sent to"},
    Help{"unknown_target", "frames for a target that was not heard on any link"},
    Help{"consumed", "frames that were for the program itself"},
    Help{"tap", "frames that a tap sent"},
    Help{"private_link", "frames that a private link sent"},
    Help{"out_filtered", "frames that out_ filters kept from this link"},
    Help{"out_rate_limited", "frames that max_rate kept from this link"},
    Help{"out_bytes_limited", "frames that max_bytes kept from this link"},
    Help{"kernel_drop", "datagrams that the kernel dropped because the receive buffer was full"},
    Help{"rcvbuf", "size of the kernel's receive buffer in bytes"},
    Help{"wrong_peer", "datagrams from an address other than the destination"},
    Help{"bad_source", "datagrams whose source address cannot belong to a peer"},
    Help{"stray_bytes", "bytes of datagrams from unknown addresses without a valid frame"},
    Help{"peers_refused", "newcomers that were refused"},
    Help{"peers_limited", "newcomers that tried again while too many did"},
    Help{"peers_evicted", "silent peers that made room for a newcomer"},
    Help{"peers_displaced", "active peers that made room for a newcomer"},
    Help{"send_errors", "datagrams that met a closed port or that the kernel did not send"},
    Help{"reconnects", "connections and devices that were opened again"},
    Help{"http_refused", "TCP clients that spoke HTTP or TLS"},
    Help{"heartbeats_sent", "own heartbeats"},
    Help{"not_signed", "frames that sign= sent unchanged, because they were not verified on arrival"},
    Help{"unknown_link", "frames that arrived on links beyond the limit"},
    Help{"unlisted", "frames that no series of messages counts"},
    Help{"routes_learned", "routes that are new, or new again"},
    Help{"routes_expired", "routes that were silent for route_timeout"},
    Help{"routes_evicted", "routes that were evicted because a table was full"},
    Help{"recent_evicted", "remembered frames that were evicted early"},
    Help{"reboots", "systems whose clock went back"},
    Help{"duplicate_ids", "sources heard alternately on links that do not share a group"},
    Help{"route_conflicts", "vehicles that were learned on a link while they were alive on another"},
    Help{"queue_full", "frames that a recording lacks, because its buffer was full"},
    Help{"write_error", "frames that a recording lacks, because the disk refused them"},
};

}  // namespace

std::string_view help_of(std::string_view counter) noexcept {
    const auto* const found = std::ranges::find(helps, counter, &Help::counter);
    return found == helps.end() ? counter : found->text;
}

}  // namespace mavloom::control
