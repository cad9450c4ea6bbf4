// SPDX-License-Identifier: MIT
// What the hops of a demo counted of the vehicle's frames, and what each of them lost. One owner thread.
//
// All numbers are the programs' own: counter pages, the ring, and the JSON that the listener and the relay print. They
// are read one after the other, and pages are a quarter of a second old. So while frames flow, a hop's loss is the
// difference between what the hop before had sent at the look before this one, and what this hop has sent by now: at
// most half a second of frames is not seen as lost. `settle` compares the last counts of all.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "chain.hpp"
#include "mavloom/observe/hop.hpp"

namespace mavloom::app::demo_parts {

inline constexpr std::string_view station_name = "ground station";
// The programs of a chain, and what comes after them.
inline constexpr std::size_t hop_count = stage_names.size() + 1;

struct Tally {
    std::string_view name;
    bool is_up = false;
    bool waits = false;                         // a real vehicle that was not heard yet
    std::uint64_t in = 0, out = 0;              // frames of the vehicle
    std::uint64_t lost = 0;                     // between the hop before and the hop after
    std::vector<observe::NamedCount> losses{};  // the same by name: each adds to `lost`
    std::string hint{};                         // for people; usually empty
};

class Tallies {
public:
    Tallies(const Chain& chain, const Places& places, bool is_simulated);

    // Reads all counters. `arrived`: frames of the relay at the end of the chain.
    void read(std::uint64_t arrived);
    // The same, and judges what is lost. Call it every half second or less often.
    void look(std::uint64_t arrived);
    // Whether a program listens at the end of the chain.
    void set_station(bool is_there) noexcept { tallies_.back().is_up = is_there; }
    void set_hint(std::size_t hop, std::string hint) { tallies_[hop].hint = std::move(hint); }
    // Judges without patience: each frame that is missing is lost. Call it after the last look, when nothing is on its
    // way any more.
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
    [[nodiscard]] std::uint64_t missing_for_long(std::size_t hop) const;
    [[nodiscard]] Sent sent() const;
    [[nodiscard]] Tally& at(Stage stage) noexcept { return tallies_[static_cast<std::size_t>(stage)]; }

    const Chain& chain_;
    const Places& places_;
    bool is_simulated_;
    std::array<Tally, hop_count> tallies_;
    std::array<Sent, 4> missing_{};  // at the last looks, newest first
    std::uint64_t answers_ = 0;
};

// The tallies for observe::Inspector, and as one JSON object for each hop.
[[nodiscard]] std::vector<observe::Hop> hops_of(const Tallies& tallies);
[[nodiscard]] nlohmann::ordered_json json_of(const Tallies& tallies);

}  // namespace mavloom::app::demo_parts
