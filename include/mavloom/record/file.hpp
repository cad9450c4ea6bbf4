// SPDX-License-Identifier: MIT
// An open file for reading or writing recordings. A signal does not interrupt reads and writes: each one completes or
// returns an error. A signal only interrupts the wait for a pipe or device.
//
// A File keeps its own position in a regular file and does not use the descriptor's. A forked child that continues
// reading therefore does not move its parent's position. Files are move-only, have one owner thread, and allocate only
// for paths and error texts.
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
    // The behaviour of `read` while a pipe or device is empty: wait for data, or return an error at once.
    enum class Empty : std::uint8_t { wait, report };
    // Opens a FIFO at once even if it has no writer; the FIFO stays empty until a writer opens it.
    [[nodiscard]] static SetupResult<File> open_to_read(const std::filesystem::path& path, Empty empty = Empty::wait);
    // Creates a file with mode 0644. Fails with `in_use` if it already exists.
    [[nodiscard]] static SetupResult<File> create(const std::filesystem::path& path);
    // Opens an existing device or FIFO. For a FIFO, this waits until it has a reader.
    [[nodiscard]] static SetupResult<File> open_to_write(const std::filesystem::path& path);

    File(File&& other) noexcept
        : path_(std::move(other.path_)),
          fd_(std::exchange(other.fd_, -1)),
          regular_(other.regular_),
          empty_(other.empty_),
          offset_(other.offset_) {}
    File& operator=(File&& other) noexcept;
    ~File();

    // Reads from the current position and returns the number of bytes read. A regular file fills `out` unless the file
    // ends first. A pipe or device returns the bytes available, and 0 at its end. While a pipe or device is empty:
    // - `Empty::wait` waits for data. A signal ends the wait with an error whose sys_errno is EINTR.
    // - `Empty::report` returns an error whose sys_errno is EAGAIN.
    [[nodiscard]] SetupResult<std::size_t> read(ByteSpan out);
    // Waits until a pipe or device has data or has ended. Returns false after `limit` or a signal. Returns true at once
    // for a regular file.
    [[nodiscard]] bool wait(std::chrono::milliseconds limit) const noexcept;
    struct Written {
        std::size_t bytes = 0;  // bytes written; fewer than requested only if `error` is set
        int error = 0;          // errno, or 0
    };
    [[nodiscard]] Written write(ByteView bytes) noexcept;

    [[nodiscard]] SetupResult<void> seek(std::uint64_t offset);
    [[nodiscard]] SetupResult<void> truncate(std::uint64_t size);
    [[nodiscard]] SetupResult<std::uint64_t> size() const;
    void close() noexcept;
    // Waits until the disk has all bytes, then closes the file. The file is closed even if this fails.
    [[nodiscard]] SetupResult<void> sync_and_close();

    [[nodiscard]] bool is_regular() const noexcept { return regular_; }
    [[nodiscard]] bool is_open() const noexcept { return fd_ >= 0; }
    // Returns whether the path still leads to this file.
    [[nodiscard]] bool is_named() const noexcept;
    // Returns whether any path leads to this file.
    [[nodiscard]] bool is_linked() const noexcept;
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
    std::uint64_t offset_ = 0;  // of the next byte to read or write in a regular file
};

}  // namespace mavloom::record
