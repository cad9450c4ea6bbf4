// SPDX-License-Identifier: MIT
#include "page/hop_reporter.hpp"

#include <chrono>
#include <utility>

#include "mavloom/base/thread.hpp"
#include "mavloom/control/control.hpp"
#include "page/page_hop.hpp"

namespace mavloom::app {

static constexpr std::chrono::milliseconds report_interval{500}, answer_limit{1000};

web::RoutesOf routes_of(const std::string& router, const std::string& control) {
    auto routes = control::send_request(control, R"({"cmd":"routes"})", answer_limit);
    if (!routes) return {.router = router, .error = std::move(routes.error().text)};
    return {.router = router, .routes = std::move(*routes)};
}

HopReporter::HopReporter(To to, std::vector<Program> programs)
    : to_(std::move(to)), programs_(std::move(programs)), last_(programs_.size()) {
    if (!programs_.empty() || to_.note_counts || to_.wants_routes) thread_ = thread_without_signals([this] { run(); });
}

HopReporter::~HopReporter() {
    {
        const std::lock_guard lock(mutex_);
        stops_ = true;
    }
    stopped_.notify_one();
    if (thread_.joinable()) thread_.join();
}

void HopReporter::run() {
    std::unique_lock lock(mutex_);
    do {
        report();
        if (to_.wants_routes && to_.wants_routes()) to_.set_routes(ask_routes());
    } while (!stopped_.wait_for(lock, report_interval, [this] { return stops_; }));
}

static void set_down(observe::Hop& hop) {
    hop.is_up = false;
    for (auto& link : hop.links) link.is_up = false;
}

// The own counts first: a frame that is in them has passed all programs.
void HopReporter::report() {
    if (to_.note_counts) to_.note_counts();
    std::vector<observe::Hop> seen;
    for (std::size_t i = 0; i < programs_.size(); ++i) {
        if (auto hop = hop_of_page(programs_[i].page)) last_[i] = std::move(*hop);
        else set_down(last_[i]);
        last_[i].hint = programs_[i].hint;
        if (!last_[i].name.empty()) seen.push_back(last_[i]);
    }
    to_.set_hops(std::move(seen));
}

std::vector<web::RoutesOf> HopReporter::ask_routes() const {
    std::vector<web::RoutesOf> all;
    for (std::size_t i = 0; i < programs_.size(); ++i) {
        const auto& [page, hint, control] = programs_[i];
        if (last_[i].kind == observe::Hop::Kind::router)
            all.push_back(routes_of(page, control.empty() ? page : control));
    }
    return all;
}

HopReporter::To hops_to(web::Server& server, std::function<void()> note_counts) {
    return {.set_hops = [&server](auto hops) { server.set_hops(std::move(hops)); },
            .note_counts = std::move(note_counts),
            .wants_routes = [&server] { return server.wants_routes(); },
            .set_routes = [&server](const auto& routes) { server.set_routes(routes); }};
}

}  // namespace mavloom::app
