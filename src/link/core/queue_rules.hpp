// SPDX-License-Identifier: MIT
// Decides which messages a full queue drops first, and which older frames a newer frame supersedes
// (docs/guide/queues.md). Immutable after construction; look-ups do not allocate. Private to module link.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mavloom/dialect/dialect.hpp"
#include "mavloom/wire/frame.hpp"

namespace mavloom::link {

class QueueRules {
public:
    struct Rule {
        std::uint8_t block_class = 2;
        bool replaceable = false;
        std::uint8_t instance_offset = 0, instance_size = 0;  // size 0: no instance field
    };

    explicit QueueRules(const dialect::Dialect& dialect);

    // Returns the rule of a message. An id without definition counts as telemetry that is never superseded.
    [[nodiscard]] Rule of(MessageId id) const noexcept { return id.value < direct_size ? direct_[id.value] : find(id); }
    // Returns source, id and instance in one word, never 0, for a replaceable message. Returns 0 for all others.
    [[nodiscard]] static std::uint64_t key(const wire::FrameView& frame, Rule rule) noexcept;

private:
    static constexpr std::uint32_t direct_size = 512;
    struct Far {
        std::uint32_t id;
        Rule rule;
    };

    void set(const wire::MessageInfo& info, const dialect::Field* instance);
    [[nodiscard]] Rule find(MessageId id) const noexcept;

    std::array<Rule, direct_size> direct_{};
    std::vector<Far> far_;  // sorted by id
};

}  // namespace mavloom::link
