// SPDX-License-Identifier: MIT
// Parses the values of endpoint options and configuration keys: durations, sizes, file modes, numbers, filter terms and
// rate terms.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <chrono>
#include <cmath>
#include <limits>

#include "mavloom/dialect/terms.hpp"
#include "mavloom/endpoint/grammar.hpp"

namespace mavloom::endpoint {

namespace {

// The number at the start of `text`, and the text after it. Signs are refused, because no value of the grammar is
// negative.
template <class T>
struct Leading {
    T value{};
    std::string_view rest;
    bool ok = false;
};

template <class T>
Leading<T> leading_number(std::string_view text) {
    Leading<T> result;
    if (text.empty() || text.front() == '-' || text.front() == '+') return result;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), result.value);
    result.rest = text.substr(static_cast<std::size_t>(end - text.data()));
    result.ok = error == std::errc{};
    return result;
}

struct Unit {
    std::string_view name;
    double value;
};

constexpr double kib = 1024;
constexpr std::array duration_units{Unit{"", 1e9},     Unit{"ns", 1},     Unit{"us", 1e3},
                                    Unit{"ms", 1e6},   Unit{"s", 1e9},    Unit{"m", 60e9},
                                    Unit{"min", 60e9}, Unit{"h", 3600e9}, Unit{"d", 86400e9}};
constexpr std::array size_units{Unit{"", 1},
                                Unit{"B", 1},
                                Unit{"k", kib},
                                Unit{"K", kib},
                                Unit{"KiB", kib},
                                Unit{"kB", 1e3},
                                Unit{"m", kib* kib},
                                Unit{"M", kib* kib},
                                Unit{"MiB", kib* kib},
                                Unit{"MB", 1e6},
                                Unit{"g", kib* kib* kib},
                                Unit{"G", kib* kib* kib},
                                Unit{"GiB", kib* kib* kib},
                                Unit{"GB", 1e9}};

const Unit* find_unit(std::span<const Unit> units, std::string_view name) {
    const auto unit = std::find_if(units.begin(), units.end(), [&](const Unit& u) { return u.name == name; });
    return unit == units.end() ? nullptr : &*unit;
}

SetupResult<void> add_filter_term(FilterTerms& terms, std::string_view text) {
    const auto colon = text.find(':');
    if (colon == std::string_view::npos) {
        auto message = dialect::parse_message_term(text);
        if (!message) return tl::unexpected(message.error());
        terms.messages.push_back(std::move(*message));
        return {};
    }
    const auto kind = text.substr(0, colon);
    if (kind != "sys" && kind != "comp")
        return usage(
            fmt::format("{} is not a filter term; type a message name, an id, sys:N or comp:N", in_quotes(text)));
    const auto id = parse_integer(text.substr(colon + 1), 0, 255);
    if (!id) return tl::unexpected(SetupError(id.error()).within(kind));
    (kind == "sys" ? terms.systems : terms.components).push_back(static_cast<std::uint8_t>(*id));
    return {};
}

}  // namespace

SetupResult<std::chrono::nanoseconds> parse_duration(std::string_view text) {
    const auto number = leading_number<double>(text);
    const Unit* unit = number.ok ? find_unit(duration_units, number.rest) : nullptr;
    if (unit == nullptr || !std::isfinite(number.value))
        return usage(fmt::format(
            "{} is not a duration; for example, type 2, 2s, 500ms, 1m or 1h (seconds unless a unit follows)",
            in_quotes(text)));
    const double ns = number.value * unit->value;
    constexpr double ten_years_ns = 3653 * 86400e9;  // far below the range of 64-bit nanoseconds
    if (ns > ten_years_ns) return usage(fmt::format("{} is longer than ten years", in_quotes(text)));
    return std::chrono::nanoseconds{std::llround(ns)};
}

SetupResult<std::uint64_t> parse_size(std::string_view text) {
    const auto number = leading_number<std::uint64_t>(text);
    const Unit* unit = number.ok ? find_unit(size_units, number.rest) : nullptr;
    if (unit == nullptr)
        return usage(fmt::format("{} is not a size; for example, type 65536, 64k or 32MiB", in_quotes(text)));
    const auto factor = static_cast<std::uint64_t>(unit->value);
    constexpr std::uint64_t most = std::uint64_t{1} << 62;
    if (number.value > most / factor) return usage(fmt::format("{} is larger than any disk", in_quotes(text)));
    return number.value * factor;
}

SetupResult<std::uint16_t> parse_mode(std::string_view text) {
    std::string_view digits = text;
    if (digits.starts_with("0o")) digits.remove_prefix(2);
    else if (digits.size() == 4 && digits.starts_with('0')) digits.remove_prefix(1);
    std::uint16_t mode = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), mode, 8);
    if (error != std::errc{} || end != digits.data() + digits.size() || digits.size() != 3)
        return usage(
            fmt::format("{} is not a file mode; type three octal digits, for example 0600 or 0640", in_quotes(text)));
    return mode;
}

tl::unexpected<SetupError> usage(std::string text) { return setup_error(SetupCode::usage, std::move(text)); }

SetupResult<std::uint64_t> parse_integer(std::string_view text, std::uint64_t least, std::uint64_t most) {
    const auto number = leading_number<std::uint64_t>(text);
    if (!number.ok || !number.rest.empty() || number.value < least || number.value > most)
        return usage(fmt::format("{} is not a whole number from {} to {}", in_quotes(text), least, most));
    return number.value;
}

SetupResult<std::uint64_t> parse_ring_capacity(std::string_view text) {
    constexpr std::uint64_t least = 64 * 1024, most = std::uint64_t{1} << 36;
    auto size = parse_size(text);
    if (size && (!std::has_single_bit(*size) || *size < least || *size > most))
        return usage(fmt::format("{} is not a power of two from 64k to 64G", in_quotes(text)));
    return size;
}

SetupResult<bool> parse_bool(std::string_view text) {
    if (text == "true") return true;
    if (text == "false") return false;
    return usage(fmt::format("{} is neither true nor false", in_quotes(text)));
}

SetupResult<FilterTerms> parse_filter(std::string_view text) {
    FilterTerms terms;
    const auto done = dialect::for_each_term(text, [&](std::string_view term) { return add_filter_term(terms, term); });
    if (!done) return tl::unexpected(done.error());
    return terms;
}

SetupResult<FilterTerms> parse_sender(std::string_view text) {
    const auto slash = text.find('/');
    const bool has_component = slash != std::string_view::npos;
    const auto system = parse_integer(text.substr(0, slash), 0, 255);
    const auto component = parse_integer(has_component ? text.substr(slash + 1) : "0", 0, 255);
    if (!system || !component)
        return usage(fmt::format("{} is not SYS or SYS/COMP, numbers from 0 to 255, as in 1/1", in_quotes(text)));
    FilterTerms terms{.systems = {static_cast<std::uint8_t>(*system)}};
    if (has_component) terms.components.push_back(static_cast<std::uint8_t>(*component));
    return terms;
}

SetupResult<std::vector<RateTerm>> parse_rates(std::string_view text) {
    std::vector<RateTerm> terms;
    const auto done = dialect::for_each_term(text, [&](std::string_view part) -> SetupResult<void> {
        auto term = dialect::parse_rate_term(part);
        if (!term) return tl::unexpected(term.error());
        const auto same = [&](const RateTerm& other) { return other.message == term->message; };
        if (std::any_of(terms.begin(), terms.end(), same)) return usage(fmt::format("{} has two rates", term->message));
        terms.push_back(std::move(*term));
        return {};
    });
    if (!done) return tl::unexpected(done.error());
    return terms;
}

}  // namespace mavloom::endpoint
