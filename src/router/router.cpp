// SPDX-License-Identifier: MIT
#include "mavloom/router/router.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/ring/tap.hpp"
#include "router/own_messages.hpp"
#include "router/silence_watch.hpp"

namespace mavloom::router {

static_assert(link::Links::longest_late < route::Engine::echo_window);

using namespace std::chrono_literals;

namespace {

constexpr std::size_t told_each_look = 2;
constexpr Nanoseconds look_interval = 1s;  // interval of look_after()

route::Options engine_options(const config::RouterConfig& config) {
    route::Options options;
    options.dedup = std::chrono::milliseconds(config.dedup_ms);
    options.unknown_component = config.unknown_component;
    options.unknown_target = config.unknown_target;
    options.route_timeout = config.route_timeout;
    if (config.heartbeat)
        options.own = Source{SystemId{config.heartbeat->first}, ComponentId{config.heartbeat->second}};
    options.seed = static_cast<std::uint64_t>(wall_now().time_since_epoch().count());
    return options;
}

route::FilterTerms terms_of(std::string_view option, const endpoint::FilterTerms& terms) {
    return {option, terms.messages, terms.systems, terms.components};
}

tl::unexpected<SetupError> other_mode(const endpoint::Endpoint& endpoint, endpoint::GroupMode mode) {
    return setup_error(SetupCode::usage,
                       fmt::format("{}: group '{}' has group_mode={} already: a group has one", endpoint.label(),
                                   endpoint.options.group, endpoint::group_mode_name(mode)));
}

}  // namespace

Router::Router(const dialect::Dialect& dialect, const config::RouterConfig& config, Notice notice,
               std::unique_ptr<link::Links> links)
    : dialect_(dialect),
      config_(config),
      notice_(std::move(notice)),
      links_(std::move(links)),
      engine_(dialect.wire_table(), engine_options(config)),
      own_messages_(std::make_unique<OwnMessages>(
          dialect.wire_table(), config,
          OwnMessages::Ways{[this](LinkId link, const wire::FrameView& frame) { return send_own(link, frame); },
                            [this](LinkId link) { return is_answered(link); }})),
      silence_(std::make_unique<SilenceWatch>()) {}

Router::~Router() {
    // Stops the threads that may call post().
    ring_.reset();
    for (const auto& recorder : recorders_) recorder->stop();
    for (const auto& recorder : ending_recorders_) recorder->stop();
}

SetupResult<std::unique_ptr<Router>> Router::create(const dialect::Dialect& dialect, const config::RouterConfig& config,
                                                    Notice notice) {
    auto links = link::Links::create(dialect, endpoint::RoutingOptions::by_owner);
    if (!links) return tl::unexpected(std::move(links.error()));
    return std::unique_ptr<Router>(new Router(dialect, config, std::move(notice), std::move(*links)));
}

// ---- endpoints ------------------------------------------------------------------------------------------------------

SetupResult<void> Router::add(const endpoint::Endpoint& endpoint) {
    if (endpoint.scheme == endpoint::Scheme::tlog) return add_recording(endpoint);
    if (endpoint.scheme == endpoint::Scheme::shm)
        return setup_error(SetupCode::usage, endpoint::ring_is_no_endpoint(endpoint));
    if (endpoint.options.heartbeat.value_or(false) && !config_.heartbeat)
        return setup_error(SetupCode::usage, fmt::format("{}: {}", endpoint.label(), config::heartbeat_needs_id));
    if (auto good = check_group(endpoint); !good) return good;
    auto policy = policy_of(endpoint);
    if (!policy) return tl::unexpected(std::move(policy.error()).within(endpoint.label()));
    const auto id = links_->add(endpoint);
    if (!id) return tl::unexpected(id.error());
    endpoints_.push_back(std::make_unique<OpenedEndpoint>(OpenedEndpoint{*id, endpoint, std::move(*policy)}));
    endpoints_.back()->verifies = !endpoint.options.verify_key_file.empty();
    if (endpoint.options.names_group_mode) group_modes_[endpoint.options.group] = endpoint.options.group_mode;
    any_signs_ = any_signs_ || !endpoint.options.sign_key_file.empty();
    register_endpoint(*endpoints_.back());
    return {};
}

void Router::register_endpoint(OpenedEndpoint& opened) {
    if (by_id_.size() <= opened.id.value) by_id_.resize(opened.id.value + 1);
    by_id_[opened.id.value] = &opened;
}

SetupResult<void> Router::open_ring(const config::RingConfig& config) {
    auto opened = ring::RingTap::open(config.name, {config.capacity_bytes, config.full, config.mode},
                                      [this] { post([this] { look_after_ring(); }); });
    if (!opened) return tl::unexpected(std::move(opened.error()));
    ring_ = std::move(*opened);
    links_->count_from(ring_->last_link());
    return {};
}

SetupResult<void> Router::open_inlet(const config::RingConfig& config, const std::filesystem::path& socket) {
    const auto id = links_->add_inlet(config.name, socket, config.mode & 0666u);
    if (!id) return tl::unexpected(id.error());
    inlet_ = std::make_unique<OpenedEndpoint>();
    inlet_->id = *id;
    inlet_->endpoint.scheme = endpoint::Scheme::shm;
    inlet_->endpoint.path = config.name;
    register_endpoint(*inlet_);
    return {};
}

SetupResult<void> Router::add_recording(const endpoint::Endpoint& endpoint) {
    const auto same = [&](const endpoint::Endpoint& e) {
        return endpoint::same_file(e.path) == endpoint::same_file(endpoint.path) || e.label() == endpoint.label();
    };
    if (std::ranges::any_of(recordings_, same))
        return setup_error(SetupCode::usage, fmt::format("{} is recorded already", endpoint.label()));
    if (auto good = endpoint::check_written(endpoint); !good) return good;
    std::error_code unknown;
    if (std::filesystem::is_fifo(endpoint.path, unknown))
        return setup_error(SetupCode::usage,
                           fmt::format("{} is a FIFO, and routing would wait for its reader; mavloom record writes to "
                                       "one",
                                       endpoint.path));
    const auto& o = endpoint.options;
    auto recorder = record::Recorder::create(
        endpoint.label(), endpoint.path, {o.rotate_bytes, o.rotate_every}, [this](std::string_view text) {
            post([this, line = std::string(text)] { notice_(config::LogLevel::warning, line); });
        });
    if (!recorder) return tl::unexpected(std::move(recorder.error()));
    if (const auto& old = (*recorder)->renamed_to(); !old.empty())
        notice_(config::LogLevel::info, fmt::format("{} existed and is now {}", endpoint.path, old.string()));
    recorders_.push_back(std::move(*recorder));
    recordings_.push_back(endpoint);
    return {};
}

SetupResult<route::LinkPolicy> Router::policy_of(const endpoint::Endpoint& endpoint) {
    const auto& o = endpoint.options;
    route::LinkPolicy policy;
    auto in = route::Filter::compile(dialect_, terms_of("in_allow", o.in_allow), terms_of("in_block", o.in_block));
    if (!in) return tl::unexpected(std::move(in.error()));
    auto out = route::Filter::compile(dialect_, terms_of("out_allow", o.out_allow), terms_of("out_block", o.out_block));
    if (!out) return tl::unexpected(std::move(out.error()));
    auto rates = dialect::Rates::compile(dialect_, o.max_rate);
    if (!rates) return tl::unexpected(std::move(rates.error()).within("max_rate"));
    for (const auto& warning : dialect::rate_warnings(dialect_, o.max_rate))
        notice_(config::LogLevel::warning, fmt::format("{}: max_rate={}", endpoint.label(), warning));
    policy.in = std::move(*in);
    policy.out = std::move(*out);
    policy.max_rate = std::move(*rates);
    policy.max_bytes_per_s = o.max_bytes_per_s;
    policy.tap = o.tap;
    policy.is_private = o.is_private;
    if (!o.group.empty()) policy.group = group_id(o.group);
    policy.group_mode = mode_of(o);
    policy.group_order = endpoints_.empty() ? 0 : endpoints_.back()->policy.group_order + 1;
    return policy;
}

// An endpoint without `group_mode=` takes the mode of its group.
endpoint::GroupMode Router::mode_of(const endpoint::EndpointOptions& options) const {
    const auto group = group_modes_.find(options.group);
    return options.names_group_mode || group == group_modes_.end() ? options.group_mode : group->second;
}

// Checks the endpoint's mode against the existing endpoints of its group.
SetupResult<void> Router::check_group(const endpoint::Endpoint& endpoint) const {
    const auto& o = endpoint.options;
    const auto member = std::ranges::find_if(
        endpoints_, [&](const auto& e) { return !o.group.empty() && e->endpoint.options.group == o.group; });
    if (member == endpoints_.end() || mode_of(o) == (*member)->policy.group_mode) return {};
    return other_mode(endpoint, (*member)->policy.group_mode);
}

SetupResult<Router::GroupModes> Router::group_modes_of(std::span<const endpoint::Endpoint> endpoints) {
    GroupModes modes;
    for (const auto& endpoint : endpoints) {
        const auto& o = endpoint.options;
        if (o.group.empty() || !o.names_group_mode) continue;
        const auto [known, is_new] = modes.try_emplace(o.group, o.group_mode);
        if (!is_new && known->second != o.group_mode) return other_mode(endpoint, known->second);
    }
    return modes;
}

SetupResult<void> Router::learn_group_modes(std::span<const endpoint::Endpoint> endpoints) {
    auto modes = group_modes_of(endpoints);
    if (!modes) return tl::unexpected(std::move(modes.error()));
    group_modes_ = std::move(*modes);
    return {};
}

route::GroupId Router::group_id(const std::string& name) {
    auto at = std::ranges::find(groups_, name);
    if (at == groups_.end()) at = groups_.insert(groups_.end(), name);
    return route::GroupId{static_cast<std::uint32_t>(at - groups_.begin()) + 1};
}

bool Router::remove(std::string_view label) {
    const auto recorder = std::ranges::find_if(recorders_, [&](const auto& r) { return r->label() == label; });
    if (recorder != recorders_.end()) {
        recordings_.erase(recordings_.begin() + (recorder - recorders_.begin()));
        (*recorder)->end();  // does not wait for the disk, so that routing continues
        ending_recorders_.push_back(std::move(*recorder));
        recorders_.erase(recorder);
        return true;
    }
    const auto at = std::ranges::find_if(endpoints_, [&](const auto& e) { return e->endpoint.label() == label; });
    if (at == endpoints_.end()) return close_link(label);
    const link::EndpointId id = (*at)->id;
    for (const auto& link : links_->links())
        if (link.endpoint == id) forget_link(link.id);
    links_->remove(id);
    a_link_went_ = true;
    by_id_[id.value] = nullptr;
    const auto group = (*at)->endpoint.options.group;
    endpoints_.erase(at);
    const auto is_member = [&](const auto& e) { return e->endpoint.options.group == group; };
    if (std::ranges::none_of(endpoints_, is_member)) group_modes_.erase(group);
    return true;
}

bool Router::close_link(std::string_view name) {
    const auto links = links_->links();
    const auto link = std::ranges::find(links, name, &link::LinkInfo::name);
    if (link == links.end() || !links_->close(link->id)) return false;
    forget_link(link->id);
    a_link_went_ = true;
    return true;
}

void Router::configure(const config::RouterConfig& config) {
    config_ = config;
    engine_.set_options(engine_options(config));
    own_messages_->configure(config);
}

void Router::become(const std::vector<endpoint::Endpoint>& endpoints) {
    group_modes_ = group_modes_of(endpoints).value();
    const auto modes = group_modes_;
    std::vector<endpoint::Endpoint> gone;
    const auto stays = [&](const endpoint::Endpoint& e) { return std::ranges::find(endpoints, e) != endpoints.end(); };
    for (const auto& e : endpoints_) {
        const bool has_other_mode = mode_of(e->endpoint.options) != e->policy.group_mode;
        if (!stays(e->endpoint) || has_other_mode || links_->has_other_keys(e->id)) gone.push_back(e->endpoint);
    }
    for (const auto& e : recordings_)
        if (!stays(e)) gone.push_back(e);
    for (const auto& endpoint : gone) {
        remove(endpoint.label());
        notice_(config::LogLevel::info, fmt::format("{}: removed", endpoint.label()));
    }
    group_modes_ = modes;  // remove() erased the modes of groups that became empty
    for (const auto& endpoint : endpoints) {
        if (has(endpoint)) continue;
        const auto added = add(endpoint);
        notice_(added ? config::LogLevel::info : config::LogLevel::error,
                added ? fmt::format("{}: added", endpoint.label()) : fmt::format("left out: {}", added.error().text));
        if (!added) put_back(gone, endpoint.label());
    }
    order_as(endpoints);
}

// Groups of mode `primary` prefer links in the order of the configuration, not in the order of opening.
void Router::order_as(const std::vector<endpoint::Endpoint>& endpoints) {
    std::ranges::stable_sort(endpoints_, {}, [&](const auto& e) {
        return std::ranges::find(endpoints, e->endpoint.label(), &endpoint::Endpoint::label) - endpoints.begin();
    });
    for (std::uint32_t order = 0; const auto& e : endpoints_) e->policy.group_order = order++;
    std::vector<route::GroupOrder> orders;
    for (const auto& link : links_->links())
        orders.push_back({link.id, by_id_[link.endpoint.value]->policy.group_order});
    engine_.set_group_orders(orders);
}

// Reopens an endpoint with its former options if its new options failed.
void Router::put_back(const std::vector<endpoint::Endpoint>& gone, const std::string& label) {
    const auto before = std::ranges::find(gone, label, &endpoint::Endpoint::label);
    if (before != gone.end() && add(*before))
        notice_(config::LogLevel::info, fmt::format("{}: goes on with its former options", label));
}

bool Router::has(const endpoint::Endpoint& endpoint) const {
    return std::ranges::any_of(endpoints_, [&](const auto& e) { return e->endpoint == endpoint; }) ||
           std::ranges::find(recordings_, endpoint) != recordings_.end();
}

// ---- frames ---------------------------------------------------------------------------------------------------------

void Router::on_frame(const link::RxFrame& rx) {
    const std::uint64_t mark = engine_.mark_of(rx.frame);
    for (const auto& recorder : recorders_) recorder->record(rx.time, rx.link, rx.frame);
    traffic_.add(rx.link, rx.frame, rx.time);
    if (rx.frame.id() == msg::Heartbeat::id) own_messages_->on_heartbeat(rx.link, rx.frame, links_->now());
    const auto decision = decide(rx, mark);
    if (ring_) ring_->write(rx, decision.verdict, by_id_[rx.endpoint.value]->verifies);
    send(rx, decision.links);
    if (decision.verdict != route::Verdict::echo) count_loss(rx);
}

// Ignores reboots shown by frames that teach no route: those from taps, and those that the input filter drops.
void Router::count_loss(const link::RxFrame& rx) {
    if (links_->count_loss(rx).verdict != wire::SequenceTracker::Verdict::reboot) [[likely]]
        return;
    const auto& policy = by_id_[rx.endpoint.value]->policy;
    if (!policy.tap && policy.in.admits(rx.frame.id(), rx.frame.source()))
        engine_.note_reboot(rx.link, rx.frame.source(), links_->now());
}

route::Decision Router::decide(const link::RxFrame& rx, std::uint64_t mark) {
    if (!explainer_) [[likely]]
        return engine_.route(rx.frame, mark, rx.info, rx.link, links_->now());
    const auto decision = engine_.explain(rx.frame, rx.info, rx.link, links_->now(), why_);
    explainer_(rx, decision, why_);
    return decision;
}

// Signs only frames whose own signature was verified, so that the router never vouches for unverified traffic.
void Router::send(const link::RxFrame& rx, std::span<const LinkId> links) {
    const bool may_sign = !any_signs_ || by_id_[rx.endpoint.value]->verifies;
    for (const LinkId link : links) {
        if (may_sign) [[likely]] {
            links_->send(link, rx.frame);
        } else if (links_->send_unsigned(link, rx.frame)) {
            not_signed_.add();
        }
    }
}

void Router::on_link_up(LinkId link, link::EndpointId endpoint, std::string_view name) {
    if (ring_) ring_->on_link_up(link, name);
    if (!engine_.add_link(link, by_id_[endpoint.value]->policy))
        return notice_(config::LogLevel::warning,
                       fmt::format("{}: more than {} links; nothing goes to it", name, route::Engine::max_links));
    speak_on(link, endpoint);
    if (expects_answer(by_id_[endpoint.value]->endpoint)) silence_->add(link, endpoint);
    if (may_tell_of_link(endpoint)) notice_(config::LogLevel::info, fmt::format("{}: up", name));
}

// Adds the link to those that get the router's own messages. Taps get none. Neither does the inlet: programs behind it
// read the ring, which does not hold the router's own messages.
void Router::speak_on(LinkId link, link::EndpointId endpoint) {
    const OpenedEndpoint& opened = *by_id_[endpoint.value];
    if (opened.policy.tap || &opened == inlet_.get()) return;
    own_messages_->add(link, wants_heartbeat(opened.endpoint), links_->now());
}

bool Router::may_tell_of_link(link::EndpointId endpoint) noexcept {
    OpenedEndpoint& opened = *by_id_[endpoint.value];
    if (opened.may_tell == 0) {
        ++opened.not_told;
        return false;
    }
    --opened.may_tell;
    return true;
}

void Router::on_link_down(LinkId link, link::EndpointId endpoint, std::string_view why) {
    if (may_tell_of_link(endpoint))
        notice_(config::LogLevel::info, fmt::format("{}: down, {}", links_->link_name(link), why));
    forget_link(link);
    a_link_went_ = true;
}

void Router::forget_link(LinkId link) {
    if (ring_) ring_->on_link_down(link);
    engine_.remove_link(link);
    own_messages_->remove(link);
    silence_->remove(link);
}

void Router::on_notice(link::EndpointId, std::string_view text) { notice_(config::LogLevel::info, text); }

// ---- turns ----------------------------------------------------------------------------------------------------------

void Router::turn(MonoTime deadline) {
    const std::size_t frames = links_->turn(
        *this, has_posted_.load(std::memory_order_acquire) ? MonoTime{} : std::min(deadline, next_due()));
    const MonoTime now = mono_now();
    if (frames != 0)
        for (const auto& recorder : recorders_) recorder->publish();
    if (ring_) {
        ring_->note_turn(frames, now);
        if (now >= ring_->page_due()) refresh_page();
    }
    if (has_posted_.load(std::memory_order_acquire)) run_posted();
    own_messages_->send_due(now);
    if (now >= look_due_) look_after(now);
}

MonoTime Router::next_due() const noexcept {
    const MonoTime due = std::min(look_due_, own_messages_->next_due());
    return ring_ ? std::min(due, ring_->page_due()) : due;
}

void Router::finish(Nanoseconds limit) {
    // Reads what has already arrived, in a flood no more than 64 turns of 64 datagrams. A turn may read only junk, so a
    // single turn without a frame does not end the loop.
    constexpr int most_turns = 64, most_empty = 4;
    for (int turns = 0, empty = 0; turns < most_turns && empty < most_empty; ++turns)
        empty = links_->turn(*this, MonoTime{}) == 0 ? empty + 1 : 0;
    for (const auto& recorder : recorders_) recorder->publish();
    const MonoTime end = mono_now() + limit;
    while (links_->pending() && mono_now() < end) links_->turn(*this, std::min(end, mono_now() + Nanoseconds{5ms}));
    for (const auto& recorder : recorders_) recorder->stop();
    for (const auto& recorder : ending_recorders_) recorder->stop();
    while (has_posted_.load(std::memory_order_acquire)) run_posted();
    if (inlet_) links_->remove(inlet_->id);
    ring_.reset();
}

void Router::post(std::function<void()> work) {
    {
        const std::lock_guard lock(posted_mutex_);
        posted_.push_back(std::move(work));
    }
    has_posted_.store(true, std::memory_order_release);
    wake();
}

// Runs one item a turn, because reports take long and frames go first.
void Router::run_posted() {
    std::function<void()> work;
    {
        const std::lock_guard lock(posted_mutex_);
        if (!posted_.empty()) {
            work = std::move(posted_.front());
            posted_.pop_front();
        }
        has_posted_.store(!posted_.empty(), std::memory_order_relaxed);
    }
    if (work) work();
}

void Router::drop_posted() {
    std::deque<std::function<void()>> work;
    const std::lock_guard lock(posted_mutex_);
    work.swap(posted_);
    has_posted_.store(false, std::memory_order_relaxed);
}

bool Router::send_own(LinkId link, const wire::FrameView& frame) {
    if (links_->send(link, frame) == 0) return false;
    engine_.note_sent(frame, link, links_->now());
    return true;
}

bool Router::is_answered(LinkId link) const {
    const auto* const counters = links_->counters(link);
    return counters != nullptr && counters->frames_in.value() != 0;
}

std::uint64_t Router::heartbeats_sent() const noexcept { return own_messages_->heartbeats_sent(); }

void Router::look_after(MonoTime now) {
    look_due_ = now + look_interval;
    for (const auto& e : endpoints_) tell_more_links(*e);
    if (inlet_) tell_more_links(*inlet_);
    look_after_ring();
    tell_silence(now);
    std::erase_if(ending_recorders_, [](const auto& recorder) { return recorder->finished(); });
    if (std::exchange(a_link_went_, false))
        traffic_.forget_links_unless([&](LinkId link) { return !links_->link_name(link).empty(); });
    const auto name = [this](LinkId link) {
        const auto found = links_->link_name(link);
        return found.empty() ? std::string_view{"a link that is gone"} : found;
    };
    const auto ids = engine_.duplicate_ids();
    for (; duplicate_ids_told_ < ids.size(); ++duplicate_ids_told_) {
        const auto& d = ids[duplicate_ids_told_];
        notice_(
            config::LogLevel::warning,
            fmt::format("{}/{} is heard on {} and on {}: two senders of one id, or redundant links that want group=",
                        d.source.system.value, d.source.component.value, name(d.first), name(d.second)));
    }
}

void Router::tell_silence(MonoTime now) {
    const auto silent = silence_->look([this](LinkId link) { return links_->counters(link); }, now);
    if (silent.empty()) return;
    const auto endpoints = links_->endpoints();
    for (const auto& [link, endpoint] : silent)
        notice_(config::LogLevel::warning,
                silence_text(*std::ranges::find(endpoints, endpoint, &link::EndpointInfo::id), *links_->counters(link)));
}

void Router::look_after_ring() {
    if (!ring_) return;
    for (const auto& text : ring_->look_after(*links_)) notice_(config::LogLevel::warning, text);
    refresh_page();
}

void Router::refresh_page() { ring_->refresh_page(*links_, inlet_ ? std::optional(inlet_->id) : std::nullopt); }

void Router::tell_more_links(OpenedEndpoint& opened) {
    opened.may_tell = std::min(most_told, opened.may_tell + told_each_look);
    if (const auto more = std::exchange(opened.not_told, 0); more != 0)
        notice_(config::LogLevel::info,
                fmt::format("{}: {} more times a link came or went", opened.endpoint.label(), more));
}

}  // namespace mavloom::router
