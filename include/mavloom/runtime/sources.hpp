// SPDX-License-Identifier: MIT
// What listen, record, relay and replay read: live links and recordings behind one handler, on one loop. A recording's frames come at its pace
// (`speed=`), or as fast as the caller takes them. One owner thread; `wake` from any.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mavloom/dialect/dialect.hpp"
#include "mavloom/record/pacer.hpp"
#include "mavloom/record/tlog_reader.hpp"
#include "mavloom/runtime/links.hpp"
#include "mavloom/runtime/totals.hpp"

namespace mavloom::runtime {

class Sources {
public:
    // `dialect` must outlive the object.
    [[nodiscard]] static SetupResult<Sources> create(const dialect::Dialect& dialect);

    // What `add` would find wrong with it before anything is opened or waited for: options, and a file that is missing or no recording.
    [[nodiscard]] SetupResult<void> check(const Endpoint& endpoint) const;

    // Opens the endpoint; a tlog:// is read from `skip` behind its earliest record. `default_speed` holds where the URL has no `speed=`.
    [[nodiscard]] SetupResult<void> add(const Endpoint& endpoint, MonoTime now,
                                        double default_speed = record::Pacer::max_speed, Nanoseconds skip = {});

    // One turn of the links, then at most `most_frames` frames of the recordings that are due, the earliest first. Returns the number of frames handed over.
    std::size_t turn(LinkHandler& handler, MonoTime deadline, std::size_t most_frames);

    // At the end: hands over what had arrived from live sources when the end was asked for, `after_turn` after each turn, until several turns in
    // a row brought no frame, at most what a full receive buffer holds.
    void drain(
        LinkHandler& handler, const std::function<void()>& after_turn = [] {});

    [[nodiscard]] bool has_recordings() const noexcept { return !recordings_.empty(); }

    // Sends a frame to every live source: what a destination answered goes back. Returns the number of links that took it.
    std::size_t send(const wire::FrameView& frame);

    // Adds all that is here now, after asking the kernel for its drops: at the end. What links that went had counted is added by whoever
    // hears of their end (`on_link_down`).
    void add_to(Totals& totals);

    // Every source is a recording and all were read to their end.
    [[nodiscard]] bool finished() const noexcept { return live_.empty() && finished_recordings(); }
    [[nodiscard]] bool finished_recordings() const noexcept;
    // The first error that ended a recording before its end.
    [[nodiscard]] const SetupError* error() const noexcept;

    [[nodiscard]] Links& links() noexcept { return *links_; }
    [[nodiscard]] const Links& links() const noexcept { return *links_; }
    void wake() noexcept { links_->wake(); }

    struct Recording {
        LinkId link;
        EndpointId endpoint;
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

    explicit Sources(std::unique_ptr<Links> links) noexcept : links_(std::move(links)) {}
    // Reads its next record. False: it met much damage and gives way to links and signals.
    bool advance(Recording& recording, LinkHandler& handler);
    std::size_t play(LinkHandler& handler, std::size_t most_frames);
    [[nodiscard]] Recording* earliest() noexcept;

    std::unique_ptr<Links> links_;
    const wire::MessageTable* table_ = nullptr;
    std::vector<std::unique_ptr<Recording>> recordings_;
    std::vector<EndpointId> live_;
};

}  // namespace mavloom::runtime
