// SPDX-License-Identifier: MIT
// A file in /dev/shm: created whole, opened, mapped, locked byte by byte. Who holds a byte's lock is alive: the kernel lets go of it at any death.
// The locks hang on a second descriptor that is never mapped (a mapping keeps its own description, and so its locks, alive in a forked child),
// closed by exec and, through an at-fork handler, in every child. Move-only; one owner thread but for `forked()`.
#pragma once

#include <sys/types.h>

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/base/bytes.hpp"
#include "mavloom/base/result.hpp"

namespace mavloom::shm {

inline constexpr std::string_view shared_folder = "/dev/shm";

// An error (`usage`) for what is no name of a ring: [A-Za-z0-9_-]{1,64}.
[[nodiscard]] SetupResult<void> check_name(std::string_view name);
// "/dev/shm/mavloom.NAME" + suffix.
[[nodiscard]] std::string path_of(std::string_view name, std::string_view suffix = "");

class LockFile;

class Segment {
public:
    enum class Access : std::uint8_t { read_write, read_only };

    Segment(Segment&& other) noexcept;
    Segment& operator=(Segment&& other) noexcept;
    ~Segment();

    // `not_found` where there is none; `permission` names the owner; `bad_input` for what is no regular file or shorter than `least_bytes`.
    [[nodiscard]] static SetupResult<Segment> open(const std::string& path, Access access, std::size_t least_bytes);
    // A new file of `size` bytes that begins with `content`, with the lock on byte 0 held before it gets its name. `in_use` when the name is taken
    // by then; `no_space` before anything is written. From `replaced` the name is taken when nothing is left to do but to give it.
    [[nodiscard]] static SetupResult<Segment> create(const std::string& path, std::size_t size, unsigned mode,
                                                     ByteView content, const Segment* replaced = nullptr);

    [[nodiscard]] std::uint8_t* data() const noexcept { return data_; }
    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    // Has the kernel map all pages now (of a long one the first 64 MiB), for each would cost a fault of microseconds later.
    void populate() noexcept;
    [[nodiscard]] const std::string& path() const noexcept { return path_; }
    [[nodiscard]] bool writable() const noexcept { return access_ == Access::read_write; }

    // False: somebody else has it.
    [[nodiscard]] bool try_lock(std::size_t byte) noexcept;
    void unlock(std::size_t byte) noexcept;
    // Whether another description holds it.
    [[nodiscard]] bool is_locked(std::size_t byte) const noexcept;

    // In a child of the process that opened it: not the child's to use.
    [[nodiscard]] bool forked() const noexcept { return forked_flag().load(std::memory_order_relaxed); }
    [[nodiscard]] const std::atomic<bool>& forked_flag() const noexcept;  // stays where it is when the segment moves
    // Whether the path still leads here.
    [[nodiscard]] bool is_named() const noexcept;
    // Takes the name away if it still leads here.
    [[nodiscard]] SetupResult<void> unlink() const;
    struct Status {
        uid_t owner = 0;
        unsigned mode = 0;
    };
    [[nodiscard]] Status status() const noexcept;

private:
    Segment(std::string path, std::unique_ptr<LockFile> locks, Access access) noexcept;
    [[nodiscard]] SetupResult<void> map();

    std::string path_;
    std::unique_ptr<LockFile> locks_;
    Access access_ = Access::read_only;
    std::uint8_t* data_ = nullptr;
    std::size_t size_ = 0;
};

// The login name of a user, or his number.
[[nodiscard]] std::string user_name(uid_t user);

}  // namespace mavloom::shm
