// SPDX-License-Identifier: MIT
#include "mavloom/net/serial.hpp"

// <termios.h> has neither termios2 nor BOTHER, and conflicts with this kernel header.
#include <asm/termbits.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <linux/major.h>
#include <linux/serial.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <climits>
#include <utility>

namespace mavloom::net {

static constexpr int close_limit_ms = 100;
static constexpr int close_step_ms = 5;

SerialPort& SerialPort::operator=(SerialPort&& other) noexcept {
    if (this == &other) return *this;
    close();
    fd_ = std::move(other.fd_);
    baud_ = other.baud_;
    low_latency_ = other.low_latency_;
    return *this;
}

static tl::unexpected<SetupError> open_error(const std::string& device, int err) {
    auto error = system_error(fmt::format("cannot open {}", device), err);
    if (err == EACCES)
        error.value().text += "; your user must be in the group that owns serial ports (on Debian: dialout)";
    if (err == EBUSY) error.value().text += "; another program uses it";
    if (err == EISDIR) error.value().code = SetupCode::usage;
    return error;
}

SetupResult<SerialPort> SerialPort::open(const std::string& device, const SerialOptions& options) {
    SerialPort port;
    port.fd_ = Fd(::open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
    if (!port.fd_) return open_error(device, errno);
    if (::isatty(port.fd()) == 0 && errno != EIO) {
        return setup_error(SetupCode::usage, fmt::format("{} is not a serial port", device));
    }
    if (auto done = port.lock(device); !done) return tl::unexpected(std::move(done).error());
    if (auto done = port.set_raw(options); !done)
        return tl::unexpected(std::move(done.error()).within(fmt::format("cannot set up {}", device)));
    port.low_latency_ = options.low_latency && port.set_low_latency();
    return port;
}

static bool is_pseudo_terminal(int fd) noexcept {
    struct stat status;
    if (fstat(fd, &status) != 0) return false;
    const unsigned number = major(status.st_rdev);
    return number >= UNIX98_PTY_SLAVE_MAJOR && number < UNIX98_PTY_SLAVE_MAJOR + UNIX98_PTY_MAJOR_COUNT;
}

// flock stops programs that ask for a lock. TIOCEXCL stops all others, except root. A pseudo-terminal gets no TIOCEXCL,
// because it would keep that setting after this program closes it, until its other end closes too.
SetupResult<void> SerialPort::lock(const std::string& device) {
    if (::flock(fd(), LOCK_EX | LOCK_NB) != 0) {
        if (errno == EWOULDBLOCK)
            return setup_error(SetupCode::in_use, fmt::format("{} is in use: another program has locked it", device));
        return system_error(fmt::format("cannot lock {}", device), errno);
    }
    if (!is_pseudo_terminal(fd())) ::ioctl(fd(), TIOCEXCL);
    return {};
}

static std::uint32_t driver_baud(int fd, std::uint32_t asked) noexcept {
    termios2 settings{};
    return ::ioctl(fd, TCGETS2, &settings) == 0 && settings.c_ospeed != 0 ? settings.c_ospeed : asked;
}

SetupResult<void> SerialPort::set_raw(const SerialOptions& options) {
    termios2 settings{};
    if (::ioctl(fd(), TCGETS2, &settings) != 0) return system_error("its settings cannot be read", errno);
    settings.c_iflag = IGNBRK;
    settings.c_oflag = 0;
    settings.c_lflag = 0;
    // Without HUPCL, closing the port does not drop DTR. A drop of DTR resets some boards.
    settings.c_cflag = CS8 | CREAD | CLOCAL | BOTHER | (options.rtscts ? CRTSCTS : 0);
    settings.c_cc[VMIN] = 1;  // so a read of 0 bytes means that the port is gone
    settings.c_cc[VTIME] = 0;
    settings.c_ispeed = settings.c_ospeed = options.baud;
    if (::ioctl(fd(), TCSETS2, &settings) != 0) {
        return system_error(fmt::format("baud={}{} cannot be set", options.baud, options.rtscts ? " flow=rtscts" : ""),
                            errno);
    }
    baud_ = driver_baud(fd(), options.baud);
    return {};
}

bool SerialPort::set_low_latency() noexcept {
    serial_struct settings{};
    if (::ioctl(fd(), TIOCGSERIAL, &settings) != 0) return false;
    settings.flags |= ASYNC_LOW_LATENCY;
    if (::ioctl(fd(), TIOCSSERIAL, &settings) != 0) return false;
    return ::ioctl(fd(), TIOCGSERIAL, &settings) == 0 && (settings.flags & ASYNC_LOW_LATENCY) != 0;
}

SetupResult<void> SerialPort::set_baud(std::uint32_t baud) {
    termios2 settings{};
    if (::ioctl(fd(), TCGETS2, &settings) != 0) return system_error("its settings cannot be read", errno);
    settings.c_ispeed = settings.c_ospeed = baud;
    if (::ioctl(fd(), TCSETS2, &settings) != 0) return system_error(fmt::format("baud={} cannot be set", baud), errno);
    ::ioctl(fd(), TCFLSH, TCIFLUSH);
    baud_ = driver_baud(fd(), baud);
    return {};
}

void SerialPort::close() noexcept {
    if (!fd_) return;
    for (int waited_ms = 0; unsent_bytes() != 0; waited_ms += close_step_ms) {
        if (waited_ms >= close_limit_ms) {
            ::ioctl(fd(), TCFLSH, TCOFLUSH);
            break;
        }
        ::poll(nullptr, 0, close_step_ms);
    }
    fd_.reset();
}

IoResult<std::size_t> SerialPort::read(ByteSpan room) noexcept {
    assert(!room.empty() && "0 bytes mean that the port is gone");
    const ssize_t count = ::read(fd(), room.data(), room.size());
    if (count < 0) return tl::unexpected(io_error_of(errno));
    if (count == 0) return tl::unexpected(IoError::closed);
    return static_cast<std::size_t>(count);
}

IoResult<std::size_t> SerialPort::write(std::span<const iovec> pieces) noexcept {
    assert(!pieces.empty());
    const auto most = static_cast<int>(std::min<std::size_t>(pieces.size(), IOV_MAX));
    const ssize_t count = ::writev(fd(), pieces.data(), most);
    if (count < 0) return tl::unexpected(io_error_of(errno));
    if (count == 0) return tl::unexpected(IoError::would_block);
    return static_cast<std::size_t>(count);
}

std::size_t SerialPort::unsent_bytes() const noexcept {
    int count = 0;
    return ::ioctl(fd(), TIOCOUTQ, &count) == 0 && count > 0 ? static_cast<std::size_t>(count) : 0;
}

}  // namespace mavloom::net
