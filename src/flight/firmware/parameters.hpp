// SPDX-License-Identifier: MIT
// The parameters of a vehicle: definitions that all vehicles of a firmware share, and the values of this one. Private
// to flight and sim; single owner. Setting a value allocates nothing.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace mavloom::flight {

// Values of MAV_PARAM_TYPE.
enum class ParamType : std::uint8_t { int8 = 2, int16 = 4, int32 = 6, real32 = 9 };

// The smallest and the greatest value of an integer type.
struct ParamRange {
    double lowest, highest;
};
[[nodiscard]] ParamRange range_of(ParamType type) noexcept;

// A parameter value with a name, such as a mode; or the number of a bit, with what it stands for.
struct ParamChoice {
    int value = 0;
    std::string_view name;
};

inline constexpr double unbounded = std::numeric_limits<double>::infinity();

struct ParamInfo {
    std::string_view name;  // at most 16 characters
    ParamType type = ParamType::real32;
    double initial = 0;
    double minimum = -unbounded, maximum = unbounded;  // for display. Values outside are stored too.
    std::string_view unit{}, group{}, summary{};
    std::uint8_t decimals = 0;
    bool is_volatile = false;  // changes by itself; not part of the checksum
    bool is_read_only = false;
    bool needs_reboot = false;
    std::span<const ParamChoice> choices{}, bit_names{};
};

using ParamIndex = std::uint16_t;

class Parameters {
public:
    // `infos` is sorted by name (strcmp) and outlives the object.
    explicit Parameters(std::span<const ParamInfo> infos);

    [[nodiscard]] ParamIndex size() const noexcept { return static_cast<ParamIndex>(infos_.size()); }
    [[nodiscard]] const ParamInfo& info(ParamIndex index) const noexcept { return infos_[index]; }
    [[nodiscard]] std::optional<ParamIndex> find(std::string_view name) const noexcept;

    // Integers up to 32 bits are exact.
    [[nodiscard]] double value(ParamIndex index) const noexcept;
    // The value with the fewest digits: 0.15 instead of 0.15000000596046448, the same 32-bit float.
    [[nodiscard]] double shortest_value(ParamIndex index) const noexcept;
    // The four bytes of the value: a 32-bit integer (also for smaller integer types), or a float.
    [[nodiscard]] std::uint32_t bits(ParamIndex index) const noexcept { return bits_[index]; }
    void set_bits(ParamIndex index, std::uint32_t bits) noexcept { bits_[index] = bits; }
    // Rounds to a whole number for an integer parameter.
    void set(ParamIndex index, double value) noexcept;
    // Value by name; `fallback` if this firmware has no such parameter.
    [[nodiscard]] double get(std::string_view name, double fallback = 0) const noexcept;
    // Sets a parameter that the vehicle itself maintains. Does nothing if this firmware has no such parameter.
    void put(std::string_view name, double value) noexcept;
    void reset() noexcept;  // to the initial values

    // PX4's `_HASH_CHECK`: a CRC-32 over names and values (docs/design/simulator.md).
    [[nodiscard]] std::uint32_t hash() const noexcept;

private:
    std::span<const ParamInfo> infos_;
    std::vector<std::uint32_t> bits_;
};

}  // namespace mavloom::flight
