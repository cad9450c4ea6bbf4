// SPDX-License-Identifier: MIT
#include "http/token.hpp"

#include <fmt/format.h>

#include "mavloom/base/text.hpp"

namespace mavloom::http {

namespace {

constexpr std::string_view bearer = "Bearer ", token_key = "token=";

// Calls `each` with the terms of a list.
template <class Each>
void for_each_term(std::string_view list, char separator, Each&& each) {
    while (!list.empty()) {
        const auto end = list.find(separator);
        each(list.substr(0, end));
        list = end == std::string_view::npos ? std::string_view() : list.substr(end + 1);
    }
}

std::string_view value_of_cookie(std::string_view header, std::string_view name) {
    std::string_view value;
    for_each_term(header, ';', [&](std::string_view term) {
        term = trimmed(term);
        if (term.size() > name.size() && term.starts_with(name) && term[name.size()] == '=')
            value = term.substr(name.size() + 1);
    });
    return value;
}

}  // namespace

bool is_same_secret(std::string_view one, std::string_view other) noexcept {
    if (one.size() != other.size()) return false;
    unsigned difference = 0;
    for (std::size_t i = 0; i < one.size(); ++i) difference |= static_cast<unsigned char>(one[i] ^ other[i]);
    return difference == 0;
}

std::string token_cookie_name(std::uint16_t port) { return fmt::format("mavloom-{}", port); }

bool has_token(const TokenPlaces& places, std::string_view token, std::uint16_t port) {
    const bool is_bearer = same_letters(places.authorization.substr(0, bearer.size()), bearer);
    return (is_bearer && is_same_secret(trimmed(places.authorization.substr(bearer.size())), token)) ||
           is_same_secret(token_in(places.query), token) ||
           is_same_secret(value_of_cookie(places.cookie, token_cookie_name(port)), token);
}

std::string_view token_in(std::string_view query) noexcept {
    std::string_view value;
    for_each_term(query, '&', [&](std::string_view term) {
        if (value.empty() && term.starts_with(token_key)) value = term.substr(token_key.size());
    });
    return value;
}

std::string query_without_token(std::string_view query) {
    std::string rest;
    for_each_term(query, '&', [&](std::string_view term) {
        if (term.starts_with(token_key)) return;
        if (!rest.empty()) rest += '&';
        rest += term;
    });
    return rest;
}

std::string token_cookie(std::string_view token, std::uint16_t port) {
    return fmt::format("Set-Cookie: {}={}; HttpOnly; SameSite=Strict; Path=/\r\n", token_cookie_name(port), token);
}

}  // namespace mavloom::http
