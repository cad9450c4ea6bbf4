// SPDX-License-Identifier: MIT
// LinkRecorder: the Python class of that name, which records the frames of a link to a tlog. Any thread. Call with the
// GIL held; a call that waits for the disk releases it meanwhile.
#pragma once

#include <nanobind/nanobind.h>

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "mavloom/feed/channel.hpp"
#include "mavloom/feed/fork.hpp"

namespace mavloom::python {

namespace nb = nanobind;

class LinkRecorder {
public:
    // Creates the file; an existing one is renamed. Raises if it cannot be written.
    LinkRecorder(std::shared_ptr<feed::Channel> channel, const std::string& path);
    ~LinkRecorder();
    LinkRecorder(const LinkRecorder&) = delete;
    LinkRecorder& operator=(const LinkRecorder&) = delete;

    // Writes what is queued, and waits for the disk. Raises SystemFailure if frames were lost.
    void close();
    // All recorders of this process that still exist.
    [[nodiscard]] static std::vector<std::shared_ptr<record::Recorder>> all();

    [[nodiscard]] const record::Recorder& recorder() const noexcept { return *recorder_; }
    // Returns the reports about the file so far.
    [[nodiscard]] std::vector<std::string> notices() const;

private:
    // The writing thread adds them.
    struct Notices {
        std::mutex mutex;
        std::vector<std::string> texts;  // guarded by mutex
    };

    void stop() noexcept;

    const feed::ForkGuard fork_;
    std::shared_ptr<feed::Channel> channel_;
    std::shared_ptr<Notices> notices_;
    std::shared_ptr<record::Recorder> recorder_;
    std::mutex mutex_;
    bool closed_ = false;  // guarded by mutex_
};

void bind_link_recorder(nb::module_& module);

}  // namespace mavloom::python
