// SPDX-License-Identifier: MIT
// A file descriptor that holds locks of its open file description (fcntl F_OFD_SETLK). Other processes test these locks
// to learn whether this process is alive.
//
// A child of fork() shares the descriptor's open file description. It would keep the locks after the parent has died,
// so an at-fork handler closes the descriptor in the child. Any thread may construct and destroy a LockFile; one owner
// uses everything else.
#pragma once

#include <atomic>
#include <cstddef>

namespace mavloom::shm {

class LockFile {
public:
    // Takes ownership of `fd`.
    explicit LockFile(int fd);
    LockFile(const LockFile&) = delete;
    LockFile& operator=(const LockFile&) = delete;
    ~LockFile();

    [[nodiscard]] int get() const noexcept { return fd_; }
    [[nodiscard]] const std::atomic<bool>& forked() const noexcept { return forked_; }
    [[nodiscard]] bool try_lock(std::size_t byte) noexcept;
    void unlock(std::size_t byte) noexcept;
    // Returns whether another open file description holds a lock on the byte.
    [[nodiscard]] bool is_locked(std::size_t byte) const noexcept;

private:
    friend struct ForkRegistry;
    int fd_;
    std::atomic<bool> forked_{false};
    LockFile* next_ = nullptr;
    LockFile* previous_ = nullptr;
};

}  // namespace mavloom::shm
