// SPDX-License-Identifier: MIT
// The counter page of a program that has no ring, /dev/shm/mavloom.NAME.stat, with the same contents as that of a ring.
// One owner thread.
#pragma once

#include <chrono>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mavloom/ring/page.hpp"

namespace mavloom::ring {

class OwnPage {
public:
    // Errors are those of shm::CounterPage::create. The destructor removes the page.
    [[nodiscard]] static SetupResult<OwnPage> open(const std::string& name);

    void on_link_up(LinkId link, std::string_view name) {
        has_changed_ = true;
        page_.name_link(link, name);
    }
    void on_link_down(LinkId link) {
        has_changed_ = true;
        page_.link_removed(link);
    }

    // Call after each turn. If frames arrived or links changed, the page becomes due within a quarter of a second.
    void note_turn(std::size_t frames, MonoTime now) noexcept {
        const bool is_new = std::exchange(has_changed_, false) || frames != 0;
        if (is_new && due_ == MonoTime::max()) due_ = now + page_interval;
    }
    [[nodiscard]] MonoTime due() const noexcept { return due_; }
    void refresh(const link::Links& links, std::optional<link::EndpointId> inlet, std::span<const OwnCount> own);

    // Call about once a second. Creates a removed page again. Returns notices for the log, each once.
    [[nodiscard]] std::vector<std::string> maintain(const link::Links& links);

private:
    static constexpr std::chrono::milliseconds page_interval{250};

    OwnPage(std::string name, RingPage page) : name_(std::move(name)), page_(std::move(page)) {}

    std::string name_;
    RingPage page_;
    MonoTime due_{};
    bool has_changed_ = false;
    bool has_reported_ = false;  // that the page cannot be created again
};

}  // namespace mavloom::ring
