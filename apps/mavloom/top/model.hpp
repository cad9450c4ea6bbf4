// SPDX-License-Identifier: MIT
// The model that `mavloom top` shows: an Inspector that one thread fills and another one reads. Each function takes a
// lock for a short time. A terminal that stalls never delays the thread that fills it.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "mavloom/view/history.hpp"
#include "mavloom/view/snapshot.hpp"
#include "page/serving.hpp"

namespace mavloom::app {

class Model : public Audience {
public:
    static constexpr std::size_t max_notices = 50;

    // `dialect` must outlive the model.
    Model(const dialect::Dialect& dialect, std::string title);

    void take(const observe::Heard& heard) override;
    void flush() override {}
    void note_counts(observe::OwnCounts counts) override;
    void note_end(LinkId link) override;
    [[nodiscard]] std::uint64_t left_out() const override;

    void set_hops(std::vector<observe::Hop> hops);
    void set_routes(std::vector<view::Route> routes);
    [[nodiscard]] bool wants_routes() const noexcept { return wants_routes_; }
    void add_notice(std::string_view text);
    // Shown while nothing is heard. Call it before other threads use the model.
    void set_hints(std::vector<std::string> hints) { hints_ = std::move(hints); }
    // Forgets all that was heard, for a recording that continues elsewhere.
    void restart();

    // ---- the thread that draws
    void want_routes(bool wants) noexcept { wants_routes_ = wants; }
    // Puts the history of this message, from now on, into each snapshot.
    void watch(const std::optional<view::RowKey>& key);
    [[nodiscard]] bool has_rows() const;
    [[nodiscard]] view::Snapshot snapshot(view::Now now, view::Rates rates);

private:
    static constexpr auto tick_period = std::chrono::milliseconds(500);

    [[nodiscard]] observe::OwnCounts own_counts() const;
    void tick(view::Now now);

    const dialect::Dialect& dialect_;
    const std::string title_;
    std::atomic<bool> wants_routes_{false};
    mutable std::mutex mutex_;  // guards all that follows
    std::unique_ptr<observe::Inspector> inspector_;
    view::History history_;
    std::optional<observe::OwnCounts> counts_;
    std::vector<observe::Hop> hops_;
    std::vector<view::Route> routes_;
    std::vector<std::string> notices_, hints_;
    std::optional<MonoTime> began_;
    MonoTime tick_at_{};
};

}  // namespace mavloom::app
