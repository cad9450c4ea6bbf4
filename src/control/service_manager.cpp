// SPDX-License-Identifier: MIT
#include "mavloom/control/service_manager.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdlib>
#include <utility>

namespace mavloom::control {

namespace {

std::string_view variable(const char* name) {
    const char* const value = std::getenv(name);
    return value == nullptr ? std::string_view{} : std::string_view(value);
}

std::int64_t number_in(std::string_view text) noexcept {
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{} && end == text.data() + text.size() ? value : 0;
}

// `name` is a path such as "/run/systemd/notify", or "@name" in the abstract namespace.
int connect_to(std::string_view name) noexcept {
    sockaddr_un address{};
    if (name.size() < 2 || name.size() >= sizeof address.sun_path || (name[0] != '/' && name[0] != '@')) return -1;
    address.sun_family = AF_UNIX;
    std::copy(name.begin(), name.end(), std::begin(address.sun_path));
    if (name[0] == '@') address.sun_path[0] = '\0';
    const int fd = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size());
    if (fd < 0 || ::connect(fd, reinterpret_cast<const sockaddr*>(&address), size) == 0) return fd;
    ::close(fd);
    return -1;
}

std::chrono::microseconds watchdog_interval() {
    const auto pid = variable("WATCHDOG_PID");
    if (!pid.empty() && number_in(pid) != ::getpid()) return {};
    return std::chrono::microseconds(std::max<std::int64_t>(number_in(variable("WATCHDOG_USEC")), 0));
}

}  // namespace

ServiceManager::ServiceManager(int fd, std::chrono::microseconds watchdog) noexcept
    : fd_(fd), half_interval_(watchdog / 2) {
    if (fd_ >= 0 && half_interval_.count() > 0) due_ = mono_now();
}

ServiceManager::ServiceManager(ServiceManager&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)), half_interval_(other.half_interval_), due_(other.due_) {}

ServiceManager::~ServiceManager() {
    if (fd_ >= 0) ::close(fd_);
}

ServiceManager ServiceManager::from_environment() {
    return {connect_to(variable("NOTIFY_SOCKET")), watchdog_interval()};
}

// The time stamp lets the manager distinguish this reload from the next.
void ServiceManager::reloading() const noexcept {
    std::array<char, 64> text;
    const auto us = std::chrono::duration_cast<std::chrono::microseconds>(mono_now().time_since_epoch()).count();
    const auto end = fmt::format_to_n(text.begin(), text.size(), "RELOADING=1\nMONOTONIC_USEC={}", us).out;
    send({text.data(), static_cast<std::size_t>(end - text.begin())});
}

void ServiceManager::feed(MonoTime now) noexcept {
    if (now < due_) return;
    due_ = now + half_interval_;
    send("WATCHDOG=1");
}

// Never blocks: a manager that does not read must not stall the program.
void ServiceManager::send(std::string_view message) const noexcept {
    if (fd_ >= 0) (void)::send(fd_, message.data(), message.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
}

}  // namespace mavloom::control
