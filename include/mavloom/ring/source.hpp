// SPDX-License-Identifier: MIT
// One ring as a source of frames: its records are parsed, what is no frame is counted, and the links that its writer heard them on become links here.
// One owner thread.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "mavloom/link/links.hpp"
#include "mavloom/ring/room.hpp"
#include "mavloom/shm/ring_follower.hpp"
#include "mavloom/wire/datagram_parser.hpp"

namespace mavloom::ring {

// Ids of rings and of their links lie above all that Links gives and above those of recordings.
class RingLinkIds {
public:
    [[nodiscard]] std::uint32_t next() noexcept { return next_++; }

private:
    std::uint32_t next_ = 0xC000'0000;
};

// Records of a ring that were not handed over, by reason.
struct RingLosses {
    std::uint64_t lapped = 0;       // overwritten before they were read
    std::uint64_t bad_records = 0;  // held no whole valid frame
    std::uint64_t other_kinds = 0;  // no MAVLink by their kind
    std::uint64_t copies = 0;       // left out because the ring's router marked them as a copy or an echo
    std::uint64_t echo = 0;         // what was sent to its inlet from here
};

class RingSource {
public:
    // Answers go out by `links`, by the rules of `dialect` where there is one. It and the others must outlive the object.
    RingSource(const endpoint::Endpoint& endpoint, const wire::MessageTable& table, RingLinkIds& ids,
               link::Links& links, Copies copies, const dialect::Dialect* dialect = nullptr);
    RingSource(const RingSource&) = delete;
    RingSource& operator=(const RingSource&) = delete;
    ~RingSource();

    // Opens the ring if it is there. What keeps it from being read is an error only where the endpoint is required.
    [[nodiscard]] SetupResult<void> open();
    // Hands over at most `most` frames; returns how many.
    std::size_t play(link::LinkHandler& handler, std::size_t most);
    // When to play next: at once while something waits that there was no room for. Asks the writer to wake this process before.
    [[nodiscard]] MonoTime due(bool has_room, MonoTime now);
    // What is written from now on is left in the ring.
    void end_here() noexcept;
    // Whether all before that was handed over.
    [[nodiscard]] bool at_end() const noexcept { return at_end_ && next_found_ == found_.size(); }

    // Held: not read, for want of room at who takes the frames.
    void hold(bool held) noexcept { held_ = held; }

    // To the inlet; true when it was taken.
    bool send(const wire::FrameView& frame);
    // Its endpoint, opened at the first call; the first error stands.
    [[nodiscard]] SetupResult<link::EndpointId> inlet();
    [[nodiscard]] RingLosses losses() const noexcept;

    // Calls take(link, sources) for each link that was heard in the ring.
    template <class Take>
    void each_link(Take take) const {
        for (const auto& [name, link] : by_name_) take(link->id, link->tracker.sources());
    }
    // Nothing of a link that was not heard.
    [[nodiscard]] std::span<const wire::SequenceStats> losses(const std::string& link) const {
        const auto known = by_name_.find(link);
        return known == by_name_.end() ? std::span<const wire::SequenceStats>{} : known->second->tracker.sources();
    }
    [[nodiscard]] const link::LinkCounters& counters() const noexcept { return counters_; }

    [[nodiscard]] link::EndpointId id() const noexcept { return id_; }
    [[nodiscard]] const endpoint::Endpoint& endpoint() const noexcept { return endpoint_; }
    [[nodiscard]] bool lossless() const noexcept { return endpoint_.options.lossless.value_or(false); }
    [[nodiscard]] shm::RingFollower& follower() noexcept { return follower_; }

private:
    struct RingLink {
        RingLink(LinkId i, const wire::MessageTable& table) : id(i), parser(table) {}
        LinkId id;
        wire::DatagramParser parser;
        wire::SequenceTracker tracker;
        std::uint64_t heard = 0;  // when it spoke last, as others count
        bool own = false;         // what was sent to the inlet comes back on it
    };
    struct Found {
        wire::FrameView frame;
        const wire::MessageInfo* info;
    };
    // What was last said of it, so that it is said once.
    enum class Told : std::uint8_t { nothing, absent, unreadable, unwritten, damaged };

    [[nodiscard]] bool read(link::LinkHandler& handler);
    void take(const shm::RingRecord& record, link::LinkHandler& handler);
    void parse(ByteView bytes, link::LinkHandler& handler);
    void hand_over(link::LinkHandler& handler, const Found& found);
    void nothing_comes(shm::ReadError why, link::LinkHandler& handler);
    void tell(link::LinkHandler& handler, Told what, std::string_view text);
    // Others wrote meanwhile, or records were missed: what the links lost cannot be told from the numbers any longer.
    void forget_sequences();
    [[nodiscard]] RingLink& link_of(LinkId in_ring, link::LinkHandler& handler);
    [[nodiscard]] RingLink& link_called(const std::string& name, link::LinkHandler& handler);
    void forget_longest_silent(link::LinkHandler& handler);
    [[nodiscard]] std::string name_of(LinkId in_ring);
    [[nodiscard]] bool read_names();
    void look_for_names();
    [[nodiscard]] bool is_own(const std::string& name) const;

    endpoint::Endpoint endpoint_;
    link::EndpointId id_;
    const wire::MessageTable& table_;
    RingLinkIds& ids_;
    link::Links& links_;
    Copies wanted_copies_;
    const dialect::Dialect* dialect_;
    shm::RingFollower follower_;
    Told told_ = Told::nothing;
    MonoTime next_look_{};                    // at a ring that is not open, or that is damaged
    bool more_ = false;                       // the last turn ended for want of room
    bool awaited_ = false;                    // the next ring was not there before: all of it is wanted
    std::uint64_t opened_ = 0, writers_ = 0;  // the ring and its writer, who gives links their numbers
    std::optional<std::uint64_t> end_;        // where reading stops
    bool at_end_ = false, held_ = false;

    std::map<std::string, std::unique_ptr<RingLink>> by_name_;
    std::unordered_map<LinkId, RingLink*> by_number_;  // of the ring
    std::map<LinkId, std::string> names_;              // of the counter page
    bool any_unnamed_ = false;
    MonoTime next_names_{};
    std::uint64_t heard_ = 0;
    LinkId last_number_{};
    RingLink* last_ = nullptr;

    std::vector<std::uint8_t> copy_;  // of a record that a writer could take away
    std::vector<Found> found_;        // in the record that was read last
    std::size_t next_found_ = 0;
    WallTime time_{};
    std::uint8_t verdict_ = 0;

    std::optional<link::EndpointId> inlet_;
    std::optional<SetupError> no_inlet_;
    bool told_no_inlet_ = false;
    link::LinkCounters counters_;
    std::uint64_t overwritten_ = 0, bad_records_ = 0, other_kinds_ = 0, copies_ = 0, echo_ = 0;
};

}  // namespace mavloom::ring
