// SPDX-License-Identifier: MIT
// Recognises an HTTP or TLS client by the first bytes of a TCP client. A web page may make the browser send any bytes
// to any port of this machine, but only behind a request line or, for https, inside TLS. So no page can send MAVLink if
// such clients are disconnected.
// Private to module link.
//
// The methods are those of RFC 9110 and 5789, and PRI, which opens HTTP/2 (RFC 9113). They are upper case; a browser
// asks by OPTIONS before it sends any other method for a page of another origin. TLS opens with a handshake record of
// major version 3 (RFC 8446). No MAVLink frame starts with a letter or with 0x16.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "mavloom/base/bytes.hpp"

namespace mavloom::link::detail {

class HttpOpening {
public:
    enum class Verdict : std::uint8_t { undecided, http, other };

    // Takes the next bytes of the stream. Do not call it again after another verdict than `undecided`.
    [[nodiscard]] Verdict note(ByteView bytes) noexcept {
        for (const std::uint8_t byte : bytes) {
            assert(count_ < seen_.size() && "the last byte gave a verdict");
            seen_[count_++] = static_cast<char>(byte);
            if (const Verdict verdict = judge({seen_.data(), count_}); verdict != Verdict::undecided) return verdict;
        }
        return Verdict::undecided;
    }

private:
    static constexpr std::array<std::string_view, 11> openings{
        "GET ", "POST ", "PUT ", "HEAD ", "OPTIONS ", "PATCH ", "DELETE ", "CONNECT ", "TRACE ", "PRI ", "\x16\x03"};

    [[nodiscard]] static Verdict judge(std::string_view seen) noexcept {
        const auto match = std::ranges::find_if(openings, [&](auto opening) { return opening.starts_with(seen); });
        if (match == openings.end()) return Verdict::other;
        return match->size() == seen.size() ? Verdict::http : Verdict::undecided;
    }

    std::array<char, std::string_view("OPTIONS ").size()> seen_{};
    std::size_t count_ = 0;
};

}  // namespace mavloom::link::detail
