// SPDX-License-Identifier: MIT
// The beginning of each source's newest HEARTBEAT on each link, which has its mode. Private to module router; one owner
// thread. Allocates for a new source (at most `max_sources`), never for a known one.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <unordered_map>

#include "mavloom/base/bytes.hpp"
#include "mavloom/base/ids.hpp"
#include "mavloom/base/secret_hash.hpp"

namespace mavloom::router {

class NewestHeartbeats {
public:
    static constexpr std::size_t max_sources = 32'768;
    // The bytes that message::heartbeat_mode reads: custom_mode, type, autopilot, base_mode.
    using Beginning = std::array<std::uint8_t, 7>;

    void note(LinkId link, Source source, ByteView payload) {
        const std::uint64_t key = key_of(link, source);
        auto at = sources_.find(key);
        if (at == sources_.end()) {
            if (sources_.size() == max_sources) return;
            at = sources_.emplace(key, Beginning{}).first;
        }
        at->second = {};
        std::ranges::copy(payload.first(std::min(payload.size(), at->second.size())), at->second.begin());
    }
    // Null if this source has sent none on this link.
    [[nodiscard]] const Beginning* find(LinkId link, Source source) const {
        const auto at = sources_.find(key_of(link, source));
        return at == sources_.end() ? nullptr : &at->second;
    }
    // Removes the sources on all links for which `is_there(LinkId)` returns false.
    template <class IsThere>
    void forget_links_unless(IsThere&& is_there) {
        std::erase_if(sources_,
                      [&](const auto& s) { return !is_there(LinkId{static_cast<std::uint32_t>(s.first >> 16)}); });
    }

private:
    struct Hash {
        std::size_t operator()(std::uint64_t key) const noexcept { return secret_hash(key); }
    };
    [[nodiscard]] static std::uint64_t key_of(LinkId link, Source source) noexcept {
        return std::uint64_t{link.value} << 16 | std::uint64_t{source.system.value} << 8 | source.component.value;
    }

    std::unordered_map<std::uint64_t, Beginning, Hash> sources_;  // by link and source
};

}  // namespace mavloom::router
