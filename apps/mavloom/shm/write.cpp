// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "lines.hpp"
#include "mavloom/base/counted.hpp"
#include "mavloom/endpoint/endpoint.hpp"
#include "mavloom/shm/ring_info.hpp"
#include "mavloom/shm/ring_writer.hpp"
#include "parts.hpp"
#include "signals.hpp"

namespace mavloom::app::shm_parts {

namespace {

struct WriteOptions {
    std::string name;
    std::string capacity;
    std::string full = "wait";
    std::string mode = "0600";
    int link = 0, kind = 0, verdict = 0;
    bool hex = false;
    bool remove = false;
};

SetupResult<shm::RingOptions> ring_options(const WriteOptions& options) {
    shm::RingOptions ring;
    if (!options.capacity.empty()) {
        auto capacity = endpoint::parse_size(options.capacity);
        if (!capacity) return tl::unexpected(std::move(capacity.error()).within("--capacity"));
        ring.capacity = *capacity;
    } else if (const auto there = shm::ring_status(options.name)) {
        ring.capacity = there->capacity;
    }
    ring.when_full = options.full == "evict"         ? shm::WhenFull::evict
                     : options.full == "drop_newest" ? shm::WhenFull::drop_newest
                                                     : shm::WhenFull::wait;
    auto mode = endpoint::parse_mode(options.mode);
    if (!mode) return tl::unexpected(std::move(mode.error()).within("--mode"));
    ring.mode = *mode;
    return ring;
}

// Writes lines as records, and counts them.
class Writing {
public:
    Writing(const WriteOptions& options, shm::RingWriter& writer)
        : options_(options), writer_(writer), lines_(writer.longest() * (options.hex ? 2 : 1)) {}

    // Writes all lines. Stops at the first error of the input or of the ring.
    Exit run() {
        for (std::string line; lines_.next(line);) {
            ++number_;
            if (const Exit status = write(line); status != Exit::done) return status;
            if (!lines_.has_more()) writer_.flush();
        }
        return number_ == records_ ? Exit::done : Exit::mismatch;
    }

    [[nodiscard]] std::string sums() const {
        return fmt::format("{}: {}, {} written{}", writer_.name(), counted(records_, "record"), counted(bytes_, "byte"),
                           number_ == records_ ? "" : fmt::format(", {} not", number_ - records_));
    }

private:
    // A line that a full ring drops is not an error: it counts as not written.
    Exit write(std::string& line) {
        if (line.size() <= lines_.longest() && options_.hex && !decode_hex(line))
            return refuse(Exit::bad_input, "expected pairs of hexadecimal digits");
        const auto written = write_record({reinterpret_cast<const std::uint8_t*>(line.data()), line.size()});
        if (written) {
            ++records_;
            bytes_ += line.size();
            return Exit::done;
        }
        if (written.error() == shm::WriteError::full) return Exit::done;
        if (written.error() != shm::WriteError::too_long) return refuse(Exit::failed, shm::to_text(written.error()));
        return refuse(Exit::bad_input,
                      fmt::format("over {} bytes, the longest record that this ring takes", writer_.longest()));
    }

    // Waits for room with `--full wait`. A signal ends the wait.
    shm::WriteResult<void> write_record(ByteView bytes) {
        const shm::RecordInfo info{wall_now(), LinkId{static_cast<std::uint32_t>(options_.link)},
                                   static_cast<std::uint16_t>(options_.kind),
                                   static_cast<std::uint8_t>(options_.verdict)};
        for (;;) {
            const auto written = writer_.write(bytes, info, mono_now() + signal_poll_interval);
            const bool is_full = !written && written.error() == shm::WriteError::full;
            if (!is_full || options_.full != "wait" || Signals::received()) return written;
        }
    }

    [[nodiscard]] Exit refuse(Exit as, std::string_view why) const {
        return fail(as, fmt::format("line {}: {}", number_, why));
    }

    const WriteOptions& options_;
    shm::RingWriter& writer_;
    Lines lines_;
    std::uint64_t number_ = 0, records_ = 0, bytes_ = 0;
};

Exit write(const Common& common, const WriteOptions& options) {
    const auto ring = ring_options(options);
    if (!ring) return fail(ring.error());
    const Signals signals([](void*) noexcept {}, nullptr);
    auto writer = shm::RingWriter::open(options.name, *ring);
    if (!writer) return fail(writer.error());
    Writing writing(options, *writer);
    const Exit status = writing.run();
    print_notice(common, writing.sums());
    using Leave = shm::RingWriter::Leave;
    const auto closed = writer->close(options.remove ? Leave::nothing : Leave::ring);
    if (status != Exit::done && status != Exit::mismatch) return status;
    return closed ? Signals::status(status) : fail(closed.error());
}

}  // namespace

Run declare_write(Arguments part, const Common& common) {
    auto options = std::make_shared<WriteOptions>();
    add_name(part, options->name);
    part.add_option(
        "--capacity", "BYTES", options->capacity,
        "capacity of a new ring, a power of two from 64k (bytes, k, M, G); default 8M. An existing ring of another "
        "capacity is replaced if it has no writer");
    part.add_option("--full", "POLICY", options->full,
                    "what to do while lossless readers keep the ring full: wait, drop_newest, or evict them")
        .members({"wait", "drop_newest", "evict"})
        .capture_default_str();
    part.add_option("--mode", "OCTAL", options->mode, "permissions of a new ring").capture_default_str();
    part.add_option("--link", "N", options->link, "the link id stored with each record")
        .range(0, 2147483647)
        .capture_default_str();
    part.add_option("--kind", "N", options->kind, "the kind stored with each record; 1 is a MAVLink frame")
        .range(0, 65535)
        .capture_default_str();
    part.add_option("--verdict", "N", options->verdict, "the verdict stored with each record (docs/formats/ring.md)")
        .range(0, 255)
        .capture_default_str();
    part.add_flag("--hex", options->hex, "read each line as hexadecimal digits");
    part.add_flag("--remove", options->remove, "remove the ring at the end");
    return [options, &common] { return write(common, *options); };
}

}  // namespace mavloom::app::shm_parts
