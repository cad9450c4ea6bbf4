// SPDX-License-Identifier: MIT
#include "child.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <utility>

#include "mavloom/base/thread.hpp"

namespace mavloom::app::demo_parts {

namespace {

constexpr std::size_t kept_bytes = 64 * 1024;  // of each output

struct Pipe {
    net::Fd reader, writer;
};

SetupResult<Pipe> open_pipe() {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) return system_error("cannot open a pipe", errno);
    ::fcntl(ends[0], F_SETFL, O_NONBLOCK);
    return Pipe{net::Fd(ends[0]), net::Fd(ends[1])};
}

std::vector<char*> pointers_to(const std::vector<std::string>& texts) {
    std::vector<char*> all;
    all.reserve(texts.size() + 1);
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast): execve does not change them
    for (const auto& text : texts) all.push_back(const_cast<char*>(text.c_str()));
    all.push_back(nullptr);
    return all;
}

// Runs in the child, where only async-signal-safe calls are allowed.
[[noreturn]] void become(pid_t parent, int out, int err, char* const* words, char* const* environment) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
    sigset_t none_blocked;
    ::sigemptyset(&none_blocked);
    ::sigprocmask(SIG_SETMASK, &none_blocked, nullptr);
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (::getppid() != parent) ::_exit(1);  // the parent ended before that call
    ::setpgid(0, 0);
    const int none = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
    ::dup2(none, STDIN_FILENO);
    ::dup2(out, STDOUT_FILENO);
    ::dup2(err, STDERR_FILENO);
    ::execve(words[0], words, environment);
    ::_exit(127);
}

// Appends what is there. Closes the pipe at its end.
void read_into(std::string& text, net::Fd& pipe) {
    std::array<char, 4096> bytes;  // NOLINT(cppcoreguidelines-pro-type-member-init): read() fills it
    ssize_t got = 0;
    while (pipe && (got = ::read(pipe.get(), bytes.data(), bytes.size())) > 0)
        text.append(bytes.data(), static_cast<std::size_t>(got));
    if (pipe && got == 0) pipe.reset();
    if (text.size() > kept_bytes) text.erase(0, text.size() - kept_bytes);
}

}  // namespace

SetupResult<Child> Child::start(const std::vector<std::string>& words, const std::vector<std::string>& environment) {
    auto out = open_pipe(), err = open_pipe();
    if (!out || !err) return tl::unexpected(std::move(out ? err.error() : out.error()));
    const auto arguments = pointers_to(words), variables = pointers_to(environment);
    const BlockedSignals blocked;  // a signal that our handler took in the child would be lost at execve()
    const pid_t parent = ::getpid(), pid = ::fork();
    if (pid < 0) return system_error("cannot start a process", errno);
    if (pid == 0) become(parent, out->writer.get(), err->writer.get(), arguments.data(), variables.data());
    return Child(pid, std::move(out->reader), std::move(err->reader));
}

Child::Child(Child&& other) noexcept
    : pid_(std::exchange(other.pid_, 0)),
      out_(std::move(other.out_)),
      err_(std::move(other.err_)),
      printed_(std::move(other.printed_)),
      said_(std::move(other.said_)),
      status_(other.status_) {}

Child::~Child() { join(MonoTime{}); }

void Child::look() {
    const bool has_ended = pid_ > 0 && ::waitpid(pid_, &status_, WNOHANG) == pid_;
    read_into(printed_, out_);
    read_into(said_, err_);
    if (has_ended) pid_ = 0;
}

std::string Child::ending() const {
    return WIFSIGNALED(status_) ? fmt::format("signal {}", WTERMSIG(status_))
                                : fmt::format("status {}", WEXITSTATUS(status_));
}

bool Child::was_killed() const noexcept { return pid_ == 0 && WIFSIGNALED(status_); }

void Child::terminate() noexcept {
    if (pid_ > 0) ::kill(pid_, SIGTERM);
}

void Child::join(MonoTime end) {
    constexpr int look_ms = 5;
    for (look(); pid_ > 0; look()) {
        if (mono_now() >= end) ::kill(pid_, SIGKILL);
        ::poll(nullptr, 0, look_ms);
    }
}

std::string_view last_line(std::string_view text) {
    while (text.ends_with('\n')) text.remove_suffix(1);
    return text.substr(text.rfind('\n') + 1);
}

}  // namespace mavloom::app::demo_parts
