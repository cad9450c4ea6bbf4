// SPDX-License-Identifier: MIT
#include "mavloom/simserve/hil_simulator.hpp"

#include <algorithm>
#include <utility>

#include "mavloom/control/post_box.hpp"
#include "mavloom/fault/faults.hpp"
#include "simserve/hil/hil_port.hpp"

namespace mavloom::simserve {

using namespace std::chrono_literals;

namespace {

HilOptions dated(HilOptions options) {
    if (options.utc_at_start == WallTime{}) options.utc_at_start = wall_now();
    return options;
}

}  // namespace

HilSimulator::HilSimulator(const HilOptions& options, Notice notice, std::unique_ptr<link::Links> links)
    : options_(dated(options)),
      notice_(std::move(notice)),
      links_(std::move(links)),
      posted_(std::make_unique<control::PostBox>()) {}

HilSimulator::~HilSimulator() = default;

SetupResult<std::unique_ptr<HilSimulator>> HilSimulator::create(const dialect::Dialect& dialect,
                                                                const HilOptions& options, Notice notice) {
    auto links = link::Links::create(dialect);
    if (!links) return tl::unexpected(std::move(links.error()));
    return std::unique_ptr<HilSimulator>(new HilSimulator(options, std::move(notice), std::move(*links)));
}

SetupResult<void> HilSimulator::add(const flight::VehicleOptions& vehicle, const endpoint::Endpoint& endpoint,
                                    std::vector<hil::TimedFault> faults) {
    endpoint::Endpoint given = endpoint;
    given.options.low_latency = true;
    const hil::PairOptions options{.vehicle = vehicle,
                                   .rates = options_.rates,
                                   .speed = options_.speed,
                                   .has_own_clock = given.row().form == endpoint::Form::device,
                                   .utc_at_start = options_.utc_at_start};
    auto port = std::make_unique<HilPort>(options, std::move(faults), *links_, notice_);
    const auto added = fault::add(*links_, given);
    if (!added) return tl::unexpected(added.error());
    const auto opened = links_->endpoints();
    const auto info = std::ranges::find(opened, *added, &link::EndpointInfo::id);  // with the port, if it was 0
    port->opened(*added, info == opened.end() ? given.label() : info->label());
    ports_.push_back(std::move(port));
    return {};
}

// ---- turns ----------------------------------------------------------------------------------------------------------

void HilSimulator::turn(MonoTime deadline) {
    constexpr Nanoseconds longest_wait = 10ms;  // of a step: an answer that does not come makes nothing due
    deadline = std::min({deadline, next_due(), maintain_due_});
    if (!steps_.empty()) deadline = std::min(deadline, mono_now() + longest_wait);
    exchange(posted_->empty() ? deadline : MonoTime{});
    if (!posted_->empty()) posted_->run_one();
    const MonoTime now = mono_now();
    step_due(now);
    if (!steps_.empty()) end_steps(now);
    if (now >= maintain_due_) maintain(now);
}

void HilSimulator::exchange(MonoTime deadline) {
    links_->turn(*this, deadline);
    for (const auto& port : ports_) port->settle();
}

void HilSimulator::step(std::vector<hil::Pair*> pairs, Nanoseconds time, Nanoseconds limit, std::function<void()> then) {
    for (hil::Pair* const pair : pairs) pair->allow(time);
    steps_.push_back({std::move(pairs), mono_now() + limit, std::move(then)});
}

// Several requests for one flight add up, and each of them ends when the flight stands still.
void HilSimulator::end_steps(MonoTime now) {
    const auto is_stepping = [&](const hil::Pair* pair) { return pair->lock_step().is_stepping(now); };
    std::erase_if(steps_, [&](const Step& step) {
        if (now < step.end && std::ranges::any_of(step.pairs, is_stepping)) return false;
        step.then();
        return true;
    });
}

MonoTime HilSimulator::next_due() const noexcept {
    MonoTime due = MonoTime::max();
    for (const auto& port : ports_) due = std::min(due, port->due());
    return due;
}

void HilSimulator::step_due(MonoTime now) {
    for (const auto& port : ports_)
        if (port->due() <= now) port->step(now);
}

void HilSimulator::maintain(MonoTime now) {
    maintain_due_ = now + 1s;
    for (const auto& port : ports_) port->maintain(now);
    for (std::size_t i = 1; i < ports_.size(); ++i)
        for (std::size_t before = 0; before < i; ++before) ports_[i]->note_double(*ports_[before]);
}

HilPort* HilSimulator::port_of(link::EndpointId endpoint) noexcept {
    const auto port = std::ranges::find(ports_, endpoint, [](const auto& each) { return each->endpoint(); });
    return port == ports_.end() ? nullptr : port->get();
}

void HilSimulator::on_frame(const link::RxFrame& rx) {
    if (HilPort* const port = port_of(rx.endpoint)) port->receive(rx.link, rx.frame);
}

void HilSimulator::on_link_up(LinkId link, link::EndpointId endpoint, std::string_view name) {
    if (HilPort* const port = port_of(endpoint)) port->on_link_up(link, name);
}

void HilSimulator::on_link_down(LinkId link, link::EndpointId endpoint, std::string_view why) {
    if (HilPort* const port = port_of(endpoint)) port->on_link_down(link, why);
}

void HilSimulator::on_notice(link::EndpointId, std::string_view text) { notice_(config::LogLevel::info, text); }

void HilSimulator::post(std::function<void()> work) {
    posted_->post(std::move(work));
    wake();
}

void HilSimulator::drop_posted() {
    posted_->drop();
    steps_.clear();
}

// ---- reports --------------------------------------------------------------------------------------------------------

std::vector<HilReport> HilSimulator::reports() const {
    std::vector<HilReport> all;
    all.reserve(ports_.size());
    for (const auto& port : ports_) all.push_back(port->report());
    return all;
}

std::uint64_t HilSimulator::refused_orders() const {
    std::uint64_t all = 0;
    for (const auto& port : ports_) all += port->refused_orders();
    return all;
}

std::vector<hil::Pair*> HilSimulator::pairs(std::optional<SystemId> system) {
    std::vector<hil::Pair*> found;
    found.reserve(ports_.size());
    for (const auto& port : ports_)
        if (!system || port->pair().status().system == *system) found.push_back(&port->pair());
    return found;
}

}  // namespace mavloom::simserve
