// SPDX-License-Identifier: MIT
#include "simserve/fleet.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace mavloom::simserve {

namespace {

// The system that a frame targets; 0: all. A truncated payload ends in zeros.
std::uint8_t target_of(const wire::FrameView& frame, const wire::MessageInfo& info) noexcept {
    const ByteView payload = frame.payload();
    if (info.target_system_offset == wire::MessageInfo::no_target) return 0;
    return info.target_system_offset < payload.size() ? payload[info.target_system_offset] : std::uint8_t{0};
}

sim::Profile usual_profile(sim::Autopilot autopilot) noexcept {
    return autopilot == sim::Autopilot::ardupilot ? sim::Profile::ardupilot : sim::Profile::normal;
}

}  // namespace

SetupResult<void> Fleet::add(const sim::VehicleOptions& options, sim::Moment now) {
    std::uint16_t& place = by_system_[options.system.value];
    if (place != nobody)
        return setup_error(SetupCode::usage,
                           fmt::format("two vehicles have system id {}; each needs its own", options.system.value));
    place = static_cast<std::uint16_t>(vehicles_.size());
    vehicles_.push_back({std::make_unique<sim::Vehicle>(options, sink_, now), options.autopilot, options.system});
    vehicles_.back().vehicle->ask_for_system([this](SystemId wanted) { return by_system_[wanted.value] == nobody; });
    schedule_.add(vehicles_.back().vehicle->next_due());
    return {};
}

void Fleet::open(LinkId link, const LinkRates& rates, sim::Moment now) {
    const auto share = rates.max_bytes_s / std::max<std::size_t>(vehicles_.size(), 1);
    for (Index i = 0; i < vehicles_.size(); ++i) {
        sim::LinkOptions options;
        options.rates = rates.rates;
        options.profile = rates.profile.value_or(usual_profile(vehicles_[i].autopilot));
        if (rates.max_bytes_s != 0) options.max_bytes_s = std::max<std::uint32_t>(static_cast<std::uint32_t>(share), 1);
        vehicles_[i].vehicle->open(link, options, now);
        note_due(i, now);
    }
}

void Fleet::close(LinkId link) {
    for (const Member& member : vehicles_) member.vehicle->close(link);
}

void Fleet::receive(LinkId link, const wire::FrameView& frame, const wire::MessageInfo* info, sim::Moment now) {
    if (info == nullptr) return;
    const std::uint8_t target = target_of(frame, *info);
    const std::uint16_t place = by_system_[target];
    if (target != 0 && place == nobody) return;
    const Index first = target == 0 ? 0 : place;
    const Index last = target == 0 ? static_cast<Index>(vehicles_.size()) : first + 1u;
    for (Index i = first; i < last; ++i) {
        vehicles_[i].vehicle->receive(link, frame, info, now);
        note_due(i, now);
    }
}

void Fleet::advance(sim::Moment now) {
    while (schedule_.due() <= now.flight) {
        const Index first = schedule_.first();
        vehicles_[first].vehicle->advance(now);
        note_system(first);
        schedule_.update(first, std::max(vehicles_[first].vehicle->next_due(), now.flight + Nanoseconds{1}));
    }
}

sim::Vehicle* Fleet::find(SystemId system) const noexcept {
    const std::uint16_t place = by_system_[system.value];
    return place == nobody ? nullptr : vehicles_[place].vehicle.get();
}

void Fleet::reschedule(const sim::Vehicle& vehicle, sim::Moment now) noexcept {
    const auto at = std::ranges::find(vehicles_, &vehicle, [](const Member& member) { return member.vehicle.get(); });
    if (at != vehicles_.end()) note_due(static_cast<Index>(at - vehicles_.begin()), now);
}

void Fleet::note_system(Index index) noexcept {
    Member& member = vehicles_[index];
    if (member.system == member.vehicle->system()) return;
    by_system_[member.system.value] = nobody;
    member.system = member.vehicle->system();
    by_system_[member.system.value] = static_cast<std::uint16_t>(index);
}

void Fleet::note_due(Index index, sim::Moment now) noexcept {
    note_system(index);
    schedule_.update(index, std::max(vehicles_[index].vehicle->next_due(), now.flight));
}

}  // namespace mavloom::simserve
