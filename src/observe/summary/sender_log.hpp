// SPDX-License-Identifier: MIT
// What one sender sent, and what it reported of itself. Private to module observe.
#pragma once

#include <vector>

#include "mavloom/dialect/dialect.hpp"
#include "mavloom/msg/autopilot_version.hpp"
#include "mavloom/observe/summary.hpp"
#include "mavloom/wire/message_table.hpp"
#include "observe/summary/journey_log.hpp"
#include "observe/summary/text_log.hpp"

namespace mavloom::observe {

// One message of one sender.
struct Tally {
    std::uint64_t count = 0, bytes = 0;

    void add(std::size_t size) noexcept {
        ++count;
        bytes += size;
    }
};

class SenderLog {
public:
    SenderLog(Source source, std::size_t messages) : tallies_(messages) { vehicle_.source = source; }

    // The message at a place of the wire table.
    void count(std::size_t place, std::size_t size) noexcept { tallies_[place].add(size); }
    // A message without definition. Returns false if there is no room.
    [[nodiscard]] bool count_unknown(MessageId id, std::size_t size);

    // Returns false if a list has no room.
    [[nodiscard]] bool take(const msg::Heartbeat& message, ByteView payload, const When& when);
    void take(const msg::AutopilotVersion& message);
    void take(const msg::GlobalPositionInt& message, const When& when, bool with_track);
    void take(const msg::GpsRawInt& message, const When& when, bool with_track);
    template <class Message>
    void take_battery(const Message& message) {
        VehicleTable::take(vehicle_, message);
        note_battery();
    }

    [[nodiscard]] Source source() const noexcept { return vehicle_.source; }
    [[nodiscard]] bool is_bytewise() const noexcept;  // how it encodes parameters
    [[nodiscard]] SenderSummary summary(const dialect::Dialect& dialect) const;

    OpenText open_text{};

private:
    static constexpr std::size_t max_unknown = 64;
    struct Unknown {
        MessageId id;
        Tally tally{};
    };

    [[nodiscard]] bool note_mode(std::uint32_t custom_mode, const When& when);
    [[nodiscard]] bool note_armed(bool was_armed, const When& when);
    void note_battery();
    [[nodiscard]] bool is_flown() const noexcept { return vehicle_.is_armed || vehicle_.heartbeats == 0; }
    [[nodiscard]] std::vector<MessageTotal> totals(const dialect::Dialect& dialect) const;

    Vehicle vehicle_{};
    std::vector<Tally> tallies_;
    std::vector<Unknown> unknown_;
    std::optional<Firmware> firmware_;
    std::uint64_t capabilities_ = 0;  // MAV_PROTOCOL_CAPABILITY
    std::vector<ModePeriod> modes_;
    std::vector<ArmedPeriod> armed_;
    std::optional<BatteryUse> battery_;
    JourneyLog by_position_, by_gps_;
};

}  // namespace mavloom::observe
