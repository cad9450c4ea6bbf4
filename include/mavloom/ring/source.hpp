// SPDX-License-Identifier: MIT
// Delivers the frames of one shared-memory ring, as if they were received here.
//
// It parses the records and counts those without a valid frame. Each link from which the ring's writer received frames
// becomes a link here. One owner thread.
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

// Records of a ring that were not delivered, by reason.
struct RingLosses {
    std::uint64_t lapped = 0;       // overwritten before they were read
    std::uint64_t bad_records = 0;  // contained no complete valid frame
    std::uint64_t other_kinds = 0;  // not MAVLink, according to their kind
    std::uint64_t copies = 0;       // left out because the ring's router marked them as a duplicate or an echo
    std::uint64_t echo = 0;         // frames that this process had sent to the ring's inlet
};

class RingSource {
public:
    // The ids come from `links`. `send` uses it too, with the queue rules of `dialect` if it is given. `table`, `links`
    // and `dialect` must outlive the object.
    RingSource(const endpoint::Endpoint& endpoint, const wire::MessageTable& table, link::Links& links, Copies copies,
               const dialect::Dialect* dialect = nullptr);
    RingSource(const RingSource&) = delete;
    RingSource& operator=(const RingSource&) = delete;
    ~RingSource();

    // Opens the ring if it exists. Returns an error only if the ring cannot be opened and the endpoint is required.
    [[nodiscard]] SetupResult<void> open();
    // Delivers at most `most` frames. Returns how many.
    std::size_t play(link::LinkHandler& handler, std::size_t most);
    // Returns when to call play next: at once if frames are waiting, provided there is room. Asks the writer to wake
    // this process earlier if it commits a record.
    [[nodiscard]] MonoTime due(bool has_room, MonoTime now);
    // From now on, reads no further than the current end of the ring. Later records stay in the ring.
    void stop_at_current_end() noexcept;
    // Returns whether `stop_at_current_end` was called and everything up to that end was delivered.
    [[nodiscard]] bool at_end() const noexcept { return at_end_ && next_found_ == found_.size(); }

    // Pauses reading while `held` is true, because the consumer has no room for more frames.
    void hold(bool held) noexcept { held_ = held; }

    // Sends a frame to the ring's inlet, the socket through which readers send frames to the ring's writer. Returns
    // true if it was accepted.
    bool send(const wire::FrameView& frame);
    // Returns the inlet's endpoint; the first call opens it. If that fails, every later call returns the same error.
    [[nodiscard]] SetupResult<link::EndpointId> inlet();
    [[nodiscard]] RingLosses losses() const noexcept;

    // Calls take(link, sources) for each link that appeared in the ring.
    template <class Take>
    void each_link(Take take) const {
        for (const auto& [name, link] : by_name_) take(link->id, link->tracker.sources());
    }
    // Returns nothing for a link that has not appeared.
    [[nodiscard]] std::span<const wire::SequenceStats> losses(const std::string& link) const {
        const auto known = by_name_.find(link);
        return known == by_name_.end() ? std::span<const wire::SequenceStats>{} : known->second->tracker.sources();
    }
    [[nodiscard]] const link::LinkCounters& counters() const noexcept { return counters_; }
    // It has a writer, as far as is known.
    [[nodiscard]] bool is_there() const noexcept { return last_notice_ == Notice::nothing; }

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
        std::uint64_t heard = 0;  // value of heard_ at its last frame
        bool own = false;         // this process's own link, on which frames sent to the inlet come back
    };
    struct Found {
        wire::FrameView frame;
        const wire::MessageInfo* info;
    };
    // The kind of the last notice, so that each is reported only once.
    enum class Notice : std::uint8_t { nothing, absent, unreadable, unwritten, damaged };

    [[nodiscard]] bool read(link::LinkHandler& handler);
    void take(const shm::RingRecord& record, link::LinkHandler& handler);
    void notice_other_writer(const shm::RingRecord& record);
    void parse_record(ByteView bytes, link::LinkHandler& handler);
    void parse(ByteView bytes, link::LinkHandler& handler);
    void hand_over(link::LinkHandler& handler, const Found& found);
    void on_no_record(shm::ReadError why, link::LinkHandler& handler);
    void report(link::LinkHandler& handler, Notice what, std::string_view text);
    // Restarts loss counting. After a change of writer or missed records, per-link loss cannot be derived from sequence
    // numbers.
    void forget_sequences();
    [[nodiscard]] RingLink& link_of(LinkId in_ring, link::LinkHandler& handler);
    [[nodiscard]] RingLink& link_called(const std::string& name, link::LinkHandler& handler);
    void forget_longest_silent(link::LinkHandler& handler);
    [[nodiscard]] std::string name_of(LinkId in_ring);
    [[nodiscard]] bool read_names();
    void poll_names();
    [[nodiscard]] bool is_own(const std::string& name) const;

    endpoint::Endpoint endpoint_;
    link::EndpointId id_;
    const wire::MessageTable& table_;
    link::Links& links_;
    Copies wanted_copies_;
    const dialect::Dialect* dialect_;
    shm::RingFollower follower_;
    Notice last_notice_ = Notice::nothing;
    MonoTime next_poll_{};  // when to look again at a ring that is missing or damaged
    bool more_ = false;     // the last turn ended because it had no more room
    bool awaited_ = false;  // the ring was absent: records overwritten before the first read count as lost
    // The ring and writer to which the link numbers belong.
    std::uint64_t opened_ = 0, writers_ = 0;
    std::optional<std::uint64_t> end_;  // the position at which reading stops
    bool at_end_ = false, held_ = false;

    std::map<std::string, std::unique_ptr<RingLink>> by_name_;
    std::unordered_map<LinkId, RingLink*> by_number_;  // by the number in the ring
    std::map<LinkId, std::string> names_;              // from the counter page
    bool any_unnamed_ = false;
    MonoTime next_names_{};
    std::uint64_t heard_ = 0;
    LinkId last_number_{};
    RingLink* last_ = nullptr;

    std::vector<std::uint8_t> copy_;  // of a record that an evicting writer could overwrite
    std::vector<Found> found_;        // frames of the last record
    std::size_t next_found_ = 0;
    WallTime time_{};
    std::uint8_t verdict_ = 0;

    std::optional<link::EndpointId> inlet_;
    std::optional<SetupError> no_inlet_;
    bool reported_no_inlet_ = false;
    link::LinkCounters counters_;
    std::uint64_t overwritten_ = 0, bad_records_ = 0, other_kinds_ = 0, copies_ = 0, echo_ = 0;
};

}  // namespace mavloom::ring
