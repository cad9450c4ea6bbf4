// SPDX-License-Identifier: MIT
// Source: MAVLink guide, "Parameter Protocol", "Parameter Encoding".
#include "observe/summary/parameter_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <string_view>
#include <utility>

#include "mavloom/observe/summarizer.hpp"

namespace mavloom::observe {

namespace {

constexpr std::uint8_t u8 = 1, i8 = 2, u16 = 3, i16 = 4, i32 = 6;  // MAV_PARAM_TYPE; the others are 32 bits

double integer_in(std::uint32_t bits, std::uint8_t type) noexcept {
    switch (type) {
        case u8: return static_cast<std::uint8_t>(bits);
        case i8: return static_cast<std::int8_t>(bits);
        case u16: return static_cast<std::uint16_t>(bits);
        case i16: return static_cast<std::int16_t>(bits);
        case i32: return static_cast<std::int32_t>(bits);
        default: return bits;
    }
}

// The shortest decimal number that is the same float: 0.15, not 0.15000000596046448.
double shortest(float value) {
    const auto text = fmt::format("{}", value);
    double number = value;
    std::from_chars(text.data(), text.data() + text.size(), number);
    return number;
}

// PX4 sends the checksum of all parameters as one of them.
bool is_checksum(std::string_view name) noexcept { return name == "_HASH_CHECK"; }

}  // namespace

std::size_t ParameterLog::KeyHash::operator()(const Key& key) const noexcept {
    const auto* const name = reinterpret_cast<const std::uint8_t*>(key.name.data());
    const auto source = std::uint64_t{key.source.system.value} << 8 | key.source.component.value;
    return secret_hash(secret_hash(load_le<std::uint64_t>(name), source), load_le<std::uint64_t>(name + 8));
}

double ParameterLog::number(const Value& value, bool is_bytewise) {
    if (is_bytewise && value.type >= u8 && value.type <= i32) return integer_in(value.bits, value.type);
    return shortest(std::bit_cast<float>(value.bits));
}

bool ParameterLog::add(Source source, const msg::ParamValue& message, bool is_bytewise, const When& when) {
    Key key{source, message.param_id};
    std::fill(std::ranges::find(key.name, '\0'), key.name.end(), '\0');  // nothing counts after the end of the name
    const std::string_view name(key.name.data(),
                                static_cast<std::size_t>(std::ranges::find(key.name, '\0') - key.name.begin()));
    if (is_checksum(name)) return true;
    const Value value{std::bit_cast<std::uint32_t>(message.param_value), message.param_type};
    const auto known = values_.find(key);
    if (known == values_.end()) return values_.size() < max_parameters && values_.emplace(key, value).second;
    if (known->second == value) return true;
    const auto before = std::exchange(known->second, value);
    if (changes_.size() == Summarizer::max_entries) return false;
    changes_.push_back({.when = when,
                        .source = source,
                        .name = std::string(name),
                        .before = number(before, is_bytewise),
                        .after = number(value, is_bytewise)});
    return true;
}

}  // namespace mavloom::observe
