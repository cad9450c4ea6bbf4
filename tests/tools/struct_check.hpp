// SPDX-License-Identifier: MIT
// The generated structs against MessageView, which finds fields by the run-time tables: two ways to one layout. Which
// members belong to which names is written by struct_check_generator.cpp from the definitions.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <random>
#include <string_view>
#include <vector>

#include "mavloom/dialect/dialect.hpp"
#include "mavloom/message/view.hpp"

namespace mavloom::test {

// Compares members with the fields of those names. Nothing here is a template but for the forwarding of types: 400
// structs pass through.
class StructCheck {
public:
    explicit StructCheck(const message::MessageView& view) : view_(view) {}

    template <class T>
    void member(std::string_view name, const T& value) {
        compare(name, &value, sizeof(T), 1);
    }
    template <class T, std::size_t n>
    void member(std::string_view name, const std::array<T, n>& values) {
        compare(name, values.data(), sizeof(T), n);
    }
    [[nodiscard]] std::size_t members() const noexcept { return members_; }

private:
    // As bytes, since NaN equals itself then; the machines that run this are little-endian like the wire.
    void compare(std::string_view name, const void* values, std::size_t element_size, std::size_t count) {
        ++members_;
        const auto* field = view_.definition().find(name);
        ASSERT_NE(field, nullptr) << name;
        ASSERT_EQ(field->count(), count) << name;
        ASSERT_EQ(dialect::size_of(field->type), element_size) << name;
        std::array<std::uint8_t, wire::max_payload_length> expected{};
        for (std::size_t i = 0; i < field->size(); ++i) expected[i] = byte_of_view(*field, i);
        EXPECT_EQ(std::memcmp(values, expected.data(), field->size()), 0) << view_.definition().name << "." << name;
    }

    [[nodiscard]] std::uint8_t byte_of_view(const dialect::Field& field, std::size_t i) const {
        const auto size = dialect::size_of(field.type);
        const auto shift = 8 * (i % size);
        switch (size) {
            case 1: return view_.get<std::uint8_t>(field, i);
            case 2: return static_cast<std::uint8_t>(view_.get<std::uint16_t>(field, i / 2) >> shift);
            case 4: return static_cast<std::uint8_t>(view_.get<std::uint32_t>(field, i / 4) >> shift);
            default: return static_cast<std::uint8_t>(view_.get<std::uint64_t>(field, i / 8) >> shift);
        }
    }

    const message::MessageView& view_;
    std::size_t members_ = 0;
};

struct StructFacts {
    std::string_view name;
    wire::MessageInfo wire;
    void (*decode_and_encode)(ByteView payload, StructCheck& check, ByteSpan encoded);
};

// Any bytes, at full length and cut anywhere; encoding gives them back, zero-extended.
inline void check_struct(const StructFacts& facts) {
    const auto* definition = dialect::default_dialect().find(facts.wire.id);
    ASSERT_NE(definition, nullptr) << facts.name;
    EXPECT_EQ(definition->name, facts.name);
    EXPECT_EQ(definition->wire.crc_extra, facts.wire.crc_extra);
    EXPECT_EQ(definition->wire.min_length, facts.wire.min_length);
    ASSERT_EQ(definition->wire.max_length, facts.wire.max_length);
    std::mt19937 random(facts.wire.id.value);  // NOLINT: the same in every run
    std::vector<std::uint8_t> payload(facts.wire.max_length);
    for (std::size_t length = 0; length <= payload.size(); ++length) {
        for (auto& byte : payload) byte = static_cast<std::uint8_t>(random());
        const auto cut = ByteView(payload).first(length);
        const message::MessageView view(*definition, cut);
        StructCheck check(view);
        std::vector<std::uint8_t> encoded(payload.size()), expected(payload);

        facts.decode_and_encode(cut, check, encoded);

        EXPECT_EQ(check.members(), definition->fields.size()) << facts.name;
        std::fill(expected.begin() + static_cast<std::ptrdiff_t>(length), expected.end(), std::uint8_t{0});
        ASSERT_EQ(encoded, expected) << facts.name << " cut to " << length;
    }
}

template <class Struct>
StructFacts facts_of(void (*decode_and_encode)(ByteView, StructCheck&, ByteSpan)) {
    return {Struct::name, {Struct::id, Struct::crc_extra, Struct::min_length, Struct::max_length}, decode_and_encode};
}

}  // namespace mavloom::test
