// SPDX-License-Identifier: MIT
#include "edit/draft.hpp"

#include <cstring>

#include "mavloom/message/builder.hpp"
#include "mavloom/message/view.hpp"
#include "mavloom/wire/frame_checksum.hpp"

namespace mavloom::edit {

namespace {

using dialect::Field;
using dialect::FieldType;
using message::MessageBuilder;
using message::MessageView;

template <class T>
void copy_values(const MessageView& in, const Field& field, MessageBuilder& out) noexcept {
    for (std::size_t i = 0; i < field.count(); ++i) out.put(field, in.get<T>(field, i), i);
}

void copy_field(const MessageView& in, const Field& field, MessageBuilder& out) noexcept {
    switch (field.type) {
        case FieldType::char8: return copy_values<char>(in, field, out);
        case FieldType::u8: return copy_values<std::uint8_t>(in, field, out);
        case FieldType::i8: return copy_values<std::int8_t>(in, field, out);
        case FieldType::u16: return copy_values<std::uint16_t>(in, field, out);
        case FieldType::i16: return copy_values<std::int16_t>(in, field, out);
        case FieldType::u32: return copy_values<std::uint32_t>(in, field, out);
        case FieldType::i32: return copy_values<std::int32_t>(in, field, out);
        case FieldType::u64: return copy_values<std::uint64_t>(in, field, out);
        case FieldType::i64: return copy_values<std::int64_t>(in, field, out);
        case FieldType::f32: return copy_values<float>(in, field, out);
        case FieldType::f64: return copy_values<double>(in, field, out);
    }
}

}  // namespace

std::optional<Draft> Draft::of(const wire::FrameView& frame, const dialect::Message* message) noexcept {
    Draft draft;
    draft.header_ = {frame.version(), frame.sequence(), frame.source(), frame.compat_flags()};
    const auto payload = frame.payload();
    if (message == nullptr) {
        const int extra = wire::crc_extra_of(frame);
        if (extra < 0) return std::nullopt;
        draft.info_ = {frame.id(), static_cast<std::uint8_t>(extra), frame.payload_length(), frame.payload_length()};
    } else {
        draft.known_ = true;
        draft.info_ = message->wire;
        draft.decoded_ = payload.size() <= message->wire.max_length;
    }
    // The specification does not allow a version 1 payload with extension fields, but keep all of its bytes.
    if (frame.version() == wire::Version::v1)
        draft.info_.min_length = std::max(draft.info_.min_length, frame.payload_length());
    if (draft.decoded_) {
        const MessageView view(*message, payload);
        MessageBuilder builder(*message);
        for (const Field& field : message->fields) copy_field(view, field, builder);
        std::memcpy(draft.payload_.data(), builder.payload().data(), builder.payload().size());
    } else {
        if (!payload.empty()) std::memcpy(draft.payload_.data(), payload.data(), payload.size());
        draft.info_.max_length = frame.payload_length();
    }
    return draft;
}

bool Draft::remap(const SystemMap& map) noexcept {
    const SystemId source{map[header_.source.system.value]};
    bool changed = source != header_.source.system;
    header_.source.system = source;
    const auto at = info_.target_system_offset;
    if (at >= info_.max_length) return changed;  // no such field; no_target is larger than every payload length
    changed = changed || map[payload_[at]] != payload_[at];
    payload_[at] = map[payload_[at]];
    return changed;
}

bool Draft::patch(std::span<const Patch> patches) noexcept {
    const auto id = info_.id.value;
    const auto first = std::lower_bound(patches.begin(), patches.end(), id,
                                        [](const Patch& p, std::uint32_t i) { return p.id < i; });
    auto patch = first;
    for (; patch != patches.end() && patch->id == id; ++patch)
        std::memcpy(payload_.data() + patch->offset, patch->bytes.data(), patch->size);
    return patch != first;
}

bool Draft::fits_v1() const noexcept {
    return wire::fits_v1(info_) && (known_ || header_.version == wire::Version::v1);
}

bool Draft::set_version(wire::Version version) noexcept {
    const bool changed = version != header_.version;
    header_.version = version;
    return changed;
}

wire::FrameView Draft::write(wire::FrameBuffer& out, wire::Signing signing) const noexcept {
    return wire::write_frame(out, header_, info_, {payload_.data(), info_.max_length}, signing);
}

}  // namespace mavloom::edit
