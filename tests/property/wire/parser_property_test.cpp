// SPDX-License-Identifier: MIT
// What holds for every input: chunking changes nothing; garbage costs no frame that it does not overlap; every byte is
// counted once; a frame that is written is found with the same content.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "mavloom/wire/datagram_parser.hpp"
#include "mavloom/wire/frame_writer.hpp"
#include "mavloom/wire/stream_parser.hpp"
#include "support/golden_frames.hpp"
#include "support/parse_log.hpp"
#include "support/seed.hpp"

namespace mavloom::wire {

using test::Bytes;

namespace {

const MessageTable table{test::golden_messages};

const std::vector<Bytes> good_frames{test::heartbeat_v2,   test::heartbeat_v1, test::heartbeat_signed_1,
                                     test::attitude_v2,    test::attitude_v1,  test::ping_zero_v2,
                                     test::command_ack_v2, test::tunnel_v2};

// Bytes as a bad line has them: whole frames, damaged and cut ones, start bytes, noise.
rc::Gen<Bytes> line_noise() {
    const auto frame = rc::gen::elementOf(good_frames);
    const auto cut = rc::gen::mapcat(frame, [](Bytes f) {
        return rc::gen::map(rc::gen::inRange<std::size_t>(0, f.size()),
                            [f](std::size_t n) { return Bytes(f.begin(), f.begin() + static_cast<std::ptrdiff_t>(n)); });
    });
    const auto damaged = rc::gen::mapcat(frame, [](Bytes f) {
        return rc::gen::map(
            rc::gen::pair(rc::gen::inRange<std::size_t>(0, f.size()), rc::gen::arbitrary<std::uint8_t>()),
            [f](std::pair<std::size_t, std::uint8_t> change) {
                auto g = f;
                g[change.first] = change.second;
                return g;
            });
    });
    const auto noise = rc::gen::container<Bytes>(
        rc::gen::oneOf(rc::gen::arbitrary<std::uint8_t>(), rc::gen::element(stx_v1, stx_v2)));
    const auto pieces = rc::gen::container<std::vector<Bytes>>(rc::gen::oneOf(frame, frame, frame, cut, damaged, noise));
    return rc::gen::map(pieces, [](const std::vector<Bytes>& all) {
        Bytes joined;
        for (const auto& piece : all) joined.insert(joined.end(), piece.begin(), piece.end());
        return joined;
    });
}

// Noise that cannot begin a frame, so that the frames between it are certain.
rc::Gen<Bytes> quiet_noise() {
    return rc::gen::container<Bytes>(rc::gen::suchThat(rc::gen::arbitrary<std::uint8_t>(),
                                                       [](std::uint8_t b) { return b != stx_v1 && b != stx_v2; }));
}

}  // namespace

RC_GTEST_PROP(StreamParserProperty, AnyChunkingGivesTheSameEvents, ()) {
    const auto bytes = *line_noise();
    StreamParser whole{table}, chunked{table};
    test::ParseLog expected, actual;

    whole.feed(bytes, MonoTime{}, expected);
    whole.finish(expected);
    for (std::size_t at = 0; at < bytes.size();) {
        const auto size = std::min(*rc::gen::inRange<std::size_t>(1, 400), bytes.size() - at);
        chunked.feed(ByteView{bytes}.subspan(at, size), MonoTime{}, actual);
        at += size;
    }
    chunked.finish(actual);

    RC_ASSERT(actual.events == expected.events);
    RC_ASSERT(actual.frames == expected.frames);
}

// With one definition only most frames are of unknown id: what was learned of them must not depend on where chunks end
// either.
RC_GTEST_PROP(StreamParserProperty, AnyChunkingGivesTheSameEventsForUnknownIds, ()) {
    const MessageTable only_heartbeat{std::span(test::golden_messages).first(1)};
    Bytes bytes;
    FrameBuffer buffer;
    for (int i = *rc::gen::inRange(1, 60); i > 0; --i) {
        const auto extra = static_cast<std::uint8_t>(*rc::gen::element(7, 7, 7, 9));
        const bool known = *rc::gen::inRange(0, 3) == 0;
        const MessageInfo info{known ? MessageId{0} : MessageId{9'999'999}, known ? std::uint8_t{50} : extra, 4, 4};
        const auto frame = write_frame(buffer, {Version::v2, 0, {SystemId{1}, ComponentId{1}}, 0}, info,
                                       test::hex("01020304"));
        bytes.insert(bytes.end(), frame.bytes().begin(), frame.bytes().end());
        if (*rc::gen::inRange(0, 10) == 0) bytes.push_back(*rc::gen::arbitrary<std::uint8_t>());
    }
    StreamParser whole{only_heartbeat}, chunked{only_heartbeat};
    test::ParseLog expected, actual;

    whole.feed(bytes, MonoTime{}, expected);
    whole.finish(expected);
    for (std::size_t at = 0; at < bytes.size();) {
        const auto size = std::min(*rc::gen::inRange<std::size_t>(1, 40), bytes.size() - at);
        chunked.feed(ByteView{bytes}.subspan(at, size), MonoTime{}, actual);
        at += size;
    }
    chunked.finish(actual);

    RC_ASSERT(actual.events == expected.events);
}

RC_GTEST_PROP(StreamParserProperty, EveryByteIsCountedOnce, ()) {
    const auto bytes = *line_noise();
    StreamParser sut{table};
    test::ParseLog log;

    sut.feed(bytes, MonoTime{}, log);

    const auto& c = sut.counters();
    RC_ASSERT(c.frame_bytes.value() + c.flagged_bytes.value() + c.junk_bytes.value() + sut.pending_bytes() ==
              bytes.size());
}

RC_GTEST_PROP(StreamParserProperty, GarbageLosesNoFrameItDoesNotOverlap, ()) {
    Bytes bytes;
    std::vector<Bytes> sent;
    for (int i = *rc::gen::inRange(1, 20); i > 0; --i) {
        const auto noise = *quiet_noise();
        sent.push_back(*rc::gen::elementOf(good_frames));
        bytes.insert(bytes.end(), noise.begin(), noise.end());
        bytes.insert(bytes.end(), sent.back().begin(), sent.back().end());
    }
    StreamParser sut{table};
    test::ParseLog log;

    sut.feed(bytes, MonoTime{}, log);

    RC_ASSERT(log.frames == sent);
}

// A damaged frame takes none of its intact neighbours with it. (Bytes that the damage turns into a false start may
// claim a neighbour's bytes, but the scan continues behind that start.)
RC_GTEST_PROP(DatagramParserProperty, DamageStaysWithTheDamagedFrame, ()) {
    const auto before = *rc::gen::elementOf(good_frames);
    const auto after = *rc::gen::elementOf(good_frames);
    auto damaged = test::attitude_v1;
    const auto at = *rc::gen::inRange<std::size_t>(0, damaged.size());
    damaged[at] = static_cast<std::uint8_t>(damaged[at] ^ *rc::gen::inRange(1, 256));
    DatagramParser sut{table};
    test::ParseLog log;

    sut.parse(test::join({before, damaged, after}), log);

    RC_ASSERT(std::ranges::find(log.frames, before) != log.frames.end());
    RC_ASSERT(std::ranges::find(log.frames, after) != log.frames.end());
}

RC_GTEST_PROP(FrameWriterProperty, WhatIsWrittenIsFoundAgain, ()) {
    const auto info = *rc::gen::elementOf(std::vector(test::golden_messages.begin(), test::golden_messages.end()));
    const auto payload = *rc::gen::container<Bytes>(
        info.max_length, rc::gen::oneOf(rc::gen::just<std::uint8_t>(0), rc::gen::arbitrary<std::uint8_t>()));
    const FrameHeader header{
        *rc::gen::element(Version::v2, Version::v1),
        *rc::gen::arbitrary<std::uint8_t>(),
        {SystemId{*rc::gen::arbitrary<std::uint8_t>()}, ComponentId{*rc::gen::arbitrary<std::uint8_t>()}},
        0};
    RC_PRE(header.version == Version::v2 || fits_v1(info));
    FrameBuffer out;
    DatagramParser parser{table};
    std::vector<Bytes> found;

    const auto written = write_frame(out, header, info, payload);
    parser.parse(written.bytes(), [&](const ParseEvent& event) {
        RC_ASSERT(event.kind == ParseEvent::Kind::frame);
        RC_ASSERT(event.info->id == info.id);
        RC_ASSERT(event.frame.source() == header.source);
        RC_ASSERT(event.frame.sequence() == header.sequence);
        auto received = test::copy(event.frame.payload());
        received.resize(header.version == Version::v1 ? info.min_length : info.max_length);
        found.push_back(received);
    });

    const auto sent = Bytes(payload.begin(),
                            payload.begin() + (header.version == Version::v1 ? info.min_length : info.max_length));
    RC_ASSERT(found == std::vector<Bytes>{sent});
}

// Intact frames that a brute-force search sees, checked against what the parser finds: a frame may only be missing
// where it lies inside another good frame.
RC_GTEST_PROP(DatagramParserProperty, FindsWhatBruteForceFinds, ()) {
    const auto bytes = *line_noise();
    DatagramParser sut{table};
    std::vector<std::pair<std::size_t, std::size_t>> found;  // begin, end
    sut.parse(bytes, [&](const ParseEvent& event) {
        if (event.kind != ParseEvent::Kind::frame && event.kind != ParseEvent::Kind::unknown_flags) return;
        const auto begin = static_cast<std::size_t>(event.frame.bytes().data() - bytes.data());
        found.emplace_back(begin, begin + event.frame.size());
    });

    for (const auto& frame : good_frames) {
        for (auto it = bytes.begin(); (it = std::search(it, bytes.end(), frame.begin(), frame.end())) != bytes.end();
             ++it) {
            const auto begin = static_cast<std::size_t>(it - bytes.begin());
            RC_ASSERT(std::ranges::any_of(found, [&](const auto& f) { return f.first <= begin && begin < f.second; }));
        }
    }
}

}  // namespace mavloom::wire
