// SPDX-License-Identifier: MIT
// The output side of replay and relay: the endpoints of `--to`.
// Destinations sends frames to them and reports whether they have peers, how much room their queues have, and the
// totals at the end. Single owner; `links` must outlive it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "command.hpp"
#include "mavloom/link/links.hpp"
#include "mavloom/record/rotating_writer.hpp"
#include "traffic_report.hpp"

namespace mavloom::app {

// Creates the recording of a tlog:// destination. It rotates as the endpoint's options say. Error texts begin with
// `option`.
[[nodiscard]] SetupResult<record::RotatingWriter> create_recording(const Common& common,
                                                                   const endpoint::Endpoint& endpoint,
                                                                   std::string_view option);
// Logs "x.tlog: 12 frames, 348 bytes written". Adds the number of files, if several, and the frames that were not
// written.
void say_recorded(const Common& common, const record::RotatingWriter& file);
[[nodiscard]] Json recorded_json(const record::RotatingWriter& file);

class Destinations {
public:
    // Opens every address; `links` must outlive the object.
    [[nodiscard]] static SetupResult<Destinations> open(const Common& common, const std::vector<std::string>& addresses,
                                                        link::Links& links);

    // Queues the frame for every peer of every endpoint, and writes it to the files with `time`. Returns false if no
    // peer and no file took it.
    bool send(const wire::FrameView& frame, WallTime time);
    // How many frames of maximum length still fit into every queue. A recording may send that many now.
    [[nodiscard]] std::size_t room_in_frames() const;
    // Whether every endpoint has at least one link that is up.
    [[nodiscard]] bool all_up() const;
    [[nodiscard]] bool has(link::EndpointId endpoint) const noexcept;

    // Whether frames were dropped, failed to send, had no peer, or were still queued at the end.
    [[nodiscard]] bool lost_any() const;
    // How many frames were passed to `send`.
    [[nodiscard]] std::uint64_t given() const noexcept { return given_; }
    // Whether there are no files and no frame was sent to any peer.
    [[nodiscard]] bool reached_nobody() const;
    // Writes what the files still buffer and closes them. Returns the first error of any file, including earlier ones.
    [[nodiscard]] SetupResult<void> close();
    // Whether a file could not be written. The command must then end.
    [[nodiscard]] bool failed() const noexcept { return failure_.has_value(); }

    // Logs "udpout://…: 40087 frames, 1834899 bytes sent" for each destination, and how many frames were lost and why.
    void say_sums(const Common& common) const;
    // Returns the same totals as a JSON array. docs/guide/relay.md lists the keys.
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
    std::vector<std::uint64_t> nobody_there_;  // frames without a peer, for each endpoint
    std::uint64_t given_ = 0, sent_ = 0;
};

}  // namespace mavloom::app
