// SPDX-License-Identifier: MIT
// A mapped file in /dev/shm with byte locks. A process counts as alive while it holds its lock; the kernel releases the
// locks however the process ends.
//
// The locks belong to a second descriptor, which is never mapped. A mapping would keep its open file description, and
// so the locks, alive in a forked child. That descriptor is closed by exec and, through an at-fork handler, in every
// child. Private to module shm. Move-only. One owner thread; any thread may call `forked()`.
#pragma once

#include <sys/types.h>

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/base/bytes.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/shm/trust.hpp"

namespace mavloom::shm {

inline constexpr std::string_view shared_folder = "/dev/shm";

// Returns a `usage` error if `name` is not a valid ring name: [A-Za-z0-9_-]{1,64}.
[[nodiscard]] SetupResult<void> check_name(std::string_view name);
// Returns "/dev/shm/mavloom.NAME" + suffix.
[[nodiscard]] std::string path_of(std::string_view name, std::string_view suffix = "");

class LockFile;
struct Mapping;

class Segment {
public:
    enum class Access : std::uint8_t { read_write, read_only };

    Segment(Segment&& other) noexcept;
    Segment& operator=(Segment&& other) noexcept;
    ~Segment();

    // Decides by owner and mode whether this program may use the file. Called before the file is mapped, because its
    // owner could shorten it meanwhile.
    using Check = std::function<SetupResult<void>(const Segment&)>;
    // Opens and maps an existing file. Errors: `not_found`; `permission` names the owner; `bad_input` if it is not a
    // regular file or is shorter than `min_bytes`; the error of `check`.
    [[nodiscard]] static SetupResult<Segment> open(const std::string& path, Access access, std::size_t min_bytes,
                                                   const Check& check);
    // Creates and maps a file of `size` bytes that begins with `content`. Holds the lock on byte 0 before the file gets
    // its name. Removes the name of `replaced` only at the last step, when nothing else can fail. Errors: `in_use` if
    // the name is already taken; `no_space` before anything is written.
    [[nodiscard]] static SetupResult<Segment> create(const std::string& path, std::size_t size, unsigned mode,
                                                     ByteView content, const Segment* replaced = nullptr);

    // Reads the beginning of the file without the mapping, so that a shortened file cannot crash the process. Returns
    // how many bytes it read.
    [[nodiscard]] std::size_t read_begin(ByteSpan out) const noexcept;

    [[nodiscard]] std::uint8_t* data() const noexcept { return data_; }
    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    // Makes the kernel map all pages now (at most the first 64 MiB). Otherwise each page would later cost a page fault
    // of microseconds.
    void populate() noexcept;
    [[nodiscard]] const std::string& path() const noexcept { return path_; }
    [[nodiscard]] bool writable() const noexcept { return access_ == Access::read_write; }

    // Sets the offset of the word that retires the ring, so that a lost mapping becomes a retired ring
    // (lost_mapping.hpp).
    void set_retired_word(std::size_t offset) noexcept;

    // Returns false if another process holds a lock on the byte.
    [[nodiscard]] bool try_lock(std::size_t byte) noexcept;
    void unlock(std::size_t byte) noexcept;
    // Returns whether another open file description holds the lock. A lock for reading does not count: every process
    // that may read the file can take one.
    [[nodiscard]] bool is_locked(std::size_t byte) const noexcept;

    // True in a child of the process that opened the file. The child must not use the segment.
    [[nodiscard]] bool forked() const noexcept { return forked_flag().load(std::memory_order_relaxed); }
    [[nodiscard]] const std::atomic<bool>& forked_flag() const noexcept;  // keeps its address when the segment moves
    // Returns whether the path still leads to this file. False if the file was shortened and the mapping replaced.
    [[nodiscard]] bool is_named() const noexcept;
    // Removes the path if it still leads to this file.
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
    Mapping* mapping_ = nullptr;  // the entry in the list of mappings; null if that is full
};

// Returns an error if the file belongs to a user other than this one or root. Its owner can shorten it at any time.
[[nodiscard]] SetupResult<void> check_owner(const Segment& segment);

// Returns an error if a reader must not trust the file of this ring or page: see Trust (trust.hpp).
// `what` names it in the error text.
[[nodiscard]] SetupResult<void> check_trusted(const Segment& segment, std::string_view what, const Trust& trust);
// Returns the error code for a file whose lock another process holds. It is `in_use`, or `permission` if users other
// than the owner may write the file, because any of them may then hold the lock.
[[nodiscard]] SetupCode held_code(const Segment& segment) noexcept;
// Returns an error if this program would not survive when the owner of the file shortens it.
[[nodiscard]] SetupResult<void> check_survivable(const Segment& segment);

// Renames the file to PATH.aside, replacing an earlier file of that name. Returns false if that is not allowed.
[[nodiscard]] bool rename_aside(const std::string& path);

// Returns the user's login name, or "user N" if there is none.
[[nodiscard]] std::string user_name(uid_t user);

}  // namespace mavloom::shm
