// SPDX-License-Identifier: MIT
#include "mavloom/wire/message_table.hpp"

#include <bit>
#include <cassert>

namespace mavloom::wire {

MessageTable::MessageTable(std::span<const MessageInfo> messages) {
    assert(messages.size() < 0xffff);
    const auto slots = static_cast<std::uint32_t>(std::bit_ceil(messages.size() * 2 + 2));
    hashed_.assign(slots, 0);
    hash_shift_ = 32u - static_cast<std::uint32_t>(std::countr_zero(slots));
    infos_.reserve(messages.size());
    for (const auto& info : messages) {
        if (find(info.id) != nullptr) continue;
        infos_.push_back(info);
        const auto index = static_cast<std::uint16_t>(infos_.size());
        if (info.id.value < direct_size) {
            direct_[info.id.value] = index;
            continue;
        }
        auto slot = slot_of(info.id.value);
        while (hashed_[slot] != 0) slot = (slot + 1) & (slots - 1);
        hashed_[slot] = index;
    }
}

const MessageInfo* MessageTable::find_hashed(MessageId id) const noexcept {
    const auto mask = static_cast<std::uint32_t>(hashed_.size() - 1);
    for (auto slot = slot_of(id.value); hashed_[slot] != 0; slot = (slot + 1) & mask) {
        const auto& info = infos_[hashed_[slot] - 1u];
        if (info.id == id) return &info;
    }
    return nullptr;
}

}  // namespace mavloom::wire
