// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <poll.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "command.hpp"
#include "frames/receiving.hpp"
#include "frames/sending.hpp"
#include "frames/traffic_report.hpp"
#include "output.hpp"
#include "progress.hpp"
#include "signals.hpp"

namespace mavloom::app {

namespace {

constexpr std::chrono::milliseconds retry_interval{100};
constexpr std::uint64_t frames_between_looks = 4096;

struct RecordOptions {
    ReceiveOptions receive;
    Selection selection;
    std::string file;
    bool json = false;
};

// Writes the frames of the receiver to the recording. While the disk is full, or the folder of the file is missing, it
// waits, as a router's recording does. Meanwhile frames wait in the receiver's buffer. Frames that do not fit there are
// counted.
class Recording {
public:
    Recording(const Common& common, const RecordOptions& options, feed::Receiver& receiver,
              record::RotatingWriter& writer, MonoTime end)
        : common_(common),
          options_(options),
          receiver_(receiver),
          writer_(writer),
          end_(end),
          begin_(mono_now()),
          progress_(common) {
        for (const auto& source : options.receive.sources) {
            const auto endpoint = endpoint::parse_endpoint(source);
            total_bytes_ += endpoint ? recorded_bytes(*endpoint) : 0;
        }
    }

    // Runs until the end. Flushes records to the system whenever idle, so that a kill loses little.
    SetupResult<void> run() {
        while (receiver_.wait()) {
            if (auto looked = check_file(); !looked) return looked;
            while (const auto entry = receiver_.next()) {
                if (!options_.selection.filter.admits(entry->frame)) continue;
                if (auto written = write(*entry); !written) return written;
                if (writer_.taken_records() == options_.receive.count) return {};
                if (writer_.taken_records() % frames_between_looks == 0) show_progress();
            }
            show_progress();
            if (auto flushed = flush(); !flushed) return flushed;
        }
        return {};
    }

private:
    SetupResult<void> check_file() {
        auto removed = writer_.maintain(mono_now());
        if (!removed && writer_.can_retry(removed.error())) return {};  // the next write waits
        if (!removed) return tl::unexpected(std::move(removed.error()));
        if (!removed->empty()) print_event(common_, writer_.removal_notice(*removed));
        return {};
    }

    SetupResult<void> write(const record::FrameQueue::Entry& entry) {
        auto room = retried([&] { return writer_.make_room(entry.time, entry.frame); });
        if (room) return writer_.write(entry.time, entry.frame);
        writer_.give_up();
        return room;
    }

    SetupResult<void> flush() {
        return retried([&] { return writer_.flush(); });
    }

    // Repeats the step every 100 ms while it fails and a retry can succeed.
    template <class Step>
    SetupResult<void> retried(Step step) {
        auto done = step();
        if (done || !writer_.can_retry(done.error())) return done;
        print_event(common_,
                    fmt::format("{}; trying again; frames that do not fit into --buffer are dropped and counted",
                                done.error().text));
        while (!done && writer_.can_retry(done.error()) && may_continue()) {
            ::poll(nullptr, 0, static_cast<int>(retry_interval.count()));  // a signal ends the wait
            if (auto looked = check_file(); !looked) return looked;
            done = step();
        }
        if (done) print_event(common_, fmt::format("{}: records are written again", writer_.path().string()));
        return done;
    }

    void show_progress() {
        if (!progress_.is_due()) return;
        progress_.show({.frames = writer_.taken_records(), .bytes = writer_.written_bytes(), .part = part_done()});
    }

    // By the limit that was given. Empty: there is none.
    [[nodiscard]] std::optional<double> part_done() {
        if (options_.receive.count != 0)
            return static_cast<double>(writer_.taken_records()) / static_cast<double>(options_.receive.count);
        if (const auto part = part_of_time(begin_, end_)) return part;
        if (total_bytes_ == 0) return std::nullopt;
        return static_cast<double>(bytes_read(receiver_)) / static_cast<double>(total_bytes_);
    }

    [[nodiscard]] bool may_continue() const { return !Signals::received() && mono_now() < end_; }

    const Common& common_;
    const RecordOptions& options_;
    feed::Receiver& receiver_;
    record::RotatingWriter& writer_;
    MonoTime end_, begin_;
    Progress progress_;
    std::uint64_t total_bytes_ = 0;  // of recordings
};

// Accepts FILE with any name, or with options: tlog://PATH?... or PATH.tlog?rotate_every=...
SetupResult<record::RotatingWriter> create_output(const Common& common, const std::string& text) {
    const auto query = std::string_view(text).find('?');
    const bool has_options = query != std::string_view::npos && !endpoint::is_recording_path(text) &&
                             endpoint::is_recording_path(std::string_view(text).substr(0, query));
    const bool is_endpoint = text.find("://") != std::string::npos || has_options;
    endpoint::Endpoint endpoint;
    endpoint.scheme = endpoint::Scheme::tlog;
    endpoint.path = text;
    if (!is_endpoint) return create_recording(common, endpoint, "--output");
    auto parsed = endpoint::parse_endpoint(text);
    if (!parsed) return tl::unexpected(std::move(parsed.error()).within("--output"));
    if (!parsed->is_recording())
        return setup_error(SetupCode::usage,
                           fmt::format("--output {}: record writes a .tlog file; relay sends to endpoints", text));
    return create_recording(common, *parsed, "--output");
}

// After a write error, counts the frames that still wait in the receiver as not written.
void give_up_the_rest(const RecordOptions& options, feed::Receiver& receiver, record::RotatingWriter& writer) {
    while (const auto entry = receiver.next())
        if (options.selection.filter.admits(entry->frame)) writer.give_up();
}

std::string summary(const record::RotatingWriter& file, const feed::Totals& heard) {
    Json totals{{"frames", heard.frames}, {"bytes", heard.bytes}};
    totals.update(losses_json(heard));
    return stats_line({{"destinations", Json::array({recorded_json(file)})}, {"totals", std::move(totals)}});
}

Exit record(const Common& common, RecordOptions& options) {
    const auto dialect = load_dialect(common);
    if (!dialect) return fail(dialect.error());
    if (auto compiled = options.selection.compile(*dialect); !compiled) return fail(compiled.error());
    auto receiver = options.receive.open(common, *dialect);
    if (!receiver) return fail(receiver.error());
    const Signals signals([](void* r) noexcept { static_cast<feed::Receiver*>(r)->stop(); }, receiver->get());
    log_ports(common, (*receiver)->endpoints());
    auto writer = create_output(common, options.file);
    if (!writer) return Signals::received() ? Signals::status(Exit::failed) : fail(writer.error());
    const MonoTime end = options.receive.end(mono_now());
    (*receiver)->start(end);
    auto recorded = Recording(common, options, **receiver, *writer, end).run();
    (*receiver)->stop();
    (*receiver)->join();
    if (!recorded) give_up_the_rest(options, **receiver, *writer);
    auto closed = writer->close();
    if (closed && !closed->empty()) print_notice(common, writer->removal_notice(*closed));
    log_recorded(common, *writer);
    log_losses(common, (*receiver)->totals());
    const auto status = options.json ? print_at_end(summary(*writer, (*receiver)->totals()), Exit::done) : Exit::done;
    if (!recorded) return fail(recorded.error());
    if (!closed) return fail(closed.error());
    if (status != Exit::done) return status;
    if (const auto* error = (*receiver)->error()) return fail(*error);
    return Signals::status(Exit::done);
}

}  // namespace

Run declare_record(Arguments command, const Common& common) {
    auto options = std::make_shared<RecordOptions>();
    options->receive.declare(command);
    options->selection.declare(command);
    command
        .add_option("-o,--output", "FILE", options->file,
                    "the file to write; an existing file is first renamed to FILE.1. FILE.tlog?rotate_bytes=100M or "
                    "?rotate_every=1h starts a new file at that size or interval")
        .required();
    command.add_flag("--json", options->json,
                     "at the end, print the totals as one JSON object on stdout (docs/guide/relay.md)");
    command.footer(
        "Records every good frame with the kernel's receive time, in the tlog format (docs/formats/tlog.md).\n\n"
        "Examples:\n  mavloom record udpin://0.0.0.0:14550 -o flight.tlog --for 10m\n"
        "  mavloom record udpin://0.0.0.0:14550 -o 'flight.tlog?rotate_every=1h'");
    return [options, &common] { return record(common, *options); };
}

}  // namespace mavloom::app
