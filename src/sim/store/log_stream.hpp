// SPDX-License-Identifier: MIT
// Sends clients the log that the vehicle is writing, while that log grows. Private to module sim; single owner.
//
// PX4 sends the header in LOGGING_DATA_ACKED, each of which waits for its LOGGING_ACK, and the rest in LOGGING_DATA.
// ArduPilot sends REMOTE_LOG_DATA_BLOCKs and repeats those that the client misses. Sources: MAVLink guide, "Log
// transfer protocol"; MAVLink common.xml and ardupilotmega.xml.
#pragma once

#include <cstdint>
#include <vector>

#include "flight/orders.hpp"
#include "mavloom/sim/flight.hpp"
#include "sim/radio/client.hpp"
#include "sim/radio/radio.hpp"
#include "sim/store/recorded_logs.hpp"

namespace mavloom::sim {

using flight::Result;  // and not mavloom::Result

class LogStreams {
public:
    // `radio` must outlive the object.
    LogStreams(bool is_px4, SystemId system, std::size_t most, Radio& radio) noexcept
        : radio_(radio), image_(LogImage::endless(is_px4, system)), max_streams_(most), is_px4_(is_px4) {}

    // If the client already streams, its stream starts over. Returns TEMPORARILY_REJECTED if too many clients stream.
    Result start(const Client& to, Moment now);
    void stop(const Client& to);
    void on_logging_ack(const Client& from, ByteView payload);
    void on_block_status(const Client& from, ByteView payload, Moment now);

    [[nodiscard]] bool is_busy() const noexcept { return !streams_.empty(); }
    void pump(Moment now);
    void reboot() { streams_.clear(); }
    void forget(LinkId link);

private:
    struct Block {  // that was sent and not acknowledged
        std::uint32_t seq;
        MonoTime sent{};
    };
    struct Stream {
        Client client;
        FlightTime began{};
        std::uint32_t offset = 0;    // PX4: of the next bytes
        std::uint16_t sequence = 0;  // PX4: of the next message
        bool waits = false;          // PX4: for the acknowledgement of `sequence`
        unsigned tries = 0;
        MonoTime sent{}, heard{};
        std::uint32_t next_block = 0;  // ArduPilot
        std::vector<Block> blocks{};   // ArduPilot
    };
    // Both return false if the stream is over.
    [[nodiscard]] bool pump_messages(Stream& stream, Moment now);
    [[nodiscard]] bool pump_blocks(Stream& stream, Moment now);
    template <class Message>
    void send_message(Stream& stream);
    void send_block(const Stream& stream, std::uint32_t seq);
    [[nodiscard]] std::uint32_t piece_length(const Stream& stream) const noexcept;
    [[nodiscard]] bool is_in_header(const Stream& stream) const noexcept {
        return stream.offset < image_.header_size();
    }
    [[nodiscard]] std::uint64_t written(const Stream& stream, Moment now) const noexcept;
    [[nodiscard]] Stream* find(const Client& client) noexcept;

    Radio& radio_;
    LogImage image_;
    std::size_t max_streams_;
    bool is_px4_;
    std::vector<Stream> streams_;
};

}  // namespace mavloom::sim
