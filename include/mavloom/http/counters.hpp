// SPDX-License-Identifier: MIT
// What an HTTP server counts. Only the server's thread counts; any thread may read.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "mavloom/base/counter.hpp"

namespace mavloom::http {

// `Counters::help` has the meanings.
enum class Count : std::uint8_t {
    connections,
    turned_away,
    displaced,
    timed_out,
    requests,
    bad_request,
    header_size,
    body_size,
    wrong_host,
    wrong_origin,
    wrong_token,
    wrong_path,
    wrong_method,
    wrong_query,
    streams,
    bad_handshake,
    web_sockets,
    ws_silent,
    ws_protocol,
    ws_size,
    ws_fragments,
    ws_kind,
    ws_lost,
};

class Counters {
public:
    static constexpr std::size_t size = static_cast<std::size_t>(Count::ws_lost) + 1;

    // The server's thread only.
    void add(Count what) noexcept { all_[static_cast<std::size_t>(what)].add(); }
    [[nodiscard]] std::uint64_t value(Count what) const noexcept {
        return all_[static_cast<std::size_t>(what)].value();
    }
    [[nodiscard]] static std::string_view name(Count what) noexcept;
    // One sentence for people about the counter.
    [[nodiscard]] static std::string_view help(Count what) noexcept;

private:
    std::array<Counter, size> all_;
};

}  // namespace mavloom::http
