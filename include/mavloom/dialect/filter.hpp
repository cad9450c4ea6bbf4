// SPDX-License-Identifier: MIT
// Selects frames by message, system and component: for links of a router, for relays, recordings, commands and Python.
// See docs/guide/routing.md, "Filters and limits".
//
// FilterTerms: what a user typed. Filter: compiled from it with a dialect. Both are plain values. Compiling allocates;
// `admits` does not.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "mavloom/base/ids.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/wire/frame.hpp"

namespace mavloom::dialect {

class Dialect;

struct FilterTerms {
    std::vector<std::string> messages{};  // names or numeric ids; an id needs no definition
    std::vector<std::uint8_t> systems{}, components{};
    [[nodiscard]] bool empty() const noexcept { return messages.empty() && systems.empty() && components.empty(); }
    friend bool operator==(const FilterTerms&, const FilterTerms&) = default;
};

class Filter {
public:
    // Admits everything.
    Filter() noexcept;
    // Admits nothing.
    [[nodiscard]] static Filter none() noexcept;

    // Narrow the filter, in any order; on an error, the filter is not changed. `allow`: of each kind (message, system,
    // component) of which there are terms, a frame must match one. `block`: a frame must match none of the terms.
    // Errors are `usage`: an unknown message name; the text suggests the nearest name.
    [[nodiscard]] SetupResult<void> allow(const Dialect& dialect, const FilterTerms& terms);
    [[nodiscard]] SetupResult<void> block(const Dialect& dialect, const FilterTerms& terms);

    [[nodiscard]] bool admits(MessageId id, Source source) const noexcept {
        return has(systems_, source.system.value) && has(components_, source.component.value) && admits(id);
    }
    [[nodiscard]] bool admits(const wire::FrameView& frame) const noexcept {
        return admits(frame.id(), frame.source());
    }
    // Whether it admits the message, from a source that it admits.
    [[nodiscard]] bool admits(MessageId id) const noexcept {
        return id.value < near_size ? has(near_, id.value) : admits_far(id.value);
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
    [[nodiscard]] bool admits_far(std::uint32_t id) const noexcept;

    Bits256 systems_, components_;
    std::array<std::uint64_t, near_size / 64> near_;
    bool far_passes_ = true;            // whether ids from near_size up pass by default
    std::vector<std::uint32_t> far_{};  // sorted: the exceptions to far_passes_
};

}  // namespace mavloom::dialect
