// SPDX-License-Identifier: MIT
// Finds the vehicle that is due first: a binary heap of vehicles, ordered by the flight time at which they are due. Of
// those due at the same time, the one that was added first is first, whatever happened before, so that a session that
// is played again has the same order. An update takes logarithmic time and allocates nothing. Private to module
// simserve; single owner thread.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "mavloom/sim/flight.hpp"

namespace mavloom::simserve {

class Schedule {
public:
    using Index = std::uint32_t;

    // Adds the vehicle with the next index: 0, 1, 2 ...
    void add(sim::FlightTime due) {
        places_.push_back(static_cast<Index>(heap_.size()));
        heap_.push_back({due, static_cast<Index>(places_.size() - 1)});
        rise(heap_.size() - 1);
    }
    void update(Index vehicle, sim::FlightTime due) noexcept {
        const std::size_t place = places_[vehicle];
        const bool is_earlier = due < heap_[place].due;
        heap_[place].due = due;
        if (is_earlier) {
            rise(place);
        } else {
            sink(place);
        }
    }

    [[nodiscard]] bool empty() const noexcept { return heap_.empty(); }
    // Call it only if the schedule is not empty.
    [[nodiscard]] Index first() const noexcept { return heap_.front().vehicle; }
    // FlightTime::max() if the schedule is empty.
    [[nodiscard]] sim::FlightTime due() const noexcept { return empty() ? sim::FlightTime::max() : heap_.front().due; }

private:
    struct Item {
        sim::FlightTime due;
        Index vehicle;

        auto operator<=>(const Item&) const = default;
    };

    void rise(std::size_t place) noexcept {
        for (; place != 0; place = (place - 1) / 2) {
            const std::size_t parent = (place - 1) / 2;
            if (heap_[parent] < heap_[place]) return;
            exchange(parent, place);
        }
    }
    void sink(std::size_t place) noexcept {
        for (;;) {
            std::size_t least = place;
            for (std::size_t child = 2 * place + 1; child < heap_.size() && child <= 2 * place + 2; ++child)
                if (heap_[child] < heap_[least]) least = child;
            if (least == place) return;
            exchange(least, place);
            place = least;
        }
    }
    void exchange(std::size_t a, std::size_t b) noexcept {
        std::swap(heap_[a], heap_[b]);
        places_[heap_[a].vehicle] = static_cast<Index>(a);
        places_[heap_[b].vehicle] = static_cast<Index>(b);
    }

    std::vector<Item> heap_;
    std::vector<Index> places_;  // by vehicle: its place in heap_
};

}  // namespace mavloom::simserve
