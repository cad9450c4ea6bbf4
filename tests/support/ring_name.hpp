// SPDX-License-Identifier: MIT
// A ring's name that nobody else has, and nothing left of it when the test is over.
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <string>

namespace mavloom::test {

class RingName {
public:
    RingName() {
        static std::atomic<int> count{0};
        name_ = fmt::format("test-{}-{}", ::getpid(), ++count);
    }
    RingName(const RingName&) = delete;
    RingName& operator=(const RingName&) = delete;
    ~RingName() {
        ::unlink(path().c_str());
        ::unlink((path() + ".stat").c_str());
    }

    [[nodiscard]] const std::string& text() const { return name_; }
    [[nodiscard]] std::string path() const { return "/dev/shm/mavloom." + name_; }

private:
    std::string name_;
};

}  // namespace mavloom::test
