// SPDX-License-Identifier: MIT
// A filter decides which frames a link accepts or sends. It is compiled once, from a dialect and the terms that a user
// typed. For each kind of term (message, system, component) in the allow list, the frame must match one of the terms.
// It must match no term of the block list. See docs/guide/routing.md, "Filters and limits".
//
// Filters are immutable values, safe to use from any thread. Compiling allocates; `admits` does not.
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

// One list of terms. `option`, for example "out_allow", prefixes error messages.
struct FilterTerms {
    std::string_view option{};
    std::span<const std::string> messages{};  // names or numeric ids; an id needs no definition
    std::span<const std::uint8_t> systems{}, components{};
};

class Filter {
public:
    // Admits everything.
    Filter() noexcept;
    // Fails with `usage` for an unknown message name; the error text suggests the nearest name.
    [[nodiscard]] static SetupResult<Filter> compile(const dialect::Dialect& dialect, const FilterTerms& allow,
                                                     const FilterTerms& block);

    [[nodiscard]] bool admits(MessageId id, Source source) const noexcept {
        return has(systems_, source.system.value) && has(components_, source.component.value) && admits(id);
    }
    [[nodiscard]] bool admits_all() const noexcept { return *this == Filter{}; }
    friend bool operator==(const Filter&, const Filter&) = default;

private:
    static constexpr std::uint32_t near_size = 1024;  // smaller ids are looked up in a bit set
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
    bool far_passes_ = true;            // whether ids from near_size up pass by default
    std::vector<std::uint32_t> far_{};  // sorted: the exceptions to far_passes_
};

}  // namespace mavloom::route
