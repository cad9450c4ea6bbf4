// SPDX-License-Identifier: MIT
// Messages as frames, times, and the recordings of tests/data.
#pragma once

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "mavloom/observe/inspector.hpp"
#include "mavloom/wire/frame_writer.hpp"

namespace mavloom::observe::testing {

using namespace std::chrono_literals;
using Bytes = std::vector<std::uint8_t>;

inline constexpr Source vehicle{SystemId{1}, ComponentId{1}}, station{SystemId{255}, ComponentId{190}};

template <class Message>
Bytes frame_of(const Message& message, Source source = vehicle) {
    std::array<std::uint8_t, 255> payload{};
    const auto size = message.encode(payload);
    wire::FrameBuffer buffer;
    const auto& info = *dialect::default_dialect().wire_table().find(Message::id);
    const auto frame = wire::write_frame(buffer, {wire::Version::v2, 0, source}, info, ByteView(payload).first(size));
    return {frame.bytes().begin(), frame.bytes().end()};
}
inline wire::FrameView view(const Bytes& bytes) { return wire::FrameView::unchecked(bytes); }

// Both clocks begin at some time, and run alike.
inline WallTime wall(Nanoseconds since_start) { return WallTime{1'700'000'000s + since_start}; }
inline MonoTime mono(Nanoseconds since_start) { return MonoTime{1000s + since_start}; }

struct InspectorTest : ::testing::Test {
    template <class Message>
    const LatestRow* hear(const Message& message, Nanoseconds at = 0s, Source source = vehicle, LinkId link = LinkId{1}) {
        const auto bytes = frame_of(message, source);
        return inspector.add(
            {.frame = view(bytes), .link = link, .link_name = "link", .time = wall(at), .now = mono(at)});
    }
    void tick(Nanoseconds at) { inspector.tick(wall(at), mono(at)); }

    // All records, by the times in them.
    void hear_recording(const std::string& name) {
        std::ifstream file(std::string(MAVLOOM_TEST_DATA "/") + name, std::ios::binary);
        const Bytes all{std::istreambuf_iterator<char>(file), {}};
        for (std::size_t at = 0; at + 8 < all.size();) {
            std::uint64_t time_us = 0;
            for (int i = 0; i < 8; ++i) time_us = time_us << 8 | all[at++];
            const auto size = wire::frame_length(ByteView(all).subspan(at));
            last = wall_from_us(time_us);
            inspector.add({.frame = wire::FrameView::unchecked(ByteView(all).subspan(at, size)),
                           .link = LinkId{1},
                           .link_name = name,
                           .time = last,
                           .now = MonoTime{last.time_since_epoch()}});
            at += size;
        }
    }

    [[nodiscard]] Vehicle the_vehicle(Source source = vehicle) const {
        for (const auto& one : inspector.vehicles(last))
            if (one.source == source) return one;
        return {};
    }
    // "battery warning 1/1: battery at 12 %", and " (ended)"
    [[nodiscard]] std::vector<std::string> alarms() const {
        static constexpr std::array severities{"error", "warning", "info"};
        std::vector<std::string> all;
        for (const auto& one : inspector.alarms())
            all.push_back(fmt::format("{} {} {}/{}: {}{}", name_of(one.kind),
                                      severities[static_cast<std::size_t>(one.severity)], one.source.system.value,
                                      one.source.component.value, one.text, one.ended ? " (ended)" : ""));
        return all;
    }

    WallTime last{};
    Inspector inspector{dialect::default_dialect()};
};

}  // namespace mavloom::observe::testing
