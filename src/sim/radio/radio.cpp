// SPDX-License-Identifier: MIT
#include "sim/radio/radio.hpp"

#include <algorithm>

#include "mavloom/msg/heartbeat.hpp"

namespace mavloom::sim {

void Radio::open(LinkId link) {
    if (find(link) != nullptr) return;
    ids_.push_back(link);
    Outlet& outlet = outlets_.emplace_back();
    outlet.signing_link = next_signing_link_++;
    if (key_) outlet.signer.emplace(*key_, outlet.signing_link, signing_start_);
}

void Radio::close(LinkId link) {
    const auto at = std::ranges::find(ids_, link);
    if (at == ids_.end()) return;
    outlets_.erase(outlets_.begin() + (at - ids_.begin()));
    ids_.erase(at);
}

void Radio::transmit(LinkId link, const wire::MessageInfo& info, ByteView payload, ComponentId from) {
    Outlet* const outlet = find(link);
    if (outlet == nullptr || silent_ || is_off_) return;
    if (withholds_heartbeat_ && info.id == msg::Heartbeat::id && from == autopilot_component) return;
    auto& sequence = outlet->sequences[from.value];
    wire::Signing signing;
    if (outlet->signer) signing = {&*outlet->signer, std::max(wire::SigningTime::from(utc_), signing_start_)};
    wire::FrameBuffer buffer;
    const auto frame = wire::write_frame(buffer, {.sequence = sequence++, .source = {system_, from}}, info, payload,
                                         signing);
    outlet->totals.frames += 1;
    outlet->totals.bytes += frame.size();
    sink_.send(link, frame);
}

void Radio::restart_sequences() noexcept {
    for (Outlet& outlet : outlets_) outlet.sequences.fill(0);
}

void Radio::note_received(LinkId link, std::size_t bytes) noexcept {
    Outlet* const outlet = find(link);
    if (outlet == nullptr) return;
    outlet->totals.received_frames += 1;
    outlet->totals.received_bytes += bytes;
}

Radio::Totals Radio::totals(LinkId link) const noexcept {
    const auto at = std::ranges::find(ids_, link);
    return at == ids_.end() ? Totals{} : outlets_[static_cast<std::size_t>(at - ids_.begin())].totals;
}

void Radio::sign_with(const std::optional<wire::SigningKey>& key, wire::SigningTime now) {
    key_ = key;
    signing_start_ = now;
    for (Outlet& outlet : outlets_) {
        outlet.signer.reset();
        if (key) outlet.signer.emplace(*key, outlet.signing_link, now);
    }
}

Radio::Outlet* Radio::find(LinkId link) noexcept {
    const auto at = std::ranges::find(ids_, link);
    return at == ids_.end() ? nullptr : &outlets_[static_cast<std::size_t>(at - ids_.begin())];
}

}  // namespace mavloom::sim
