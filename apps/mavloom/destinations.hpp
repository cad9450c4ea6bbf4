// SPDX-License-Identifier: MIT
// What replay and relay share on the way out: the endpoints of `--to`, whether somebody is there, room in their queues, and the sums at the end.
#pragma once

#include <string>
#include <vector>

#include "command.hpp"
#include "mavloom/runtime/links.hpp"

namespace mavloom::app {

class Destinations {
public:
    // Opens every address; `links` must outlive the object.
    [[nodiscard]] static SetupResult<Destinations> open(const Common& common, const std::vector<std::string>& addresses, runtime::Links& links);

    // Queues the frame for all that are there; false when nobody is.
    bool send(const wire::FrameView& frame);
    // Queues hold little enough that a recording may go on.
    [[nodiscard]] bool have_room() const;
    // Every endpoint has at least one link.
    [[nodiscard]] bool all_up() const;
    [[nodiscard]] bool has(runtime::EndpointId endpoint) const noexcept;

    // "udpout://…: 40087 frames, 1834899 bytes" for each, and what was dropped on the way.
    void say_sums(const Common& common) const;
    [[nodiscard]] std::uint64_t sent() const noexcept { return sent_; }
    [[nodiscard]] std::uint64_t nobody_there() const noexcept { return nobody_there_; }

private:
    explicit Destinations(runtime::Links& links) : links_(&links) {}

    runtime::Links* links_;
    std::vector<runtime::EndpointId> endpoints_;
    std::vector<std::size_t> queue_bytes_;
    std::uint64_t sent_ = 0, nobody_there_ = 0;
};

}  // namespace mavloom::app
