// SPDX-License-Identifier: MIT
#include "top/model.hpp"

#include <algorithm>
#include <utility>

namespace mavloom::app {

Model::Model(const dialect::Dialect& dialect, std::string title)
    : dialect_(dialect), title_(std::move(title)), inspector_(std::make_unique<observe::Inspector>(dialect)) {}

void Model::take(const observe::Heard& heard) {
    const std::lock_guard lock(mutex_);
    if (!began_) began_ = heard.now;
    if (const auto* const row = inspector_->add(heard)) history_.take(*row);
}

void Model::note_counts(observe::OwnCounts counts) {
    const std::lock_guard lock(mutex_);
    counts_ = std::move(counts);
}

void Model::note_end(LinkId link) {
    const std::lock_guard lock(mutex_);
    inspector_->note_end(link);
}

std::uint64_t Model::left_out() const {
    const std::lock_guard lock(mutex_);
    return inspector_->latest().unlisted();
}

void Model::set_hops(std::vector<observe::Hop> hops) {
    const std::lock_guard lock(mutex_);
    hops_ = std::move(hops);
}

void Model::set_routes(std::vector<view::Route> routes) {
    const std::lock_guard lock(mutex_);
    routes_ = std::move(routes);
}

void Model::add_notice(std::string_view text) {
    const std::lock_guard lock(mutex_);
    if (notices_.size() == max_notices) notices_.erase(notices_.begin());
    notices_.emplace_back(text);
}

void Model::restart() {
    const std::lock_guard lock(mutex_);
    inspector_ = std::make_unique<observe::Inspector>(dialect_);
    history_.clear();
    counts_.reset();
    tick_at_ = {};
    began_.reset();
}

void Model::watch(const std::optional<view::RowKey>& key) {
    const std::lock_guard lock(mutex_);
    history_.watch(key);
}

observe::OwnCounts Model::own_counts() const {
    return counts_.value_or(observe::OwnCounts{.frames = inspector_->latest().frames()});
}

void Model::tick(view::Now now) {
    if (now.mono < tick_at_) return;
    tick_at_ = now.mono + tick_period;
    const auto own = own_counts();
    auto hops = hops_;
    hops.push_back({.name = "mavloom top",
                    .kind = observe::Hop::Kind::listener,
                    .frames_in = own.frames,
                    .losses = own.losses,
                    .links = own.links});
    inspector_->set_hops(std::move(hops), now.wall, now.mono);
    inspector_->note_losses(own.on_links, now.wall, now.mono);
    inspector_->tick(now.wall, now.mono);
}

bool Model::has_rows() const {
    const std::lock_guard lock(mutex_);
    return std::ranges::any_of(inspector_->latest().rows(), [](const auto& row) { return row.born != 0; });
}

view::Snapshot Model::snapshot(view::Now now, view::Rates rates) {
    const std::lock_guard lock(mutex_);
    tick(now);
    static const std::vector<observe::SenderLoss> none;
    auto shown = view::take_snapshot(dialect_, *inspector_, now, counts_ ? counts_->on_links : none, rates);
    shown.title = title_;
    shown.began = began_.value_or(now.mono);
    shown.notices = notices_;
    shown.hints = hints_;
    shown.routes = routes_;
    shown.history = history_;
    return shown;
}

}  // namespace mavloom::app
