// SPDX-License-Identifier: MIT
// Private to module runtime.
#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <filesystem>

namespace mavloom::runtime {

// Of routers that start at once in one folder, each looks at a socket, takes it over and listens before the next one looks.
class FolderLock {
public:
    enum class Wait : bool { no, yes };

    explicit FolderLock(const std::filesystem::path& folder, Wait wait = Wait::yes)
        : fd_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
        held_ = fd_ >= 0 && ::flock(fd_, LOCK_EX | (wait == Wait::no ? LOCK_NB : 0)) == 0;
    }
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;
    ~FolderLock() {
        if (fd_ >= 0) ::close(fd_);
    }

    [[nodiscard]] bool held() const noexcept { return held_; }

private:
    int fd_;
    bool held_ = false;
};

}  // namespace mavloom::runtime
