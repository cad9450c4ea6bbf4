// SPDX-License-Identifier: MIT
// Totals of a command over all its links, endpoints, rings and recordings, including links that are gone. They count
// the frames received and every kind of loss. A plain value without synchronization.
#pragma once

#include <cstdint>

#include "mavloom/link/links.hpp"
#include "mavloom/record/tlog_reader.hpp"
#include "mavloom/ring/source.hpp"

namespace mavloom::feed {

struct Totals {
    std::uint64_t frames = 0, bytes = 0;
    std::uint64_t buffer_full = 0;  // frames dropped because the consumer was slower than `--buffer` allows
    std::uint64_t kernel_drop = 0;  // datagrams dropped by the kernel for lack of buffer space
    std::uint64_t crc_error = 0, junk_bytes = 0, unknown_flags = 0, bad_signature = 0;
    std::uint64_t wrong_peer = 0, bad_source = 0, stray_bytes = 0, peers_refused = 0, http_refused = 0;
    std::uint64_t wrong_origin = 0, bad_handshake = 0, bad_message = 0;
    std::uint64_t lost = 0;            // frames lost on the links, from sequence gaps
    std::uint64_t damaged_places = 0;  // runs of damaged bytes in recordings
    std::uint64_t lapped = 0;          // ring records overwritten before they were read
    std::uint64_t bad_records = 0;     // ring records without one whole valid frame
    std::uint64_t other_kinds = 0;     // ring records whose kind is not MAVLink
    std::uint64_t copies = 0;          // ring records left out because the ring's router marked them as a copy or echo
    std::uint64_t echo = 0;            // ring records of frames that this program itself sent to the inlet

    // Adds the counters of a current link, of an endpoint (which include its closed links), of a recording or of a
    // ring. Call it once for each of them, at the end.
    void add(const link::LinkCounters& counters) noexcept;
    void add(const link::EndpointCounters& counters) noexcept;
    void add(const record::ReadCounters& counters) noexcept;
    void add(const ring::RingSource& ring) noexcept;
};

}  // namespace mavloom::feed
