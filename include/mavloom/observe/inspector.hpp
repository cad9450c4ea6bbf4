// SPDX-License-Identifier: MIT
// Inspector: the one model of what links carry. It knows each message's rate, jitter and latest value, the vehicles,
// the programs on the way, round trips, and alarms. Everything that shows traffic reads it.
//
// It has no thread, socket or screen, and reads no clock: one owner calls it with frames and times. It is bounded in
// memory, also if senders invent ids.
#pragma once

#include <memory>
#include <set>
#include <span>
#include <vector>

#include "mavloom/observe/alarm.hpp"
#include "mavloom/observe/heard.hpp"
#include "mavloom/observe/hop_table.hpp"
#include "mavloom/observe/latest_table.hpp"
#include "mavloom/observe/loss.hpp"
#include "mavloom/observe/vehicle_table.hpp"

namespace mavloom::observe {

struct Parts;  // private

class Inspector {
public:
    // Invented senders must not push out all other alarms.
    static constexpr std::uint64_t heartbeats_before_silence = 3;
    static constexpr std::size_t max_silent = 64;

    // `dialect` must outlive the object.
    explicit Inspector(const dialect::Dialect& dialect);
    ~Inspector();
    Inspector(const Inspector&) = delete;
    Inspector& operator=(const Inspector&) = delete;

    // Returns the row of the frame; null if there is no room for another one.
    const LatestRow* add(const Heard& heard);
    // The loss on links, as their receiver counts it; of all senders, about twice a second.
    void note_losses(std::span<const SenderLoss> losses, WallTime time, MonoTime now);
    // The link, a recording, has ended, so its senders are not silent.
    void note_end(LinkId link) { ended_.insert(link); }
    [[nodiscard]] bool has_ended(LinkId link) const { return ended_.contains(link); }
    // The programs on the way of the frames, about twice a second.
    void set_hops(std::vector<Hop> hops, WallTime time, MonoTime now);
    // Notices what does not come. Call it about twice a second.
    void tick(WallTime time, MonoTime now);

    [[nodiscard]] const LatestTable& latest() const noexcept { return latest_; }
    [[nodiscard]] const std::vector<Hop>& hops() const noexcept { return hops_.all(); }
    [[nodiscard]] std::vector<Alarm> alarms() const;  // newest first
    [[nodiscard]] std::uint64_t evicted_alarms() const;
    // The components that send HEARTBEATs, by id, with the rates of all that they send. Searches all rows.
    [[nodiscard]] std::vector<Vehicle> vehicles(WallTime time) const;

private:
    void watch_silence(WallTime time, MonoTime now);

    LatestTable latest_;
    HopTable hops_;
    std::set<LinkId> ended_;
    std::unique_ptr<Parts> parts_;
};

}  // namespace mavloom::observe
