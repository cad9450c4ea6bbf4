// SPDX-License-Identifier: MIT
// What replay and relay share on the way out: the endpoints of `--to`, whether somebody is there, room in their queues, and the sums at the end.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "command.hpp"
#include "mavloom/link/links.hpp"
#include "mavloom/record/rotating_writer.hpp"
#include "traffic_report.hpp"

namespace mavloom::app {

// The recording that a tlog:// destination names, rotated as its options say. Errors begin with `option`.
[[nodiscard]] SetupResult<record::RotatingWriter> create_recording(const Common& common,
                                                                   const endpoint::Endpoint& endpoint,
                                                                   std::string_view option);
// "x.tlog: 12 frames, 348 bytes written", and in how many files.
void say_recorded(const Common& common, const record::RotatingWriter& file);
[[nodiscard]] Json recorded_json(const record::RotatingWriter& file);

class Destinations {
public:
    // Opens every address; `links` must outlive the object.
    [[nodiscard]] static SetupResult<Destinations> open(const Common& common, const std::vector<std::string>& addresses,
                                                        link::Links& links);

    // Queues the frame for all that are there, and writes it to the files with its time; false when nobody is there.
    bool send(const wire::FrameView& frame, WallTime time);
    // How many frames of any length all queues still take: what a recording may send now.
    [[nodiscard]] std::size_t room_in_frames() const;
    // Every endpoint has at least one link.
    [[nodiscard]] bool all_up() const;
    [[nodiscard]] bool has(link::EndpointId endpoint) const noexcept;

    // Frames were dropped, had nobody there, or were left in a queue at the end.
    [[nodiscard]] bool lost_any() const;
    // How many frames `send` was given.
    [[nodiscard]] std::uint64_t given() const noexcept { return given_; }
    // There is no file among them, and not one frame was sent to anybody.
    [[nodiscard]] bool reached_nobody() const;
    // Writes what the files still buffer. The first error of a file, now or earlier, is returned.
    [[nodiscard]] SetupResult<void> close();
    // A file could not be written: the command ends.
    [[nodiscard]] bool failed() const noexcept { return failure_.has_value(); }

    // "udpout://…: 40087 frames, 1834899 bytes sent" for each, and what did not get there.
    void say_sums(const Common& common) const;
    // The same as an array: "endpoint", "frames", "bytes" and the rest (docs/guide/relay.md).
    [[nodiscard]] Json sums_json() const;
    [[nodiscard]] std::uint64_t sent() const noexcept { return sent_; }

private:
    explicit Destinations(link::Links& links) : links_(&links) {}
    struct Sums {
        std::uint64_t frames = 0, bytes = 0, dropped = 0, refused = 0, not_sent = 0, came_back = 0;
    };
    [[nodiscard]] Sums sums_of(const link::EndpointInfo& info) const;
    [[nodiscard]] SetupResult<void> add(const Common& common, const endpoint::Endpoint& endpoint);
    void keep(SetupResult<void> result);

    link::Links* links_;
    std::vector<link::EndpointId> endpoints_;
    std::vector<std::size_t> queue_bytes_;
    std::vector<record::RotatingWriter> files_;
    std::optional<SetupError> failure_;
    std::vector<std::uint64_t> nobody_there_;  // frames, by endpoint
    std::uint64_t given_ = 0, sent_ = 0;
};

}  // namespace mavloom::app
