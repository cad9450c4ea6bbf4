// SPDX-License-Identifier: MIT
#include "shm/lock_file.hpp"

#include <fcntl.h>
#include <pthread.h>
#include <unistd.h>

#include <mutex>
#include <utility>

namespace mavloom::shm {

// The process's only list of open lock files, for the at-fork handler. Never destroyed, because rings may be closed
// during program exit.
struct ForkRegistry {
    std::mutex mutex;
    LockFile* first = nullptr;

    static ForkRegistry& instance() {
        static auto& registry = *new ForkRegistry;  // always reachable, so not reported as a leak
        static const int registered = ::pthread_atfork([] { registry.mutex.lock(); }, [] { registry.mutex.unlock(); },
                                                       [] { registry.close_all(); });
        static_cast<void>(registered);  // fails only without memory; children then keep locks until exec or exit
        return registry;
    }

    void add(LockFile& file) {
        const std::lock_guard lock(mutex);
        file.next_ = first;
        if (first != nullptr) first->previous_ = &file;
        first = &file;
    }

    void remove(LockFile& file) {
        const std::lock_guard lock(mutex);
        (file.previous_ != nullptr ? file.previous_->next_ : first) = file.next_;
        if (file.next_ != nullptr) file.next_->previous_ = file.previous_;
    }

    // Runs in the child, with the mutex locked by the prepare handler.
    void close_all() {
        for (LockFile* file = first; file != nullptr; file = file->next_) {
            ::close(std::exchange(file->fd_, -1));
            file->forked_.store(true, std::memory_order_relaxed);
        }
        mutex.unlock();
    }
};

LockFile::LockFile(int fd) : fd_(fd) { ForkRegistry::instance().add(*this); }

LockFile::~LockFile() {
    ForkRegistry::instance().remove(*this);
    if (fd_ >= 0) ::close(fd_);
}

static struct flock range_of(std::size_t byte, short type) {
    struct flock range {};
    range.l_type = type;
    range.l_whence = SEEK_SET;
    range.l_start = static_cast<off_t>(byte);
    range.l_len = 1;
    return range;
}

bool LockFile::try_lock(std::size_t byte) noexcept {
    struct flock range = range_of(byte, F_WRLCK);
    return ::fcntl(fd_, F_OFD_SETLK, &range) == 0;
}

void LockFile::unlock(std::size_t byte) noexcept {
    struct flock range = range_of(byte, F_UNLCK);
    ::fcntl(fd_, F_OFD_SETLK, &range);
}

bool LockFile::is_locked(std::size_t byte) const noexcept {
    struct flock range = range_of(byte, F_RDLCK);  // conflicts with locks for writing only
    return ::fcntl(fd_, F_OFD_GETLK, &range) == 0 && range.l_type != F_UNLCK;
}

}  // namespace mavloom::shm
