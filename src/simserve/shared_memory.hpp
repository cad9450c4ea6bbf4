// SPDX-License-Identifier: MIT
// The shared memory of a simulator that other processes read: its ring, if it has one, and its counter page. Private to
// module simserve; single owner thread.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/config/config.hpp"
#include "mavloom/link/links.hpp"
#include "mavloom/ring/own_page.hpp"
#include "mavloom/ring/tap.hpp"

namespace mavloom::simserve {

class SharedMemory {
public:
    // A thread of the ring calls `ready` when `maintain` has something to do.
    [[nodiscard]] SetupResult<void> open_ring(const config::RingConfig& config, std::function<void()> ready);
    [[nodiscard]] SetupResult<void> open_page(const std::string& name);
    void close() noexcept;  // the counts stay

    // The link whose frames go into the ring; LinkId{} without a ring.
    [[nodiscard]] LinkId ring_link() const noexcept { return ring_link_; }
    [[nodiscard]] std::string ring_link_name() const { return "shm://" + ring_name_; }
    void write(const wire::FrameView& frame) noexcept {
        if (!ring_) return;  // closed
        ++frames_;
        bytes_ += frame.size();
        ring_->write({frame, nullptr, ring_link_, {}, wall_now()}, route::Verdict::forwarded, false);
    }
    [[nodiscard]] std::uint64_t frames() const noexcept { return frames_; }
    [[nodiscard]] std::uint64_t bytes() const noexcept { return bytes_; }

    void on_link_up(LinkId link, std::string_view name);
    void on_link_down(LinkId link);
    void refresh_page(const link::Links& links, std::optional<link::EndpointId> inlet,
                      std::span<const ring::OwnCount> counts);
    // Call about once a second. Creates a removed ring or page again. Returns notices for the log.
    [[nodiscard]] std::vector<std::string> maintain(const link::Links& links);

private:
    std::unique_ptr<ring::RingTap> ring_;
    std::optional<ring::OwnPage> page_;  // without a ring
    std::string ring_name_;
    LinkId ring_link_{};
    std::uint64_t frames_ = 0, bytes_ = 0;
};

}  // namespace mavloom::simserve
