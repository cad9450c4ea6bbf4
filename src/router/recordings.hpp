// SPDX-License-Identifier: MIT
// The recordings of a router: every good frame goes into each, on arrival. Private to module router; single owner
// thread.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/endpoint/endpoint.hpp"
#include "mavloom/link/links.hpp"
#include "mavloom/record/recorder.hpp"
#include "router/notice.hpp"

namespace mavloom::router {

class Recordings {
public:
    // `notice` is called on the owner's thread. `warn` is called on the writing threads, until `stop` has returned.
    Recordings(Notice notice, std::function<void(std::string)> warn)
        : notice_(std::move(notice)), warn_(std::move(warn)) {}

    // Fails if another recording already writes to the file, or if the file cannot be written.
    [[nodiscard]] SetupResult<void> add(const endpoint::Endpoint& endpoint);
    // Ends the recording without waiting for the disk, so that routing continues. Returns false if there is none.
    bool remove(std::string_view label);
    [[nodiscard]] bool has(const endpoint::Endpoint& endpoint) const;
    [[nodiscard]] std::vector<endpoint::Endpoint> endpoints() const;

    void record(const link::RxFrame& rx) noexcept {
        for (const auto& open : open_) open.recorder->record(rx.time, rx.link, rx.frame);
    }
    // Call it after each turn that received frames.
    void publish() noexcept {
        for (const auto& open : open_) open.recorder->publish();
    }
    // Frees removed recordings whose frames have all been written.
    void maintain();
    // Writes the queued frames and closes all files.
    void stop();

    // Calls f(const record::Recorder&) for each recording.
    template <class F>
    void each(F&& f) const {
        for (const auto& open : open_) f(*open.recorder);
    }

private:
    struct Open {
        endpoint::Endpoint endpoint;
        std::unique_ptr<record::Recorder> recorder;
    };

    Notice notice_;
    std::function<void(std::string)> warn_;
    std::vector<Open> open_;
    std::vector<std::unique_ptr<record::Recorder>> ending_;  // removed, and still writing
};

}  // namespace mavloom::router
