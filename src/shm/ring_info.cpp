// SPDX-License-Identifier: MIT
#include "mavloom/shm/ring_info.hpp"

#include <dirent.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>

#include "mavloom/base/shown.hpp"
#include "mavloom/shm/detail/consumer.hpp"
#include "shm/ring_file.hpp"

namespace mavloom::shm {

namespace {

constexpr std::string_view prefix = "mavloom.";

struct CloseFolder {
    void operator()(DIR* folder) const noexcept { ::closedir(folder); }
};

WallTime time_of(std::uint64_t unix_ns) { return WallTime{Nanoseconds{static_cast<std::int64_t>(unix_ns)}}; }

// Returns how far one count is behind another. Never negative, although the two are not read at the same moment.
std::uint64_t behind(std::uint64_t ahead, std::uint64_t at) {
    const auto distance = static_cast<std::int64_t>(ahead - at);
    return distance > 0 ? static_cast<std::uint64_t>(distance) : 0;
}

// The program name that the reader stored, up to the first NUL.
std::string program_of(const ReaderSlot<SharedWords>& slot) {
    std::array<char, sizeof slot.program> bytes;
    for (std::size_t i = 0; i < slot.program.size(); ++i) {
        const std::uint64_t word = slot.program[i].load(std::memory_order_relaxed);
        std::memcpy(bytes.data() + i * sizeof word, &word, sizeof word);
    }
    return printable({bytes.data(), ::strnlen(bytes.data(), bytes.size())});
}

ReaderStatus reader_status(const RingMemory<SharedWords>& ring, unsigned index) {
    const auto& slot = ring.slots[index];
    const auto has_bit = [&](const SharedWords::Word64& word) {
        return (word.load(std::memory_order_relaxed) >> index & 1) != 0;
    };
    ReaderStatus status;
    status.slot = index;
    status.pid = slot.pid.load(std::memory_order_relaxed);
    status.program = program_of(slot);
    status.opened = time_of(slot.opened_ns.load(std::memory_order_relaxed));
    status.lossless = slot.lossless.load(std::memory_order_relaxed) != 0;
    status.holds = has_bit(ring.control->holders);
    status.asleep = has_bit(ring.control->sleepers);
    status.missed = slot.missed.load(std::memory_order_relaxed);
    const std::uint64_t position = slot.position.load(std::memory_order_acquire);  // pairs with Consumer::publish()
    const std::uint64_t sequence = slot.sequence.load(std::memory_order_relaxed);
    status.behind_bytes = behind(ring.control->tail.load(std::memory_order_acquire), position);
    status.behind_records = behind(ring.control->records.load(std::memory_order_relaxed), sequence);
    return status;
}

WhenFull policy_of(std::uint32_t word) {
    return word == 1 ? WhenFull::drop_newest : word == 2 ? WhenFull::evict : WhenFull::wait;
}

tl::unexpected<SetupError> cannot_remove(const std::string& path, int error) {
    auto failed = system_error(fmt::format("cannot remove {}", path), error);
    struct stat status {};
    if ((error == EPERM || error == EACCES) && ::lstat(path.c_str(), &status) == 0)
        failed.value().text += fmt::format("; it belongs to {}", user_name(status.st_uid));
    return failed;
}

SetupResult<void> unlink_if_there(const std::string& path) {
    if (::unlink(path.c_str()) == 0 || errno == ENOENT) return {};
    return cannot_remove(path, errno);
}

}  // namespace

// A name with a dot is none. So without a suffix, this skips counter pages.
static std::vector<std::string> names_with(std::string_view suffix) {
    std::vector<std::string> names;
    const std::unique_ptr<DIR, CloseFolder> folder(::opendir(std::string(shared_folder).c_str()));
    if (!folder) return names;
    while (const dirent* entry = ::readdir(folder.get())) {
        const std::string_view file = entry->d_name;
        if (!file.starts_with(prefix) || !file.ends_with(suffix)) continue;
        const auto name = file.substr(prefix.size(), file.size() - prefix.size() - suffix.size());
        if (check_name(name)) names.emplace_back(name);
    }
    std::ranges::sort(names);
    return names;
}

std::vector<std::string> ring_names() { return names_with(""); }
std::vector<std::string> counter_page_names() { return names_with(".stat"); }

SetupResult<RingStatus> ring_status(std::string_view name) {
    const auto segment = open_ring(name, Segment::Access::read_only, check_survivable);
    if (!segment) return tl::unexpected(segment.error());
    const auto ring = memory_of(*segment);
    const auto& control = *ring.control;
    RingStatus status;
    status.name = name;
    status.path = segment->path();
    status.owner = user_name(segment->status().owner);
    status.mode = segment->status().mode;
    status.capacity = ring.capacity;
    status.created = time_of(static_cast<std::uint64_t>(control.identity.created_ns));
    status.retired = control.retired.load(std::memory_order_relaxed) != 0;
    status.writer_alive = segment->is_locked(writer_byte);
    status.writer_pid = control.writer_pid.load(std::memory_order_relaxed);
    status.writer_opened = time_of(control.writer_opened_ns.load(std::memory_order_relaxed));
    status.writers = control.writers.load(std::memory_order_relaxed);
    status.when_full = policy_of(control.when_full.load(std::memory_order_relaxed));
    status.records = control.records.load(std::memory_order_relaxed);
    status.bytes = control.tail.load(std::memory_order_relaxed);
    status.dropped = control.dropped.load(std::memory_order_relaxed);
    status.evictions = control.evictions.load(std::memory_order_relaxed);
    status.damaged = !detail::Consumer<SharedWords>(ring, std::nullopt, false)
                          .start(detail::Consumer<SharedWords>::Start::newest);
    // Acquire: pairs with the release in RingReader::begin().
    const std::uint64_t attached = control.attached.load(std::memory_order_acquire);
    for (unsigned slot = 0; slot < reader_slots; ++slot)
        if ((attached >> slot & 1) != 0 && segment->is_locked(slot_byte(slot)))
            status.readers.push_back(reader_status(ring, slot));
    return status;
}

SetupResult<void> remove_ring(std::string_view name) {
    if (auto good = check_name(name); !good) return good;
    if (const auto segment = open_ring(name, Segment::Access::read_write, check_survivable)) {
        if (auto unlinked = segment->unlink(); !unlinked) return unlinked;
        retire(*segment);
    } else if (::unlink(path_of(name).c_str()) != 0) {
        if (errno != ENOENT) return cannot_remove(path_of(name), errno);
        struct stat page {};
        if (::lstat(path_of(name, ".stat").c_str(), &page) != 0) return tl::unexpected(segment.error());
    }
    return remove_counter_page(name);
}

SetupResult<void> remove_counter_page(std::string_view name) { return unlink_if_there(path_of(name, ".stat")); }

}  // namespace mavloom::shm
