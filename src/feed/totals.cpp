// SPDX-License-Identifier: MIT
#include "mavloom/feed/totals.hpp"

namespace mavloom::feed {

void Totals::add(const link::LinkCounters& counters) noexcept {
    crc_error += counters.crc_error.value();
    junk_bytes += counters.junk_bytes.value();
    unknown_flags += counters.unknown_flags.value();
    bad_signature += counters.bad_signature.value();
    lost += counters.lost.value();
}

void Totals::add(const link::EndpointCounters& counters) noexcept {
    kernel_drop += counters.kernel_drop.value();
    wrong_peer += counters.wrong_peer.value();
    bad_source += counters.bad_source.value();
    stray_bytes += counters.stray_bytes.value();
    peers_refused += counters.peers_refused.value() + counters.peers_limited.value();
    http_refused += counters.http_refused.value();
    wrong_origin += counters.wrong_origin.value();
    bad_handshake += counters.bad_handshake.value();
    bad_message += counters.bad_message.value();
    add(counters.gone);
}

void Totals::add(const record::ReadCounters& counters) noexcept {
    junk_bytes += counters.lost_bytes.value();
    damaged_places += counters.damaged_places.value();
    unknown_flags += counters.unknown_flags.value();
}

void Totals::add(const ring::RingSource& ring) noexcept {
    add(ring.counters());
    const auto losses = ring.losses();
    lapped += losses.lapped;
    bad_records += losses.bad_records;
    other_kinds += losses.other_kinds;
    copies += losses.copies;
    echo += losses.echo;
}

}  // namespace mavloom::feed
