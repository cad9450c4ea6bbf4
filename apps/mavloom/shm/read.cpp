// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "mavloom/base/counted.hpp"
#include "mavloom/endpoint/endpoint.hpp"
#include "mavloom/link/links.hpp"
#include "mavloom/shm/ring_follower.hpp"
#include "output.hpp"
#include "parts.hpp"
#include "signals.hpp"

namespace mavloom::app::shm_parts {

namespace {

struct ReadOptions {
    std::string name;
    bool json = false;
    std::string from = "newest";
    bool lossless = false, foreign = false;
    bool data = false;
    bool drain = false;
    int count = 0;
    std::string duration;
};

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
    Reading(const Common& common, const ReadOptions& options, MonoTime end)
        : common_(common),
          options_(options),
          end_(end),
          follower_(options.name, {.lossless = options.lossless,
                                   .from = options.from == "oldest" ? shm::ReaderOptions::From::oldest
                                                                    : shm::ReaderOptions::From::newest,
                                   .trust = {.foreign = options.foreign, .user = link::Links::owner_of_inlets()}}) {
        output_.end_at(end);
    }

    Exit run() {
        while (going_ && !Signals::received()) {
            auto record = follower_.read(mono_now());
            if (!record && idle(record.error()))
                record = follower_.read(std::min(end_, mono_now() + signal_poll_interval));
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
        if (error != nullptr && !std::exchange(has_said_, true)) print_event(common_, error->text + "; waiting for it");
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
            print_notice(common_, fmt::format("{}: {}, {} missed: the writer was faster", options_.name,
                                              counted(records_, "record"), follower_.missed()));
        return Signals::status(follower_.missed() != 0 ? Exit::mismatch : Exit::done);
    }

    const Common& common_;
    const ReadOptions& options_;
    MonoTime end_;
    shm::RingFollower follower_;
    Output output_;
    std::uint64_t records_ = 0;
    bool going_ = true;
    bool has_said_ = false;
};

Exit read(const Common& common, const ReadOptions& options) {
    MonoTime end = MonoTime::max();
    if (!options.duration.empty()) {
        const auto time = endpoint::parse_duration(options.duration);
        if (!time) return fail(SetupError(time.error()).within("--for"));
        end = mono_now() + *time;
    }
    const Signals signals([](void*) noexcept {}, nullptr);
    return Reading(common, options, end).run();
}

}  // namespace

Run declare_read(Arguments part, const Common& common) {
    auto options = std::make_shared<ReadOptions>();
    add_name(part, options->name);
    add_json(part, options->json);
    part.add_option("--from", "WHERE", options->from,
                    "newest: records from now on; oldest: also those that the ring holds")
        .members({"newest", "oldest"})
        .capture_default_str();
    part.add_flag("--lossless", options->lossless,
                  "miss no record; if this reader is slow, the writer waits for it, or evicts it");
    part.add_flag("--foreign", options->foreign,
                  "read a ring of any user; without it, only rings of this user, of root, and of the owner of the "
                  "folder of the sockets (MAVLOOM_RUN)");
    part.add_flag("--data", options->data, "print each record as its bytes and a newline, without tags");
    part.add_flag("--drain", options->drain, "end when everything is read and no process writes the ring");
    part.add_option("--count", "N", options->count, "end after this many records").range(1, 2147483647);
    part.add_option("--for", "TIME", options->duration, "end after this time: 10s, 2m, 500ms");
    return [options, &common] { return read(common, *options); };
}

}  // namespace mavloom::app::shm_parts
