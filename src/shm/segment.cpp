// SPDX-License-Identifier: MIT
#include "shm/segment.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <pwd.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <utility>

#include "mavloom/base/name.hpp"
#include "mavloom/base/shown.hpp"
#include "shm/lock_file.hpp"
#include "shm/mappings.hpp"

namespace mavloom::shm {

namespace {

constexpr unsigned others_write = 0022;  // mode bits

// Opening this path opens the same file again, with an open file description of its own.
std::string path_of_descriptor(int fd) { return fmt::format("/proc/self/fd/{}", fd); }

tl::unexpected<SetupError> cannot_open(const std::string& path, int error) {
    auto failed = system_error(fmt::format("cannot open {}", path), error);
    struct stat status {};
    if ((error == EACCES || error == EPERM) && ::stat(path.c_str(), &status) == 0)
        failed.value().text += fmt::format("; it belongs to {}, mode {:04o}", user_name(status.st_uid),
                                           status.st_mode & 07777u);
    return failed;
}

tl::unexpected<SetupError> no_space(const std::string& path, std::size_t size, int error) {
    const auto folder = path.substr(0, path.rfind('/'));
    auto failed = system_error(fmt::format("cannot create {} of {} bytes", path, size), error);
    struct statvfs status {};
    if (error == ENOSPC && ::statvfs(folder.c_str(), &status) == 0)
        failed.value().text += fmt::format("; {} has {} bytes free", folder, status.f_bavail * status.f_frsize);
    return failed;
}

bool write_all(int fd, ByteView bytes) {
    for (off_t at = 0; !bytes.empty();) {
        const auto took = ::pwrite(fd, bytes.data(), bytes.size(), at);
        if (took < 0 && errno == EINTR) continue;
        if (took <= 0) return false;
        at += took;
        bytes = bytes.subspan(static_cast<std::size_t>(took));
    }
    return true;
}

// Returns 0 or an errno value. Retries, because any signal interrupts posix_fallocate.
int allocate(int fd, std::size_t size) {
    int error;
    do error = ::posix_fallocate(fd, 0, static_cast<off_t>(size));
    while (error == EINTR);
    return error;
}

}  // namespace

SetupResult<void> check_name(std::string_view name) {
    if (is_name(name)) return {};
    return setup_error(
        SetupCode::usage,
        fmt::format("{} is not a valid ring name: use 1 to {} letters, digits, _ and -", in_quotes(name), longest_name));
}

std::string path_of(std::string_view name, std::string_view suffix) {
    return fmt::format("{}/mavloom.{}{}", shared_folder, name, suffix);
}

SetupResult<void> check_owner(const Segment& segment) {
    const auto owner = segment.status().owner;
    if (owner == 0 || owner == ::geteuid()) return {};
    return setup_error(SetupCode::permission, fmt::format("{} belongs to {}; remove it or choose another name",
                                                          segment.path(), user_name(owner)));
}

SetupResult<void> check_trusted(const Segment& segment, std::string_view what, const Trust& trust) {
    if (trust.foreign) return {};
    const auto [owner, mode] = segment.status();
    if (owner != 0 && owner != ::geteuid() && owner != trust.user)
        return setup_error(
            SetupCode::permission,
            fmt::format("{} belongs to {}, so anything may be in it; foreign=true reads it", what, user_name(owner)));
    if ((mode & others_write) == 0 || has_lost_mapping_handler()) return {};
    return setup_error(
        SetupCode::permission,
        fmt::format("users other than its owner may write {} (mode {:04o}), and could end this program by "
                    "shortening it; foreign=true reads it",
                    what, mode));
}

SetupCode held_code(const Segment& segment) noexcept {
    return (segment.status().mode & others_write) == 0 ? SetupCode::in_use : SetupCode::permission;
}

SetupResult<void> check_survivable(const Segment& segment) {
    return check_trusted(segment, segment.path(), {.foreign = has_lost_mapping_handler()});
}

bool rename_aside(const std::string& path) { return ::rename(path.c_str(), (path + ".aside").c_str()) == 0; }

std::string user_name(uid_t user) {
    std::array<char, 1024> buffer;
    passwd entry{};
    passwd* found = nullptr;
    if (::getpwuid_r(user, &entry, buffer.data(), buffer.size(), &found) == 0 && found != nullptr)
        return found->pw_name;
    return fmt::format("user {}", user);
}

Segment::Segment(std::string path, std::unique_ptr<LockFile> locks, Access access) noexcept
    : path_(std::move(path)), locks_(std::move(locks)), access_(access) {}

Segment::Segment(Segment&& other) noexcept
    : path_(std::move(other.path_)),
      locks_(std::move(other.locks_)),
      access_(other.access_),
      data_(std::exchange(other.data_, nullptr)),
      size_(std::exchange(other.size_, 0)),
      mapping_(std::exchange(other.mapping_, nullptr)) {}

Segment& Segment::operator=(Segment&& other) noexcept {
    std::swap(path_, other.path_);
    std::swap(locks_, other.locks_);
    std::swap(access_, other.access_);
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(mapping_, other.mapping_);
    return *this;
}

Segment::~Segment() {
    remove_mapping(mapping_);
    if (data_ != nullptr) ::munmap(data_, size_);
}

SetupResult<void> Segment::map() {
    assert(data_ == nullptr && mapping_ == nullptr);
    const bool writes = access_ == Access::read_write;
    const int fd = ::open(path_of_descriptor(locks_->get()).c_str(), (writes ? O_RDWR : O_RDONLY) | O_CLOEXEC);
    if (fd < 0) return cannot_open(path_, errno);
    void* const memory = ::mmap(nullptr, size_, writes ? PROT_READ | PROT_WRITE : PROT_READ, MAP_SHARED, fd, 0);
    const int error = errno;
    ::close(fd);
    if (memory == MAP_FAILED) return system_error(fmt::format("cannot map {}", path_), error);
    data_ = static_cast<std::uint8_t*>(memory);
    mapping_ = add_mapping(data_, size_);
    return {};
}

void Segment::set_retired_word(std::size_t offset) noexcept {
    assert(offset % alignof(std::uint32_t) == 0 && offset + sizeof(std::uint32_t) <= size_);
    if (mapping_ != nullptr) mapping_->retired_word.store(offset, std::memory_order_relaxed);
}

// Failure is harmless: if the kernel lacks MADV_POPULATE, or the file was shortened, nothing changes.
void Segment::populate() noexcept {
    assert(data_ != nullptr);
    constexpr std::size_t most = 64 << 20;
    ::madvise(data_, std::min(size_, most), writable() ? MADV_POPULATE_WRITE : MADV_POPULATE_READ);
}

SetupResult<Segment> Segment::open(const std::string& path, Access access, std::size_t min_bytes, const Check& check) {
    const int flags = (access == Access::read_write ? O_RDWR : O_RDONLY) | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;
    const int fd = ::open(path.c_str(), flags);
    if (fd < 0) return cannot_open(path, errno);
    Segment segment(path, std::make_unique<LockFile>(fd), access);
    struct stat status {};
    if (::fstat(fd, &status) != 0) return cannot_open(path, errno);
    if (!S_ISREG(status.st_mode))
        return setup_error(SetupCode::bad_input, fmt::format("{} is not a regular file", path));
    if (auto trusted = check(segment); !trusted) return tl::unexpected(std::move(trusted.error()));
    segment.size_ = static_cast<std::size_t>(status.st_size);
    if (segment.size_ < min_bytes)
        return setup_error(SetupCode::bad_input, fmt::format("{} is truncated: {} bytes instead of at least {}", path,
                                                             segment.size_, min_bytes));
    if (auto mapped = segment.map(); !mapped) return tl::unexpected(std::move(mapped.error()));
    return segment;
}

SetupResult<Segment> Segment::create(const std::string& path, std::size_t size, unsigned mode, ByteView content,
                                     const Segment* replaced) {
    assert(content.size() <= size && (mode & ~0777u) == 0);
    const auto folder = path.substr(0, path.rfind('/'));
    const int fd = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, mode);
    if (fd < 0) return no_space(path, size, errno);
    Segment segment(path, std::make_unique<LockFile>(fd), Access::read_write);
    segment.size_ = size;
    if (const int error = allocate(fd, size); error != 0) return no_space(path, size, error);
    // fchmod, because the umask must not apply.
    if (!write_all(fd, content) || ::fchmod(fd, mode) != 0) return no_space(path, size, errno);
    if (!segment.try_lock(0)) return system_error(fmt::format("cannot lock {}", path), errno);
    if (auto mapped = segment.map(); !mapped) return tl::unexpected(std::move(mapped.error()));
    if (replaced != nullptr)
        if (auto unlinked = replaced->unlink(); !unlinked) return tl::unexpected(std::move(unlinked.error()));
    if (::linkat(AT_FDCWD, path_of_descriptor(fd).c_str(), AT_FDCWD, path.c_str(), AT_SYMLINK_FOLLOW) != 0)
        return system_error(fmt::format("cannot create {}", path), errno);
    return segment;
}

std::size_t Segment::read_begin(ByteSpan out) const noexcept {
    ssize_t count;
    do count = ::pread(locks_->get(), out.data(), out.size(), 0);
    while (count < 0 && errno == EINTR);
    return count < 0 ? 0 : static_cast<std::size_t>(count);
}

bool Segment::try_lock(std::size_t byte) noexcept { return locks_->try_lock(byte); }
void Segment::unlock(std::size_t byte) noexcept { locks_->unlock(byte); }
bool Segment::is_locked(std::size_t byte) const noexcept { return locks_->is_locked(byte); }
const std::atomic<bool>& Segment::forked_flag() const noexcept { return locks_->forked(); }

bool Segment::is_named() const noexcept {
    if (mapping_ != nullptr && mapping_->lost.load(std::memory_order_acquire)) return false;
    struct stat named {
    }, mine{};
    return ::stat(path_.c_str(), &named) == 0 && ::fstat(locks_->get(), &mine) == 0 && named.st_dev == mine.st_dev &&
           named.st_ino == mine.st_ino;
}

SetupResult<void> Segment::unlink() const {
    if (!is_named() || ::unlink(path_.c_str()) == 0 || errno == ENOENT) return {};
    auto failed = system_error(fmt::format("cannot remove {}", path_), errno);
    if (failed.value().code == SetupCode::permission)
        failed.value().text += fmt::format("; it belongs to {}", user_name(status().owner));
    return failed;
}

Segment::Status Segment::status() const noexcept {
    struct stat mine {};
    if (::fstat(locks_->get(), &mine) != 0) return {};
    return {mine.st_uid, static_cast<unsigned>(mine.st_mode & 07777u)};
}

}  // namespace mavloom::shm
