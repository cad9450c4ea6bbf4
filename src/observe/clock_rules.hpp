// SPDX-License-Identifier: MIT
// Alarms from clocks: a vehicle's time since boot and its time of day, and this machine's clock. Private to module
// observe.
//
// A vehicle's `time_boot_ms` gives the moment of its start. If this moment
// - moves later, the vehicle has restarted, or its clock stood still.
// - moves earlier, its clock jumped.
// - moves to and fro, two vehicles have the same id. No sequence numbers show that if they are on different links.
#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>

#include "mavloom/base/clock.hpp"
#include "mavloom/msg/system_time.hpp"
#include "mavloom/observe/alarm.hpp"
#include "observe/vehicle_rules.hpp"

namespace mavloom::observe {

class ClockRules {
public:
    // More than frames wait in queues.
    static constexpr Nanoseconds tolerance = std::chrono::seconds{2};

    void boot_time(Alarms& alarms, const Moment& at, std::uint32_t boot_ms);
    void judge(Alarms& alarms, const Moment& at, const msg::SystemTime& time);
    // This machine's clock.
    void tick(Alarms& alarms, WallTime time, MonoTime now);

private:
    static constexpr std::size_t max_sources = 4096;
    struct Start {
        MonoTime at{}, heard{};
    };
    struct Clocks {
        std::optional<Start> start{}, former{};
        int returns = 0;  // to the former start
        std::optional<Nanoseconds> day_from_mono{};
        MonoTime heard{};
    };
    [[nodiscard]] Clocks* find_or_add(const Moment& at);
    void forget_silent(MonoTime now);
    static void new_start(Alarms& alarms, const Moment& at, Clocks& clocks, MonoTime start);

    std::unordered_map<std::uint16_t, Clocks> all_;
    MonoTime may_forget_at_{};
    std::optional<Nanoseconds> own_from_mono_{};
};

}  // namespace mavloom::observe
