// SPDX-License-Identifier: MIT
// Compares what two sources heard of the same senders, frame by frame: before and after a hop, for example.
//
// A FrameLog remembers the frames of one source. Clocks do not matter: the common time begins and ends with frames that
// both sources heard. Bounded: beyond `max_frames`, frames are not remembered. One owner thread.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "mavloom/observe/heard.hpp"
#include "mavloom/wire/message_table.hpp"

namespace mavloom::observe {

class FrameLog {
public:
    static constexpr std::size_t max_frames = 1'000'000;

    struct Print {
        std::uint64_t frame = 0;    // of all bytes up to the checksum
        std::uint64_t content = 0;  // of id and payload: the same after a program has numbered, signed or converted it
        MessageId id{};
        bool is_targeted = false;  // to a system of its own: a router does not send it everywhere
    };

    // `table` knows which messages have a target. It must outlive the object.
    explicit FrameLog(const wire::MessageTable& table) : table_(&table) {}
    void add(const Heard& heard);
    [[nodiscard]] const std::map<Source, std::vector<Print>>& senders() const noexcept { return senders_; }
    [[nodiscard]] std::uint64_t left_out() const noexcept { return left_out_; }

private:
    const wire::MessageTable* table_;
    std::map<Source, std::vector<Print>> senders_;
    std::size_t size_ = 0;
    std::uint64_t left_out_ = 0;
};

// The frames of one sender between A and B, in their common time.
struct Passage {
    struct OfMessage {
        MessageId id{};
        std::uint64_t heard = 0, lost = 0;  // at A; of these, not at B
        bool is_filtered = false;           // none came through, and that is no chance
    };

    Source source{};
    // Different: each has its own frames of the sender, as of a vehicle that sends two streams. Only `has_few` is set.
    bool is_comparable = false;
    bool has_few = false;               // it is not comparable, because A or B heard few frames of the sender
    bool is_rewritten = false;          // numbered, signed or converted in between
    std::uint64_t before = 0;           // frames of A in the common time, without those for a system of its own
    std::uint64_t lost = 0;             // of these, not at B; without `filtered`
    std::uint64_t filtered = 0;         // of these, of messages of which none came to B
    std::uint64_t targeted = 0;         // to a system of its own, and not at B
    std::uint64_t added = 0;            // frames of B in the common time that A did not hear
    std::vector<OfMessage> messages{};  // of which some were lost or filtered; the most first
};

// One for each sender that both heard.
[[nodiscard]] std::vector<Passage> compare(const FrameLog& a, const FrameLog& b);

}  // namespace mavloom::observe
