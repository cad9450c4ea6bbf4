// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "mavloom/record/tlog_index.hpp"
#include "mavloom/record/tlog_reader.hpp"
#include "mavloom/record/tlog_writer.hpp"
#include "mavloom/wire/frame_writer.hpp"
#include "support/bytes.hpp"
#include "support/golden_table.hpp"
#include "support/seed.hpp"
#include "support/temp_dir.hpp"

namespace mavloom::record {
namespace {

using test::Bytes;
using test::golden_table;
using test::TempDir;

struct Sample {
    std::uint64_t time_us = 0;
    Bytes frame;
    bool operator==(const Sample&) const = default;
};

void showValue(const Sample& sample, std::ostream& out) {
    out << sample.time_us << " us, " << sample.frame.size() << " bytes";
}

rc::Gen<Sample> samples() {
    return rc::gen::map(
        rc::gen::tuple(rc::gen::inRange<std::uint64_t>(0, time_limit_us),
                       rc::gen::inRange<std::size_t>(0, golden_table().messages().size()),
                       rc::gen::arbitrary<std::uint8_t>(), rc::gen::arbitrary<bool>(), rc::gen::arbitrary<Bytes>()),
        [](const auto& parts) {
            const auto& info = golden_table().messages()[std::get<1>(parts)];
            Bytes payload = std::get<4>(parts);
            payload.resize(info.max_length);
            wire::FrameBuffer buffer;
            const bool v1 = std::get<3>(parts) && wire::fits_v1(info);
            const auto frame = wire::write_frame(
                buffer, {v1 ? wire::Version::v1 : wire::Version::v2, std::get<2>(parts), {SystemId{1}, ComponentId{1}}},
                info, payload);
            return Sample{std::get<0>(parts), test::copy(frame.bytes())};
        });
}

std::filesystem::path write_samples(const TempDir& dir, const std::vector<Sample>& recording, std::size_t buffer_bytes) {
    auto writer = TlogWriter::create(dir / "x.tlog", buffer_bytes);
    for (const auto& sample : recording)
        RC_ASSERT(writer->write(wall_from_us(sample.time_us), wire::FrameView::unchecked(sample.frame)).has_value());
    RC_ASSERT(writer->close().has_value());
    return dir / "x.tlog";
}

std::vector<Sample> read_samples(TlogReader& reader) {
    std::vector<Sample> result;
    while (const auto record = reader.next())
        result.push_back({static_cast<std::uint64_t>(unix_us(record->time)), test::copy(record->frame.bytes())});
    return result;
}

RC_GTEST_PROP(Tlog, WhatWasWrittenIsRead, ()) {
    const auto recording = *rc::gen::container<std::vector<Sample>>(samples());
    const TempDir dir;
    const auto path = write_samples(dir, recording, *rc::gen::inRange<std::size_t>(288, 2000));

    auto reader = TlogReader::open(path, golden_table());

    RC_ASSERT(read_samples(*reader) == recording);
    RC_ASSERT(reader->counters().lost_bytes.value() == 0u);
}

auto is_one_of(const std::vector<Sample>& recording) {
    return [&recording](const Sample& sample) { return std::ranges::find(recording, sample) != recording.end(); };
}

// Some bytes are overwritten, taken out or put in. Every record that overlaps none of that is found, in order, and
// every byte is accounted for.
RC_GTEST_PROP(Tlog, DamageLosesOnlyWhatItTouches, ()) {
    const auto recording = *rc::gen::nonEmpty(rc::gen::container<std::vector<Sample>>(samples()));
    const TempDir dir;
    const auto path = write_samples(dir, recording, 300);
    Bytes content = test::content_of(path);
    const auto at = *rc::gen::inRange<std::size_t>(0, content.size());
    const auto taken = std::min(*rc::gen::inRange<std::size_t>(0, 400), content.size() - at);
    const auto put = *rc::gen::container<Bytes>(rc::gen::arbitrary<std::uint8_t>());
    RC_PRE(taken + put.size() > 0);
    std::vector<Sample> intact;
    std::size_t begin = 0;
    for (const auto& sample : recording) {
        const std::size_t end = begin + time_length + sample.frame.size();
        const bool before = end <= at, behind = begin >= at + taken;
        if (before || behind) intact.push_back(sample);
        begin = end;
    }
    const auto place = content.begin() + static_cast<std::ptrdiff_t>(at);
    content.insert(content.erase(place, place + static_cast<std::ptrdiff_t>(taken)), put.begin(), put.end());
    test::write_file(path, content);

    auto reader = TlogReader::open(path, golden_table());
    // The damage may leave a short recording that is all text, which the reader refuses.
    if (!reader) {
        RC_ASSERT(intact.empty());
        return;
    }
    const auto found = read_samples(*reader);

    // Put-in bytes between two records can happen to leave the one around them whole, so more may be found than is
    // certain.
    auto next = found.begin();
    for (const auto& sample : intact) {
        next = std::find(next, found.end(), sample);
        // One damaged record in 65,536 has a good checksum by chance. It may reach into the intact one behind it.
        if (next == found.end() && !std::ranges::all_of(found, is_one_of(recording))) RC_DISCARD("a good checksum");
        RC_ASSERT(next != found.end());
        ++next;
    }
    const auto& counters = reader->counters();
    RC_ASSERT(counters.record_bytes.value() + counters.flagged_bytes.value() + counters.lost_bytes.value() ==
              content.size());
}

// Whether the damaged length of a record reaches the end of another record.
bool swallows_records(const std::vector<Sample>& recording, const Bytes& content) {
    std::vector<std::size_t> begins;
    std::size_t end = 0;
    for (const auto& sample : recording) {
        begins.push_back(end);
        end += time_length + sample.frame.size();
    }
    begins.push_back(end);
    for (std::size_t i = 0; i + 1 < begins.size(); ++i) {
        const auto length = wire::frame_length(ByteView(content).subspan(begins[i] + time_length));
        const auto claimed = begins[i] + time_length + length;
        if (claimed != begins[i + 1] && std::ranges::binary_search(begins, claimed)) return true;
    }
    return false;
}

// `next_of` passes over checksums of other messages, and must still find what a full examination finds.
RC_GTEST_PROP(Tlog, TheRecordsOfOneMessageAreThoseThatAFullExaminationFinds, ()) {
    constexpr std::uint64_t time_us = 1'700'000'000'000'000;
    auto recording = *rc::gen::container<std::vector<Sample>>(2'000, samples());
    for (std::size_t i = 0; i < recording.size(); ++i) recording[i].time_us = time_us + 1000 * i;
    // Few ids, as a flight has them.
    for (std::size_t i = 20; i < recording.size(); ++i) recording[i].frame = recording[i % 20].frame;
    const TempDir dir;
    const auto path = write_samples(dir, recording, 4096);
    auto content = test::content_of(path);
    const auto damage = *rc::gen::container<std::vector<std::pair<std::size_t, std::uint8_t>>>(
        *rc::gen::inRange<std::size_t>(0, 30),
        rc::gen::pair(rc::gen::inRange<std::size_t>(0, content.size()), rc::gen::inRange<std::uint8_t>(1, 255)));
    for (const auto& [at, bits] : damage) content[at] ^= bits;
    if (swallows_records(recording, content)) RC_DISCARD("next_of takes them for one record");
    test::write_file(path, content);
    const auto id = wire::FrameView::unchecked(recording[0].frame).id();

    auto examining = TlogReader::open(path, golden_table());
    std::vector<Sample> expected;
    for (auto& sample : read_samples(*examining))
        if (wire::FrameView::unchecked(sample.frame).id() == id) expected.push_back(std::move(sample));
    auto passing = TlogReader::open(path, golden_table());
    std::vector<Sample> found;
    const auto max_bytes = *rc::gen::element<std::uint64_t>(1, 100, 3000, ~std::uint64_t{0});
    for (;;) {
        const auto record = passing->next_of(id, max_bytes);
        if (record)
            found.push_back({static_cast<std::uint64_t>(unix_us(record->time)), test::copy(record->frame.bytes())});
        else if (record.error() != TlogReader::Stop::damage) break;
    }

    RC_ASSERT(found == expected);
    const auto& counters = passing->counters();
    RC_ASSERT(counters.record_bytes.value() + counters.flagged_bytes.value() + counters.lost_bytes.value() ==
              content.size());
}

RC_GTEST_PROP(TlogIndex, SeeksWhereAWalkFromTheStartWouldStop, ()) {
    auto recording = *rc::gen::container<std::vector<Sample>>(samples());
    for (auto& sample : recording) sample.time_us %= 50;  // many equal times, many steps back
    const TempDir dir;
    auto reader = TlogReader::open(write_samples(dir, recording, 4096), golden_table());
    const auto index = TlogIndex::build(*reader, *rc::gen::inRange<std::uint64_t>(1, 10));
    const auto time_us = *rc::gen::inRange<std::uint64_t>(0, 60);

    RC_ASSERT(index->seek(*reader, wall_from_us(time_us)).has_value());
    const auto found = read_samples(*reader);

    const auto expected = std::find_if(recording.begin(), recording.end(),
                                       [&](const Sample& s) { return s.time_us >= time_us; });
    RC_ASSERT(found == std::vector<Sample>(expected, recording.end()));
}

}  // namespace
}  // namespace mavloom::record
