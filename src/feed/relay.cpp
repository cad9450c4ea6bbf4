// SPDX-License-Identifier: MIT
#include "mavloom/feed/relay.hpp"

#include <algorithm>
#include <utility>

#include "mavloom/link/flush.hpp"

namespace mavloom::feed {

RelayOutcome Relay::run(MonoTime end) {
    watch_sources(mono_now());
    while (!handler_.should_stop() && mono_now() < end && !destinations_.failed() && !sources_.finished()) turn(end);
    sources_.drain(*this, [this] { return Room{0, room(), frames_a_turn}; });
    link::flush(sources_.links(), *this, longest_flush);
    return finish();
}

void Relay::turn(MonoTime end) {
    if (!has_started_) wait_for_peers();
    const std::size_t of_recordings = has_started_ ? room() : 0;
    const Nanoseconds longest = of_recordings == 0 ? Nanoseconds{room_poll_interval} : Nanoseconds{longest_turn};
    sources_.turn(*this, std::min(end, mono_now() + longest), {of_recordings, room(), frames_a_turn});
    maintain(mono_now());
}

void Relay::watch_sources(MonoTime now) {
    for (const auto& info : sources_.links().endpoints())
        if (!destinations_.has(info.id)) silence_.add(info.id, info.endpoint, now);
}

void Relay::maintain(MonoTime now) {
    destinations_.maintain_files(now, [this](std::string_view text) { handler_.on_notice(text); });
    if (now < maintain_due_) return;
    maintain_due_ = now + maintain_interval;
    for (const auto& text : link::poll_silence(silence_, sources_.links(), now)) handler_.on_notice(text);
}

void Relay::wait_for_peers() {
    has_started_ = destinations_.all_up();
    if (has_started_ && has_waited_) handler_.on_started();
    if (!has_started_ && sources_.has_recordings() && !std::exchange(has_waited_, true)) handler_.on_waiting();
}

void Relay::on_frame(const link::RxFrame& rx) {
    if (destinations_.has(rx.endpoint)) {
        const auto outcome = stage_.backward(rx.frame);
        if (outcome.verdict == edit::Verdict::forward && sources_.send(outcome.frame) == 0) ++unheard_answers_;
        return;
    }
    const auto outcome = stage_.forward(rx.frame, rx.time, signing_ == Signing::on ? wall_now() : WallTime{});
    if (outcome.verdict == edit::Verdict::forward) destinations_.send(outcome.frame, rx.time);
}

std::size_t Relay::room() const { return std::min(frames_a_turn, destinations_.room_in_frames()); }

RelayOutcome Relay::finish() {
    RelayOutcome outcome;
    sources_.add_to(outcome.totals);
    auto closed = destinations_.close([this](std::string_view text) { handler_.on_notice(text); });
    if (!closed) outcome.write_error = std::move(closed.error());
    if (const auto* error = sources_.error()) outcome.read_error = *error;
    outcome.unheard_answers = unheard_answers_;
    outcome.is_incomplete = sources_.are_recordings() && destinations_.lost_any();
    const bool had_any = destinations_.given() != 0 || (has_waited_ && !has_started_);
    outcome.reached_no_destination = had_any && destinations_.reached_no_destination();
    return outcome;
}

}  // namespace mavloom::feed
