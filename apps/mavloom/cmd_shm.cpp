// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <nlohmann/json.hpp>

#include "command.hpp"
#include "counted.hpp"
#include "mavloom/base/shown.hpp"
#include "mavloom/endpoint/endpoint.hpp"
#include "mavloom/shm/ring_follower.hpp"
#include "mavloom/shm/ring_info.hpp"
#include "mavloom/shm/ring_writer.hpp"
#include "output.hpp"
#include "signals.hpp"

namespace mavloom::app {

namespace {

using namespace std::chrono_literals;
using Json = nlohmann::ordered_json;

constexpr Nanoseconds look_at_signals = 100ms;

struct Options {
    std::string name;
    bool json = false;
    // write
    std::string capacity;
    std::string full = "wait";
    std::string mode = "0600";
    int link = 0, kind = 0, verdict = 0;
    bool hex = false;
    bool remove = false;
    // read
    std::string from = "newest";
    bool lossless = false;
    bool data = false;
    bool drain = false;
    int count = 0;
    std::string duration;
    // remove
    std::vector<std::string> names;
    bool force = false;
};

// ---- list, stat -----------------------------------------------------------------------------------------------------

std::string size_text(std::uint64_t bytes) {
    for (const auto& [shift, unit] : {std::pair(30, "GiB"), std::pair(20, "MiB"), std::pair(10, "KiB")})
        if (bytes >> shift != 0 && bytes % (std::uint64_t{1} << shift) == 0)
            return fmt::format("{} {}", bytes >> shift, unit);
    return counted(bytes, "byte");
}

std::string writer_text(const shm::RingStatus& ring) {
    if (ring.writer_alive)
        return fmt::format("written by process {} ({})", ring.writer_pid, shm::to_text(ring.when_full));
    return ring.writer_pid == 0 ? "no writer" : fmt::format("no writer, process {} was killed", ring.writer_pid);
}

Json json_of(const shm::ReaderStatus& reader) {
    return {{"slot", reader.slot},         {"pid", reader.pid},
            {"program", reader.program},   {"opened_us", unix_us(reader.opened)},
            {"lossless", reader.lossless}, {"holds", reader.holds},
            {"asleep", reader.asleep},     {"behind_bytes", reader.behind_bytes},
            {"missed", reader.missed},     {"behind_records", reader.behind_records}};
}

Json json_of(const shm::RingStatus& ring) {
    Json readers = Json::array();
    for (const auto& reader : ring.readers) readers.push_back(json_of(reader));
    return {{"name", ring.name},
            {"path", ring.path},
            {"owner", ring.owner},
            {"mode", fmt::format("{:04o}", ring.mode)},
            {"capacity", ring.capacity},
            {"created_us", unix_us(ring.created)},
            {"writer_alive", ring.writer_alive},
            {"writer_pid", ring.writer_pid},
            {"writer_opened_us", unix_us(ring.writer_opened)},
            {"writers", ring.writers},
            {"full", shm::to_text(ring.when_full)},
            {"records", ring.records},
            {"bytes", ring.bytes},
            {"dropped", ring.dropped},
            {"evictions", ring.evictions},
            {"retired", ring.retired},
            {"damaged", ring.damaged},
            {"readers", std::move(readers)}};
}

std::string line_of(const Json& object) { return object.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n"; }

std::string text_of(const shm::RingStatus& ring) {
    return fmt::format("{}  {}, {}, {}, {}\n", ring.name, size_text(ring.capacity), writer_text(ring),
                       counted(ring.readers.size(), "reader"),
                       ring.damaged ? "damaged" : counted(ring.records, "record"));
}

std::string text_of(const shm::ReaderStatus& reader) {
    return fmt::format("  reader {} {} process {}{}: {}, {} behind, {} missed\n", reader.slot, printable(reader.program),
                       reader.pid, reader.lossless ? (reader.holds ? ", lossless" : ", lossless, evicted") : "",
                       counted(reader.behind_records, "record"), counted(reader.behind_bytes, "byte"), reader.missed);
}

std::string details_of(const shm::RingStatus& ring) {
    auto text = text_of(ring);
    text += fmt::format("  {}, {:04o}, {}\n", ring.path, ring.mode, printable(ring.owner));
    if (ring.damaged) return text;
    text += fmt::format("  {} so far, {} dropped, {}, {}\n", counted(ring.bytes, "byte"), ring.dropped,
                        counted(ring.evictions, "eviction"), counted(ring.writers, "writer"));
    for (const auto& reader : ring.readers) text += text_of(reader);
    return text;
}

Exit list(const Common& common, const Options& options) {
    std::string text;
    for (const auto& name : shm::ring_names()) {
        const auto ring = shm::ring_status(name);
        if (!ring && ring.error().code == SetupCode::not_found) continue;  // removed meanwhile
        if (options.json) text += line_of(ring ? json_of(*ring) : Json{{"name", name}, {"error", ring.error().text}});
        else text += ring ? text_of(*ring) : fmt::format("{}  {}\n", name, printable(ring.error().text));
    }
    if (text.empty()) say(common, "there are no rings");
    return print_at_end(text, Exit::done);
}

Exit stat(const Options& options) {
    const auto ring = shm::ring_status(options.name);
    if (!ring) return fail(ring.error());
    return print_at_end(options.json ? line_of(json_of(*ring)) : details_of(*ring), Exit::done);
}

// ---- write ----------------------------------------------------------------------------------------------------------

// Reads standard input line by line, until its end or a signal.
class Lines {
public:
    explicit Lines(std::size_t longest) : longest_(longest) {}
    [[nodiscard]] std::size_t longest() const noexcept { return longest_; }
    // Sets `line` to the next line without its newline. Returns false if there are no more. If a line is longer than
    // `longest`, sets `line` to the part that was read so far.
    [[nodiscard]] bool next(std::string& line) {
        for (;;) {
            if (const auto end = text_.find('\n', searched_); end != std::string::npos) return take(line, end, end + 1);
            searched_ = text_.size();
            if (Signals::received()) return false;
            if (text_.size() > longest_) return take(line, text_.size(), text_.size());
            if (!read_more()) return !text_.empty() && !Signals::received() && take(line, text_.size(), text_.size());
        }
    }
    // Whether the input read so far holds another whole line.
    [[nodiscard]] bool has_more() const noexcept { return text_.find('\n') != std::string::npos; }

private:
    bool take(std::string& line, std::size_t end, std::size_t used) {
        line.assign(text_, 0, end);
        text_.erase(0, used);
        searched_ = 0;
        return true;
    }

    bool read_more() {
        char chunk[16 << 10];
        const auto got = ::read(STDIN_FILENO, chunk, sizeof chunk);
        if (got > 0) text_.append(chunk, static_cast<std::size_t>(got));
        return got > 0 || (got < 0 && errno == EINTR);
    }

    std::size_t longest_;
    std::string text_;
    std::size_t searched_ = 0;
};

int digit(char c) {
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

// Decodes in place. Returns false if the line is not made of pairs of hexadecimal digits.
bool decode_hex(std::string& line) {
    if (line.size() % 2 != 0) return false;
    for (std::size_t i = 0; i < line.size(); i += 2) {
        const int high = digit(line[i]), low = digit(line[i + 1]);
        if (high < 0 || low < 0) return false;
        line[i / 2] = static_cast<char>(high << 4 | low);
    }
    line.resize(line.size() / 2);
    return true;
}

SetupResult<shm::RingOptions> ring_options(const Options& options) {
    shm::RingOptions ring;
    if (!options.capacity.empty()) {
        const auto capacity = endpoint::parse_size(options.capacity);
        if (!capacity) return tl::unexpected(SetupError(capacity.error()).within("--capacity"));
        ring.capacity = *capacity;
    } else if (const auto there = shm::ring_status(options.name)) {
        ring.capacity = there->capacity;
    }
    ring.when_full = options.full == "evict"         ? shm::WhenFull::evict
                     : options.full == "drop_newest" ? shm::WhenFull::drop_newest
                                                     : shm::WhenFull::wait;
    const char* const end = options.mode.data() + options.mode.size();
    const auto [stop, error] = std::from_chars(options.mode.data(), end, ring.mode, 8);
    if (error != std::errc{} || stop != end)
        return setup_error(SetupCode::usage,
                           fmt::format("--mode {}: expected octal digits, for example 0640", options.mode));
    return ring;
}

// Waits for room if `waits` is set. A signal ends the wait.
shm::WriteResult<void> write_record(shm::RingWriter& writer, ByteView bytes, const shm::RecordInfo& info, bool waits) {
    for (;;) {
        const auto written = writer.write(bytes, info, mono_now() + look_at_signals);
        if (written || written.error() != shm::WriteError::full || !waits || Signals::received()) return written;
    }
}

Exit write_lines(const Common& common, const Options& options, shm::RingWriter& writer) {
    Lines lines(writer.longest() * (options.hex ? 2 : 1));
    std::string line;
    std::uint64_t number = 0, records = 0, bytes = 0;
    Exit status = Exit::done;
    const auto refuse = [&](Exit as, std::string_view why) {
        status = fail(as, fmt::format("line {}: {}", number, why));
    };
    while (status == Exit::done && lines.next(line)) {
        ++number;
        if (line.size() <= lines.longest() && options.hex && !decode_hex(line)) {
            refuse(Exit::bad_input, "expected pairs of hexadecimal digits");
            break;
        }
        const shm::RecordInfo info{wall_now(), LinkId{static_cast<std::uint32_t>(options.link)},
                                   static_cast<std::uint16_t>(options.kind), static_cast<std::uint8_t>(options.verdict)};
        const ByteView payload(reinterpret_cast<const std::uint8_t*>(line.data()), line.size());
        const auto written = write_record(writer, payload, info, options.full == "wait");
        if (written) {
            ++records;
            bytes += line.size();
        } else if (written.error() == shm::WriteError::too_long) {
            refuse(Exit::bad_input,
                   fmt::format("over {} bytes, the most that a record of this ring has", writer.longest()));
        } else if (written.error() != shm::WriteError::full) {
            refuse(Exit::failed, shm::to_text(written.error()));
        }
        if (!lines.has_more()) writer.flush();
    }
    say(common, fmt::format("{}: {}, {} written{}", writer.name(), counted(records, "record"), counted(bytes, "byte"),
                            number == records ? "" : fmt::format(", {} not", number - records)));
    return status == Exit::done && number != records ? Exit::mismatch : status;
}

Exit write(const Common& common, const Options& options) {
    const auto ring = ring_options(options);
    if (!ring) return fail(ring.error());
    const Signals signals([](void*) noexcept {}, nullptr);
    auto writer = shm::RingWriter::open(options.name, *ring);
    if (!writer) return fail(writer.error());
    const Exit status = write_lines(common, options, *writer);
    using Leave = shm::RingWriter::Leave;
    const auto closed = writer->close(options.remove ? Leave::nothing : Leave::ring);
    if (status != Exit::done && status != Exit::mismatch) return status;
    return closed ? Signals::status(status) : fail(closed.error());
}

// ---- read -----------------------------------------------------------------------------------------------------------

void append_hex(message::TextBuffer& out, ByteView bytes) {
    constexpr std::string_view digits = "0123456789abcdef";
    for (const auto byte : bytes) {
        out.push_back(digits[byte >> 4]);
        out.push_back(digits[byte & 15]);
    }
}

void append_json(message::TextBuffer& out, const shm::RingRecord& record) {
    fmt::format_to(
        fmt::appender(out),
        R"({{"time_ns":{},"link":{},"kind":{},"verdict":{},"position":{},"sequence":{},"missed":{},"length":{},"hex":")",
        record.info.time.time_since_epoch().count(), record.info.link.value, record.info.kind, record.info.verdict,
        record.position, record.sequence, record.missed, record.data.size());
    append_hex(out, record.data);
    out.append(std::string_view("\"}\n"));
}

void append_text(message::TextBuffer& out, const shm::RingRecord& record) {
    constexpr std::int64_t day_us = 86'400'000'000;
    const std::int64_t us = (unix_us(record.info.time) % day_us + day_us) % day_us;
    if (record.missed != 0) fmt::format_to(fmt::appender(out), "({} missed)\n", counted(record.missed, "record"));
    fmt::format_to(fmt::appender(out), "{:02}:{:02}:{:02}.{:06} link {} kind {} verdict {}  {}  ", us / 3'600'000'000,
                   us / 60'000'000 % 60, us / 1'000'000 % 60, us % 1'000'000, record.info.link.value, record.info.kind,
                   record.info.verdict, counted(record.data.size(), "byte"));
    append_hex(out, record.data);
    out.push_back('\n');
}

void append_data(message::TextBuffer& out, const shm::RingRecord& record) {
    out.append(reinterpret_cast<const char*>(record.data.data()),
               reinterpret_cast<const char*>(record.data.data()) + record.data.size());
    out.push_back('\n');
}

class Reading {
public:
    Reading(const Common& common, const Options& options, MonoTime end)
        : common_(common),
          options_(options),
          end_(end),
          follower_(options.name, {.lossless = options.lossless,
                                   .from = options.from == "oldest" ? shm::ReaderOptions::From::oldest
                                                                    : shm::ReaderOptions::From::newest}) {
        output_.end_at(end);
    }

    Exit run() {
        while (going_ && !Signals::received()) {
            auto record = follower_.read(mono_now());
            if (!record && idle(record.error())) record = follower_.read(std::min(end_, mono_now() + look_at_signals));
            if (record) take(*record);
            else if (record.error() == shm::ReadError::damaged) return finish(Exit::bad_input);
            if (mono_now() >= end_) going_ = false;
        }
        return finish(Exit::done);
    }

private:
    // Called when there is nothing to read. Returns true if the reader should wait for more.
    bool idle(shm::ReadError why) {
        if (output_.flush() != Output::State::open || why == shm::ReadError::damaged) return going_ = false;
        if (why != shm::ReadError::no_writer) return true;
        if (options_.drain && follower_.opened() != 0) return going_ = false;
        const auto* const error = follower_.error();
        if (error != nullptr && (options_.drain || error->code != SetupCode::not_found)) return going_ = false;
        if (error != nullptr && !std::exchange(told_, true)) say(common_, error->text + "; waiting for it");
        return true;
    }

    void take(const shm::RingRecord& record) {
        auto& out = output_.buffer();
        if (options_.json) append_json(out, record);
        else if (options_.data) append_data(out, record);
        else append_text(out, record);
        ++records_;
        if (output_.flush_if_full() != Output::State::open || records_ == static_cast<std::uint64_t>(options_.count))
            going_ = false;
    }

    Exit finish(Exit status) {
        output_.flush();
        if (output_.state() == Output::State::failed) return fail(output_.error());
        const bool wants_one = options_.drain && follower_.opened() == 0;
        if (const auto* error = follower_.error();
            error != nullptr && (wants_one || error->code != SetupCode::not_found))
            return fail(*error);
        if (status == Exit::bad_input) return fail(status, fmt::format("ring {} is damaged", options_.name));
        if (follower_.missed() != 0)
            say(common_, fmt::format("{}: {}, {} missed: the writer was faster", options_.name,
                                     counted(records_, "record"), follower_.missed()));
        return Signals::status(follower_.missed() != 0 ? Exit::mismatch : Exit::done);
    }

    const Common& common_;
    const Options& options_;
    MonoTime end_;
    shm::RingFollower follower_;
    Output output_;
    std::uint64_t records_ = 0;
    bool going_ = true;
    bool told_ = false;
};

Exit read(const Common& common, const Options& options) {
    MonoTime end = MonoTime::max();
    if (!options.duration.empty()) {
        const auto time = endpoint::parse_duration(options.duration);
        if (!time) return fail(SetupError(time.error()).within("--for"));
        end = mono_now() + *time;
    }
    const Signals signals([](void*) noexcept {}, nullptr);
    return Reading(common, options, end).run();
}

// ---- remove ---------------------------------------------------------------------------------------------------------

SetupResult<void> remove_one(const Options& options, const std::string& name) {
    const auto ring = shm::ring_status(name);
    if (ring && ring->writer_alive && !options.force)
        return setup_error(SetupCode::in_use,
                           fmt::format("ring {} is in use, written by process {}; --force removes it all the same",
                                       name, ring->writer_pid));
    return shm::remove_ring(name);
}

Exit remove(const Options& options) {
    Exit status = Exit::done;
    for (const auto& name : options.names)
        if (const auto removed = remove_one(options, name); !removed) status = fail(removed.error());
    return status;
}

}  // namespace

Run declare_shm(Arguments command, const Common& common) {
    auto options = std::make_shared<Options>();
    command.require_subcommand();
    command.footer(
        "Rings are files /dev/shm/mavloom.NAME; docs/guide/shm.md, docs/formats/ring.md.\n\n"
        "Examples: mavloom shm list\n"
        "          mavloom shm stat px4\n"
        "          mavloom shm read px4 --from oldest --for 1s");
    const auto part = [&](const char* name, const char* description, const char* examples) {
        auto added = command.add_subcommand(name, description);
        added.fallthrough();
        added.footer(examples);
        return added;
    };
    const auto with_name = [&](Arguments to) {
        to.add_option("NAME", options->name, "the ring: letters, digits, _ and -").required();
    };
    const auto with_json = [&](Arguments to) { to.add_flag("--json", options->json, "one JSON object a line"); };

    auto list_part = part("list", "every ring with its writer, readers and records", "Example: mavloom shm list --json");
    with_json(list_part);

    auto stat_part = part("stat", "one ring: who is attached, how far behind, what was lost",
                          "Example: mavloom shm stat px4");
    with_name(stat_part);
    with_json(stat_part);

    auto write_part = part(
        "write", "write each line of standard input as a record; status 4 when some were not, for the ring was full",
        "A ring that is there and has no writer is carried on with. It stays when the command ends.\n\n"
        "Examples: mavloom shm write px4 --capacity 1M < lines.txt\n"
        "          mavloom shm write px4 --hex --full evict < frames.hex");
    with_name(write_part);
    write_part
        .add_option("--capacity", options->capacity,
                    "bytes that a new ring holds: a power of two from 64k (bytes, k, M, G); 8M unless told otherwise. "
                    "A ring of another capacity that nobody writes is replaced")
        .type_name("BYTES");
    write_part
        .add_option("--full", options->full, "when lossless readers hold the ring: wait, drop_newest, or evict them")
        .members({"wait", "drop_newest", "evict"})
        .capture_default_str()
        .type_name("POLICY");
    write_part.add_option("--mode", options->mode, "who may open a new ring").capture_default_str().type_name("OCTAL");
    write_part.add_option("--link", options->link, "link id of the records")
        .range(0, 2147483647)
        .capture_default_str()
        .type_name("N");
    write_part.add_option("--kind", options->kind, "kind of the records")
        .range(0, 65535)
        .capture_default_str()
        .type_name("N");
    write_part.add_option("--verdict", options->verdict, "verdict of the records")
        .range(0, 255)
        .capture_default_str()
        .type_name("N");
    write_part.add_flag("--hex", options->hex, "lines are hexadecimal digits");
    write_part.add_flag("--remove", options->remove, "take the ring away at the end");

    auto read_part = part(
        "read", "print the records of a ring; status 4 when some were missed",
        "Waits for a ring that is not there, and for a writer that went. Never holds the writer unless --lossless.\n\n"
        "Examples: mavloom shm read px4 --json --count 10 --for 1s\n"
        "          mavloom shm read px4 --from oldest --drain --data");
    with_name(read_part);
    with_json(read_part);
    auto from = read_part.add_option("--from", options->from,
                                     "newest: what comes from now on; oldest: what the ring holds, too");
    from.members({"newest", "oldest"}).capture_default_str().type_name("WHERE");
    read_part.add_flag("--lossless", options->lossless, "hold the writer: miss nothing");
    read_part.add_flag("--data", options->data, "the bytes of each record alone, and a line end");
    read_part.add_flag("--drain", options->drain, "end when all is read and nobody writes");
    read_part.add_option("--count", options->count, "end after this many records").range(1, 2147483647).type_name("N");
    read_part.add_option("--for", options->duration, "end after this time: 10s, 2m, 500ms").type_name("TIME");

    auto remove_part = part("remove", "take rings away, with their counters; who has one open is told",
                            "Example: mavloom shm remove px4");
    remove_part.add_option("NAME", options->names, "the rings").required().type_name("NAME");
    remove_part.add_flag("--force", options->force, "also where a writer is alive");

    return [&common, options, list_part, stat_part, write_part, read_part, remove_part] {
        if (list_part.parsed()) return list(common, *options);
        if (stat_part.parsed()) return stat(*options);
        if (write_part.parsed()) return write(common, *options);
        if (read_part.parsed()) return read(common, *options);
        return remove_part.parsed() ? remove(*options) : Exit::wrong_use;
    };
}

}  // namespace mavloom::app
