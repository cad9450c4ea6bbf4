// SPDX-License-Identifier: MIT
// The outputs of `relay` and `replay`: live endpoints and recordings. Destinations sends each frame to all of them. It
// reports whether they have peers, how much room their queues have, and what each one sent and lost.
//
// One owner, on the thread that drives the links. A file that cannot be written does not stop the other destinations:
// `failed` reports it, and `close` returns the error.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mavloom/link/links.hpp"
#include "mavloom/record/rotating_writer.hpp"

namespace mavloom::feed {

// Creates the recording of a tlog:// destination. The endpoint's options set its rotation.
[[nodiscard]] SetupResult<record::RotatingWriter> create_recording(const endpoint::Endpoint& endpoint);

// Counts of the frames for one live destination, including those on links that are gone. docs/guide/relay.md
// explains them.
struct Delivery {
    std::string name;
    std::uint64_t frames = 0, bytes = 0;  // sent
    std::uint64_t dropped = 0;            // whole frames, from a queue
    std::uint64_t refused = 0, not_sent = 0;
    std::uint64_t nobody_there = 0;  // frames for which there was no link
    std::uint64_t send_errors = 0;   // datagrams that the peer's port refused (ICMP) or the kernel rejected
    std::uint64_t queued_bytes = 0;  // not sent yet

    [[nodiscard]] bool lost_any() const noexcept {
        return dropped != 0 || nobody_there != 0 || send_errors != 0 || queued_bytes != 0;
    }
};

class Destinations {
public:
    using OnFile = std::function<void(const record::RotatingWriter&)>;

    // Opens the endpoints; `links` must outlive the object. It opens files last: creating a file renames an existing
    // one, and that must not happen if a link cannot be opened. `on_file` is called for each file that was created,
    // even if a later one fails.
    [[nodiscard]] static SetupResult<Destinations> open(std::span<const endpoint::Endpoint> endpoints,
                                                        link::Links& links, const OnFile& on_file = {});

    // Queues the frame for every peer of every endpoint, and writes it to the files with `time`. Returns false if no
    // peer and no file took it.
    bool send(const wire::FrameView& frame, WallTime time);
    // Returns how many more frames of maximum length fit into every queue. A source that can pause should deliver no
    // more than that.
    [[nodiscard]] std::size_t room_in_frames() const;
    // Whether every endpoint has at least one link that is up.
    [[nodiscard]] bool all_up() const;
    [[nodiscard]] bool has(link::EndpointId endpoint) const noexcept;

    // How many frames were passed to `send`, and how many of them a peer or file took.
    [[nodiscard]] std::uint64_t given() const noexcept { return given_; }
    [[nodiscard]] std::uint64_t sent() const noexcept { return sent_; }
    // One entry for each live endpoint, in the order of `open`.
    [[nodiscard]] std::vector<Delivery> deliveries() const;
    [[nodiscard]] std::span<const record::RotatingWriter> files() const noexcept { return files_; }
    // Whether a live endpoint lost frames (Delivery::lost_any()).
    [[nodiscard]] bool lost_any() const;
    // True if there are no files and no frame was sent to any peer.
    [[nodiscard]] bool reached_no_destination() const;

    using OnNotice = std::function<void(std::string_view)>;
    // Calls RotatingWriter::maintain of each file, and reports files that were removed to `on_notice`. Call it at
    // least once a second.
    void maintain_files(MonoTime now, const OnNotice& on_notice);
    // Whether a file could not be written. The command must then end.
    [[nodiscard]] bool failed() const noexcept { return failure_.has_value(); }
    // Writes what the files still buffer and closes them. Reports files that were removed to `on_notice`. Returns the
    // first error of any file, including earlier ones.
    [[nodiscard]] SetupResult<void> close(const OnNotice& on_notice);

private:
    struct Output {
        link::EndpointId endpoint;
        std::size_t queue_bytes = 0;
        std::uint64_t nobody_there = 0;
    };

    explicit Destinations(link::Links& links) : links_(&links) {}
    [[nodiscard]] SetupResult<void> add_link(const endpoint::Endpoint& endpoint);
    [[nodiscard]] SetupResult<void> add_file(const endpoint::Endpoint& endpoint, const OnFile& on_file);
    void keep(SetupResult<void> result);
    void report_removed(const record::RotatingWriter& file, SetupResult<std::filesystem::path> removed,
                        const OnNotice& on_notice);

    link::Links* links_;
    std::vector<Output> outputs_;
    std::vector<record::RotatingWriter> files_;
    std::optional<SetupError> failure_;
    std::uint64_t given_ = 0, sent_ = 0;
};

}  // namespace mavloom::feed
