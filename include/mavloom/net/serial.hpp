// SPDX-License-Identifier: MIT
// Serial ports: opening and configuring them, finding an unplugged port again, and noticing when it comes back.
//
// Ports carry raw bytes at any baud rate, are non-blocking, and are locked against use by other programs.
// Pseudo-terminals count as serial ports. One thread at a time; reading and writing allocate nothing. Sources:
// tty_ioctl(4) for termios2 and BOTHER, inotify(7).
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
    bool low_latency = false;  // sets ASYNC_LOW_LATENCY, if the driver supports it
};

class SerialPort {
public:
    SerialPort() noexcept = default;
    SerialPort(SerialPort&&) noexcept = default;
    SerialPort& operator=(SerialPort&& other) noexcept;
    ~SerialPort() { close(); }

    // Opens `device` with eight data bits, no parity, one stop bit and no byte translation. Returns `in_use` if another
    // program holds the port (flock, TIOCEXCL), and `usage` if the path is not a serial port.
    [[nodiscard]] static SetupResult<SerialPort> open(const std::string& device, const SerialOptions& options);
    // Waits up to 100 ms for the driver to send its remaining bytes, then discards them. Without that limit, flow
    // control could block the close for half a minute.
    void close() noexcept;

    // Changes the baud rate. Discards received bytes that were not read yet, because they were received at the old
    // rate.
    [[nodiscard]] SetupResult<void> set_baud(std::uint32_t baud);
    // The rate that the driver actually uses, which may differ from the requested one.
    [[nodiscard]] std::uint32_t baud() const noexcept { return baud_; }
    // Whether low latency was requested and the driver supports it.
    [[nodiscard]] bool low_latency() const noexcept { return low_latency_; }

    [[nodiscard]] int fd() const noexcept { return fd_.get(); }
    [[nodiscard]] explicit operator bool() const noexcept { return static_cast<bool>(fd_); }

    // Reads at least one byte, or returns would_block. Any other error means that the port is gone.
    [[nodiscard]] IoResult<std::size_t> read(ByteSpan room) noexcept;
    // Writes some of the bytes, or returns would_block. Any other error means that the port is gone.
    [[nodiscard]] IoResult<std::size_t> write(std::span<const iovec> pieces) noexcept;
    // The number of bytes that the driver has not sent yet (TIOCOUTQ). 0 if the driver does not report it.
    [[nodiscard]] std::size_t unsent_bytes() const noexcept;

private:
    [[nodiscard]] SetupResult<void> lock(const std::string& device);
    [[nodiscard]] SetupResult<void> set_raw(const SerialOptions& options);
    [[nodiscard]] bool set_low_latency() noexcept;

    Fd fd_;
    std::uint32_t baud_ = 0;
    bool low_latency_ = false;
};

// Finds one serial device again after it was unplugged. It tracks two names: the path that the user gave, and the link
// in /dev/serial/by-id that led to the open device. If the device returns under another number, the link still leads to
// it. While the link and the user's path lead to different devices, the path is not tried, because another device may
// have taken it.
class SerialDevice {
public:
    static constexpr std::string_view default_id_folder = "/dev/serial/by-id";
    // udev creates the links shortly after the kernel has created the device.
    static constexpr std::chrono::seconds link_delay{1};

    explicit SerialDevice(std::string path, std::string id_folder = std::string(default_id_folder))
        : path_(std::move(path)), id_folder_(std::move(id_folder)) {}

    [[nodiscard]] const std::string& path() const noexcept { return path_; }
    // Empty while no link is known.
    [[nodiscard]] const std::string& id_link() const noexcept { return id_link_; }

    // Call when the device was opened under `name`. Finds and remembers its link.
    void note_opened(const std::string& name);
    // Returns the paths to try now. Empty if the device at the path is so new that its link may still appear.
    [[nodiscard]] std::vector<std::string> places() const;
    // Returns the existing folders in which names of the device may appear.
    [[nodiscard]] std::vector<std::string> folders() const;

private:
    [[nodiscard]] std::string id_of(const std::string& name) const;

    std::string path_, id_folder_;
    std::string id_link_;
};

// Watches folders through inotify. The descriptor becomes readable when a name in one of them is created, renamed,
// removed or changes its permissions.
class FolderWatch {
public:
    FolderWatch() noexcept = default;
    [[nodiscard]] static SetupResult<FolderWatch> create();
    [[nodiscard]] explicit operator bool() const noexcept { return static_cast<bool>(fd_); }
    [[nodiscard]] int fd() const noexcept { return fd_.get(); }

    // Adds a folder. Ignores a folder that cannot be watched or is already watched.
    void add(const std::string& folder) noexcept;
    // Discards all pending notifications.
    void drain() noexcept;

private:
    Fd fd_;
};

}  // namespace mavloom::net
