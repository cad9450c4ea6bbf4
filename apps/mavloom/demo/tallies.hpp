// SPDX-License-Identifier: MIT
// What the hops of a demo counted of the vehicle's frames, and what each of them lost. One owner thread.
//
// All numbers are the programs' own: counter pages, the ring, and the JSON that the listener and the relay print. They
// are read one after the other, and pages are a quarter of a second old. So a hop's loss is the difference between what
// the hop before had sent at the look before this one, and what this hop has sent by now.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string_view>
#include <vector>

#include "chain.hpp"
#include "mavloom/observe/hop.hpp"

namespace mavloom::app::demo_parts {

inline constexpr std::string_view station_name = "ground station";
inline constexpr const char* no_station = "none yet: start one, it connects by itself";
// The programs of a chain, and what comes after them.
inline constexpr std::size_t hop_count = stage_names.size() + 1;

struct Tally {
    std::string_view name;
    bool is_up = false;
    std::uint64_t in = 0, out = 0;              // frames of the vehicle
    std::uint64_t lost = 0;                     // between the hop before and the hop after
    std::vector<observe::NamedCount> losses{};  // the same by name: each adds to `lost`
};

class Tallies {
public:
    Tallies(const Chain& chain, const Places& places, bool is_simulated);

    // Reads all counters. `arrived`: frames at the end of the chain. Call it every half second or less often.
    void look(std::uint64_t arrived);
    // Whether a program listens at the end of the chain.
    void set_station(bool is_there) noexcept { tallies_.back().is_up = is_there; }
    // Judges without patience: each frame that is missing is lost. Call it after the last look, when nothing is on its
    // way any more. A real vehicle always sends, so its frames are compared with the look before.
    void settle();

    [[nodiscard]] const std::array<Tally, hop_count>& all() const noexcept { return tallies_; }
    // Frames that ground stations sent, as far as the router got them.
    [[nodiscard]] std::uint64_t answers() const noexcept { return answers_; }
    // Whether all programs run.
    [[nodiscard]] bool are_up() const noexcept;
    // Whether each hop has every frame of the hop before.
    [[nodiscard]] bool are_equal() const noexcept;
    // Whether frames came through, no program lost one, and all run. Frames that a radio lost before the router are no
    // loss of the programs.
    [[nodiscard]] bool are_whole() const noexcept;
    [[nodiscard]] bool is_simulated() const noexcept { return is_simulated_; }

private:
    using Sent = std::array<std::uint64_t, hop_count>;

    void look_at_vehicle();
    void look_at_router();
    void look_at_ring();
    void look_at_listener();
    void look_at_relay();
    void judge(const Sent& before, bool is_settled);
    void name_losses(Tally& tally) const;
    [[nodiscard]] Sent sent() const;
    [[nodiscard]] Tally& at(Stage stage) noexcept { return tallies_[static_cast<std::size_t>(stage)]; }

    const Chain& chain_;
    const Places& places_;
    bool is_simulated_;
    std::array<Tally, hop_count> tallies_;
    Sent sent_before_{}, lost_before_{};
    std::uint64_t answers_ = 0;
};

// The tallies for observe::Inspector, and as one JSON object for each hop.
[[nodiscard]] std::vector<observe::Hop> hops_of(const Tallies& tallies);
[[nodiscard]] nlohmann::ordered_json json_of(const Tallies& tallies);

}  // namespace mavloom::app::demo_parts
