// SPDX-License-Identifier: MIT
#include "mavloom/dialect/terms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>

#include "mavloom/base/shown.hpp"

namespace mavloom::dialect {

namespace {

constexpr std::uint32_t max_message_id = 0xffffff;  // 24 bits on the wire
constexpr std::size_t longest_name = 64;

tl::unexpected<SetupError> usage(std::string text) { return setup_error(SetupCode::usage, std::move(text)); }

bool is_name(std::string_view text) {
    return !text.empty() && text.size() <= longest_name && std::ranges::all_of(text, [](char c) {
        return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
    });
}

bool is_number(std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

SetupResult<MessageId> parse_id(std::string_view digits) {
    std::uint32_t id = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), id);
    if (error != std::errc{} || end != digits.data() + digits.size() || id > max_message_id)
        return usage(fmt::format("{} is not a message id; expected a whole number from 0 to {}", in_quotes(digits),
                                 max_message_id));
    return MessageId{id};
}

}  // namespace

SetupResult<std::string> parse_message_term(std::string_view text) {
    if (!is_name(text))
        return usage(fmt::format("{} is not a message name or id; for example, type ATTITUDE or 30", in_quotes(text)));
    if (is_number(text))
        if (const auto id = parse_id(text); !id) return tl::unexpected(id.error());
    return std::string(text);
}

SetupResult<double> parse_positive(std::string_view text) {
    double value = 0;
    const bool is_signed = !text.empty() && (text.front() == '-' || text.front() == '+');
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || is_signed || error != std::errc{} || end != text.data() + text.size() ||
        !std::isfinite(value) || value <= 0)
        return usage(fmt::format("{} is not a number above 0", in_quotes(text)));
    return value;
}

SetupResult<RateTerm> parse_rate_term(std::string_view text) {
    const auto colon = text.rfind(':');
    if (colon == std::string_view::npos)
        return usage(fmt::format("{} has no rate; for example, type ATTITUDE:10 or *:50", in_quotes(text)));
    RateTerm term{"*", 0};
    if (const auto name = text.substr(0, colon); name != "*") {
        auto message = parse_message_term(name);
        if (!message) return tl::unexpected(std::move(message.error()));
        term.message = std::move(*message);
    }
    const auto rate = parse_positive(text.substr(colon + 1));
    if (!rate) return tl::unexpected(SetupError(rate.error()).within(fmt::format("rate of {}, in Hz", term.message)));
    term.rate_hz = *rate;
    return term;
}

SetupResult<MessageId> find_message_id(const Dialect& dialect, std::string_view name_or_id) {
    if (is_number(name_or_id)) return parse_id(name_or_id);
    const auto message = dialect.message(name_or_id);
    if (!message) return tl::unexpected(message.error());
    return (*message)->id();
}

SetupResult<const Message*> find_message(const Dialect& dialect, std::string_view name_or_id) {
    const auto id = find_message_id(dialect, name_or_id);
    if (!id) return tl::unexpected(id.error());
    if (const auto* message = dialect.find(*id)) return message;
    return usage(fmt::format("message {} has no definition (--dialect FILE adds some)", id->value));
}

}  // namespace mavloom::dialect
