// SPDX-License-Identifier: MIT
// The text of the metrics, shared by all HTTP clients. Control thread only.
//
// A text is reused for `fresh_for`. However many clients ask, the served program copies its counters only once in that
// time, and clients that read slowly share a few texts.
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "control/ask_served.hpp"

namespace mavloom::control {

class MetricsReports {
public:
    using Text = std::shared_ptr<const std::string>;
    using Take = std::function<void(const Text&)>;
    static constexpr std::chrono::seconds fresh_for{1};

    explicit MetricsReports(Served& served) : served_(served) {}

    // Calls `take` with the text, at once or later, on `back`, the executor of the control thread.
    void get(const asio::any_io_executor& back, Take take) {
        if (text_ != nullptr && std::chrono::steady_clock::now() - made_ < fresh_for) return take(text_);
        waiting_.push_back(std::move(take));
        if (waiting_.size() > 1) return;  // the report is on its way
        ask_served(
            served_, back, [](Served& served) { return served.metrics(); },
            [this](const Report& report) { answer(whole(report)); });
    }

private:
    static std::string whole(const Report& report) {
        std::string all;
        for (auto piece = report.next_text(); !piece.empty(); piece = report.next_text()) all += piece;
        return all;
    }
    void answer(std::string report) {
        text_ = std::make_shared<const std::string>(std::move(report));
        made_ = std::chrono::steady_clock::now();
        for (const auto& take : std::exchange(waiting_, {})) take(text_);
    }

    Served& served_;
    Text text_;
    std::chrono::steady_clock::time_point made_;
    std::vector<Take> waiting_;
};

}  // namespace mavloom::control
