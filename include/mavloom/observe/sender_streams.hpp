// SPDX-License-Identifier: MIT
// How the frames of each sender arrive on all links of one source together: copies, two senders with one id,
// signatures, the loss that a ground station shows, and whether gaps are regular. For a diagnosis; it costs more than
// an Inspector.
//
// One owner thread. Bounded in senders; 4 KiB for each.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "mavloom/observe/heard.hpp"

namespace mavloom::observe {

// Plain counts.
struct SenderStream {
    Source source{};
    std::uint64_t frames = 0;
    WallTime first{}, last{};
    std::map<LinkId, std::uint64_t> links{};  // the frames on each; at most `SenderStreams::max_links`

    // Frames that repeat an earlier one byte for byte, heard on the same link or on another one.
    std::uint64_t copies_on_link = 0, copies_across = 0;
    // Frames that have the sequence number of an earlier one on the same link, and other bytes.
    std::uint64_t conflicts_on_link = 0;
    // Frames that follow the one before them on their link, and do not fit into the sequence of all links.
    std::uint64_t conflicts_across = 0;
    // SYSTEM_TIMEs that contradict one of another link: by them, the vehicle's clock started at another time.
    std::uint64_t clocks_across = 0;
    // Changes of the vehicle's kind or autopilot between two HEARTBEATs.
    std::uint64_t changes_of_kind = 0;
    std::uint64_t heartbeats = 0;
    bool has_sequence = true;  // false: each frame has the same number

    // Without RADIO_STATUS and RADIO, which radios insert unsigned.
    std::uint64_t signed_frames = 0, unsigned_frames = 0;

    // Frames that are missing in the sequence numbers of all links together, if it is one sequence.
    std::uint64_t missing = 0;
    // Missing frames as QGroundControl counts them: it knows no late frames and no links.
    std::uint64_t station_lost = 0;

    // The missing frames of each half second, beside all that were sent in it.
    struct Windows {
        std::uint64_t count = 0;
        double missing = 0, sent = 0;                                    // sums
        double missing_squared = 0, missing_sent = 0, sent_squared = 0;  // sums of the products

        void add(double missing_in_window, double sent_in_window) noexcept;
        // How much the number of missing frames varies, as a part of what it would by chance. 0: not at all.
        [[nodiscard]] double variation() const noexcept;
    };
    Windows windows{};

    [[nodiscard]] double station_loss() const noexcept {
        const auto all = frames + station_lost;
        return all == 0 ? 0 : static_cast<double>(station_lost) / static_cast<double>(all);
    }
    // Whether the gaps are too regular to be losses by chance: a filter or a rate limit leaves frames out.
    [[nodiscard]] bool has_regular_gaps() const noexcept;
};

class SenderStreams {
public:
    static constexpr std::size_t max_senders = 1024, max_links = 64;
    static constexpr Nanoseconds window = std::chrono::milliseconds{500};

    SenderStreams();
    SenderStreams(SenderStreams&&) noexcept;
    SenderStreams& operator=(SenderStreams&&) noexcept;
    ~SenderStreams();

    void add(const Heard& heard);
    // Sorted by sender.
    [[nodiscard]] std::vector<SenderStream> all() const;
    [[nodiscard]] std::uint64_t unlisted() const noexcept { return unlisted_; }

private:
    struct State;
    [[nodiscard]] State* find_or_add(const Heard& heard);
    static void note_sequence(State& state, const Heard& heard);
    static void note_window(State& state, WallTime time);
    static void note_clock(State& state, const Heard& heard);
    static bool count_copy(State& state, const Heard& heard, std::uint64_t print);

    std::map<Source, std::size_t> index_;
    std::vector<std::unique_ptr<State>> states_;
    State* last_ = nullptr;
    std::uint64_t unlisted_ = 0;
};

}  // namespace mavloom::observe
