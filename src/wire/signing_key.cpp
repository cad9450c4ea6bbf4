// SPDX-License-Identifier: MIT
// Creates signing keys and their files. signing.cpp reads them.
#include <fcntl.h>
#include <fmt/format.h>
#include <sodium.h>
#include <unistd.h>

#include <cerrno>

#include "mavloom/wire/signing.hpp"

namespace mavloom::wire {

SetupResult<SigningKey> SigningKey::random() {
    if (sodium_init() < 0) return system_error("the system provides no random numbers", EIO);
    std::array<std::uint8_t, length> bytes;
    randombytes_buf(bytes.data(), bytes.size());
    const SigningKey key(bytes);
    sodium_memzero(bytes.data(), bytes.size());
    return key;
}

SetupResult<void> SigningKey::create_file(const std::filesystem::path& file) const {
    const int fd = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (fd < 0 && errno == EEXIST)
        return setup_error(
            SetupCode::in_use,
            fmt::format("{} already exists, and its key would be lost; choose another file", file.string()));
    if (fd < 0) return system_error(fmt::format("cannot create {}", file.string()), errno);
    std::array<char, 2 * length + 1> text;
    sodium_bin2hex(text.data(), text.size(), bytes_.data(), bytes_.size());
    text.back() = '\n';
    const ssize_t took = ::write(fd, text.data(), text.size());
    int error = took < 0 ? errno : took != static_cast<ssize_t>(text.size()) ? ENOSPC : 0;
    if (error == 0 && ::fsync(fd) != 0) error = errno;
    sodium_memzero(text.data(), text.size());
    ::close(fd);
    if (error == 0) return {};
    ::unlink(file.c_str());
    return system_error(fmt::format("cannot write {}", file.string()), error);
}

}  // namespace mavloom::wire
