// SPDX-License-Identifier: MIT
#include "mavloom/base/secret_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

namespace mavloom {

// The file is user input, so every failure to open it is `bad_input`.
static tl::unexpected<SetupError> cannot_open(std::string_view named, int error) {
    auto failed = system_error(fmt::format("cannot open {}", named), error);
    failed.value().code = SetupCode::bad_input;
    return failed;
}

// Checks and reads the same open file, so that it cannot be replaced in between.
static SetupResult<std::string> read_secret(int fd, std::string_view named, const std::string& file) {
    struct stat status {};
    if (::fstat(fd, &status) != 0) return cannot_open(named, errno);
    if (!S_ISREG(status.st_mode))
        return setup_error(SetupCode::bad_input, fmt::format("{} is not a regular file", named));
    if ((status.st_mode & 077) != 0)
        return setup_error(SetupCode::bad_input, fmt::format("{} can be read by others (mode {:04o}): chmod 600 {}",
                                                             named, status.st_mode & 0777u, file));
    std::string text(longest_secret_bytes + 1, '\0');
    const ssize_t size = ::read(fd, text.data(), text.size());
    if (size < 0) return cannot_open(named, errno);
    text.resize(static_cast<std::size_t>(size));
    if (text.size() <= longest_secret_bytes) return text;
    return setup_error(SetupCode::bad_input, fmt::format("{} is longer than {} bytes", named, longest_secret_bytes));
}

SetupResult<std::string> read_secret_file(const std::filesystem::path& file, std::string_view what) {
    const auto named = fmt::format("{} {}", what, file.string());
    // O_NONBLOCK: opening a pipe must not wait for a writer.
    const int fd = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (fd < 0) return cannot_open(named, errno);
    auto text = read_secret(fd, named, file.string());
    ::close(fd);
    return text;
}

}  // namespace mavloom
