// SPDX-License-Identifier: MIT
// MavutilLog: reads a recording for mavloom.mavutil. Any thread, one at a time. The GIL is free while it reads.
#pragma once

#include <nanobind/nanobind.h>

#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mavloom/record/tlog_reader.hpp"
#include "mavutil/damage.hpp"
#include "mavutil/state.hpp"

namespace mavloom::python {

// The names of messages that a call selects.
class MavutilTypes {
public:
    MavutilTypes(const PyDialect& dialect, const nb::iterable& names);

    [[nodiscard]] bool takes(const MavutilMessage& message) const noexcept;
    // Whether any of them can arrive. These are the messages of the dialect, UNKNOWN_<id>, and BAD_DATA, which a
    // connection that verifies signatures returns.
    [[nodiscard]] bool has_any() const noexcept { return bad_data_ || !ids_.empty() || !unknown_.empty(); }

private:
    std::vector<MessageId> ids_, unknown_;
    bool bad_data_ = false;
};

class MavutilLog {
public:
    // `bad_data(bytes, reason)` creates the BAD_DATA message for damaged bytes. `state` is a MavutilState.
    MavutilLog(std::string path, const nb::object& dialect, nb::object bad_data, nb::object state);

    // Reads the whole file: counts its messages, and notes the first one of each type, as pymavlink does when it opens
    // a file. The noted messages, and the first one of each further instance, also become messages of the target. Calls
    // owner._notice() for the noted messages that the owner must examine, and progress(percent) unless it is None.
    // Returns {name: count}.
    nb::dict index(const nb::object& owner, const nb::object& progress);
    // Returns the next message, without noting it. At the end of the file, returns an invalid object until the file
    // grows.
    nb::object next();
    // Returns the next message of these types, or None at the end. Notes every message up to that one, and calls
    // owner._notice() for those that the owner must examine.
    nb::object match(const nb::object& owner, const MavutilTypes* types);

    void rewind();
    // The place of the last message that was returned, in percent of the file.
    [[nodiscard]] double percent();
    // How many messages were returned, including BAD_DATA, and how many bytes they had.
    [[nodiscard]] std::pair<std::uint64_t, std::uint64_t> totals();
    // How many of them are BAD_DATA.
    [[nodiscard]] std::uint64_t damaged();
    void close();

private:
    struct Entry {
        std::int64_t time_ns = 0;
        const dialect::Message* definition = nullptr;
        std::uint64_t place = 0;  // of the record in the file
        std::uint32_t link = 0;   // the lowest bits of the time, which pymavlink takes for a link
        std::uint32_t begin = 0;  // in bytes_
        std::uint16_t size = 0;
        std::string damage{};  // the reason; empty for a frame
    };

    [[nodiscard]] record::TlogReader& reader();
    [[nodiscard]] SetupResult<record::TlogReader> open() const;
    bool has_grown();
    bool fill();
    void add(const record::Record& record);
    void add_damage(std::uint64_t from, std::uint64_t count);
    std::size_t add_damaged_frame(ByteView bytes, std::uint64_t place);
    void add_entry(Entry entry, ByteView bytes);
    [[nodiscard]] nb::object message_of(const Entry& entry) const;

    const std::string path_;
    const std::shared_ptr<Origin> origin_;
    const nb::object bad_data_;
    const nb::object state_object_;
    MavutilState& state_;  // in state_object_
    std::mutex mutex_;
    // Guarded by mutex_:
    std::optional<record::TlogReader> reader_;  // empty: closed
    std::vector<Entry> entries_;
    std::vector<std::uint8_t> bytes_;
    std::size_t next_ = 0;
    std::uint64_t place_ = 0, size_ = 0;
    std::uint64_t end_ = 0;     // of the last record that was read
    std::int64_t time_ns_ = 0;  // of the last record that was read
    bool ended_ = false;
    std::uint64_t packets_ = 0, packet_bytes_ = 0, damaged_ = 0;  // that were returned
};

}  // namespace mavloom::python
