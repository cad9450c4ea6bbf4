// SPDX-License-Identifier: MIT
// Which frames a link takes in or gives out: filter terms as users type them, looked up once against a dialect. A frame must match every kind of term (message, system, component) that the allow list names, and none that the block list names.
// Immutable values, safe from any thread; compiling allocates, asking does not. docs/guide/routing.md,
// "Filters and limits".
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/base/ids.hpp"
#include "mavloom/base/result.hpp"

namespace mavloom::dialect {
class Dialect;
}

namespace mavloom::route {

// One list of terms. `option` stands in front of an error: "out_allow".
struct FilterTerms {
    std::string_view option{};
    std::span<const std::string> messages{};  // names, or plain ids for messages without definition too
    std::span<const std::uint8_t> systems{}, components{};
};

class Filter {
public:
    // Admits everything.
    Filter() noexcept;
    // The error is `usage` and names the nearest message.
    [[nodiscard]] static SetupResult<Filter> compile(const dialect::Dialect& dialect, const FilterTerms& allow,
                                                     const FilterTerms& block);

    [[nodiscard]] bool admits(MessageId id, Source source) const noexcept {
        return has(systems_, source.system.value) && has(components_, source.component.value) && admits(id);
    }
    [[nodiscard]] bool admits_all() const noexcept { return *this == Filter{}; }
    friend bool operator==(const Filter&, const Filter&) = default;

private:
    static constexpr std::uint32_t near_size = 1024;  // ids that are looked up by bit
    using Bits256 = std::array<std::uint64_t, 4>;

    template <std::size_t n>
    static bool has(const std::array<std::uint64_t, n>& bits, std::uint32_t at) noexcept {
        return (bits[at / 64] >> (at % 64) & 1) != 0;
    }
    [[nodiscard]] bool admits(MessageId id) const noexcept {
        return id.value < near_size ? has(near_, id.value) : admits_far(id.value);
    }
    [[nodiscard]] bool admits_far(std::uint32_t id) const noexcept;

    Bits256 systems_, components_;
    std::array<std::uint64_t, near_size / 64> near_;
    bool far_passes_ = true;            // ids beyond that are not among far_
    std::vector<std::uint32_t> far_{};  // rising; those of which the opposite holds
};

}  // namespace mavloom::route
