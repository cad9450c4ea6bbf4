// SPDX-License-Identifier: MIT
#include "shm/ring_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cassert>
#include <cstring>
#include <utility>

#include "mavloom/base/shown.hpp"
#include "mavloom/shm/ring_info.hpp"

namespace mavloom::shm {

namespace {

constexpr std::size_t retired_offset = offsetof(RingControl<SharedWords>, retired);
constexpr int max_attempts = 100;  // retries when other processes create or remove the ring meanwhile

tl::unexpected<SetupError> wrong(const std::string& path, std::string_view what) {
    return setup_error(SetupCode::bad_input, fmt::format("{}: {}", path, what));
}

// Not through the mapping: a file of another user may have been shortened meanwhile.
Identity identity_of(const Segment& segment) noexcept {
    Identity identity;
    std::array<std::uint8_t, sizeof identity> bytes{};
    static_cast<void>(segment.read_begin(bytes));
    std::memcpy(&identity, bytes.data(), sizeof identity);
    return identity;
}

SetupResult<void> check_identity(const Segment& segment) {
    const Identity found = identity_of(segment);
    const auto& path = segment.path();
    if (found.magic != ring_magic) return wrong(path, "is not a Mavloom ring");
    if (found.byte_order != byte_order_mark) return wrong(path, "is a ring of another byte order");
    if (found.major != ring_major)
        return wrong(path, fmt::format("is a ring of version {}.{}; this program supports {}.{}", found.major,
                                       found.minor, ring_major, ring_minor));
    if (!std::has_single_bit(found.capacity) || found.capacity < min_capacity || found.capacity > max_capacity ||
        found.data_begin != data_offset || found.slots != reader_slots)
        return wrong(path, "is a damaged ring: its sizes are invalid");
    if (segment.size() != data_offset + found.capacity)
        return wrong(path, fmt::format("is a truncated ring: {} bytes instead of {}", segment.size(),
                                       data_offset + found.capacity));
    return {};
}

std::string names_of(const std::vector<std::string>& rings) {
    if (rings.empty()) return "there are no rings";
    std::string text = rings.size() == 1 ? "there is" : "there are";
    for (std::size_t i = 0; i < rings.size(); ++i) text += (i == 0 ? " " : ", ") + printable(rings[i]);
    return text;
}

// Leaves out `name`, which may have been created since the failed open.
std::vector<std::string> other_rings(std::string_view name) {
    auto rings = ring_names();
    std::erase(rings, name);
    return rings;
}

SetupResult<void> check_options(const RingOptions& options) {
    if (!std::has_single_bit(options.capacity) || options.capacity < min_capacity || options.capacity > max_capacity)
        return setup_error(SetupCode::usage,
                           fmt::format("a ring of {} bytes: the capacity must be a power of two from 64 KiB to 64 GiB",
                                       options.capacity));
    if ((options.mode & 0600u) != 0600u || options.mode > 0777u)
        return setup_error(SetupCode::usage,
                           fmt::format("mode {:04o} of a ring: it must let the owner read and write, and contain only "
                                       "permission bits",
                                       options.mode));
    return {};
}

SetupResult<Segment> create_ring(const std::string& path, const RingOptions& options, const Segment* replaced) {
    Identity identity;
    identity.capacity = options.capacity;
    identity.created_ns = unix_time().time_since_epoch().count();
    identity.creator_pid = static_cast<std::uint32_t>(::getpid());
    std::array<std::uint8_t, sizeof identity> bytes;
    std::memcpy(bytes.data(), &identity, sizeof identity);
    auto segment = Segment::create(path, static_cast<std::size_t>(data_offset + options.capacity), options.mode, bytes,
                                   replaced);
    if (segment) segment->set_retired_word(retired_offset);
    return segment;
}

tl::unexpected<SetupError> has_writer(std::string_view name, const Segment& segment) {
    const auto pid = memory_of(segment).control->writer_pid.load(std::memory_order_relaxed);
    const auto who = pid == 0 ? std::string("which is just starting or ending") : fmt::format("process {}", pid);
    return setup_error(held_code(segment), fmt::format("ring {} already has a writer, {}", name, who));
}

}  // namespace

WallTime unix_time() noexcept { return wall_now(); }

RingMemory<SharedWords> memory_of(const Segment& segment) noexcept {
    assert(segment.data() != nullptr && std::has_single_bit(segment.size() - data_offset));
    std::uint8_t* const base = segment.data();
    return {reinterpret_cast<RingControl<SharedWords>*>(base),
            reinterpret_cast<ReaderSlot<SharedWords>*>(base + slots_offset),
            reinterpret_cast<SharedWords::Word64*>(base + data_offset), segment.size() - data_offset};
}

SetupResult<Segment> open_ring(std::string_view name, Segment::Access access, const Segment::Check& check) {
    if (auto good = check_name(name); !good) return tl::unexpected(std::move(good.error()));
    auto segment = Segment::open(path_of(name), access, data_offset, check);
    if (!segment) {
        if (segment.error().code == SetupCode::not_found)
            segment.error().text = fmt::format("there is no ring {}; {}", name, names_of(other_rings(name)));
        return segment;
    }
    if (auto good = check_identity(*segment); !good) return tl::unexpected(std::move(good.error()));
    segment->set_retired_word(retired_offset);
    return segment;
}

void retire(const Segment& segment) noexcept {
    auto& control = *memory_of(segment).control;
    control.retired.store(1, std::memory_order_release);  // pairs with Consumer::retired()
    for (auto* word : {&control.wakes, &control.rooms}) {
        word->fetch_add(1, std::memory_order_release);
        SharedWords::wake(*word);
    }
}

SetupResult<Segment> writer_segment(std::string_view name, const RingOptions& options, std::string* set_aside) {
    if (auto good = check_options(options); !good) return tl::unexpected(std::move(good.error()));
    for (int attempt = 0; attempt < max_attempts; ++attempt) {
        auto present = open_ring(name, Segment::Access::read_write, check_owner);
        if (!present && present.error().code != SetupCode::not_found) {
            if (!options.sets_aside || !rename_aside(path_of(name))) return present;
            if (set_aside != nullptr) *set_aside = std::move(present.error().text);
            continue;
        }
        const bool is_ours = present && present->try_lock(writer_byte);
        if (present && !present->is_named()) continue;
        if (present && !is_ours && present->is_locked(writer_byte)) return has_writer(name, *present);
        const bool retired = present && memory_of(*present).control->retired.load(std::memory_order_acquire) != 0;
        if (is_ours && !retired && memory_of(*present).capacity == options.capacity) return present;
        // If this process holds the writer lock of the present ring, no other writer replaces it. If a reader's lock is
        // in the way, the ring is replaced without it. The ring is retired last, so that a woken reader cannot find it
        // under its name again.
        auto created = create_ring(path_of(name), options, present ? &*present : nullptr);
        if (present && !present->is_named()) retire(*present);
        if (created || created.error().code != SetupCode::in_use) return created;
    }
    return setup_error(SetupCode::in_use,
                       fmt::format("ring {} keeps being created and removed by other processes", name));
}

}  // namespace mavloom::shm
