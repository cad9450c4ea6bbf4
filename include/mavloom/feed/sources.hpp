// SPDX-License-Identifier: MIT
// What listen, record, relay and replay read: live links, rings and recordings behind one handler, on one loop. A recording's frames come at its pace
// (`speed=`), or as fast as the caller takes them; a ring's as they are written, and a lossless ring waits for the caller. With rings a second thread
// sleeps on them (shm::RingWaiter). One owner thread; `wake` from any.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
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

    // What `add` would find wrong with it before anything is opened or waited for: options, and a file that is missing or no recording.
    [[nodiscard]] SetupResult<void> check(const endpoint::Endpoint& endpoint) const;

    // Opens the endpoint; a ring that is not there is told of by `on_notice` and waited for, without end; a tlog:// is read from
    // `skip` behind its earliest record. `default_speed` holds where the URL has no `speed=`.
    [[nodiscard]] SetupResult<link::EndpointId> add(const endpoint::Endpoint& endpoint, MonoTime now,
                                                    double default_speed = record::Pacer::max_speed,
                                                    Nanoseconds skip = {});

    // A ring alone, which these calls are about: `remove` closes it and its inlet (not inside a callback); a ring that is held is not read until it is let
    // go, for want of room at whoever takes its frames; `inlet` is the endpoint of its inlet, opened at the first call.
    [[nodiscard]] SetupResult<link::EndpointId> add_ring(const endpoint::Endpoint& endpoint,
                                                         const dialect::Dialect* dialect = nullptr);
    void remove_ring(link::EndpointId ring);
    void hold_ring(link::EndpointId ring, bool held) noexcept;
    [[nodiscard]] SetupResult<link::EndpointId> inlet(link::EndpointId ring);
    // What came out of it, and what was not handed over.
    [[nodiscard]] const link::LinkCounters& ring_counters(link::EndpointId ring) const noexcept;
    void add_ring_to(link::EndpointId ring, Totals& totals) const noexcept;

    struct SourceLoss {
        LinkId link;
        wire::SequenceStats stats;
    };
    // What each source lost on each link of a live endpoint that is there, or of a ring.
    [[nodiscard]] std::vector<SourceLoss> losses(link::EndpointId endpoint) const;

    // The same of the ring's link `name` alone: before it is forgotten (`on_link_down`).
    [[nodiscard]] std::span<const wire::SequenceStats> ring_losses(link::EndpointId ring, const std::string& name) const;

    // One turn of the links, then what stands in the rings, then the recordings that are due, the earliest first, as far as there is room. Returns the
    // number of frames handed over.
    std::size_t turn(link::LinkHandler& handler, MonoTime deadline, Room room);

    // At the end: hands over what had arrived from live sources when the end was asked for, rings as far as there is `room`, asked before each turn
    // and after the last (the recordings' is not used), until several turns in a row brought no frame, at most what a full receive buffer holds.
    void drain(link::LinkHandler& handler, const std::function<Room()>& room);

    [[nodiscard]] bool has_recordings() const noexcept { return !recordings_.empty(); }

    // Sends a frame to every live source, to a ring's inlet where there is one: what a destination answered goes back. Returns the
    // number of links that took it.
    std::size_t send(const wire::FrameView& frame);

    // Adds all that is here now, after asking the kernel for its drops: at the end. What links that went had counted is added by whoever
    // hears of their end (`on_link_down`).
    void add_to(Totals& totals);

    // Every source is a recording and all were read to their end.
    [[nodiscard]] bool finished() const noexcept;
    [[nodiscard]] bool finished_recordings() const noexcept;
    // The first error that ended a recording before its end.
    [[nodiscard]] const SetupError* error() const noexcept;

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
        std::optional<record::Record> next;  // read, not yet handed over
        MonoTime due{};
        bool ended = false;
        std::optional<SetupError> error{};  // why it ended early
    };
    [[nodiscard]] const std::vector<std::unique_ptr<Recording>>& recordings() const noexcept { return recordings_; }

private:
    // Ids of recordings lie above all that Links gives.
    static constexpr std::uint32_t first_recording_id = 0x8000'0000;

    Sources(std::unique_ptr<link::Links> links, const wire::MessageTable& table, Copies copies);
    // Reads its next record. False: it met much damage and gives way to links and signals.
    bool advance(Recording& recording, link::LinkHandler& handler);
    std::size_t play(link::LinkHandler& handler, std::size_t most_frames);
    [[nodiscard]] Recording* earliest() noexcept;

    std::unique_ptr<link::Links> links_;
    const wire::MessageTable* table_;
    std::unique_ptr<ring::RingSources> rings_;  // its thread wakes the links
    std::vector<std::unique_ptr<Recording>> recordings_;
    std::vector<link::EndpointId> live_;
};

}  // namespace mavloom::feed
