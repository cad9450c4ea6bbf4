// SPDX-License-Identifier: MIT
// What the tests of Destinations and Relay share: recordings byte by byte (docs/formats/tlog.md), and what a plain
// socket receives.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "mavloom/dialect/dialect.hpp"
#include "mavloom/feed/destinations.hpp"
#include "support/temp_dir.hpp"
#include "unit/link/fixture.hpp"

namespace mavloom::feed::testing {

using link::testing::Bytes;
using link::testing::PlainSocket;

inline WallTime at_ms(std::int64_t ms) { return WallTime{std::chrono::milliseconds{ms}}; }

// A record: the Unix time in microseconds, eight bytes, big-endian; then the frame.
inline Bytes record(WallTime time, const Bytes& frame) {
    using std::chrono::duration_cast, std::chrono::microseconds;
    const auto us = static_cast<std::uint64_t>(duration_cast<microseconds>(time.time_since_epoch()).count());
    Bytes bytes;
    for (int shift = 56; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::uint8_t>(us >> shift));
    bytes.insert(bytes.end(), frame.begin(), frame.end());
    return bytes;
}

inline void append(Bytes& all, const Bytes& more) { all.insert(all.end(), more.begin(), more.end()); }

// The frames of a recording of unsigned MAVLink 2 frames, one after another.
inline Bytes frames_of(const std::filesystem::path& tlog) {
    const Bytes all = test::content_of(tlog);
    Bytes frames;
    for (std::size_t at = 0; at + 10 < all.size();) {
        const std::size_t begin = at + 8, length = 12u + all[begin + 1];
        frames.insert(frames.end(), all.begin() + static_cast<std::ptrdiff_t>(begin),
                      all.begin() + static_cast<std::ptrdiff_t>(begin + length));
        at = begin + length;
    }
    return frames;
}

// Appends all that has arrived at the socket.
inline void read_into(Bytes& all, const PlainSocket& socket) {
    for (Bytes more = socket.read(); !more.empty(); more = socket.read()) append(all, more);
}

inline std::string udpout(const PlainSocket& to) { return "udpout://127.0.0.1:" + std::to_string(to.port()); }

inline std::vector<endpoint::Endpoint> endpoints_of(const std::vector<std::string>& urls) {
    std::vector<endpoint::Endpoint> all;
    for (const auto& url : urls) all.push_back(link::testing::endpoint_of(url));
    return all;
}

inline Destinations open(const std::vector<std::string>& urls, link::Links& links) {
    auto all = Destinations::open(endpoints_of(urls), links);
    if (!all) throw std::runtime_error(all.error().text);
    return std::move(*all);
}

// The port of the endpoint that was opened last.
inline std::uint16_t last_port(const link::Links& links) { return links.endpoints().back().local_port; }

}  // namespace mavloom::feed::testing
