// SPDX-License-Identifier: MIT
#include "mavloom/wire/signing.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "mavloom/wire/frame_writer.hpp"
#include "support/golden_frames.hpp"

namespace mavloom::wire {

using SignatureVerdict = Verifier::Verdict;

namespace {

SigningKey key_from(std::uint8_t first) {
    std::array<std::uint8_t, SigningKey::length> bytes{};
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(first + i);
    return SigningKey(bytes);
}

constexpr std::uint64_t minute = 60 * 100'000;
const SigningTime noon{1'000'000'000'000};

// Signs heartbeats of any source at any time.
struct Sender {
    SigningKey key = key_from(0);
    std::uint8_t link = 1;
    FrameBuffer buffer{};
    FrameView at(SigningTime time, std::uint8_t system = 1) {
        Signer signer(key, link);
        return write_frame(buffer, {Version::v2, 0, {SystemId{system}, ComponentId{1}}, 0}, test::golden_messages[0],
                           test::hex("00000402020c510403"), {&signer, time});
    }
};

class KeyFile : public ::testing::Test {
protected:
    std::filesystem::path path = std::filesystem::temp_directory_path() / ("mavloom-key-" + std::to_string(::getpid()));
    void write(std::string_view text, mode_t mode = 0600) {
        std::ofstream(path) << text;
        ::chmod(path.c_str(), mode);
    }
    void TearDown() override { std::filesystem::remove(path); }
};

}  // namespace

TEST(SigningTime, CountsTicksOfTenMicrosecondsSince2015) {
    EXPECT_EQ(SigningTime::from(wall_from_us(1420070400'000000)).ticks, 0u);
    EXPECT_EQ(SigningTime::from(wall_from_us(1420070400'000010)).ticks, 1u);
    EXPECT_EQ(SigningTime::from(wall_from_us(1420070401'000000)).ticks, 100'000u);
    EXPECT_EQ(SigningTime::from(wall_from_us(0)).ticks, 0u);
}

TEST(Verifier, WhatAnEarlierRunTookIsAReplay) {
    Sender sender;
    Verifier before(sender.key);
    ASSERT_EQ(before.verify(sender.at(noon), noon), SignatureVerdict::good);

    Verifier after(sender.key);
    for (const auto& stream : before.streams()) after.restore(stream);

    EXPECT_EQ(after.verify(sender.at(noon), noon), SignatureVerdict::replay);
    EXPECT_EQ(after.verify(sender.at({noon.ticks + 1}), noon), SignatureVerdict::good);
    EXPECT_EQ(after.newest().ticks, noon.ticks + 1);
}

TEST(Verifier, RestoringNeverGoesBackAndHasABound) {
    Sender sender;
    Verifier verifier(sender.key);
    verifier.restore({0x010101, {noon.ticks + 5}});
    verifier.restore({0x010101, noon});
    EXPECT_EQ(verifier.newest().ticks, noon.ticks + 5);
    for (std::uint32_t key = 0; key < 2 * Verifier::max_streams; ++key) verifier.restore({key, {1}});

    EXPECT_EQ(verifier.streams().size(), Verifier::max_streams);
    EXPECT_TRUE(std::ranges::is_sorted(verifier.streams(), {}, &Verifier::Stream::key));
}

TEST(Verifier, AcceptsPymavlinksSignature) {
    Verifier sut(key_from(0));

    EXPECT_EQ(sut.verify(FrameView::unchecked(test::heartbeat_signed_1), SigningTime{5}), SignatureVerdict::good);
    EXPECT_EQ(sut.verify(FrameView::unchecked(test::heartbeat_signed_late), SigningTime{5}), SignatureVerdict::good);
}

TEST(Verifier, RefusesEveryFlippedBitOfASignedFrame) {
    for (std::size_t bit = 0; bit < test::heartbeat_signed_1.size() * 8; ++bit) {
        const std::size_t byte = bit / 8;
        if (byte < 3) continue;  // start byte, length and flags say where the signature lies
        auto damaged = test::heartbeat_signed_1;
        damaged[byte] = static_cast<std::uint8_t>(damaged[byte] ^ (1u << (bit % 8)));
        Verifier sut(key_from(0));
        ASSERT_EQ(sut.verify(FrameView::unchecked(damaged), SigningTime{5}), SignatureVerdict::bad_signature) << bit;
    }
}

TEST(Verifier, RefusesAnotherKeyAndUnsignedFrames) {
    Verifier sut(key_from(1));

    EXPECT_EQ(sut.verify(FrameView::unchecked(test::heartbeat_signed_1), SigningTime{5}),
              SignatureVerdict::bad_signature);
    EXPECT_EQ(sut.verify(FrameView::unchecked(test::heartbeat_v2), SigningTime{5}), SignatureVerdict::unsigned_frame);
    EXPECT_EQ(sut.verify(FrameView::unchecked(test::heartbeat_v1), SigningTime{5}), SignatureVerdict::unsigned_frame);
}

TEST(Verifier, RefusesAReplay) {
    Verifier sut(key_from(0));
    Sender sender;
    EXPECT_EQ(sut.verify(sender.at(noon), noon), SignatureVerdict::good);

    EXPECT_EQ(sut.verify(sender.at(noon), noon), SignatureVerdict::replay);
    EXPECT_EQ(sut.verify(sender.at({noon.ticks - 1}), noon), SignatureVerdict::replay);
    EXPECT_EQ(sut.verify(sender.at({noon.ticks + 1}), noon), SignatureVerdict::good);
}

TEST(Verifier, KeepsStreamsOfLinksAndSourcesApart) {
    Verifier sut(key_from(0));
    Sender one, other_link{key_from(0), 2};
    EXPECT_EQ(sut.verify(one.at(noon), noon), SignatureVerdict::good);

    EXPECT_EQ(sut.verify(other_link.at(noon), noon), SignatureVerdict::good);
    EXPECT_EQ(sut.verify(one.at(noon, 2), noon), SignatureVerdict::good);
}

TEST(Verifier, LetsANewStreamBeAMinuteBehindAndNoMore) {
    Verifier sut(key_from(0));
    Sender sender;

    EXPECT_EQ(sut.verify(sender.at({noon.ticks - minute - 1}), noon), SignatureVerdict::too_old);
    EXPECT_EQ(sut.verify(sender.at({noon.ticks - minute}), noon), SignatureVerdict::good);
}

// In pymavlink, a forged frame with a future timestamp locks out the true sender.
TEST(Verifier, AForgedFrameFromTheFutureDoesNotLockTheTrueSenderOut) {
    Verifier sut(key_from(0));
    Sender honest, forger{key_from(99)};
    EXPECT_EQ(sut.verify(honest.at(noon), noon), SignatureVerdict::good);

    EXPECT_EQ(sut.verify(forger.at({noon.ticks + 1000 * minute}), noon), SignatureVerdict::bad_signature);
    EXPECT_EQ(sut.verify(forger.at({noon.ticks + 1000 * minute}, 9), noon), SignatureVerdict::bad_signature);

    EXPECT_EQ(sut.verify(honest.at({noon.ticks + 1}), noon), SignatureVerdict::good);
    EXPECT_EQ(sut.newest(), SigningTime{noon.ticks + 1});
}

TEST(Verifier, BoundsItsStreams) {
    Verifier sut(key_from(0));
    Sender sender;
    std::size_t accepted = 0;
    for (unsigned link = 0; link < 8; ++link) {
        sender.link = static_cast<std::uint8_t>(link);
        for (unsigned system = 0; system < 256; ++system)
            accepted += sut.verify(sender.at(noon, static_cast<std::uint8_t>(system)), noon) == SignatureVerdict::good;
    }

    EXPECT_EQ(accepted, Verifier::max_streams);
    sender.link = 0;
    EXPECT_EQ(sut.verify(sender.at({noon.ticks + 1}, 0), noon), SignatureVerdict::good);  // known streams continue
}

TEST(Signer, NeverRepeatsATimeWhenTheClockStands) {
    Signer sut(key_from(0), 1);
    FrameBuffer frame{};
    frame[0] = stx_v2;
    frame[2] = incompat_signed;

    sut.sign(frame, 12, noon);
    EXPECT_EQ(sut.last(), noon);
    sut.sign(frame, 12, noon);
    EXPECT_EQ(sut.last(), SigningTime{noon.ticks + 1});
    sut.sign(frame, 12, SigningTime{5});
    EXPECT_EQ(sut.last(), SigningTime{noon.ticks + 2});
}

TEST_F(KeyFile, LoadsHexadecimalDigits) {
    write("000102030405060708090a0b0c0d0e0f101112131415161718191A1B1C1D1E1F\n");

    const auto key = SigningKey::load(path);

    ASSERT_TRUE(key) << key.error().text;
    EXPECT_EQ(key->bytes(), key_from(0).bytes());
}

TEST_F(KeyFile, RefusesWhatIsNotAKey) {
    for (const auto* text : {"", "00", "zz0102030405060708090a0b0c0d0e0f101112131415161718191a1b1c1d1e1f",
                             "000102030405060708090a0b0c0d0e0f101112131415161718191a1b1c1d1e1f 00",
                             "000102030405060708090a0b0c0d0e0f101112131415161718191a1b1c1d1e1f00"}) {
        write(text);
        const auto key = SigningKey::load(path);
        ASSERT_FALSE(key) << text;
        EXPECT_EQ(key.error().code, SetupCode::bad_input);
        EXPECT_NE(key.error().text.find("64 hexadecimal digits"), std::string::npos) << key.error().text;
    }
}

TEST_F(KeyFile, RefusesAFileThatOthersCanRead) {
    write("000102030405060708090a0b0c0d0e0f101112131415161718191a1b1c1d1e1f", 0644);

    const auto key = SigningKey::load(path);

    ASSERT_FALSE(key);
    EXPECT_EQ(key.error().code, SetupCode::bad_input);
    EXPECT_NE(key.error().text.find("chmod 600"), std::string::npos);
}

TEST_F(KeyFile, RefusesWhatIsNoRegularFileAtOnce) {
    ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);

    const auto fifo = SigningKey::load(path), folder = SigningKey::load(path.parent_path());

    for (const auto* key : {&fifo, &folder}) {
        ASSERT_FALSE(*key);
        EXPECT_EQ(key->error().code, SetupCode::bad_input);
        EXPECT_NE(key->error().text.find("is not a regular file"), std::string::npos) << key->error().text;
    }
}

TEST_F(KeyFile, NamesAMissingFile) {
    const auto key = SigningKey::load("/nonexistent/key");

    ASSERT_FALSE(key);
    EXPECT_EQ(key.error().code, SetupCode::bad_input);
}

}  // namespace mavloom::wire
