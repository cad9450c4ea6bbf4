// SPDX-License-Identifier: MIT
#include "link/core/border.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "link/core/core.hpp"

namespace mavloom::link::detail {

Link::Link(EndpointId owner, const endpoint::EndpointOptions& options)
    : endpoint(owner), max_held_bytes(static_cast<std::size_t>(options.queue_bytes)), queue(queue_limits(options)) {}
Link::~Link() = default;

std::size_t Link::queued_bytes() const noexcept { return queue.bytes() + (border ? border->held_bytes(Way::out) : 0); }

// Takes the pieces that a stage passes on.
class Border::Step final : public Next {
public:
    Step(Border& border, Way way, std::size_t place, MonoTime now) noexcept
        : border_(border), way_(way), place_(place), now_(now) {}
    void pass(const Piece& piece) noexcept override { border_.pass(way_, place_, piece, now_); }
    void pass_at(const Piece& piece, MonoTime when) noexcept override {
        if (when <= now_) pass(piece);
        else border_.hold(way_, place_, piece, now_, when);
    }

private:
    Border& border_;
    Way way_;
    std::size_t place_;  // of the next stage
    MonoTime now_;
};

Border::~Border() { core_.tickers.forget(*this); }

// Holds what stages have kept to themselves when others replace them.
class Border::Rest final : public Next {
public:
    explicit Rest(Chain& chain) noexcept : chain_(chain) {}
    void pass(const Piece& piece) noexcept override {
        if (!piece.bytes.empty()) chain_.keep(MonoTime::max(), {piece, {piece.bytes.begin(), piece.bytes.end()}, 0});
    }
    void pass_at(const Piece& piece, MonoTime) noexcept override { pass(piece); }

private:
    Chain& chain_;
};

void Border::Chain::keep(MonoTime when, Held piece) {
    bytes += piece.bytes.size();
    held.emplace_hint(held.end(), when, std::move(piece));
}

MonoTime Border::Chain::due() const noexcept {
    MonoTime earliest = held.empty() ? MonoTime::max() : held.begin()->first;
    for (const auto& stage : stages) earliest = std::min(earliest, stage->tick_due().value_or(MonoTime::max()));
    return earliest;
}

void Border::Chain::exchange(std::vector<std::unique_ptr<Stage>> others) {
    Rest rest(*this);
    for (const auto& stage : stages) stage->finish(wall_now(), rest);
    stages = std::move(others);
    std::multimap<MonoTime, Held> due;
    for (auto& [when, held_piece] : held) {
        held_piece.place = stages.size();
        due.emplace_hint(due.end(), MonoTime{}, std::move(held_piece));
    }
    held = std::move(due);
}

void Border::replace(Stages stages, const CreateStages& by) {
    at(Way::in).exchange(std::move(stages.in));
    at(Way::out).exchange(std::move(stages.out));
    text_ = std::move(stages.text);
    made_by_ = by;
    core_.tickers.keep(*this);
}

void Border::take(Way way, const Piece& piece) {
    release_until(way, core_.now());
    pass(way, 0, piece, core_.now());
    if (at(way).due() != MonoTime::max()) core_.tickers.keep(*this);
}

void Border::pass(Way way, std::size_t place, const Piece& piece, MonoTime now) {
    if (piece.bytes.empty()) return;
    if (place == at(way).stages.size()) return leave(way, piece);
    Step next(*this, way, place + 1, now);
    at(way).stages[place]->take(piece, now, next);
}

void Border::leave(Way way, const Piece& piece) {
    if (way == Way::in) return link_.hear(piece.bytes, piece.time);
    Core::push_staged(link_, piece, core_.now());
}

// Each piece takes memory of its own, so there may be no more than there could be frames.
bool Border::has_room(const Chain& chain, const Piece& piece) const noexcept {
    return chain.bytes + piece.bytes.size() <= link_.max_held_bytes &&
           chain.held.size() < link_.max_held_bytes / wire::min_frame_length;
}

void Border::hold(Way way, std::size_t place, const Piece& piece, MonoTime now, MonoTime when) {
    if (piece.bytes.empty()) return;
    Chain& chain = at(way);
    if (!has_room(chain, piece)) return link_.counters.held_dropped.add();
    Held held{piece, {piece.bytes.begin(), piece.bytes.end()}, place};
    if (way == Way::in) held.piece.time += when - now;
    chain.keep(when, std::move(held));
    core_.tickers.keep(*this);
}

void Border::release_until(Way way, MonoTime end) {
    Chain& chain = at(way);
    while (!chain.held.empty() && chain.held.begin()->first <= end) {
        auto node = chain.held.extract(chain.held.begin());
        Held& held = node.mapped();
        chain.bytes -= held.bytes.size();
        held.piece.bytes = held.bytes;
        pass(way, held.place, held.piece, node.key());
    }
}

void Border::tick_stages(Way way, MonoTime now) {
    for (std::size_t place = 0; place < at(way).stages.size(); ++place) {
        Stage& stage = *at(way).stages[place];
        const auto due = stage.tick_due();
        if (!due || *due > now) continue;
        Step next(*this, way, place + 1, now);
        stage.tick(now, wall_now(), next);
    }
}

void Border::release(Way way) {
    release_until(way, MonoTime::max());
    for (std::size_t place = 0; place < at(way).stages.size(); ++place) {
        Step next(*this, way, place + 1, core_.now());
        at(way).stages[place]->finish(wall_now(), next);
    }
    release_until(way, MonoTime::max());
}

void Border::drop(Way way) noexcept {
    Chain& chain = at(way);
    link_.counters.held_dropped.add(chain.held.size());
    chain.held.clear();
    chain.bytes = 0;
}

std::optional<MonoTime> Border::tick_due() const {
    if (is_idle()) return MonoTime{};
    const MonoTime due = std::min(at(Way::in).due(), at(Way::out).due());
    return due == MonoTime::max() ? std::optional<MonoTime>() : due;
}

void Border::tick(MonoTime now) {
    for (const Way way : {Way::in, Way::out}) {
        release_until(way, now);
        tick_stages(way, now);
    }
    if (is_idle()) core_.remove_border(link_);
}

bool Border::is_idle() const noexcept {
    return std::ranges::all_of(chains_, [](const Chain& chain) { return chain.stages.empty() && chain.held.empty(); });
}

}  // namespace mavloom::link::detail
