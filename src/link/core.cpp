// SPDX-License-Identifier: MIT
#include "link/core.hpp"

#include <fmt/format.h>

#include <cassert>

namespace mavloom::link::detail {

// One read takes all that a fast sender writes during a turn. Still small enough for the second-level cache.
static constexpr std::size_t stream_buffer_bytes = 128 * 1024;
// While an outlet is blocked, frames that are too old are dropped at least this often.
static constexpr std::chrono::milliseconds expire_interval{100};

net::BlockQueue::Limits queue_limits(const endpoint::EndpointOptions& options) {
    net::BlockQueue::Limits limits;
    limits.max_bytes = static_cast<std::size_t>(options.queue_bytes);
    if (options.queue_age) limits.max_age.fill(*options.queue_age);
    return limits;
}

void LinkTable::add(Link& link) {
    if ((size_ + 1) * 2 > places_.size()) {
        std::vector<Link*> larger(places_.size() * 2);
        each([&](Link& l) { larger[l.id.value & (larger.size() - 1)] = &l; });
        places_ = std::move(larger);
    }
    do {
        ++last_;
    } while (places_[last_ & (places_.size() - 1)] != nullptr);
    places_[last_ & (places_.size() - 1)] = &link;
    ++size_;
    link.id = LinkId{last_};
}

void LinkTable::remove(LinkId id) noexcept {
    if (find(id) == nullptr) return;
    places_[id.value & (places_.size() - 1)] = nullptr;
    --size_;
}

void OpenEndpoint::count_gone(const Link& link) noexcept {
    counters.gone.add(link.counters);
    counters.gone_queued.add(link.queue.blocks());
}

Core::Core(Language language, std::unique_ptr<net::EventLoop> loop, net::ReceiveBatch batch)
    : language_(std::move(language)),
      loop_(std::move(loop)),
      resolver_([wake = loop_->wake_handle()] { net::EventLoop::wake(*wake); }),
      receive_(std::move(batch)),
      stream_(stream_buffer_bytes) {}

std::size_t Core::turn(LinkHandler& handler, MonoTime deadline) {
    assert(handler_ == nullptr && "turn must not be called inside a callback");
    handler_ = &handler;
    now_ = mono_now();
    coalescing_.count(turn_began_, now_, std::exchange(frames_this_turn_, 0), std::exchange(more_waits_, false));
    tell_backlog();
    flush();
    if (const auto until = coalescing_.rest_until(); until && deadline > now_)
        net::EventLoop::sleep_until(std::min(*until, deadline));
    loop_->wait(wait_limit(deadline));
    now_ = turn_began_ = mono_now();
    ++turns_;
    if (loop_->dispatch(now_)) collect_answers();
    run_tickers();
    expire_blocked();
    if (now_ >= key_states_.due()) save_signing_times();
    flush();
    graveyard_.clear();
    handler_ = nullptr;
    return frames_this_turn_;
}

MonoTime Core::wait_limit(MonoTime deadline) const {
    for (const Ticker* ticker : tickers_) {
        if (const auto due = ticker->tick_due()) deadline = std::min(deadline, *due);
    }
    if (!outlets_.empty()) deadline = std::min(deadline, now_ + expire_interval);
    return std::min(deadline, key_states_.due());
}

void Core::save_signing_times() {
    std::vector<std::string> notices;
    key_states_.save(now_, notices);
    for (const auto& text : notices) handler_->on_notice({}, text);
}

void Core::run_tickers() {
    if (tickers_.empty()) return;
    now_ = mono_now();
    for (std::size_t i = 0; i < tickers_.size();) {
        Ticker& ticker = *tickers_[i];
        const auto due = ticker.tick_due();
        if (due && *due <= now_) ticker.tick(now_);
        if (i >= tickers_.size() || tickers_[i] != &ticker) continue;  // it removed itself
        if (ticker.tick_due()) {
            ++i;
        } else {
            ticker.ticking = false;
            tickers_[i] = tickers_.back();
            tickers_.pop_back();
        }
    }
}

// An outlet that is still blocked stays scheduled.
void Core::flush() {
    if (outlets_.empty()) return;
    flushing_.swap(outlets_);
    for (std::size_t i = 0; i < flushing_.size(); ++i) {
        Outlet* const outlet = flushing_[i];
        if (outlet == nullptr) continue;
        outlet->scheduled = false;
        outlet->flush();
        if (flushing_[i] != nullptr && outlet->blocked()) schedule(*outlet);
    }
    flushing_.clear();
}

void Core::expire_blocked() {
    for (Outlet* outlet : outlets_) {
        if (outlet->blocked()) outlet->expire(now_);
    }
}

void Core::forget(Outlet& outlet) noexcept {
    std::erase(outlets_, &outlet);
    std::replace(flushing_.begin(), flushing_.end(), &outlet, static_cast<Outlet*>(nullptr));
    outlet.scheduled = false;
}

void Core::forget(Ticker& ticker) noexcept {
    std::erase(tickers_, &ticker);
    ticker.ticking = false;
}

bool Core::pending() const {
    bool any = false;
    links_.each([&](const Link& link) { any = any || (link.up && !link.queue.empty()); });
    return any;
}

bool Core::name_taken(const std::string& name) const {
    bool taken = false;
    links_.each([&](const Link& link) { taken = taken || link.name == name; });
    return taken;
}

void Core::add_link(Link& link) {
    const std::string wanted = link.name;
    for (int n = 2; name_taken(link.name); ++n) link.name = fmt::format("{} ({})", wanted, n);
    link.language = &language(link.endpoint);
    links_.add(link);
}

void Core::speaks(EndpointId endpoint, const dialect::Dialect& dialect) {
    languages_.emplace(endpoint, Language{dialect.wire_table(), MessageClasses(dialect)});
}

void Core::set_up(Link& link) {
    if (std::exchange(link.up, true)) return;
    if (handler_ == nullptr) {
        to_tell_up_.push_back(link.id);
        return;
    }
    link.told_up = true;
    handler_->on_link_up(link.id, link.endpoint, link.name);
}

void Core::set_down(Link& link, std::string_view why) {
    if (!std::exchange(link.up, false)) return;
    if (std::exchange(link.told_up, false) && handler_ != nullptr) handler_->on_link_down(link.id, link.endpoint, why);
}

void Core::remove_link(Link& link, std::string_view why) {
    set_down(link, why);
    links_.remove(link.id);
}

void Core::notice(EndpointId endpoint, std::string text) {
    if (handler_ != nullptr) {
        handler_->on_notice(endpoint, text);
    } else {
        notices_.emplace_back(endpoint, std::move(text));
    }
}

void Core::tell_backlog() {
    if (!notices_.empty()) {
        for (auto& [endpoint, text] : std::exchange(notices_, {})) handler_->on_notice(endpoint, text);
    }
    if (to_tell_up_.empty()) return;
    for (const LinkId id : std::exchange(to_tell_up_, {})) {
        Link* const link = links_.find(id);
        if (link == nullptr || !link->up || std::exchange(link->told_up, true)) continue;
        handler_->on_link_up(link->id, link->endpoint, link->name);
    }
}

void Core::on_frame(Link& link, const wire::ParseEvent& event, WallTime time) {
    LinkCounters& counters = link.counters;
    if (link.signature != nullptr && !link.signature->accepts(event.frame, time)) [[unlikely]] {
        counters.bad_signature.add();
        return;
    }
    counters.frames_in.add();
    counters.bytes_in.add(event.frame.size());
    if (event.info == nullptr) [[unlikely]]
        counters.unknown_ids.add();
    const auto update = owner_counts_loss_ ? wire::SequenceTracker::Update{} : count_loss(link, event.frame, event.info);
    ++frames_this_turn_;
    handler_->on_frame({event.frame, event.info, link.id, link.endpoint, time, update});
}

void Core::on_bad_bytes(Link& link, const wire::ParseEvent& event) {
    using Kind = wire::ParseEvent::Kind;
    if (event.kind == Kind::bad_checksum) {
        link.counters.crc_error.add();
        if (handler_ != nullptr) handler_->on_bad_checksum(link.id, link.endpoint, event.frame.id());
    }
    if (event.kind == Kind::junk) link.counters.junk_bytes.add(event.bytes);
    if (event.kind == Kind::unknown_flags) link.counters.unknown_flags.add();
}

bool Core::queue(Link& link, const wire::FrameView& frame) {
    if (link.finds_in_ring) {
        link.counters.frames_out.add();
        link.counters.bytes_out.add(frame.size());
        return true;
    }
    const MessageClasses::Rule rule = link.language->classes.of(frame.id());
    const auto pushed = link.queue.push(frame.bytes(), rule.block_class, MessageClasses::key(frame, rule), now_);
    if (pushed.dropped != 0) [[unlikely]]
        link.counters.queue_bytes.add(pushed.dropped);
    if (pushed.queued && !std::exchange(link.queued, true)) link.schedule();
    return pushed.queued;
}

void Core::resolve(OpenEndpoint& endpoint, const endpoint::HostPort& host) {
    questions_.emplace_back(resolver_.ask(host.host, host.port), &endpoint);
}

std::optional<net::Resolver::Answer> Core::resolve_now(const endpoint::HostPort& host, std::chrono::milliseconds limit,
                                                       OpenEndpoint& endpoint) {
    if (const auto numeric = net::Address::parse(host.host, host.port)) return std::vector<net::Address>{*numeric};
    const std::uint64_t ticket = resolver_.ask(host.host, host.port);
    auto answer = running() ? std::nullopt : resolver_.wait(ticket, limit);
    if (!answer) questions_.emplace_back(ticket, &endpoint);
    return answer;
}

void Core::collect_answers() {
    while (auto done = resolver_.take()) {
        const auto question = std::find_if(questions_.begin(), questions_.end(),
                                           [&](const auto& q) { return q.first == done->ticket; });
        if (question == questions_.end()) continue;
        OpenEndpoint* const endpoint = question->second;
        questions_.erase(question);
        endpoint->on_resolved(std::move(done->answer));
    }
}

void Core::forget(const OpenEndpoint& endpoint) noexcept {
    std::erase_if(questions_, [&](const auto& question) { return question.second == &endpoint; });
}

}  // namespace mavloom::link::detail
