// SPDX-License-Identifier: MIT
// `mavloom bench`: measures Mavloom's own throughput on this machine.
// `./run bench` also measures the programs that docs/performance.md compares it with.
#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <memory>
#include <thread>
#include <vector>

#include "bench_sim.hpp"
#include "command.hpp"
#include "mavloom/base/counted.hpp"
#include "mavloom/endpoint/endpoint.hpp"
#include "mavloom/message/format.hpp"
#include "mavloom/record/tlog_reader.hpp"
#include "mavloom/shm/ring_reader.hpp"
#include "mavloom/shm/ring_writer.hpp"
#include "mavloom/wire/stream_parser.hpp"
#include "signals.hpp"

namespace mavloom::app {

namespace {

using Bytes = std::vector<std::uint8_t>;

struct BenchOptions {
    std::string file;
    int turns = 21;
    std::string chunk_text = "4096";
    std::size_t chunk = 0;  // chunk_text as a number; set by set_chunk
    bool json = false;
};

struct RecordedFrames {
    Bytes frames;  // back to back, as a serial line would carry them
    std::vector<WallTime> times;
};

SetupResult<RecordedFrames> read_recording(const std::string& path, const wire::MessageTable& table) {
    auto reader = record::TlogReader::open(path, table);
    if (!reader) return tl::unexpected(of_input_file(std::move(reader.error())));
    RecordedFrames recording;
    while (const auto record = reader->next()) {
        const auto bytes = record->frame.bytes();
        recording.frames.insert(recording.frames.end(), bytes.begin(), bytes.end());
        recording.times.push_back(record->time);
    }
    if (recording.times.empty()) return setup_error(SetupCode::bad_input, fmt::format("{} holds no frame", path));
    return recording;
}

// Runs `work` once a turn and returns the median of `amount` per second. A signal ends the loop after the current turn.
template <class Work>
double per_second(int turns, double amount, Work&& work) {
    std::vector<double> rates;
    for (int turn = 0; turn < std::max(turns, 1) && !(turn > 0 && Signals::received()); ++turn) {
        const auto begin = mono_now();
        work();
        rates.push_back(amount / std::chrono::duration<double>(mono_now() - begin).count());
    }
    std::ranges::nth_element(rates, rates.begin() + static_cast<std::ptrdiff_t>(rates.size() / 2));
    return rates[rates.size() / 2];
}

template <class OnFrame>
void parse_all(const RecordedFrames& recording, std::size_t chunk, const wire::MessageTable& table, OnFrame&& on_frame) {
    wire::StreamParser parser(table);
    const auto sink = [&](const wire::ParseEvent& event) {
        if (event.kind == wire::ParseEvent::Kind::frame) on_frame(event.frame);
    };
    const ByteView all{recording.frames};
    for (std::size_t at = 0; at < all.size(); at += chunk)
        parser.feed(all.subspan(at, std::min(chunk, all.size() - at)), MonoTime{}, sink);
    parser.finish(sink);
}

void print(const BenchOptions& options, std::string_view what, double per_s, std::string_view unit,
           const RecordedFrames& recording) {
    if (options.json) {
        fmt::print(
            "{{\"bench\":\"{}\",\"per_second\":{:.0f},\"unit\":\"{}\",\"frames\":{},\"bytes\":{},\"turns\":{}}}\n",
            what, per_s, unit, recording.times.size(), recording.frames.size(), options.turns);
    } else {
        fmt::print("{:<14} {:>14.0f} {}/s   ({}, {}, median of {})\n", what, per_s, unit,
                   counted(recording.times.size(), "frame"), counted(recording.frames.size(), "byte"),
                   counted(static_cast<std::uint64_t>(options.turns), "turn"));
    }
}

Exit bench_parse(const BenchOptions& options, const dialect::Dialect& dialect, const RecordedFrames& recording) {
    const auto& table = dialect.wire_table();
    std::uint64_t found = 0;
    parse_all(recording, options.chunk, table, [&](const wire::FrameView&) { ++found; });
    if (found != recording.times.size())
        return fail(Exit::mismatch,
                    fmt::format("the stream parser found {} of {} frames", found, recording.times.size()));
    const auto work = [&] {
        parse_all(recording, options.chunk, table, [&](const wire::FrameView& frame) { found += frame.sequence(); });
    };
    const double rate = per_second(options.turns, static_cast<double>(recording.frames.size()), work);
    print(options, "parse", rate, "bytes", recording);
    return Exit::done;
}

template <class Append>
void bench_form(const BenchOptions& options, std::string_view what, const dialect::Dialect& dialect,
                const RecordedFrames& recording, Append&& append) {
    message::TextBuffer out;
    const auto work = [&] {
        std::size_t index = 0;
        parse_all(recording, options.chunk, dialect.wire_table(), [&](const wire::FrameView& frame) {
            out.clear();
            append(out, message::Received{recording.times[index++], "bench", frame, dialect.find(frame.id())});
        });
    };
    print(options, what, per_second(options.turns, static_cast<double>(recording.times.size()), work), "messages",
          recording);
}

Exit bench_decode(const BenchOptions& options, const dialect::Dialect& dialect, const RecordedFrames& recording) {
    const message::JsonFormatter json(dialect);
    bench_form(options, "decode json", dialect, recording,
               [&](auto& out, const auto& received) { json.append(out, received); });
    bench_form(options, "decode text", dialect, recording,
               [&](auto& out, const auto& received) { message::append_text(out, received, dialect); });
    return Exit::done;
}

SetupResult<void> set_chunk(BenchOptions& options) {
    constexpr std::uint64_t most = 1u << 30;
    const auto chunk = endpoint::parse_size(options.chunk_text);
    if (!chunk) return tl::unexpected(SetupError(chunk.error()).within("--chunk"));
    if (*chunk == 0 || *chunk > most)
        return setup_error(SetupCode::usage, fmt::format("--chunk {}: from 1 byte to 1G", options.chunk_text));
    options.chunk = static_cast<std::size_t>(*chunk);
    return {};
}

template <class Bench>
Exit run_bench(const Common& common, BenchOptions& options, Bench&& bench) {
    if (auto good = set_chunk(options); !good) return fail(good.error());
    const auto dialect = load_dialect(common);
    if (!dialect) return fail(dialect.error());
    const auto recording = read_recording(options.file, dialect->wire_table());
    if (!recording) return fail(recording.error());
    return bench(options, *dialect, *recording);
}

// ---- shm ------------------------------------------------------------------------------------------------------------

struct RingOptions {
    std::uint8_t readers = 1;
    std::size_t bytes = 64;
    std::uint64_t records = 5'000'000;
    int turns = 5;
    bool json = false;
};

constexpr auto longest_wait = std::chrono::seconds(10);  // for the other side
constexpr auto end_poll_interval = std::chrono::milliseconds(100);
constexpr std::uint64_t signal_poll_records = 1u << 16;  // check after this many records

// Reads up to record `end`, which a signal may lower. Each payload must begin with the record's number. Returns false
// if one does not, or if no record arrives in time.
bool read_up_to(shm::RingReader& reader, std::uint64_t& next, const std::atomic<std::uint64_t>& end) {
    bool good = true;
    const auto look = [&](const shm::RingRecord& record) {
        good = good && std::memcmp(record.data.data(), &next, sizeof next) == 0;
        ++next;
    };
    MonoTime limit = mono_now() + longest_wait;
    while (good && next < end) {
        if (!reader.try_visit(end - next, look)) {
            const auto record = reader.read(mono_now() + end_poll_interval);
            if (!record && mono_now() >= limit) return false;
            if (!record) continue;
            look(*record);
        }
        limit = mono_now() + longest_wait;
    }
    return good;
}

// Passes `options.records` records through the ring to every reader. Returns false if one got wrong data or none in
// time.
bool hand_over(shm::RingWriter& writer, std::vector<shm::RingReader>& readers, const RingOptions& options,
               std::uint64_t& first) {
    std::atomic<std::uint64_t> end{first + options.records};
    std::atomic<bool> good{true};
    {
        std::vector<std::jthread> threads;
        threads.reserve(readers.size());
        for (auto& reader : readers)
            threads.emplace_back([&reader, &good, &end, first] {
                auto next = first;
                if (!read_up_to(reader, next, end)) good = false;
                reader.release();
            });
        Bytes payload(options.bytes);
        for (; first < end && good; ++first) {
            if (first % signal_poll_records == 0 && Signals::received()) {
                end = first;
                break;
            }
            std::memcpy(payload.data(), &first, sizeof first);
            if (!writer.write(payload, {}, mono_now() + longest_wait)) good = false;
        }
        writer.flush();
    }
    return good;
}

SetupResult<std::vector<shm::RingReader>> open_readers(std::string_view ring, std::size_t count) {
    std::vector<shm::RingReader> readers;
    readers.reserve(count);
    while (readers.size() < count) {
        auto reader = shm::RingReader::open(ring, {.lossless = true});
        if (!reader) return tl::unexpected(std::move(reader.error()));
        readers.push_back(std::move(*reader));
    }
    return readers;
}

void print(const RingOptions& options, double per_s) {
    if (options.json)
        fmt::print(
            "{{\"bench\":\"shm\",\"per_second\":{:.0f},\"unit\":\"records\",\"readers\":{},\"bytes\":{},\"records\":{},"
            "\"turns\":{}}}\n",
            per_s, options.readers, options.bytes, options.records, options.turns);
    else
        fmt::print("{:<14} {:>14.0f} records/s   ({} bytes each, {}, median of {})\n", "shm", per_s, options.bytes,
                   counted(options.readers, "lossless reader"),
                   counted(static_cast<std::uint64_t>(options.turns), "turn"));
}

Exit bench_shm(const RingOptions& options) {
    const Signals signals([](void*) noexcept {}, nullptr);  // so that the ring is removed even after a signal
    auto writer = shm::RingWriter::open(fmt::format("bench-{}", ::getpid()));
    if (!writer) return fail(writer.error());
    auto readers = open_readers(writer->name(), options.readers);
    std::uint64_t next = 0;
    bool good = true;
    double rate = 0;
    if (readers)
        rate = per_second(options.turns, static_cast<double>(options.records),
                          [&] { good = good && hand_over(*writer, *readers, options, next); });
    (void)writer->close(shm::RingWriter::Leave::nothing);
    if (!readers) return fail(readers.error());
    if (!good) return fail(Exit::mismatch, "a reader received wrong data, or none in time");
    if (!Signals::received()) print(options, rate);
    return Signals::status(Exit::done);
}

Arguments declare_ring(Arguments command, RingOptions& options) {
    auto sub = command.add_subcommand("shm", "pass records through a ring to other threads: records per second");
    sub.add_option("--readers", "N", options.readers, "number of lossless readers, each in its own thread; 1 to 64")
        .capture_default_str()
        .range(1, 64);
    sub.add_option("--bytes", "N", options.bytes, "size of a record, 8 to 65536").capture_default_str().range(8, 65536);
    sub.add_option("--records", "N", options.records, "number of records in each measurement")
        .capture_default_str()
        .range(1, 1 << 30);
    sub.add_option("--turns", "N", options.turns, "number of measurements, 1 to 10000; the result is their median")
        .capture_default_str()
        .range(1, 10'000);
    sub.add_flag("--json", options.json, "print one JSON object");
    sub.fallthrough();
    sub.footer("Example:\n  mavloom bench shm --readers 3 --turns 5");
    return sub;
}

Arguments declare_one(Arguments command, BenchOptions& options, const char* name, const char* description) {
    auto sub = command.add_subcommand(name, description);
    sub.add_option("file", "FILE.tlog", options.file, "a recording").required();
    sub.add_option("--turns", "N", options.turns, "number of measurements, 1 to 10000; the result is their median")
        .capture_default_str()
        .range(1, 10'000);
    sub.add_option("--chunk", "BYTES", options.chunk_text, "bytes passed to the parser at once: 4096, 64k; up to 1G")
        .capture_default_str();
    sub.add_flag("--json", options.json, "print one JSON object per line");
    sub.fallthrough();
    sub.footer(fmt::format("Example:\n  mavloom bench {} flight.tlog --turns 5 --json", name));
    return sub;
}

}  // namespace

Run declare_bench(Arguments command, const Common& common) {
    auto options = std::make_shared<BenchOptions>();
    auto parse = declare_one(command, *options, "parse",
                             "find and validate the frames of a recording: bytes per second");
    declare_one(command, *options, "decode", "decode a recording to JSON and to text: messages per second");
    auto ring_options = std::make_shared<RingOptions>();
    auto ring = declare_ring(command, *ring_options);
    auto sim_options = std::make_shared<SimBenchOptions>();
    auto sim = declare_sim_bench(command, *sim_options);
    command.require_subcommand();
    command.footer("Example:\n  mavloom bench parse flight.tlog\n\n./run bench compares Mavloom with other programs.");
    return [options, ring_options, sim_options, parse, ring, sim, &common] {
        if (ring.parsed()) return bench_shm(*ring_options);
        if (sim.parsed()) return run_sim_bench(*sim_options);
        return parse.parsed() ? run_bench(common, *options, bench_parse) : run_bench(common, *options, bench_decode);
    };
}

}  // namespace mavloom::app
