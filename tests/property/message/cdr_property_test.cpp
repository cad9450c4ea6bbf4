// SPDX-License-Identifier: MIT
// CDR bodies of random definitions and payloads against the rule applied field by field: each number aligned to its
// size, each text with its length before it.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "mavloom/message/cdr.hpp"

namespace mavloom::message {
namespace {

using dialect::Field;
using dialect::FieldType;
using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t longest_payload = 255;
constexpr std::uint8_t untouched = 0xa5;

// Fields without gaps, in any order of sizes, as extensions have it. Text is ASCII: the names are the offsets.
std::vector<Field> any_fields() {
    std::vector<Field> fields;
    std::size_t offset = 0;
    for (auto count = *rc::gen::inRange(1, 20); count > 0; --count) {
        Field field;
        field.type = static_cast<FieldType>(*rc::gen::inRange(0, 11));
        field.array_length = static_cast<std::uint8_t>(*rc::gen::inRange(0, 12));
        field.offset = static_cast<std::uint8_t>(offset);
        if (offset + field.size() > longest_payload) break;
        offset += field.size();
        fields.push_back(field);
    }
    return fields;
}

Bytes ascii_payload(std::size_t most) {
    const auto length = *rc::gen::inRange<std::size_t>(0, most + 1);
    return *rc::gen::container<Bytes>(length, rc::gen::inRange<std::uint8_t>(0, 0x80));
}

void align(Bytes& body, std::size_t alignment) {
    while (body.size() % alignment != 0) body.push_back(0);
}

Bytes body_by_rule(const std::vector<Field>& fields, const Bytes& payload) {
    Bytes body;
    for (const auto& field : fields) {
        const auto* const from = payload.data() + field.offset;
        align(body, field.is_text() ? 4 : dialect::size_of(field.type));
        if (!field.is_text()) {
            body.insert(body.end(), from, from + field.size());
            continue;
        }
        const auto* const end = std::find(from, from + field.size(), std::uint8_t{0});
        body.insert(body.end(), {static_cast<std::uint8_t>(end - from + 1), 0, 0, 0});
        body.insert(body.end(), from, end);
        body.push_back(0);
    }
    return body;
}

RC_GTEST_PROP(CdrProperty, ABodyFollowsTheRuleOfEachField, ()) {
    const auto fields = any_fields();
    dialect::Message definition;
    definition.fields = fields;
    definition.wire.max_length = static_cast<std::uint8_t>(fields.back().offset + fields.back().size());
    auto payload = ascii_payload(longest_payload);
    const CdrEncoder encoder(definition);
    Bytes out(encoder.max_size() + 64, untouched);

    const auto size = encoder.encode(payload, ByteSpan(out).first(encoder.max_size()));

    RC_ASSERT(size <= encoder.max_size());
    RC_ASSERT(std::all_of(out.begin() + static_cast<std::ptrdiff_t>(encoder.max_size()), out.end(),
                          [](auto byte) { return byte == untouched; }));
    payload.resize(definition.wire.max_length);
    RC_ASSERT(Bytes(out.begin() + 4, out.begin() + static_cast<std::ptrdiff_t>(size)) == body_by_rule(fields, payload));
}

// Every byte may be one that is not UTF-8, which takes the most room.
RC_GTEST_PROP(CdrProperty, NothingIsWrittenBeyondTheBound, ()) {
    const auto messages = dialect::default_dialect().messages();
    const auto& definition =
        messages[*rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::size_t>(0, messages.size()))];
    const Bytes payload(*rc::gen::inRange<std::size_t>(0, longest_payload + 1), *rc::gen::arbitrary<std::uint8_t>());
    const CdrEncoder encoder(definition);
    Bytes out(encoder.max_size() + 64, untouched);

    const auto size = encoder.encode(payload, ByteSpan(out).first(encoder.max_size()));

    RC_ASSERT(size <= encoder.max_size());
    RC_ASSERT(std::all_of(out.begin() + static_cast<std::ptrdiff_t>(size), out.end(),
                          [](auto byte) { return byte == untouched; }));
}

}  // namespace
}  // namespace mavloom::message
