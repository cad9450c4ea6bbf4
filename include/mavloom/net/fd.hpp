// SPDX-License-Identifier: MIT
// A file descriptor with one owner, which closes it when destroyed. Move-only. Not thread-safe; allocates nothing.
#pragma once

#include <unistd.h>

#include <utility>

namespace mavloom::net {

class Fd {
public:
    constexpr Fd() noexcept = default;
    // Takes ownership of `fd`. -1 means none.
    constexpr explicit Fd(int fd) noexcept : fd_(fd) {}
    Fd(Fd&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
    Fd& operator=(Fd&& other) noexcept {
        if (this != &other) {
            reset();
            fd_ = std::exchange(other.fd_, -1);
        }
        return *this;
    }
    Fd(const Fd&) = delete;
    Fd& operator=(const Fd&) = delete;
    ~Fd() { reset(); }

    [[nodiscard]] int get() const noexcept { return fd_; }
    [[nodiscard]] explicit operator bool() const noexcept { return fd_ >= 0; }
    // Linux frees the number even when close() reports an error, so never retry the close.
    void reset() noexcept {
        if (fd_ >= 0) ::close(std::exchange(fd_, -1));
    }

private:
    int fd_ = -1;
};

}  // namespace mavloom::net
