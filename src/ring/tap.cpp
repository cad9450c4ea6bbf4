// SPDX-License-Identifier: MIT
#include "mavloom/ring/tap.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <system_error>
#include <utility>

#include "mavloom/base/thread.hpp"

namespace mavloom::ring {

RingTap::RingTap(std::string name, const shm::RingOptions& options, shm::RingWriter writer,
                 std::optional<RingPage> page, std::function<void()> ready)
    : name_(std::move(name)),
      options_(options),
      ready_(std::move(ready)),
      writer_(std::move(writer)),
      page_(std::move(page)) {}

// Another user may have put anything in its place: a file, a folder, a symbolic link.
static bool is_no_page_of_ours(SetupCode code) noexcept {
    return code == SetupCode::permission || code == SetupCode::bad_input || code == SetupCode::system;
}

// Opens the ring first: the process that holds its writer lock also owns the page.
SetupResult<std::unique_ptr<RingTap>> RingTap::open(const std::string& name, shm::RingOptions options,
                                                    std::function<void()> ready) {
    options.sets_aside = true;
    const auto left = shm::read_counters(name);  // read first: opening the writer removes a killed router's page
    auto writer = shm::RingWriter::open(name, options);
    if (!writer) return tl::unexpected(std::move(writer.error()));
    auto page = RingPage::create(name, options.mode);
    const bool is_taken = !page && is_no_page_of_ours(page.error().code);  // maintain() reports it
    if (!page && !is_taken) {
        (void)writer->close(writer->created() ? shm::RingWriter::Leave::nothing : shm::RingWriter::Leave::ring);
        return tl::unexpected(std::move(page.error()));
    }
    std::optional<RingPage> owned;
    if (page) owned.emplace(std::move(*page));
    auto tap = std::unique_ptr<RingTap>(
        new RingTap(name, options, std::move(*writer), std::move(owned), std::move(ready)));
    tap->carry_on(left ? left->links : std::map<LinkId, std::string>{});
    return tap;
}

void RingTap::carry_on(const std::map<LinkId, std::string>& names) {
    last_link_ = writer_.last_link();
    const auto end = names.lower_bound(shm::end_of_link_numbers);
    if (end != names.begin()) last_link_ = std::max(last_link_, std::prev(end)->first);
    if (page_) page_->inherit(names);
}

RingTap::~RingTap() {
    if (making_.valid())
        if (auto made = making_.get()) writer_ = std::move(*made);
    const bool removes = ran_ || writer_.created();
    (void)writer_.close(removes ? shm::RingWriter::Leave::nothing : shm::RingWriter::Leave::ring);
}

void RingTap::refresh_page(const link::Links& links, std::optional<link::EndpointId> inlet,
                           std::span<const OwnCount> own) {
    page_due_ = MonoTime::max();
    if (page_) page_->refresh(links.links(), links.endpoints(), inlet, {writer_.records(), dropped_.value()}, own);
}

std::vector<std::string> RingTap::maintain(const link::Links& links) {
    std::vector<std::string> notices;
    if (!noted_aside_) {
        note_aside(notices);
        note_page_aside(notices);
    }
    if (!making_.valid() && writer_.is_removed()) recreate_ring();
    else if (making_.valid() && making_.wait_for(Nanoseconds{}) == std::future_status::ready) take_new_ring(notices);
    if (!page_ || page_->is_removed()) recreate_page(links, notices);
    return notices;
}

// Runs one job at a time. If no thread can be started, the next maintain() tries again.
template <class Work>
void RingTap::run_in_background(Work work) {
    if (background_.joinable()) background_.join();
    try {
        const BlockedSignals blocked;
        background_ = std::jthread(std::move(work));
    } catch (const std::system_error&) {
        making_ = {};
    }
}

// Runs on another thread than the routing. The kernel takes 5 to 20 ms to provide 8 MiB, and seconds for gigabytes.
// Until then, frames go into the old ring.
void RingTap::recreate_ring() {
    std::packaged_task<SetupResult<shm::RingWriter>()> task(
        [name = name_, options = options_] { return shm::RingWriter::open(name, options); });
    making_ = task.get_future();
    run_in_background([task = std::move(task), ready = ready_]() mutable {
        task();
        ready();
    });
}

void RingTap::note_aside(std::vector<std::string>& notices) {
    noted_aside_ = true;
    if (const auto& why = writer_.set_aside(); !why.empty())
        notices.push_back(fmt::format("{}; it was renamed to mavloom.{}.aside", why, name_));
}

void RingTap::note_page_aside(std::vector<std::string>& notices) const {
    if (page_ && !page_->set_aside().empty())
        notices.push_back(fmt::format("{}; it was renamed to mavloom.{}.stat.aside", page_->set_aside(), name_));
}

void RingTap::take_new_ring(std::vector<std::string>& notices) {
    auto created = making_.get();
    shm::RingWriter old = std::move(writer_);
    if (created) {
        writer_ = std::move(*created);
        notices.push_back(fmt::format("ring {} was removed; it is created again", name_));
        note_aside(notices);
    } else if (!reported_ring_) {
        notices.push_back(
            fmt::format("ring {} was removed: {}; trying again every second, and counting its frames as dropped", name_,
                        created.error().text));
    }
    reported_ring_ = !created;
    run_in_background([old = std::move(old)] {});  // releasing the memory takes time too
}

void RingTap::recreate_page(const link::Links& links, std::vector<std::string>& notices) {
    auto created = RingPage::create(name_, options_.mode);
    if (!created) {
        if (!std::exchange(reported_page_, true))
            notices.push_back(fmt::format("no counter page for ring {}: {}", name_, created.error().text));
        page_.reset();
        return;
    }
    reported_page_ = false;
    page_.emplace(std::move(*created));
    note_page_aside(notices);
    for (const auto& link : links.links()) page_->name_link(link.id, link.name);
    page_due_ = MonoTime{};
}

}  // namespace mavloom::ring
