// SPDX-License-Identifier: MIT
// An open file as the recorder and the reader need it: reads and writes that are completed or reported, never interrupted half-way by a signal
// (only waiting for a pipe or device can be). The position in a regular file is the object's own, not the descriptor's: a forked child that reads on
// moves nothing in its parent.
// Move-only; one owner thread; allocates only for error texts.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <utility>

#include "mavloom/base/bytes.hpp"
#include "mavloom/base/result.hpp"

namespace mavloom::record {

class File {
public:
    // What `read` does while a pipe or device has nothing: wait for it, or say so.
    enum class Empty : std::uint8_t { wait, tell };
    // A FIFO without a writer is opened at once, and has nothing until one comes.
    [[nodiscard]] static SetupResult<File> open_to_read(const std::filesystem::path& path, Empty empty = Empty::wait);
    // A new file of this name, mode 0644; one that exists is an error (`in_use`).
    [[nodiscard]] static SetupResult<File> create(const std::filesystem::path& path);
    // Something that is there and is no regular file (a device, a FIFO).
    [[nodiscard]] static SetupResult<File> open_to_write(const std::filesystem::path& path);

    File(File&& other) noexcept
        : path_(std::move(other.path_)),
          fd_(std::exchange(other.fd_, -1)),
          regular_(other.regular_),
          empty_(other.empty_),
          offset_(other.offset_) {}
    File& operator=(File&& other) noexcept;
    ~File();

    // Fills `out` from the current position until it is full or the file ends; returns the number of bytes. A pipe or device gives what is
    // there, once something is, and 0 at its end. Nothing there is an error with sys_errno EAGAIN (`Empty::tell`), a signal while it waits one
    // with EINTR.
    [[nodiscard]] SetupResult<std::size_t> read(ByteSpan out);
    // Waits until a pipe or device has something to read, or has ended; false when the time has passed or a signal came. Always true of a file.
    [[nodiscard]] bool wait(std::chrono::milliseconds limit) const noexcept;
    struct Written {
        std::size_t bytes = 0;  // what the system took: less than all only where `error` is set
        int error = 0;          // errno
    };
    [[nodiscard]] Written write(ByteView bytes) noexcept;

    [[nodiscard]] SetupResult<void> seek(std::uint64_t offset);
    [[nodiscard]] SetupResult<void> truncate(std::uint64_t size);
    [[nodiscard]] SetupResult<std::uint64_t> size() const;
    // Hands all bytes to the disk, then closes. The object is closed in any case.
    [[nodiscard]] SetupResult<void> sync_and_close();

    [[nodiscard]] bool is_regular() const noexcept { return regular_; }
    [[nodiscard]] bool is_open() const noexcept { return fd_ >= 0; }
    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
    [[nodiscard]] tl::unexpected<SetupError> failed(std::string_view doing, int error) const;

private:
    File(std::filesystem::path path, int fd, bool regular) noexcept
        : path_(std::move(path)), fd_(fd), regular_(regular) {}
    [[nodiscard]] int wait_for_input(int limit_ms) const noexcept;
    [[nodiscard]] static SetupResult<File> open(const std::filesystem::path& path, int flags, std::string_view doing);

    std::filesystem::path path_;
    int fd_ = -1;
    bool regular_ = false;
    Empty empty_ = Empty::wait;
    std::uint64_t offset_ = 0;  // of the next byte of a regular file
};

}  // namespace mavloom::record
