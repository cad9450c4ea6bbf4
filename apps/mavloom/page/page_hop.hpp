// SPDX-License-Identifier: MIT
// A router or a simulator as a hop, from its counter page. Reading the page does not disturb the program. And the
// sources of a receiver as links of a hop.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "mavloom/feed/receiver.hpp"
#include "mavloom/link/counters.hpp"
#include "mavloom/observe/hop.hpp"
#include "mavloom/shm/counter_page.hpp"

namespace mavloom::app {

// A counter of lost frames, with its name on counter pages and its meaning.
struct LossName {
    std::string_view name, help;
};

// `name`: of a row of link::link_counters.
consteval LossName link_loss(std::string_view name) {
    return {name, std::ranges::find(link::link_counters, name, &link::LinkCounter::name)->help};
}

// Frames that a link lost or damaged. Those that are not sent because nobody listens at a port (`refused`) are no loss.
inline constexpr std::array link_losses{
    link_loss("lost"),       link_loss("crc_error"),       link_loss("bad_signature"), link_loss("queue_bytes"),
    link_loss("queue_age"),  link_loss("frames_not_sent"), link_loss("held_dropped"),  link_loss("fault_blackout"),
    link_loss("fault_lost"), link_loss("fault_corrupted"), link_loss("fault_cut"),     link_loss("fault_queue")};

// Without losses: the receiver has its own numbers.
[[nodiscard]] observe::HopLink hop_link_of(const feed::Receiver::OfSource& source);

// A simulator's page counts vehicles.
[[nodiscard]] bool is_of_simulator(const shm::CounterSnapshot& page);

// A program of `page` called `name`.
[[nodiscard]] observe::Hop hop_of(const std::string& name, const shm::CounterSnapshot& page);

// The program that owns the counter page of this name. Empty if there is no page that can be read.
[[nodiscard]] std::optional<observe::Hop> hop_of_page(const std::string& name);

}  // namespace mavloom::app
