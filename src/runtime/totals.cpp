// SPDX-License-Identifier: MIT
#include "mavloom/runtime/totals.hpp"

namespace mavloom::runtime {

void Totals::add(const LinkCounters& counters) noexcept {
    crc_error += counters.crc_error.value();
    junk_bytes += counters.junk_bytes.value();
    unknown_flags += counters.unknown_flags.value();
    bad_signature += counters.bad_signature.value();
    lost += counters.lost.value();
}

void Totals::add(const EndpointCounters& counters) noexcept {
    kernel_drop += counters.kernel_drop.value();
    wrong_peer += counters.wrong_peer.value();
    stray_bytes += counters.stray_bytes.value();
    peers_refused += counters.peers_refused.value();
    add(counters.gone);
}

void Totals::add(const record::ReadCounters& counters) noexcept {
    junk_bytes += counters.lost_bytes.value();
    damaged_places += counters.damaged_places.value();
    unknown_flags += counters.unknown_flags.value();
}

}  // namespace mavloom::runtime
