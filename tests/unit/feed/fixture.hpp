// SPDX-License-Identifier: MIT
// What the tests of the hub and its channels share: numbered frames, reading, descriptors, and waiting for a condition.
#pragma once

#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <map>
#include <memory>
#include <thread>
#include <vector>

#include "mavloom/dialect/dialect.hpp"
#include "mavloom/feed/channel.hpp"
#include "support/eventually.hpp"
#include "support/filter.hpp"
#include "unit/link/fixture.hpp"

namespace mavloom::feed::testing {

using namespace std::chrono_literals;
using link::testing::Bytes;
using link::testing::endpoint_of;
using link::testing::PlainSocket;
using link::testing::view;

inline constexpr std::size_t smallest_buffer = 64 * 1024;
using test::eventually;
using test::long_enough;
using test::make_filter;

// A frame of the default dialect. A short payload is filled with zeros.
inline Bytes frame_of(std::uint32_t id, Bytes payload = {}, Source source = {SystemId{1}, ComponentId{1}}) {
    const auto& info = *dialect::default_dialect().wire_table().find(MessageId{id});
    payload.resize(info.max_length);
    wire::FrameBuffer buffer;
    const auto frame = wire::write_frame(buffer, {wire::Version::v2, 0, source}, info, payload);
    return {frame.bytes().begin(), frame.bytes().end()};
}

inline constexpr std::uint32_t attitude_id = 30;

// An ATTITUDE that holds a number from 1 up and comes from `system`.
inline Bytes numbered(std::uint32_t number, std::uint8_t system = 1) {
    Bytes payload(sizeof number);
    std::memcpy(payload.data(), &number, sizeof number);
    return frame_of(attitude_id, payload, {SystemId{system}, ComponentId{1}});
}
inline std::uint32_t number_of(const wire::FrameView& frame) {
    std::uint32_t number = 0;
    const auto payload = frame.payload();
    std::memcpy(&number, payload.data(), std::min(payload.size(), sizeof number));
    return number;
}

inline std::shared_ptr<const dialect::Dialect> default_dialect() {
    return {std::shared_ptr<void>(), &dialect::default_dialect()};
}
inline std::shared_ptr<Channel> make_channel(std::size_t buffer_bytes = smallest_buffer) {
    return std::make_shared<Channel>(default_dialect(), std::make_shared<LinkNames>(), buffer_bytes, false);
}

inline link::RxFrame received(const Bytes& bytes, LinkId link, WallTime time) {
    link::RxFrame rx;
    rx.frame = view(bytes);
    rx.info = dialect::default_dialect().wire_table().find(rx.frame.id());
    rx.link = link;
    rx.time = time;
    return rx;
}
// As the loop thread does with a frame that it received.
inline void receive(Channel& channel, const Bytes& bytes, LinkId link = LinkId{1}, MonoTime now = {}) {
    channel.on_frame(received(bytes, link, WallTime{1s}), now);
}
inline void receive_numbers(Channel& channel, std::uint32_t first, std::uint32_t last) {
    for (std::uint32_t number = first; number <= last; ++number) receive(channel, numbered(number));
    channel.publish();
}

// All that `reader` has now.
inline std::vector<std::uint32_t> numbers_in(ChannelReader& reader) {
    std::vector<std::uint32_t> numbers;
    FrameBatch batch;
    for (bool more = true; more; batch.clear()) {
        more = reader.take(batch, 256) && batch.size() != 0;
        while (const auto* item = batch.next()) numbers.push_back(number_of(batch.frame(*item)));
    }
    return numbers;
}
inline std::vector<std::uint32_t> from_to(std::uint32_t first, std::uint32_t last) {
    std::vector<std::uint32_t> numbers;
    for (auto number = first; number <= last; ++number) numbers.push_back(number);
    return numbers;
}

// Whether the descriptor becomes readable. A test that expects no passes no time.
inline bool is_readable(int fd, std::chrono::milliseconds within = 0ms) {
    pollfd wanted{fd, POLLIN, 0};
    return ::poll(&wanted, 1, static_cast<int>(within.count())) == 1;
}
// Reads an eventfd empty. Returns how often it was signalled since the last time.
inline std::uint64_t read_count(int fd) {
    std::uint64_t count = 0;
    return ::read(fd, &count, sizeof count) == sizeof count ? count : 0;
}

}  // namespace mavloom::feed::testing
