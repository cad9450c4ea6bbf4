// SPDX-License-Identifier: MIT
// The inputs of `listen`, `record`, `relay` and `replay`: live links, shared-memory rings and recordings, all read in
// one loop through one handler. A recording delivers frames at the pace of `speed=`, or as fast as the caller takes
// them. A ring delivers frames as they are written; a lossless ring waits for the caller.
//
// One owner thread; any thread may call `wake`. If there are rings, a second thread sleeps on them (shm::RingWaiter).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mavloom/dialect/dialect.hpp"
#include "mavloom/feed/totals.hpp"
#include "mavloom/link/links.hpp"
#include "mavloom/record/pacer.hpp"
#include "mavloom/record/tlog_reader.hpp"
#include "mavloom/ring/room.hpp"

namespace mavloom::ring {
class RingSources;
}

namespace mavloom::feed {

using ring::Copies;
using ring::Room;

class Sources {
public:
    Sources(Sources&&) noexcept;
    ~Sources();

    // `dialect` must outlive the object.
    [[nodiscard]] static SetupResult<Sources> create(const dialect::Dialect& dialect, Copies copies = Copies::kept);

    // Runs the checks that `add` makes first: the options must be valid, and a tlog:// file must exist and be a
    // recording. Leaves the endpoint closed, and never waits.
    [[nodiscard]] SetupResult<void> check(const endpoint::Endpoint& endpoint) const;

    // Opens the endpoint. If a ring does not exist, the source reports it through `on_notice` and waits indefinitely. A
    // recording is read from the time of its earliest record plus `skip`. `default_speed` applies if the URL has no
    // `speed=`.
    [[nodiscard]] SetupResult<link::EndpointId> add(const endpoint::Endpoint& endpoint, MonoTime now,
                                                    double default_speed = record::Pacer::max_speed,
                                                    Nanoseconds skip = {});

    // The same for what is no recording: a link or a ring. `dialect` must outlive the source; null: that of the object.
    [[nodiscard]] SetupResult<link::EndpointId> add_live(const endpoint::Endpoint& endpoint,
                                                         const dialect::Dialect* dialect = nullptr);
    // Closes a link, or a ring with its inlet. Do not call it inside a callback.
    void remove(link::EndpointId live);

    // Functions for one ring. `ring` is the id that `add` returned.
    // - `hold_ring` pauses reading while the consumer has no room for more frames.
    // - `inlet` returns the endpoint of the ring's inlet and opens it at the first call.
    void hold_ring(link::EndpointId ring, bool held) noexcept;
    [[nodiscard]] SetupResult<link::EndpointId> inlet(link::EndpointId ring);
    // The ring's counters, in the same form as those of a link. `add_ring_to` adds them to `totals`, together with the
    // counts of records that were not delivered.
    [[nodiscard]] const link::LinkCounters& ring_counters(link::EndpointId ring) const noexcept;
    void add_ring_to(link::EndpointId ring, Totals& totals) const noexcept;

    // The frames of all rings that were lost on the way to their writers.
    [[nodiscard]] std::uint64_t lost_before_rings() const noexcept;

    struct SourceLoss {
        LinkId link;
        wire::SequenceStats stats;
    };
    // The losses of each source on each current link of a live endpoint or ring.
    [[nodiscard]] std::vector<SourceLoss> losses(link::EndpointId endpoint) const;

    // The losses on one link of the ring, given by its name. Call it in `on_link_down`, before the link is forgotten.
    [[nodiscard]] std::span<const wire::SequenceStats> ring_losses(link::EndpointId ring, const std::string& name) const;

    // Runs one turn: first the links, then the rings, then the recordings that are due, earliest record first. Rings
    // and recordings deliver only as many frames as `room` allows. Returns the number of frames delivered.
    std::size_t turn(link::LinkHandler& handler, MonoTime deadline, Room room);

    // Delivers the frames that had already arrived from live links and rings. Call it at the end. It stops after
    // several turns in a row without a frame, and reads no more than a full receive buffer holds. It calls `room`
    // before each turn and after the last. Rings deliver only what `room` allows; recordings deliver nothing.
    void drain(link::LinkHandler& handler, const std::function<Room()>& room);

    [[nodiscard]] bool has_recordings() const noexcept { return !recordings_.empty(); }

    // Sends a frame, such as the answer of a destination, back to every live link and to the inlet of every ring.
    // Returns the number of links that took it.
    std::size_t send(const wire::FrameView& frame);

    // Adds the counters of all current links, endpoints, rings and recordings, after refreshing the kernel's drop
    // counts. Call it once, at the end.
    void add_to(Totals& totals);

    [[nodiscard]] bool are_recordings() const noexcept;
    // Whether all sources are recordings, and all of them have ended.
    [[nodiscard]] bool finished() const noexcept;
    [[nodiscard]] bool finished_recordings() const noexcept;
    // The error of the first recording that failed before its end; null if none failed.
    [[nodiscard]] const SetupError* error() const noexcept;

    [[nodiscard]] std::span<const std::unique_ptr<ring::RingSource>> rings() const noexcept;
    [[nodiscard]] link::Links& links() noexcept { return *links_; }
    [[nodiscard]] const link::Links& links() const noexcept { return *links_; }
    void wake() noexcept { links_->wake(); }

    struct Recording {
        LinkId link;
        link::EndpointId endpoint;
        std::string name;
        record::TlogReader reader;
        record::Pacer pacer;
        wire::SequenceTracker sequence;
        std::optional<record::Record> next;  // already read, not yet delivered
        MonoTime due{};
        bool ended = false;
        std::optional<SetupError> error{};  // set if the recording failed before its end
    };
    [[nodiscard]] const std::vector<std::unique_ptr<Recording>>& recordings() const noexcept { return recordings_; }

private:
    Sources(std::unique_ptr<link::Links> links, const wire::MessageTable& table, Copies copies);
    // Reads the next record of `recording`. Returns false if it skipped so much damage that links and signals must be
    // handled before it continues.
    bool advance(Recording& recording, link::LinkHandler& handler);
    std::size_t play(link::LinkHandler& handler, std::size_t max_frames);
    [[nodiscard]] Recording* earliest() noexcept;

    std::unique_ptr<link::Links> links_;
    const wire::MessageTable* table_;
    std::unique_ptr<ring::RingSources> rings_;  // its waiter thread wakes the links
    std::vector<std::unique_ptr<Recording>> recordings_;
    std::vector<link::EndpointId> live_;
};

}  // namespace mavloom::feed
