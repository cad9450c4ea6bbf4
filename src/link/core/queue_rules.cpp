// SPDX-License-Identifier: MIT
#include "link/core/queue_rules.hpp"

#include <algorithm>

#include "mavloom/base/secret_hash.hpp"
#include "mavloom/dialect/message_class.hpp"

namespace mavloom::link {

QueueRules::QueueRules(const dialect::Dialect& dialect) {
    for (const dialect::Message& message : dialect.messages()) {
        const auto instance = std::find_if(message.fields.begin(), message.fields.end(),
                                           [](const auto& f) { return f.instance; });
        set(message.wire, instance == message.fields.end() ? nullptr : &*instance);
    }
    std::sort(far_.begin(), far_.end(), [](const Far& a, const Far& b) { return a.id < b.id; });
}

void QueueRules::set(const wire::MessageInfo& info, const dialect::Field* instance) {
    Rule rule;
    const auto message_class = dialect::class_of(info.id, &info);
    rule.block_class = static_cast<std::uint8_t>(message_class);
    rule.replaceable = message_class == dialect::MessageClass::telemetry &&
                       dialect::meaning_of(info.id) == dialect::FrameMeaning::latest;
    if (instance != nullptr) {
        rule.instance_offset = instance->offset;
        rule.instance_size = static_cast<std::uint8_t>(instance->size());
    }
    if (info.id.value < direct_size) {
        direct_[info.id.value] = rule;
    } else {
        far_.push_back({info.id.value, rule});
    }
}

QueueRules::Rule QueueRules::find(MessageId id) const noexcept {
    const auto at = std::lower_bound(far_.begin(), far_.end(), id.value,
                                     [](const Far& f, std::uint32_t v) { return f.id < v; });
    return at != far_.end() && at->id == id.value ? at->rule : Rule{};
}

// FNV-1a with a secret start, for instance fields longer than two bytes (names).
static std::uint64_t hash_of(ByteView bytes) noexcept {
    std::uint64_t h = secret_hash(0);
    for (const std::uint8_t byte : bytes) h = (h ^ byte) * 0x100000001b3u;
    return h;
}

std::uint64_t QueueRules::key(const wire::FrameView& frame, Rule rule) noexcept {
    if (!rule.replaceable) return 0;
    constexpr std::uint64_t present = std::uint64_t{1} << 63;
    const std::uint64_t base = present | frame.id().value | std::uint64_t{frame.system().value} << 24 |
                               std::uint64_t{frame.component().value} << 32;
    if (rule.instance_size == 0) return base;
    // MAVLink 2 truncates trailing zeros of the payload, so missing bytes are zeros. Zeros at the end of the instance
    // do not change the key.
    const ByteView payload = frame.payload();
    if (rule.instance_offset >= payload.size()) return base;
    ByteView instance = payload.subspan(rule.instance_offset);
    instance = instance.first(std::min<std::size_t>(instance.size(), rule.instance_size));
    while (!instance.empty() && instance.back() == 0) instance = instance.first(instance.size() - 1);
    if (rule.instance_size <= 2) {
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < instance.size(); ++i) value |= std::uint64_t{instance[i]} << (8 * i);
        return base | value << 40;
    }
    return instance.empty() ? base : (base ^ hash_of(instance) * 0x9e3779b97f4a7c15u) | present;
}

}  // namespace mavloom::link
