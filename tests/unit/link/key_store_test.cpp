// SPDX-License-Identifier: MIT
#include "link/signing/key_store.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <fstream>

#include "link/core/core.hpp"
#include "link/signing/signature.hpp"
#include "support/golden_frames.hpp"
#include "support/temp_dir.hpp"

namespace mavloom::link::detail {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Bytes = std::vector<std::uint8_t>;
using Stream = wire::Verifier::Stream;

constexpr std::string_view two_senders =
    "mavloom signing times 1\nsigned 123456789\nheard 0 1 1 1000\nheard 3 255 190 281474976710655\n";

std::string content(const std::filesystem::path& path) {
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), {}};
}

// Of the key in SetUp: the first 8 bytes of hashlib.sha256(b"mavloom: which signing key" + b"\xaa" * 32), as a
// little-endian number.
constexpr std::string_view key_line = "key 9383837124702055004\n";

class SigningTimes : public ::testing::Test {
protected:
    test::TempDir dir;
    std::filesystem::path key = dir.path() / "link.key", file = dir.path() / "link.key.state";
    std::vector<std::string> notices;

    void SetUp() override { write(key, std::string(64, 'a')); }
    static void write(const std::filesystem::path& path, std::string_view text) {
        std::ofstream(path) << text;
        ::chmod(path.c_str(), 0600);
    }
    [[nodiscard]] endpoint::EndpointOptions options(bool sign, bool verify) const {
        endpoint::EndpointOptions o;
        if (sign) o.sign_key_file = key.string();
        if (verify) o.verify_key_file = key.string();
        return o;
    }
};

TEST(KeyState, IsTextAndBack) {
    const auto state = parse_key_state(two_senders);

    ASSERT_TRUE(state);
    EXPECT_EQ(state->last_signed.ticks, 123456789u);
    ASSERT_EQ(state->heard.size(), 2u);
    EXPECT_EQ(state->heard[0].key, 0x000101u);
    EXPECT_EQ(state->heard[1].key, 0x03FFBEu);
    EXPECT_EQ(state->heard[1].last.ticks, 281474976710655u);
    EXPECT_EQ(text_of(*state), two_senders);
}

TEST(KeyState, WhatIsNoneOfOursIsRefused) {
    for (const std::string_view text :
         {"", "x", "mavloom signing times 2\n", "mavloom signing times 1\nsigned\n",
          "mavloom signing times 1\nsigned -1\n", "mavloom signing times 1\nsigned 281474976710656\n",
          "mavloom signing times 1\nsigned 1 1\n", "mavloom signing times 1\nheard 256 1 1 1\n",
          "mavloom signing times 1\nheard 1 1 1\n", "mavloom signing times 1\nheard 1 1 1 1 1\n",
          "mavloom signing times 1\nfelt 1 1 1 1\n", "mavloom signing times 1\n\n"})
        EXPECT_FALSE(parse_key_state(text)) << text;
}

TEST(KeyState, KeepsTheLaterOfTwoTimes) {
    KeyState state;

    EXPECT_TRUE(state.merge_heard(std::array{Stream{5, {10}}, Stream{2, {20}}}));
    EXPECT_FALSE(state.merge_heard(std::array{Stream{5, {9}}}));
    EXPECT_TRUE(state.merge_heard(std::array{Stream{5, {11}}}));
    EXPECT_EQ(text_of(state), "mavloom signing times 1\nsigned 0\nheard 0 0 2 20\nheard 0 0 5 11\n");
}

TEST(KeyState, HoldsAsManySendersAsAVerifier) {
    KeyState state;
    for (std::uint32_t n = 0; n < wire::Verifier::max_streams + 10; ++n) state.merge_heard(std::array{Stream{n, {1}}});

    EXPECT_EQ(state.heard.size(), wire::Verifier::max_streams);
}

TEST_F(SigningTimes, ANewKeyHasAFileForItsOwnerOnly) {
    KeyStore states;
    (void)states.open(key, *wire::SigningKey::load(key), notices);

    struct stat status {};
    ASSERT_EQ(::stat(file.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777u, 0600u);
    EXPECT_EQ(content(file), fmt::format("mavloom signing times 1\nsigned 0\n{}", key_line));
    EXPECT_THAT(notices, IsEmpty());
}

TEST_F(SigningTimes, SigningBeginsBehindTheLastTimeOfTheFile) {
    const auto future = wire::SigningTime::from(wall_now()).ticks + 3600 * 100'000ull;
    write(file, "mavloom signing times 1\nsigned " + std::to_string(future) + "\n");
    KeyStore states;
    const auto signature = Signature::load(options(true, false), 0, states, notices);

    ASSERT_TRUE(signature);
    const auto state = parse_key_state(content(file));
    ASSERT_TRUE(state);
    EXPECT_EQ(state->last_signed.ticks, future + KeyStore::reserve_ticks);
    EXPECT_THAT(notices, ElementsAre(HasSubstr("s ahead of the clock")));
}

TEST_F(SigningTimes, AKeyWhoseTimesAreUsedUpSignsNoMoreAndKeepsItsFile) {
    const std::string text = "mavloom signing times 1\nsigned 281474976710655\n";  // 2^48 - 1
    write(file, text);
    {
        KeyStore states;
        const auto signature = Signature::load(options(true, false), 0, states, notices);

        ASSERT_FALSE(signature);
        EXPECT_THAT(signature.error().text, HasSubstr("are used up; create a new key"));
    }
    const auto state = parse_key_state(content(file));
    ASSERT_TRUE(state);
    EXPECT_EQ(state->last_signed.ticks, 281474976710655u);
}

TEST_F(SigningTimes, AtTheEndTheFileIsExact) {
    const auto future = wire::SigningTime::from(wall_now()).ticks + 3600 * 100'000ull;
    write(file, "mavloom signing times 1\nsigned " + std::to_string(future) + "\n");
    {
        KeyStore states;
        const auto signature = Signature::load(options(true, true), 0, states, notices);
        ASSERT_TRUE(signature);
    }

    EXPECT_EQ(content(file), fmt::format("mavloom signing times 1\nsigned {}\n{}", future, key_line));
}

TEST_F(SigningTimes, WhatAnotherProgramWroteMeanwhileIsKept) {
    {
        KeyStore states;
        const auto mine = states.open(key, *wire::SigningKey::load(key), notices);
        write(file, two_senders);
        mine->state.merge_heard(std::array{Stream{0x000101, {2000}}, Stream{7, {5}}});
    }

    EXPECT_EQ(content(file),
              fmt::format("mavloom signing times 1\nsigned 123456789\n{}heard 0 0 7 5\nheard 0 1 1 2000\n"
                          "heard 3 255 190 281474976710655\n",
                          key_line));
}

TEST_F(SigningTimes, EndpointsWithOneKeyShareItsTimes) {
    KeyStore states;

    EXPECT_EQ(states.open(key, *wire::SigningKey::load(key), notices),
              states.open(key, *wire::SigningKey::load(key), notices));
}

TEST_F(SigningTimes, AnotherKeyInTheFileHasHeardNobody) {
    write(file, fmt::format("mavloom signing times 1\nsigned 123456789\n{}heard 0 1 1 1000\n", key_line));
    KeyStore states;
    const auto times = states.open(key, *wire::SigningKey::load(key), notices);
    EXPECT_THAT(times->state.heard, ::testing::SizeIs(1));
    write(key, std::string(64, 'b'));
    const auto again = states.open(key, *wire::SigningKey::load(key), notices);

    EXPECT_EQ(again, times);
    EXPECT_THAT(again->state.heard, IsEmpty());
    EXPECT_EQ(again->state.last_signed.ticks, 123456789u);
    EXPECT_TRUE(again->changed);
    (void)again->write(again->state);
    EXPECT_THAT(content(file), ::testing::Not(HasSubstr("heard")));  // neither what the file held
}

TEST_F(SigningTimes, APipeInPlaceOfTheFileIsReportedAndDelaysNobody) {
    ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
    KeyStore states;
    (void)states.open(key, *wire::SigningKey::load(key), notices);

    EXPECT_THAT(notices, ElementsAre(HasSubstr("link.key.state is not a regular file")));
}

TEST_F(SigningTimes, ABrokenFileIsReportedAndStartsOver) {
    write(file, "nonsense");
    KeyStore states;
    (void)states.open(key, *wire::SigningKey::load(key), notices);

    EXPECT_THAT(notices, ElementsAre(HasSubstr("link.key.state does not contain signing times")));
    EXPECT_EQ(content(file), fmt::format("mavloom signing times 1\nsigned 0\n{}", key_line));
}

TEST_F(SigningTimes, AFileThatCannotBeWrittenIsReportedAndNotFatal) {
    std::filesystem::create_directory(file);
    KeyStore states;
    const auto signature = Signature::load(options(true, true), 0, states, notices);

    ASSERT_TRUE(signature);
    EXPECT_THAT(notices, ::testing::Contains(HasSubstr("cannot write ")));
    EXPECT_THAT(std::vector<std::filesystem::path>(std::filesystem::directory_iterator(dir.path()), {}),
                ::testing::SizeIs(2));
}

TEST_F(SigningTimes, WhatIsNewIsWrittenWhileItRuns) {
    KeyStore states;
    const auto mine = states.open(key, *wire::SigningKey::load(key), notices);
    EXPECT_NE(states.due(), MonoTime::max());
    mine->state.merge_heard(std::array{Stream{7, {5}}});
    mine->changed = true;
    const auto now = states.due();
    states.save(now, notices);

    EXPECT_EQ(states.due(), now + KeyStore::save_interval);
    const auto deadline = mono_now() + std::chrono::seconds(60);
    const auto expected = fmt::format("mavloom signing times 1\nsigned 0\n{}heard 0 0 7 5\n", key_line);
    while (content(file) != expected && mono_now() < deadline) std::this_thread::yield();
    EXPECT_EQ(content(file), expected);
}

// Signed by pymavlink with the key of SetUp, at 500,000,000 s after 2015, one second later, and two seconds later.
const std::array signed_in_turn{
    test::hex("fd090100000101000000000000000203000403ad2f0000203d88792dcb8d7240623f"),
    test::hex("fd090100010101000000000000000203000403bda100a0a63e88792d95625c163a12"),
    test::hex("fd0901000201010000000000000002030004039c3b00402d4088792d328a82fa5632"),
};

// A frame that one endpoint has heard arrives on another. A sender without the key may have sent it there.
class RepeatedFrames : public SigningTimes {
protected:
    [[nodiscard]] std::unique_ptr<Signature> endpoint(std::string group) {
        auto wanted = options(false, true);
        wanted.group = std::move(group);
        return *Signature::load(wanted, 0, states, notices);
    }
    static bool accepts(const std::unique_ptr<Signature>& signature, std::size_t n, MonoTime at = begin) {
        return signature->accepts(wire::FrameView::unchecked(signed_in_turn[n]), now, at);
    }

    // On an endpoint without verify=.
    void hear(std::size_t n, MonoTime at = begin) {
        states.note_heard(wire::FrameView::unchecked(signed_in_turn[n]), now, at);
    }

    static constexpr WallTime now{std::chrono::seconds{1'420'070'400 + 500'000'000}};
    static constexpr MonoTime begin{std::chrono::hours{1}};
    KeyStore states;
};

TEST_F(RepeatedFrames, DifferFromFirstArrivals) {
    const auto first = endpoint("radios"), second = endpoint("radios");

    EXPECT_TRUE(accepts(first, 0) && !first->is_repeated());
    EXPECT_TRUE(accepts(second, 0) && second->is_repeated());
    EXPECT_TRUE(accepts(second, 1) && !second->is_repeated());
    EXPECT_TRUE(accepts(first, 1) && first->is_repeated());
}

TEST_F(RepeatedFrames, AreNoProofOfAPeer) {
    const auto first = endpoint("radios"), second = endpoint("radios");

    EXPECT_TRUE(accepts(first, 0));
    EXPECT_FALSE(second->accepts_early(wire::FrameView::unchecked(signed_in_turn[0]), now, begin));
    EXPECT_TRUE(second->accepts_early(wire::FrameView::unchecked(signed_in_turn[1]), now, begin));
}

TEST_F(RepeatedFrames, AreKnownFromEndpointsOutsideTheGroup) {
    const auto outside = endpoint(""), inside = endpoint("radios");

    EXPECT_TRUE(accepts(inside, 0) && !inside->is_repeated());
    EXPECT_TRUE(accepts(outside, 1));
    EXPECT_TRUE(accepts(inside, 1) && inside->is_repeated());
}

TEST_F(RepeatedFrames, AreKnownFromEndpointsThatDoNotVerify) {
    const auto verified = endpoint("");

    hear(0);
    EXPECT_TRUE(accepts(verified, 0) && verified->is_repeated());
}

TEST_F(RepeatedFrames, AreRefusedWhenTheyComeLate) {
    const auto verified = endpoint("");
    const MonoTime late = begin + std::chrono::seconds{10};

    hear(1);
    hear(2, begin + std::chrono::seconds{1});
    EXPECT_FALSE(accepts(verified, 1, late) || accepts(verified, 2, late));
}

// The table holds 65,536 signatures.
TEST_F(RepeatedFrames, ThatAreOldPushOutNoNewOne) {
    const auto verified = endpoint("");
    wire::Signer signer(*wire::SigningKey::load(key), 0);
    test::Bytes old(signed_in_turn[0]);
    old[5] = 2;  // the system
    const std::size_t unsigned_length = old.size() - wire::signature_length;

    hear(0);
    for (int i = 0; i < 70'000; ++i) {
        (void)signer.sign(old, unsigned_length, wire::SigningTime::from(now - std::chrono::hours{24}));
        states.note_heard(wire::FrameView::unchecked(old), now, begin);
    }
    EXPECT_TRUE(accepts(verified, 0) && verified->is_repeated());
}

TEST_F(RepeatedFrames, AreForgottenWhenAForgedOneFollows) {
    const auto verified = endpoint("");
    hear(0);
    auto forged = signed_in_turn[1];
    forged.back() ^= 1;

    EXPECT_TRUE(accepts(verified, 0) && verified->is_repeated());
    EXPECT_FALSE(verified->accepts(wire::FrameView::unchecked(forged), now, begin) || verified->is_repeated());
}

TEST_F(RepeatedFrames, AreNotThoseThatOnlyLookSigned) {
    const auto verified = endpoint("");
    auto forged = signed_in_turn[0];
    forged.back() ^= 1;

    states.note_heard(wire::FrameView::unchecked(forged), now, begin);
    EXPECT_TRUE(accepts(verified, 0) && !verified->is_repeated());
}

// The second link's own verifier has seen nothing, so only what the group heard states that the frame is old.
TEST_F(RepeatedFrames, InAGroupThatCameLongAgoAreNotTakenFromAnotherLink) {
    const auto first = endpoint("radios"), second = endpoint("radios");

    EXPECT_TRUE(accepts(first, 0));
    EXPECT_TRUE(accepts(second, 0));
    EXPECT_TRUE(accepts(first, 1, begin + SeenSignatures::step));
    EXPECT_TRUE(accepts(first, 2, begin + 2 * SeenSignatures::step));
    EXPECT_FALSE(accepts(second, 1, begin + 3 * SeenSignatures::step));
    EXPECT_TRUE(accepts(second, 2, begin + 3 * SeenSignatures::step));
}

// A program with endpoints that sign and verify with one key. Their link ids are 255, 254 and so on.
struct SigningProgram {
    KeyStore states;
    std::vector<std::unique_ptr<Signature>> endpoints;
    wire::MessageTable table{test::golden_messages};

    SigningProgram(const endpoint::EndpointOptions& options, int count, std::vector<std::string>& notices) {
        for (int i = 0; i < count; ++i)
            endpoints.push_back(*Signature::load(options, static_cast<std::uint8_t>(255 - i), states, notices));
    }
    [[nodiscard]] Bytes sign(std::size_t endpoint, WallTime now) {
        const auto frame = endpoints[endpoint]->sign(wire::FrameView::unchecked(test::heartbeat_v2), table, now);
        return {frame.bytes().begin(), frame.bytes().end()};
    }
    [[nodiscard]] bool accepts(std::size_t endpoint, const Bytes& frame, WallTime now) {
        return endpoints[endpoint]->accepts(wire::FrameView::unchecked(frame), now, MonoTime{std::chrono::hours{1}});
    }
};

// Everybody who saw it can send it back.
TEST_F(SigningTimes, WhatTheProgramSignedItselfIsNotAccepted) {
    const WallTime now = wall_now() + std::chrono::seconds{1};
    SigningProgram program(options(true, true), 2, notices);
    const Bytes seen = program.sign(0, now);

    EXPECT_FALSE(program.accepts(0, seen, now));
    EXPECT_FALSE(program.accepts(1, seen, now));
    for (int i = 0; i < 200'000; ++i) (void)program.sign(1, now);
    EXPECT_FALSE(program.accepts(0, seen, now));
    EXPECT_FALSE(program.accepts(1, program.sign(0, now), now));
}

TEST_F(SigningTimes, WhatAnEarlierRunSignedIsNotAccepted) {
    const WallTime begin = wall_now();
    const Bytes seen = SigningProgram(options(true, true), 1, notices).sign(0, begin);
    SigningProgram program(options(true, true), 1, notices);

    EXPECT_FALSE(program.accepts(0, seen, begin));
}

// Two routers in a row choose the same link ids.
TEST_F(SigningTimes, WhatAnotherProgramSignedWithTheSameLinkIdIsAccepted) {
    const WallTime now = wall_now() + std::chrono::seconds{1};
    SigningProgram program(options(true, true), 1, notices);
    key = dir.path() / "copy.key";
    write(key, std::string(64, 'a'));
    SigningProgram other(options(true, true), 1, notices);

    for (int i = 0; i < 1000; ++i) {
        const Bytes from_other = other.sign(0, now);
        (void)program.sign(0, now + std::chrono::seconds{2});
        EXPECT_TRUE(program.accepts(0, from_other, now));
        EXPECT_TRUE(other.accepts(0, program.sign(0, now), now));
    }
}

TEST(KeyStore, WithoutAKeyThereIsNothingToDo) { EXPECT_EQ(KeyStore().due(), MonoTime::max()); }

}  // namespace
}  // namespace mavloom::link::detail
