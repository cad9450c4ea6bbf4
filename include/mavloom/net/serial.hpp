// SPDX-License-Identifier: MIT
// Serial ports: raw bytes at any baud rate, non-blocking throughout, not shared with other programs unawares; where a port that was
// unplugged may come back; and being told at once when it does. Pseudo-terminals are serial ports too. One thread at a time; reading and
// writing allocate nothing. termios2 and BOTHER of tty_ioctl(4), inotify(7).
#pragma once

#include <sys/uio.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/base/bytes.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/net/fd.hpp"
#include "mavloom/net/io_result.hpp"

namespace mavloom::net {

struct SerialOptions {
    std::uint32_t baud = 57600;
    bool rtscts = false;
    bool low_latency = false;  // ASYNC_LOW_LATENCY, where the driver has it
};

class SerialPort {
public:
    SerialPort() noexcept = default;
    SerialPort(SerialPort&&) noexcept = default;
    SerialPort& operator=(SerialPort&& other) noexcept;
    ~SerialPort() { close(); }

    // Eight bits, no parity, one stop bit, no translation of any byte. `in_use` when another program holds the port (flock, TIOCEXCL);
    // `usage` when the path is no serial port.
    [[nodiscard]] static SetupResult<SerialPort> open(const std::string& device, const SerialOptions& options);
    // What the driver has not sent yet has 100 ms to leave, and is then discarded: a port held by flow control would else hold its closer
    // for half a minute.
    void close() noexcept;

    // Discards what was received and not read yet: it was heard at another rate.
    [[nodiscard]] SetupResult<void> set_baud(std::uint32_t baud);
    // The rate that the driver made of the one asked for.
    [[nodiscard]] std::uint32_t baud() const noexcept { return baud_; }
    // Asked for, and the driver has it.
    [[nodiscard]] bool low_latency() const noexcept { return low_latency_; }

    [[nodiscard]] int fd() const noexcept { return fd_.get(); }
    [[nodiscard]] explicit operator bool() const noexcept { return static_cast<bool>(fd_); }

    // At least one byte, or would_block; everything else: the port is gone.
    [[nodiscard]] IoResult<std::size_t> read(ByteSpan room) noexcept;
    // Some of the bytes, or would_block; everything else: the port is gone.
    [[nodiscard]] IoResult<std::size_t> write(std::span<const iovec> pieces) noexcept;
    // What the driver holds and has not sent (TIOCOUTQ); 0 where it does not know.
    [[nodiscard]] std::size_t unsent_bytes() const noexcept;

private:
    [[nodiscard]] SetupResult<void> lock(const std::string& device);
    [[nodiscard]] SetupResult<void> set_raw(const SerialOptions& options);
    [[nodiscard]] bool set_low_latency() noexcept;

    Fd fd_;
    std::uint32_t baud_ = 0;
    bool low_latency_ = false;
};

// Under which names one device is to be found: the one that the user gave, and the link in /dev/serial/by-id that led to it while it was
// open, which leads to it under a new number too. Another device that took its name is not taken for it while that link leads elsewhere.
class SerialDevice {
public:
    static constexpr std::string_view default_id_folder = "/dev/serial/by-id";
    // udev makes the links a moment after the kernel has made the device.
    static constexpr std::chrono::seconds link_delay{1};

    explicit SerialDevice(std::string path, std::string id_folder = std::string(default_id_folder))
        : path_(std::move(path)), id_folder_(std::move(id_folder)) {}

    [[nodiscard]] const std::string& path() const noexcept { return path_; }
    // Empty while none is known.
    [[nodiscard]] const std::string& id_link() const noexcept { return id_link_; }

    // The device was opened under `name`: looks for its link.
    void note_opened(const std::string& name);
    // Where to try now. Empty: what stands under its name is so new that its link may still come.
    [[nodiscard]] std::vector<std::string> places() const;
    // Where names of it may appear; folders that exist.
    [[nodiscard]] std::vector<std::string> folders() const;

private:
    [[nodiscard]] std::string id_of(const std::string& name) const;

    std::string path_, id_folder_;
    std::string id_link_;
};

// Readable when a name was made, moved, removed or got other permissions in one of some folders.
class FolderWatch {
public:
    FolderWatch() noexcept = default;
    [[nodiscard]] static SetupResult<FolderWatch> create();
    [[nodiscard]] explicit operator bool() const noexcept { return static_cast<bool>(fd_); }
    [[nodiscard]] int fd() const noexcept { return fd_.get(); }

    // A folder that cannot be watched is passed over; one watched already stays.
    void add(const std::string& folder) noexcept;
    // Forgets what was told so far.
    void drain() noexcept;

private:
    Fd fd_;
};

}  // namespace mavloom::net
