// SPDX-License-Identifier: MIT
#include "mavloom/record/file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>

namespace mavloom::record {

tl::unexpected<SetupError> File::failed(std::string_view doing, int error) const {
    return system_error(fmt::format("cannot {} {}", doing, path_.string()), error);
}

SetupResult<File> File::open(const std::filesystem::path& path, int flags, std::string_view doing) {
    const int fd = ::open(path.c_str(), flags | O_CLOEXEC, 0644);
    File file(path, fd, false);
    if (fd < 0) return file.failed(doing, errno);
    struct stat status {};
    if (::fstat(fd, &status) != 0) return file.failed(doing, errno);
    if (S_ISDIR(status.st_mode)) return file.failed(doing, EISDIR);
    file.regular_ = S_ISREG(status.st_mode);
    return file;
}

SetupResult<File> File::open_to_read(const std::filesystem::path& path, Empty empty) {
    auto file = open(path, O_RDONLY | O_NONBLOCK, "read");  // O_NONBLOCK has no effect on a regular file
    if (file) file->empty_ = empty;
    if (file && file->regular_)
        (void)::posix_fadvise(file->fd_, 0, 0, POSIX_FADV_SEQUENTIAL);  // advice only; an error does no harm
    return file;
}

SetupResult<File> File::create(const std::filesystem::path& path) {
    return open(path, O_WRONLY | O_CREAT | O_EXCL, "create");
}

SetupResult<File> File::open_to_write(const std::filesystem::path& path) { return open(path, O_WRONLY, "write"); }

File& File::operator=(File&& other) noexcept {
    std::swap(path_, other.path_);
    std::swap(fd_, other.fd_);
    std::swap(regular_, other.regular_);
    std::swap(empty_, other.empty_);
    std::swap(offset_, other.offset_);
    return *this;
}

File::~File() { close(); }

void File::close() noexcept {
    if (fd_ >= 0) ::close(std::exchange(fd_, -1));
}

// Returns 0 or an errno value. A read would not do: a FIFO that no writer has opened yet reads as ended, but polls as
// empty.
int File::wait_for_input(int limit_ms) const noexcept {
    pollfd input{fd_, POLLIN, 0};
    const int ready = ::poll(&input, 1, limit_ms);
    return ready > 0 ? 0 : ready == 0 ? EAGAIN : errno;
}

bool File::wait(std::chrono::milliseconds limit) const noexcept {
    return regular_ || wait_for_input(static_cast<int>(limit.count())) == 0;
}

SetupResult<std::size_t> File::read(ByteSpan out) {
    std::size_t done = 0;
    while (done < out.size()) {
        if (!regular_)
            if (const int error = wait_for_input(empty_ == Empty::wait ? -1 : 0); error != 0)
                return failed("read", error);
        const auto got = regular_
                             ? ::pread(fd_, out.data() + done, out.size() - done, static_cast<off_t>(offset_ + done))
                             : ::read(fd_, out.data() + done, out.size() - done);
        if (got == 0) break;
        if (got > 0) done += static_cast<std::size_t>(got);
        else if (errno != EINTR || !regular_) return failed("read", errno);
        if (!regular_) break;
    }
    offset_ += done;
    return done;
}

File::Written File::write(ByteView bytes) noexcept {
    std::size_t done = 0;
    while (done < bytes.size()) {
        const auto took = regular_ ? ::pwrite(fd_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(offset_))
                                   : ::write(fd_, bytes.data() + done, bytes.size() - done);
        if (took < 0 && errno != EINTR) return {done, errno};
        if (took < 0) continue;
        done += static_cast<std::size_t>(took);
        offset_ += static_cast<std::size_t>(took);
    }
    return {done, 0};
}

SetupResult<void> File::seek(std::uint64_t offset) {
    if (!regular_) return failed("seek in", ESPIPE);
    offset_ = offset;
    return {};
}

SetupResult<void> File::truncate(std::uint64_t size) {
    if (::ftruncate(fd_, static_cast<off_t>(size)) != 0) return failed("shorten", errno);
    return seek(size);
}

SetupResult<std::uint64_t> File::size() const {
    struct stat status {};
    if (::fstat(fd_, &status) != 0) return failed("read the size of", errno);
    return static_cast<std::uint64_t>(status.st_size);
}

SetupResult<void> File::sync_and_close() {
    const int fd = std::exchange(fd_, -1);
    const int sync_error = regular_ && ::fdatasync(fd) != 0 ? errno : 0;
    const int close_error = ::close(fd) != 0 ? errno : 0;
    if (sync_error != 0) return failed("write", sync_error);
    if (close_error != 0 && close_error != EINTR) return failed("write", close_error);
    return {};
}

bool File::is_named() const noexcept {
    struct statx named {
    }, mine{};
    return ::statx(AT_FDCWD, path_.c_str(), 0, STATX_INO, &named) == 0 &&
           ::statx(fd_, "", AT_EMPTY_PATH, STATX_INO, &mine) == 0 && named.stx_ino == mine.stx_ino &&
           named.stx_dev_major == mine.stx_dev_major && named.stx_dev_minor == mine.stx_dev_minor;
}

bool File::is_linked() const noexcept {
    struct stat mine {};
    return ::fstat(fd_, &mine) == 0 && mine.st_nlink != 0;
}

}  // namespace mavloom::record
