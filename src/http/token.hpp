// SPDX-License-Identifier: MIT
// The token that requests must have, if `Access` has one. Private to module http.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace mavloom::http {

// The parts of a request in which a token may stand.
struct TokenPlaces {
    std::string_view authorization;  // the header: "Bearer TOKEN" (RFC 6750)
    std::string_view query;          // "token=TOKEN" among its terms, for what people type
    std::string_view cookie;         // the header; of a browser that had the token in a query before
};

// The secret's length may become known, and nothing else about it.
[[nodiscard]] bool is_same_secret(std::string_view one, std::string_view other) noexcept;

// Browsers send a cookie to each port of a host, so its name has the port.
[[nodiscard]] std::string token_cookie_name(std::uint16_t port);
[[nodiscard]] bool has_token(const TokenPlaces& places, std::string_view token, std::uint16_t port);

// The value of the first term "token="; empty: there is none.
[[nodiscard]] std::string_view token_in(std::string_view query) noexcept;
[[nodiscard]] std::string query_without_token(std::string_view query);

// A header that makes the browser send the token with what it requests next: the page's files and its WebSocket. No
// script can read the cookie, and no other site can make the browser send it.
[[nodiscard]] std::string token_cookie(std::string_view token, std::uint16_t port);

}  // namespace mavloom::http
