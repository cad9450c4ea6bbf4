// SPDX-License-Identifier: MIT
// A vehicle on a test bench: a clock that the test moves, and links whose frames the test collects and sends.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "mavloom/dialect/dialect.hpp"
#include "mavloom/sim/vehicle.hpp"
#include "mavloom/wire/frame_writer.hpp"

namespace mavloom::sim::test {

// A frame that the vehicle sent, and when.
struct Sent {
    LinkId link;
    FlightTime at{};
    std::vector<std::uint8_t> bytes;

    [[nodiscard]] wire::FrameView frame() const { return wire::FrameView::unchecked(bytes); }
};

class ListSink final : public Sink {
public:
    void send(LinkId link, const wire::FrameView& frame) override {
        frames.push_back({link, now, {frame.bytes().begin(), frame.bytes().end()}});
    }
    [[nodiscard]] bool has_room(LinkId link) const override { return !full.contains(link.value); }

    FlightTime now{};
    std::vector<Sent> frames;
    std::set<std::uint32_t> full;  // links without room
};

// The client that a test plays.
struct Peer {
    LinkId link{1};
    Source id{SystemId{255}, ComponentId{190}};
};

class Rig {
public:
    explicit Rig(const VehicleOptions& options = {}, const LinkOptions& link = {}) : vehicle(options, sink, Moment{}) {
        vehicle.open(LinkId{1}, link, now());
    }

    [[nodiscard]] Moment now() const { return {.flight = flight, .real = MonoTime{flight}}; }

    // Moves the clock, stopping whenever the vehicle has something to do.
    void run(Nanoseconds time) {
        const FlightTime end = flight + time;
        while (vehicle.next_due() <= end) advance(std::max(vehicle.next_due(), flight));
        advance(end);
    }
    void run(double seconds) { run(std::chrono::duration_cast<Nanoseconds>(std::chrono::duration<double>(seconds))); }
    // Runs until the condition holds. False: it did not within `limit` seconds.
    [[nodiscard]] bool run_until(const std::function<bool()>& condition, double limit) {
        for (double passed = 0; passed < limit; passed += 0.02) {
            if (condition()) return true;
            run(0.02);
        }
        return condition();
    }

    // Sends a message to the vehicle as `peer`.
    template <class Message>
    void send(const Message& message, const Peer& peer = {}) {
        std::array<std::uint8_t, Message::max_length> payload;
        (void)message.encode(payload);
        const wire::MessageInfo& info = *dialect::default_dialect().wire_table().find(Message::id);
        wire::FrameBuffer buffer;
        const auto frame = wire::write_frame(buffer, {.sequence = sequence++, .source = peer.id}, info, payload);
        sink.now = flight;
        vehicle.receive(peer.link, frame, &info, now());
    }

    // All messages of a kind that the vehicle sent on a link, oldest first; `forget` them with the rest.
    template <class Message>
    [[nodiscard]] std::vector<Message> all(LinkId link = LinkId{1}) const {
        std::vector<Message> found;
        for (const Sent& sent : sink.frames)
            if (sent.link == link && sent.frame().id() == Message::id)
                found.push_back(Message::decode(sent.frame().payload()));
        return found;
    }
    template <class Message>
    [[nodiscard]] std::optional<Message> last(LinkId link = LinkId{1}) const {
        const auto found = all<Message>(link);
        return found.empty() ? std::nullopt : std::optional(found.back());
    }
    void forget() { sink.frames.clear(); }

    ListSink sink;
    FlightTime flight{};
    Vehicle vehicle;
    std::uint8_t sequence = 0;

private:
    void advance(FlightTime to) {
        flight = sink.now = to;
        vehicle.advance(now());
    }
};

}  // namespace mavloom::sim::test
