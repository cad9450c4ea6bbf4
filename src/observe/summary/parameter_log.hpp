// SPDX-License-Identifier: MIT
// Values of parameters that differ from the earlier value of the same name. Private to module observe.
#pragma once

#include <array>
#include <unordered_map>
#include <vector>

#include "mavloom/base/secret_hash.hpp"
#include "mavloom/msg/param_value.hpp"
#include "mavloom/observe/summary.hpp"

namespace mavloom::observe {

class ParameterLog {
public:
    static constexpr std::size_t max_parameters = 16'384;

    // `is_bytewise`: the sender puts integers as bytes into the field (PX4), and not as a float (ArduPilot).
    // Returns false if there was no room.
    [[nodiscard]] bool add(Source source, const msg::ParamValue& message, bool is_bytewise, const When& when);
    [[nodiscard]] const std::vector<ParameterChange>& changes() const noexcept { return changes_; }

private:
    struct Key {
        Source source;
        std::array<char, 16> name;
        friend bool operator==(const Key&, const Key&) = default;
    };
    struct KeyHash {
        std::size_t operator()(const Key& key) const noexcept;
    };
    struct Value {
        std::uint32_t bits;
        std::uint8_t type;  // MAV_PARAM_TYPE
        friend bool operator==(const Value&, const Value&) = default;
    };
    [[nodiscard]] static double number(const Value& value, bool is_bytewise);

    std::unordered_map<Key, Value, KeyHash> values_;
    std::vector<ParameterChange> changes_;
};

}  // namespace mavloom::observe
