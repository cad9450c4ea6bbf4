// SPDX-License-Identifier: MIT
#include "mavloom/wire/crc.hpp"

#include <gtest/gtest.h>

#include <set>

#include "support/golden_frames.hpp"

namespace mavloom::wire {

using test::Bytes;

TEST(Crc, GivesTheCatalogueCheckValue) {
    const std::string_view digits = "123456789";
    const ByteView bytes{reinterpret_cast<const std::uint8_t*>(digits.data()), digits.size()};

    for (const auto& form : crc_implementations())
        EXPECT_EQ(form.update(crc_seed, bytes.data(), bytes.size()), 0x6f91) << form.name;
}

TEST(Crc, OfNothingIsTheSeed) { EXPECT_EQ(crc_update(crc_seed, ByteView{}), 0xffff); }

TEST(Crc, AgreesWithFramesOfPymavlink) {
    const auto covered = ByteView{test::tunnel_v2}.subspan(1, test::tunnel_v2.size() - 3);

    for (const auto& form : crc_implementations())
        EXPECT_EQ(crc_update(form.update(crc_seed, covered.data(), covered.size()), std::uint8_t{147}), 0x6615)
            << form.name;
}

// All lengths that a frame can have, at every alignment: the fast form against byte by byte.
TEST(Crc, AllFormsAgreeByteByByteAtEveryLength) {
    Bytes bytes(400);
    std::uint32_t state = 12345;
    for (auto& b : bytes) b = static_cast<std::uint8_t>((state = state * 1664525 + 1013904223) >> 24);

    for (std::size_t offset = 0; offset < 17; ++offset) {
        for (std::size_t size = 0; size <= 300; ++size) {
            const auto view = ByteView{bytes}.subspan(offset, size);
            std::uint16_t plain = static_cast<std::uint16_t>(size * 257);
            const std::uint16_t seed = plain;
            for (const auto b : view) plain = crc_update(plain, b);
            for (const auto& form : crc_implementations())
                ASSERT_EQ(form.update(seed, view.data(), size), plain) << form.name << ' ' << size;
        }
    }
}

// Each length with just its own bytes readable, and with a whole group of 64 more; a single wrong bit is never
// accepted, neither in CRC_EXTRA nor in the checksum.
TEST(Crc, AllFormsCheckWhatTheByteByByteFormComputes) {
    Bytes bytes(400);
    std::uint32_t state = 54321;
    for (auto& b : bytes) b = static_cast<std::uint8_t>((state = state * 1664525 + 1013904223) >> 24);

    for (std::size_t size = 1; size <= 300; ++size) {
        const auto extra = static_cast<std::uint8_t>(size * 37);
        std::uint16_t plain = crc_seed;
        for (const auto b : ByteView{bytes}.first(size)) plain = crc_update(plain, b);
        const std::uint32_t tail = extra | std::uint32_t{crc_update(plain, extra)} << 8;
        for (const auto& form : crc_implementations()) {
            for (const std::size_t readable : {size, size + 64}) {
                ASSERT_TRUE(form.check(tail, bytes.data(), size, readable)) << form.name << ' ' << size;
                for (unsigned bit = 0; bit < 24; ++bit)
                    ASSERT_FALSE(form.check(tail ^ 1u << bit, bytes.data(), size, readable)) << form.name << ' ' << size;
            }
        }
    }
}

TEST(Crc, BeforeUndoesOneByteForEveryChecksum) {
    for (unsigned crc = 0; crc < 0x10000; ++crc) {
        const auto byte = static_cast<std::uint8_t>(crc * 7 >> 3);
        ASSERT_EQ(crc_before(crc_update(static_cast<std::uint16_t>(crc), byte), byte), crc);
    }
}

TEST(CrcExtra, IsFoundForEveryByteAndOnlyThen) {
    for (unsigned before : {0x0000u, 0x1234u, 0xffffu, 0x80a5u}) {
        std::set<std::uint16_t> reachable;
        for (unsigned extra = 0; extra < 256; ++extra) {
            const auto crc = crc_update(static_cast<std::uint16_t>(before), static_cast<std::uint8_t>(extra));
            reachable.insert(crc);
            EXPECT_EQ(crc_extra_between(static_cast<std::uint16_t>(before), crc), static_cast<int>(extra));
        }
        ASSERT_EQ(reachable.size(), 256u);
        unsigned refused = 0;
        for (unsigned crc = 0; crc < 0x10000; ++crc)
            refused += crc_extra_between(static_cast<std::uint16_t>(before), static_cast<std::uint16_t>(crc)) < 0;
        EXPECT_EQ(refused, 65536u - 256u);
    }
}

}  // namespace mavloom::wire
