// SPDX-License-Identifier: MIT
// Sums over all links, endpoints and recordings of a command, those that are gone included: what came in, and every loss by its name
// (DESIGN.md rule 3). A plain value; whoever fills it owns it.
#pragma once

#include <cstdint>

#include "mavloom/link/links.hpp"
#include "mavloom/record/tlog_reader.hpp"
#include "mavloom/ring/source.hpp"

namespace mavloom::feed {

struct Totals {
    std::uint64_t frames = 0, bytes = 0;
    std::uint64_t buffer_full = 0;  // our own: the consumer was slower than `--buffer` allows
    std::uint64_t kernel_drop = 0;  // datagrams that the kernel had no room for
    std::uint64_t crc_error = 0, junk_bytes = 0, unknown_flags = 0, bad_signature = 0;
    std::uint64_t wrong_peer = 0, stray_bytes = 0, peers_refused = 0;
    std::uint64_t lost = 0;            // on the links themselves: sequence gaps
    std::uint64_t damaged_places = 0;  // in recordings
    std::uint64_t lapped = 0;          // records that a ring's writer overwrote before they were read
    std::uint64_t bad_records = 0;     // records of a ring that held no whole valid frame
    std::uint64_t other_kinds = 0;     // records of a ring that are no MAVLink by their kind
    std::uint64_t copies = 0;          // records of a ring left out because its router marked them as a copy or an echo
    std::uint64_t echo = 0;            // records of a ring that hold what was sent to its inlet from here

    // Of a link that is there, of an endpoint with its links that are gone, of a recording: once each, at the end.
    void add(const link::LinkCounters& counters) noexcept;
    void add(const link::EndpointCounters& counters) noexcept;
    void add(const record::ReadCounters& counters) noexcept;
    void add(const ring::RingSource& ring) noexcept;
};

}  // namespace mavloom::feed
