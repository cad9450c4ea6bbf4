// SPDX-License-Identifier: MIT
#include "mavloom/wire/message_table.hpp"

#include <gtest/gtest.h>

namespace mavloom::wire {

TEST(MessageTable, FindsSmallAndLargeIds) {
    std::vector<MessageInfo> infos;
    for (std::uint32_t id : {0u, 1u, 255u, 1023u, 1024u, 12901u, 65536u, 0xffffffu})
        infos.push_back({MessageId{id}, static_cast<std::uint8_t>(id % 251), 1, 2});
    const MessageTable sut(infos);

    for (const auto& info : infos) {
        const auto* found = sut.find(info.id);
        ASSERT_NE(found, nullptr) << info.id.value;
        EXPECT_EQ(*found, info);
    }
    for (std::uint32_t id : {2u, 1022u, 1025u, 12900u, 0xfffffeu}) EXPECT_EQ(sut.find(MessageId{id}), nullptr) << id;
}

TEST(MessageTable, HoldsThousandsOfIdsThatCollide) {
    std::vector<MessageInfo> infos;
    for (std::uint32_t i = 0; i < 5000; ++i)
        infos.push_back({MessageId{1024 + i * 4096 % 0xff0000 + i}, static_cast<std::uint8_t>(i), 1, 1});
    const MessageTable sut(infos);

    for (const auto& info : infos) ASSERT_NE(sut.find(info.id), nullptr);
}

TEST(MessageTable, KeepsTheFirstOfTwoEqualIds) {
    const std::vector<MessageInfo> infos{
        {MessageId{7}, 1, 1, 1}, {MessageId{7}, 2, 2, 2}, {MessageId{5000}, 3, 1, 1}, {MessageId{5000}, 4, 1, 1}};
    const MessageTable sut(infos);

    EXPECT_EQ(sut.find(MessageId{7})->crc_extra, 1);
    EXPECT_EQ(sut.find(MessageId{5000})->crc_extra, 3);
    EXPECT_EQ(sut.messages().size(), 2u);
}

TEST(MessageTable, OfNothingFindsNothing) {
    const MessageTable sut({});

    EXPECT_EQ(sut.find(MessageId{0}), nullptr);
    EXPECT_EQ(sut.find(MessageId{0xffffff}), nullptr);
}

}  // namespace mavloom::wire
