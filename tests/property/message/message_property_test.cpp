// SPDX-License-Identifier: MIT
// Decode and encode are inverse, whichever way a field is reached; both printed forms stay within their bounds for any
// bytes.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>

#include "mavloom/message/builder.hpp"
#include "mavloom/message/format.hpp"
#include "mavloom/message/view.hpp"
#include "mavloom/wire/frame_writer.hpp"
#include "support/seed.hpp"

namespace mavloom::message {
namespace {

using dialect::Field;
using dialect::FieldType;
using Bytes = std::vector<std::uint8_t>;

// RapidCheck begins with small values: the first few messages, bytes near 0. All are as likely here.
template <class Gen>
auto full_size(Gen gen) {
    return rc::gen::resize(rc::kNominalSize, std::move(gen));
}

const dialect::Dialect& the_dialect() { return dialect::default_dialect(); }

const dialect::Message& any_message() {
    const auto messages = the_dialect().messages();
    return messages[*full_size(rc::gen::inRange<std::size_t>(0, messages.size()))];
}

Bytes any_payload(std::size_t most) {
    const auto length = *full_size(rc::gen::inRange<std::size_t>(0, most + 1));
    return *full_size(rc::gen::container<Bytes>(length, rc::gen::arbitrary<std::uint8_t>()));
}

Bytes extended(Bytes payload, std::size_t length) {
    payload.resize(length);
    return payload;
}

Bytes bytes_of(ByteView view) { return {view.begin(), view.end()}; }

bool is_float(const Field& field) { return field.type == FieldType::f32 || field.type == FieldType::f64; }

// ---- encode and decode

RC_GTEST_PROP(MessageProperty, ABuilderOfCutBytesIsTheZeroExtendedPayload, ()) {
    const auto& message = any_message();
    const auto payload = any_payload(255);
    RC_ASSERT(bytes_of(MessageBuilder(message, payload).payload()) == extended(payload, message.wire.max_length));
}

RC_GTEST_PROP(MessageProperty, CopyingFieldByFieldGivesTheSameBytes, ()) {
    const auto& message = any_message();
    const auto payload = any_payload(message.wire.max_length);
    const MessageView view(message, payload);
    MessageBuilder builder(message);
    for (const auto& field : message.fields) {
        if (field.is_text()) RC_ASSERT(builder.set_text(field, view.text(field)).has_value());
        for (std::size_t i = 0; i < field.count() && !field.is_text(); ++i) {
            // Numbers with their sign where it fits; floats as bits, since NaN has many.
            if (field.type == FieldType::f32) builder.put(field, view.get<std::uint32_t>(field, i), i);
            else if (field.type == FieldType::f64) builder.put(field, view.get<std::uint64_t>(field, i), i);
            else if (field.type == FieldType::u64)
                RC_ASSERT(builder.set_unsigned(field, view.unsigned_integer(field, i), i).has_value());
            else RC_ASSERT(builder.set_integer(field, view.integer(field, i), i).has_value());
        }
    }
    RC_ASSERT(bytes_of(builder.payload()) == extended(payload, message.wire.max_length));
}

RC_GTEST_PROP(MessageProperty, ACanonicalFrameIsItsOwnReencoding, ()) {
    const auto& message = any_message();
    const auto version = message.wire.id.value < 256 && *rc::gen::arbitrary<bool>() ? wire::Version::v1
                                                                                    : wire::Version::v2;
    const wire::FrameHeader header{version, *rc::gen::arbitrary<std::uint8_t>(), {SystemId{1}, ComponentId{2}}};
    wire::FrameBuffer first{}, second{};
    const auto frame = wire::write_frame(first, header, message.wire,
                                         extended(any_payload(message.wire.max_length), message.wire.max_length));

    const auto again = wire::write_frame(second, header, message.wire,
                                         MessageBuilder(message, frame.payload()).payload());

    RC_ASSERT(bytes_of(again.bytes()) == bytes_of(frame.bytes()));
}

RC_GTEST_PROP(MessageProperty, IntegersComeBackOrAreRefused, ()) {
    const auto& message = any_message();
    const auto& field = message.fields[*full_size(rc::gen::inRange<std::size_t>(0, message.fields.size()))];
    RC_PRE(!is_float(field));
    const auto value = *rc::gen::oneOf(rc::gen::arbitrary<std::int64_t>(),
                                       rc::gen::inRange<std::int64_t>(-70000, 70000));
    const auto index = *rc::gen::inRange<std::size_t>(0, field.count());
    MessageBuilder builder(message);

    const bool accepted = builder.set_integer(field, value, index).has_value();

    const bool is_signed = field.type == FieldType::i8 || field.type == FieldType::i16 ||
                           field.type == FieldType::i32 || field.type == FieldType::i64;
    const auto bits = 8 * dialect::size_of(field.type);
    const bool fits = is_signed ? bits == 64 || (value >= -(std::int64_t{1} << (bits - 1)) && value < std::int64_t{1}
                                                                                                          << (bits - 1))
                                : value >= 0 && (bits == 64 || value < std::int64_t{1} << bits);
    RC_ASSERT(accepted == fits);
    if (accepted) RC_ASSERT(MessageView(message, builder.payload()).integer(field, index) == value);
}

// ---- what is printed, typed in again

RC_GTEST_PROP(MessageProperty, JsonReadsBackToTheSameBytes, ()) {
    const auto& message = any_message();
    const auto payload = any_payload(message.wire.max_length);
    const MessageView view(message, payload);
    TextBuffer out;
    append_json_fields(out, message, payload);
    const auto fields = nlohmann::json::parse("{" + fmt::to_string(out) + "}");
    RC_ASSERT(fields.size() == message.fields.size());

    MessageBuilder builder(message);
    for (const auto& field : message.fields) {
        if (field.type == FieldType::char8) continue;  // what is not UTF-8 is replaced there
        auto typed = fields.at(std::string(field.name)).dump();
        std::erase(typed, '"');
        RC_ASSERT(builder.set_from_text(field, typed).has_value());
        for (std::size_t i = 0; i < field.count(); ++i) {
            const MessageView again(message, builder.payload());
            if (is_float(field) && std::isnan(view.number(field, i))) {
                RC_ASSERT(std::isnan(again.number(field, i)));
            } else if (field.type == FieldType::f32) {
                RC_ASSERT(again.get<std::uint32_t>(field, i) == view.get<std::uint32_t>(field, i));
            } else if (field.type == FieldType::f64) {
                RC_ASSERT(again.get<std::uint64_t>(field, i) == view.get<std::uint64_t>(field, i));
            } else {
                RC_ASSERT(again.unsigned_integer(field, i) == view.unsigned_integer(field, i));
            }
        }
    }
}

RC_GTEST_PROP(MessageProperty, TextIsOneLineWithoutControls, ()) {
    const auto& message = any_message();
    wire::FrameBuffer buffer{};
    const auto frame = wire::write_frame(buffer, {wire::Version::v2, 0, {SystemId{1}, ComponentId{1}}}, message.wire,
                                         extended(any_payload(message.wire.max_length), message.wire.max_length));
    const auto link = *rc::gen::arbitrary<std::string>();
    TextBuffer out;

    append_text(out, {wall_from_us(*rc::gen::inRange<std::uint64_t>(0, 1ull << 52)), link, frame, &message},
                the_dialect());

    const auto line = fmt::to_string(out);
    RC_ASSERT(line.back() == '\n');
    for (std::size_t i = 0; i + 1 < line.size(); ++i)
        RC_ASSERT(static_cast<unsigned char>(line[i]) >= 0x20 && line[i] != 0x7f);
    RC_ASSERT(!nlohmann::json(line).dump().empty());  // throws for what is not UTF-8
}

}  // namespace
}  // namespace mavloom::message
