// SPDX-License-Identifier: MIT
// Reports routers and simulators as hops, twice a second, from their counter pages. If routes are wanted, it asks the
// routers through their control sockets. It has a thread of its own.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "mavloom/web/server.hpp"

namespace mavloom::app {

// Asks a router through its control socket, within a second.
[[nodiscard]] web::RoutesOf routes_of(const std::string& router, const std::string& control);

class HopReporter {
public:
    struct Program {
        std::string page;       // the name of its counter page
        std::string hint{};     // of the hop
        std::string control{};  // the name of its control socket; empty: that of the page
    };

    // Called on the reporter's thread.
    struct To {
        std::function<void(std::vector<observe::Hop>)> set_hops;
        std::function<void()> note_counts{};   // before each `set_hops`, at the same moment; may be empty
        std::function<bool()> wants_routes{};  // empty: never
        std::function<void(const std::vector<web::RoutesOf>&)> set_routes{};
    };

    // A program whose page was never there is left out.
    HopReporter(To to, std::vector<Program> programs);
    ~HopReporter();
    HopReporter(const HopReporter&) = delete;
    HopReporter& operator=(const HopReporter&) = delete;

private:
    void run();
    void report();
    [[nodiscard]] std::vector<web::RoutesOf> ask_routes() const;

    const To to_;
    std::vector<Program> programs_;
    std::vector<observe::Hop> last_;  // for each program; without a name: not seen so far
    std::mutex mutex_;
    std::condition_variable stopped_;
    bool stops_ = false;  // guarded by mutex_
    std::thread thread_;
};

// `server` must outlive the reporter, and so must what `note_counts` uses.
[[nodiscard]] HopReporter::To hops_to(web::Server& server, std::function<void()> note_counts);

}  // namespace mavloom::app
