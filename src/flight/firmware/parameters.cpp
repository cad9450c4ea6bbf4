// SPDX-License-Identifier: MIT
#include "flight/firmware/parameters.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>

#include "mavloom/wire/crc32.hpp"

namespace mavloom::flight {

namespace {

std::uint32_t bits_of(ParamType type, double value) noexcept {
    if (type == ParamType::real32) return std::bit_cast<std::uint32_t>(static_cast<float>(value));
    const auto [lowest, highest] = range_of(type);
    const double whole = std::isnan(value) ? 0 : std::clamp(std::round(value), lowest, highest);
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(whole));
}

}  // namespace

ParamRange range_of(ParamType type) noexcept {
    const auto limits = [](auto zero) {
        using Limits = std::numeric_limits<decltype(zero)>;
        return ParamRange{double{Limits::lowest()}, double{Limits::max()}};
    };
    switch (type) {
        case ParamType::int8: return limits(std::int8_t{});
        case ParamType::int16: return limits(std::int16_t{});
        case ParamType::int32: return limits(std::int32_t{});
        default: return limits(float{});
    }
}

Parameters::Parameters(std::span<const ParamInfo> infos) : infos_(infos), bits_(infos.size()) { reset(); }

std::optional<ParamIndex> Parameters::find(std::string_view name) const noexcept {
    const auto at = std::ranges::lower_bound(infos_, name, {}, &ParamInfo::name);
    if (at == infos_.end() || at->name != name) return std::nullopt;
    return static_cast<ParamIndex>(at - infos_.begin());
}

double Parameters::value(ParamIndex index) const noexcept {
    if (infos_[index].type == ParamType::real32) return double{std::bit_cast<float>(bits_[index])};
    return static_cast<std::int32_t>(bits_[index]);
}

double Parameters::shortest_value(ParamIndex index) const noexcept {
    double value = this->value(index);
    if (infos_[index].type != ParamType::real32) return value;
    std::array<char, 32> text;
    const char* const end = std::to_chars(text.data(), text.data() + text.size(), static_cast<float>(value)).ptr;
    std::from_chars(text.data(), end, value);
    return value;
}

void Parameters::set(ParamIndex index, double value) noexcept { bits_[index] = bits_of(infos_[index].type, value); }

double Parameters::get(std::string_view name, double fallback) const noexcept {
    const auto index = find(name);
    return index ? value(*index) : fallback;
}

void Parameters::put(std::string_view name, double value) noexcept {
    if (const auto index = find(name)) set(*index, value);
}

void Parameters::reset() noexcept {
    for (ParamIndex i = 0; i < size(); ++i) set(i, infos_[i].initial);
}

std::uint32_t Parameters::hash() const noexcept {
    std::uint32_t crc = 0;
    for (ParamIndex i = 0; i < size(); ++i) {
        if (infos_[i].is_volatile) continue;
        crc = wire::crc32(crc, {reinterpret_cast<const std::uint8_t*>(infos_[i].name.data()), infos_[i].name.size()});
        std::array<std::uint8_t, 4> value;
        store_le(value.data(), bits_[i]);
        crc = wire::crc32(crc, value);
    }
    return crc;
}

}  // namespace mavloom::flight
