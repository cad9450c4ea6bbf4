// SPDX-License-Identifier: MIT
// The writing end of a router's ring. It records every good frame once, as received, with its link and verdict, and
// maintains the ring's counter page.
//
// Readers of the ring can neither delay nor stop the router. One owner thread. Writing a frame neither allocates nor
// locks. It makes no system call, except a wake-up at most once per millisecond while a reader sleeps.
#pragma once

#include <functional>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "mavloom/link/links.hpp"
#include "mavloom/ring/frames.hpp"
#include "mavloom/ring/page.hpp"
#include "mavloom/shm/ring_writer.hpp"

namespace mavloom::ring {

class RingTap {
public:
    // Creates the ring, or continues one whose writer was killed. If the file under the ring's name is damaged, is not
    // a ring or belongs to another user, renames that file. The same applies to the page's file. The first maintain()
    // reports what was renamed. Same errors as RingWriter::open. A thread of the tap calls `ready` when maintain()
    // has something to do.
    [[nodiscard]] static SetupResult<std::unique_ptr<RingTap>> open(
        const std::string& name, shm::RingOptions options, std::function<void()> ready = [] {});
    // The last link number that the ring's earlier writers used. New links must get higher numbers, so that a slow
    // reader does not find a different link under an old number.
    [[nodiscard]] LinkId last_link() const noexcept { return last_link_; }
    RingTap(const RingTap&) = delete;
    RingTap& operator=(const RingTap&) = delete;
    // Removes the ring and its page. Exception: if the router never ran a turn, it leaves a ring that existed before.
    ~RingTap();

    // `verified`: the frame came through an endpoint with verify=.
    void write(const link::RxFrame& rx, route::Verdict verdict, bool verified) noexcept {
        const auto signature = !rx.frame.is_signed() ? FrameSignature::none
                               : verified            ? FrameSignature::good
                                                     : FrameSignature::unchecked;
        const shm::RecordInfo info{rx.time, rx.link, ring_kind_frame, ring_verdict(verdict, signature)};
        if (!writer_.write(rx.frame.bytes(), info, MonoTime{})) [[unlikely]]
            dropped_.add();
    }

    void on_link_up(LinkId link, std::string_view name) {
        links_changed_ = true;
        if (page_) page_->name_link(link, name);
    }
    void on_link_down(LinkId link) {
        links_changed_ = true;
        if (page_) page_->link_removed(link);
    }

    // Call after each turn. If frames arrived or links changed, the page becomes due within a quarter of a second.
    void note_turn(std::size_t frames, MonoTime now) noexcept {
        ran_ = true;
        const bool is_new = std::exchange(links_changed_, false) || frames != 0;
        if (is_new && page_due_ == MonoTime::max()) page_due_ = now + page_interval;
    }
    [[nodiscard]] MonoTime page_due() const noexcept { return page_due_; }
    void refresh_page(const link::Links& links, std::optional<link::EndpointId> inlet,
                      std::span<const OwnCount> own = {});

    // Call about once a second. Recreates a removed ring or page; the ring is created on another thread. Returns
    // notices for the log.
    [[nodiscard]] std::vector<std::string> maintain(const link::Links& links);

private:
    static constexpr std::chrono::milliseconds page_interval{250};

    RingTap(std::string name, const shm::RingOptions& options, shm::RingWriter writer, std::optional<RingPage> page,
            std::function<void()> ready);
    void note_aside(std::vector<std::string>& notices);
    void note_page_aside(std::vector<std::string>& notices) const;
    void recreate_ring();
    void take_new_ring(std::vector<std::string>& notices);
    template <class Work>
    void run_in_background(Work work);
    void carry_on(const std::map<LinkId, std::string>& names);
    void recreate_page(const link::Links& links, std::vector<std::string>& notices);

    std::string name_;
    shm::RingOptions options_;
    std::function<void()> ready_;
    shm::RingWriter writer_;
    std::future<SetupResult<shm::RingWriter>> making_;  // valid while the ring is being recreated
    std::jthread background_;
    std::optional<RingPage> page_;
    Counter dropped_;  // frames that the ring did not take
    MonoTime page_due_{};
    LinkId last_link_{};
    bool ran_ = false, links_changed_ = false;
    bool noted_aside_ = false;    // whether the renaming of an earlier file was reported
    bool reported_ring_ = false;  // whether the failure to recreate the ring was reported
    bool reported_page_ = false;  // the same for the page
};

}  // namespace mavloom::ring
