// SPDX-License-Identifier: MIT
#include "mavloom/router/router.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "mavloom/control/post_box.hpp"
#include "mavloom/link/flush.hpp"
#include "mavloom/link/silence_watch.hpp"
#include "mavloom/ring/own_page.hpp"
#include "mavloom/ring/tap.hpp"
#include "router/endpoints.hpp"
#include "router/forwarder.hpp"
#include "router/recordings.hpp"
#include "router/report/snapshot.hpp"

namespace mavloom::router {

using namespace std::chrono_literals;

static constexpr Nanoseconds maintain_interval = 1s;  // interval of maintain()

Router::Router(const dialect::Dialect& dialect, const config::RouterConfig& config, Notice notice,
               std::unique_ptr<link::Links> links)
    : dialect_(dialect),
      has_heartbeat_(config.heartbeat.has_value()),
      notice_(std::move(notice)),
      links_(std::move(links)),
      endpoints_(std::make_unique<RoutedEndpoints>(dialect, *links_, notice_)),
      forwarder_(std::make_unique<Forwarder>(dialect, config, *links_)),
      silence_(std::make_unique<link::SilenceWatch>()),
      posted_(std::make_unique<control::PostBox>()),
      recordings_(std::make_unique<Recordings>(notice_,
                                               [this](std::string text) {
                                                   post([this, line = std::move(text)] {
                                                       notice_(config::LogLevel::warning, line);
                                                   });
                                               })),
      snapshots_(std::make_unique<Snapshots>()) {}

Router::~Router() {
    // Stops the threads that may call post().
    ring_.reset();
    recordings_->stop();
}

SetupResult<std::unique_ptr<Router>> Router::create(const dialect::Dialect& dialect, const config::RouterConfig& config,
                                                    Notice notice) {
    auto links = link::Links::create(dialect, endpoint::RoutingOptions::by_owner);
    if (!links) return tl::unexpected(std::move(links.error()));
    return std::unique_ptr<Router>(new Router(dialect, config, std::move(notice), std::move(*links)));
}

SetupResult<void> Router::open_ring(const config::RingConfig& config) {
    auto opened = ring::RingTap::open(config.name, {config.capacity_bytes, config.full, config.mode},
                                      [this] { post([this] { maintain_ring(); }); });
    if (!opened) return tl::unexpected(std::move(opened.error()));
    ring_ = std::move(*opened);
    links_->count_from(ring_->last_link());
    return {};
}

SetupResult<void> Router::open_page(const std::string& name) {
    auto opened = ring::OwnPage::open(name);
    if (!opened) return tl::unexpected(std::move(opened.error()));
    page_ = std::make_unique<ring::OwnPage>(std::move(*opened));
    return {};
}

SetupResult<void> Router::open_inlet(const config::RingConfig& config, const std::filesystem::path& socket) {
    return endpoints_->add_inlet(config, socket);
}

void Router::configure(const config::RouterConfig& config) {
    has_heartbeat_ = config.heartbeat.has_value();
    forwarder_->configure(config);
}

const route::Engine& Router::engine() const noexcept { return forwarder_->engine(); }
const route::LinkCounters* Router::verdicts(LinkId link) const { return forwarder_->verdicts(link); }

const observe::TrafficTable& Router::traffic() const noexcept { return forwarder_->traffic(); }
const NewestHeartbeats& Router::newest_heartbeats() const noexcept { return forwarder_->newest_heartbeats(); }

std::uint64_t Router::heartbeats_sent() const noexcept { return forwarder_->heartbeats_sent(); }

std::uint64_t Router::not_signed() const noexcept { return forwarder_->not_signed(); }

std::vector<const record::Recorder*> Router::recorders() const {
    std::vector<const record::Recorder*> all;
    recordings_->each([&](const record::Recorder& recorder) { all.push_back(&recorder); });
    return all;
}

void Router::explain(Explainer explainer) { forwarder_->explain(std::move(explainer)); }

// ---- links and frames -----------------------------------------------------------------------------------------------

void Router::on_frame(const link::RxFrame& rx) {
    const RoutedEndpoint& from = endpoints_->of(rx.endpoint);
    const std::uint64_t mark = forwarder_->mark_of(rx);
    recordings_->record(rx);
    const auto decision = forwarder_->decide(rx, mark);
    if (ring_) ring_->write(rx, decision.verdict, from.verifies);
    forwarder_->deliver(rx, decision, from);
}

void Router::on_link_up(LinkId link, link::EndpointId endpoint, std::string_view name) {
    if (ring_) ring_->on_link_up(link, name);
    if (page_) page_->on_link_up(link, name);
    RoutedEndpoint& at = endpoints_->of(endpoint);
    if (!forwarder_->add_link(link, at))
        return notice_(config::LogLevel::warning, fmt::format("{}: more than {} links; the router sends nothing to it",
                                                              name, route::Engine::max_links));
    silence_->on_link_up(link, endpoint, mono_now());
    if (at.lines.spend()) notice_(config::LogLevel::info, fmt::format("{}: up", name));
}

void Router::on_link_down(LinkId link, link::EndpointId endpoint, std::string_view why) {
    if (endpoints_->of(endpoint).lines.spend())
        notice_(config::LogLevel::info, fmt::format("{}: down, {}", links_->link_name(link), why));
    forget_link(link);
}

void Router::forget_link(LinkId link) {
    if (ring_) ring_->on_link_down(link);
    if (page_) page_->on_link_down(link);
    forwarder_->remove_link(link);
    silence_->on_link_down(link, links_->counters(link));
}

void Router::on_notice(link::EndpointId, std::string_view text) { notice_(config::LogLevel::info, text); }

// ---- turns ----------------------------------------------------------------------------------------------------------

void Router::turn(MonoTime deadline) {
    const MonoTime work_due = posted_->empty() ? MonoTime::max() : work_due_;
    const std::size_t frames = links_->turn(*this, std::min({deadline, next_due(), work_due}));
    const MonoTime now = mono_now();
    if (frames != 0) recordings_->publish();
    note_turn(frames, now);
    if (!posted_->empty() && now >= work_due_) run_posted(now);
    forwarder_->send_due(now);
    if (now >= maintain_due_) maintain(now);
}

void Router::note_turn(std::size_t frames, MonoTime now) {
    if (ring_) ring_->note_turn(frames, now);
    else if (page_) page_->note_turn(frames, now);
    else return;
    if (now >= (ring_ ? ring_->page_due() : page_->due())) refresh_page();
}

// Runs one item, because reports take long and frames go first. The next item waits four times as long as this one
// took, so that a flood of requests takes at most a fifth of the time.
void Router::run_posted(MonoTime now) {
    posted_->run_one();
    const MonoTime end = mono_now();
    work_due_ = end + 4 * (end - now);
}

MonoTime Router::next_due() const noexcept {
    const MonoTime due = std::min(maintain_due_, forwarder_->next_due());
    return ring_ ? std::min(due, ring_->page_due()) : page_ ? std::min(due, page_->due()) : due;
}

void Router::finish(Nanoseconds limit) {
    const MonoTime end = mono_now() + limit;
    handle_arrived(end);
    recordings_->publish();
    link::flush(*links_, *this, end - mono_now());
    recordings_->stop();
    while (!posted_->empty()) posted_->run_one();
    endpoints_->remove_inlet();
    ring_.reset();
    page_.reset();
}

// The limits matter in a flood, or after costly frames (ReadBudget). A turn may read only junk, so a single turn
// without a frame does not end the loop.
void Router::handle_arrived(MonoTime end) {
    constexpr int max_turns = 64, max_empty = 4;
    for (int turns = 0, empty = 0; turns < max_turns && empty < max_empty && mono_now() < end; ++turns)
        empty = links_->turn(*this, MonoTime{}) == 0 ? empty + 1 : 0;
}

void Router::post(std::function<void()> work) {
    posted_->post(std::move(work));
    wake();
}

void Router::drop_posted() { posted_->drop(); }

void Router::maintain(MonoTime now) {
    maintain_due_ = now + maintain_interval;
    endpoints_->refill_lines();
    maintain_ring();
    report_silence(now);
    recordings_->maintain();
    for (const auto& warning : forwarder_->maintain()) notice_(config::LogLevel::warning, warning);
}

void Router::report_silence(MonoTime now) {
    for (const auto& text : link::poll_silence(*silence_, *links_, now)) notice_(config::LogLevel::warning, text);
}

void Router::maintain_ring() {
    if (!ring_ && !page_) return;
    for (const auto& text : ring_ ? ring_->maintain(*links_) : page_->maintain(*links_))
        notice_(config::LogLevel::warning, text);
    sum_verdicts();
    refresh_page();
}

void Router::refresh_page() {
    if (ring_) ring_->refresh_page(*links_, endpoints_->inlet(), page_counts_);
    else page_->refresh(*links_, endpoints_->inlet(), page_counts_);
}

// The verdicts of all links together: the counters of each link would make the page too long. Once a second, because
// there may be thousands of links.
void Router::sum_verdicts() {
    page_counts_.clear();
    for (const auto& verdict : route::link_verdicts) page_counts_.push_back({verdict.name, 0, shm::CounterType::gauge});
    for (const LinkId link : links_->link_ids())
        if (const auto* const of_link = verdicts(link))
            for (std::size_t i = 0; i < page_counts_.size(); ++i)
                page_counts_[i].value += (of_link->*route::link_verdicts[i].word).value();
}

}  // namespace mavloom::router
