// SPDX-License-Identifier: MIT
// The far end of a serial port that is a pseudo-terminal: what a vehicle's radio would be.
#pragma once

#include <asm/termbits.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace mavloom::testing {

class Pty {
public:
    Pty() : fd_(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
        EXPECT_GE(fd_, 0);
        EXPECT_EQ(::grantpt(fd_), 0);
        EXPECT_EQ(::unlockpt(fd_), 0);
        char name[64] = "";
        EXPECT_EQ(::ptsname_r(fd_, name, sizeof name), 0);
        device_ = name;
    }
    Pty(Pty&& other) noexcept : fd_(std::exchange(other.fd_, -1)), device_(std::move(other.device_)) {}
    ~Pty() { unplug(); }
    void unplug() {
        if (fd_ >= 0) ::close(std::exchange(fd_, -1));
    }
    [[nodiscard]] int fd() const { return fd_; }
    [[nodiscard]] const std::string& device() const { return device_; }

    // The settings that the other side made.
    [[nodiscard]] termios2 settings() const {
        termios2 found{};
        EXPECT_EQ(::ioctl(fd_, TCGETS2, &found), 0);
        return found;
    }
    void write(const std::vector<std::uint8_t>& bytes) const {
        EXPECT_EQ(::write(fd_, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
    }
    // The bytes that are there now.
    [[nodiscard]] std::vector<std::uint8_t> read() const {
        std::vector<std::uint8_t> bytes(65536);
        const ssize_t count = ::read(fd_, bytes.data(), bytes.size());
        bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
        return bytes;
    }
    void await() const {
        pollfd wanted{fd_, POLLIN, 0};
        EXPECT_EQ(::poll(&wanted, 1, 5000), 1);
    }

private:
    int fd_;
    std::string device_;
};

}  // namespace mavloom::testing
