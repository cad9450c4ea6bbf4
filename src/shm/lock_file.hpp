// SPDX-License-Identifier: MIT
// A descriptor whose open-file-description locks say that this process lives. A child of fork() shares the description, and would hold the locks
// of a parent that has died: so an at-fork handler closes it there. Made and destroyed by any thread; the rest belongs to one owner.
#pragma once

#include <atomic>
#include <cstddef>

namespace mavloom::shm {

class LockFile {
public:
    // Takes over `fd`.
    explicit LockFile(int fd);
    LockFile(const LockFile&) = delete;
    LockFile& operator=(const LockFile&) = delete;
    ~LockFile();

    [[nodiscard]] int get() const noexcept { return fd_; }
    [[nodiscard]] const std::atomic<bool>& forked() const noexcept { return forked_; }
    [[nodiscard]] bool try_lock(std::size_t byte) noexcept;
    void unlock(std::size_t byte) noexcept;
    // By another description than this one.
    [[nodiscard]] bool is_locked(std::size_t byte) const noexcept;

private:
    friend struct ForkRegistry;
    int fd_;
    std::atomic<bool> forked_{false};
    LockFile* next_ = nullptr;
    LockFile* previous_ = nullptr;
};

}  // namespace mavloom::shm
