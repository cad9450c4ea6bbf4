// SPDX-License-Identifier: MIT
// Names and ids are MAVLink's; offsets of instance fields are worked out by hand from the definitions' wire order.
#include "link/core/queue_rules.hpp"

#include <gtest/gtest.h>

#include "mavloom/wire/frame_writer.hpp"

namespace mavloom::link {
namespace {

const QueueRules& rules() {
    static const QueueRules it(dialect::default_dialect());
    return it;
}

std::uint8_t class_of(std::uint32_t id) { return rules().of(MessageId{id}).block_class; }
bool replaceable(std::uint32_t id) { return rules().of(MessageId{id}).replaceable; }

std::uint64_t key_of(std::uint32_t id, std::size_t at, std::string_view text, std::uint8_t component = 1) {
    std::vector<std::uint8_t> payload(255);
    std::copy(text.begin(), text.end(), payload.begin() + static_cast<std::ptrdiff_t>(at));
    const dialect::Message* message = dialect::default_dialect().find(MessageId{id});
    wire::FrameBuffer buffer;
    const wire::FrameHeader header{wire::Version::v2, 0, {SystemId{1}, ComponentId{component}}};
    const auto frame = wire::write_frame(buffer, header, message->wire,
                                         ByteView(payload).first(message->wire.max_length));
    return QueueRules::key(frame, rules().of(MessageId{id}));
}

TEST(QueueRules, ByTheProtocolTheyServe) {
    for (const std::uint32_t id : {0u, 22u, 47u, 73u, 76u, 77u, 253u, 322u}) EXPECT_EQ(class_of(id), 0) << id;
    for (const std::uint32_t id : {4u, 69u, 110u, 385u})
        EXPECT_EQ(class_of(id), 1) << id;  // PING, MANUAL_CONTROL, FTP, TUNNEL
    for (const std::uint32_t id : {30u, 33u, 131u, 147u, 233u, 12345678u}) EXPECT_EQ(class_of(id), 2) << id;
}

TEST(QueueRules, PiecesAndUnknownIdsAreNeverReplaced) {
    for (const std::uint32_t id : {30u, 33u, 147u}) EXPECT_TRUE(replaceable(id)) << id;
    for (const std::uint32_t id : {0u, 76u, 120u, 131u, 233u, 246u, 385u, 410u, 12345678u})
        EXPECT_FALSE(replaceable(id)) << id;
    EXPECT_EQ(key_of(131, 0, "x"), 0u);
}

TEST(QueueRules, TheKeyContainsSourceMessageAndInstance) {
    EXPECT_EQ(key_of(30, 0, "a"), key_of(30, 0, "b")) << "another value of ATTITUDE is the same thing";
    EXPECT_NE(key_of(30, 0, "a"), key_of(33, 0, "a"));
    EXPECT_NE(key_of(30, 0, "a", 1), key_of(30, 0, "a", 2));
    // BATTERY_STATUS: 4 + 4 + 2 + 20 + 2 bytes lie before `id`.
    EXPECT_NE(key_of(147, 32, "\x01"), key_of(147, 32, "\x02"));
    EXPECT_EQ(key_of(147, 0, "a"), key_of(147, 0, "b"));
    // NAMED_VALUE_FLOAT: time and value, then the name.
    EXPECT_NE(key_of(251, 8, "speed"), key_of(251, 8, "height"));
    EXPECT_EQ(key_of(251, 8, "speed"), key_of(251, 8, "speed"));
}

}  // namespace
}  // namespace mavloom::link
