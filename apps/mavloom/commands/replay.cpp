// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>

#include "command.hpp"
#include "frames/receiving.hpp"
#include "frames/sending.hpp"
#include "frames/traffic_report.hpp"
#include "mavloom/base/counted.hpp"
#include "mavloom/base/shown.hpp"
#include "mavloom/feed/sources.hpp"
#include "mavloom/link/flush.hpp"
#include "mavloom/record/tlog_index.hpp"
#include "output.hpp"
#include "progress.hpp"
#include "signals.hpp"

namespace mavloom::app {

namespace {

using namespace std::chrono_literals;

constexpr std::size_t frames_a_turn = 256;
constexpr auto longest_flush = 5s;  // to send the last frames

struct ReplayOptions {
    std::string file;
    std::vector<std::string> to;
    std::string speed, start, duration;  // as typed; empty: not given
    Selection selection;
    bool no_wait = false;
    bool json = false;
};

class Replayer : private link::LinkHandler {
public:
    Replayer(const Common& common, const ReplayOptions& options, feed::Sources& sources,
             feed::Destinations& destinations)
        : common_(common), options_(options), sources_(sources), destinations_(destinations), progress_(common) {}

    Exit run(MonoTime end) {
        progress_.restart();
        while (going(end) && !destinations_.failed() && !sources_.finished_recordings()) {
            const std::size_t room = std::min(frames_a_turn, destinations_.room_in_frames());
            sources_.turn(*this, std::min(end, mono_now() + (room == 0 ? 1ms : 100ms)), feed::Room(room));
            destinations_.maintain_files(mono_now(), [this](auto text) { print_event(common_, text); });
            show_progress();
        }
        link::flush(sources_.links(), *this, longest_flush);
        progress_.clear();
        return finish();
    }

    // Waits until every destination has a peer.
    void wait_for_peers(MonoTime end) {
        if (options_.no_wait || destinations_.all_up()) return;
        print_event(common_, "waiting until every destination has a peer (--no-wait starts at once)");
        while (going(end) && !destinations_.all_up()) sources_.links().turn(*this, mono_now() + 100ms);
    }

private:
    void on_frame(const link::RxFrame& rx) override {
        if (destinations_.has(rx.endpoint)) return;  // a recording has no use for answers
        ++frames_;
        bytes_ += rx.frame.size();
        if (options_.selection.filter.admits(rx.frame)) destinations_.send(rx.frame, rx.time);
    }

    void on_notice(link::EndpointId, std::string_view text) override { print_event(common_, text); }

    static bool going(MonoTime end) { return !Signals::received() && mono_now() < end; }

    void show_progress() {
        if (!progress_.is_due()) return;
        progress_.show({.frames = frames_, .bytes = bytes_, .part = part_read(sources_)});
    }

    std::string summary() const {
        const auto& counters = sources_.recordings().front()->reader.counters();
        feed::Totals read;
        read.add(counters);
        Json totals{{"frames", frames_}, {"bytes", bytes_}};
        totals.update(losses_json(read));
        return stats_line({{"destinations", sums_json(destinations_)}, {"totals", std::move(totals)}});
    }

    Exit finish() {
        const auto closed = destinations_.close([this](auto text) { print_notice(common_, text); });
        log_sums(common_, destinations_);
        const auto& counters = sources_.recordings().front()->reader.counters();
        if (!options_.start.empty() && frames_ == 0 && sources_.finished_recordings() && sources_.error() == nullptr)
            print_notice(common_, fmt::format("the recording ends before --start {}", options_.start));
        if (counters.damaged_places.value() != 0)
            print_notice(common_, fmt::format("{}: {}, {} lost", options_.file,
                                              counted(counters.damaged_places.value(), "damaged place"),
                                              counted(counters.lost_bytes.value(), "byte")));
        if (counters.unknown_flags.value() != 0)
            print_notice(common_, fmt::format("{}: {} not sent: an unknown incompatibility flag", options_.file,
                                              counted(counters.unknown_flags.value(), "frame")));
        const auto printed = options_.json ? print_at_end(summary(), Exit::done) : Exit::done;
        if (!closed) return fail(closed.error());
        if (printed != Exit::done) return printed;
        if (destinations_.lost_any()) return Signals::status(Exit::mismatch);
        if (const auto* error = sources_.error()) return fail(*error);
        return Signals::status(Exit::done);
    }

    const Common& common_;
    const ReplayOptions& options_;
    feed::Sources& sources_;
    feed::Destinations& destinations_;
    Progress progress_;
    std::uint64_t frames_ = 0, bytes_ = 0;  // read from the recording so far
};

// Returns true if a destination is the recording itself: creating that output would rename the file to be read.
// Rotating outputs are allowed, because they choose their own file names.
bool is_written_over(const endpoint::Endpoint& recording, std::span<const endpoint::Endpoint> to) {
    return std::ranges::any_of(to, [&](const endpoint::Endpoint& endpoint) {
        std::error_code none;
        const bool rotates = endpoint.options.rotate_bytes != 0 || endpoint.options.rotate_every != Nanoseconds{};
        return endpoint.is_recording() && !rotates && std::filesystem::equivalent(endpoint.path, recording.path, none);
    });
}

// Returns the value of a time option, or 0 if it is not given. Error texts begin with `option`.
SetupResult<Nanoseconds> time_of(const std::string& text, std::string_view option) {
    if (text.empty()) return Nanoseconds{};
    auto parsed = endpoint::parse_duration(text);
    if (!parsed) return tl::unexpected(std::move(parsed.error()).within(option));
    return *parsed;
}

Exit replay(const Common& common, ReplayOptions& options) {
    const auto dialect = load_dialect(common);
    if (!dialect) return fail(dialect.error());
    if (auto compiled = options.selection.compile(*dialect); !compiled) return fail(compiled.error());
    const bool is_endpoint = endpoint::is_recording_path(options.file) || options.file.find("://") != std::string::npos;
    auto endpoint = endpoint::parse_endpoint(is_endpoint ? options.file : "tlog://" + options.file);
    if (!endpoint) return fail(endpoint.error());
    if (!endpoint->is_recording())
        return fail(Exit::wrong_use, fmt::format("replay reads a .tlog file, not {}", options.file));
    if (!options.speed.empty())  // overrides the speed in the URL
        if (auto set = endpoint::set_endpoint_option(*endpoint, "speed", options.speed); !set)
            return fail(std::move(set.error()).within("--speed"));
    const auto to = endpoint::parse_endpoints(options.to, "--to");
    if (!to) return fail(to.error());
    const auto start = time_of(options.start, "--start"), length = time_of(options.duration, "--for");
    if (!start) return fail(start.error());
    if (!length) return fail(length.error());

    auto sources = feed::Sources::create(*dialect);
    if (!sources) return fail(sources.error());
    if (auto checked = sources->check(*endpoint); !checked) return fail(checked.error());
    if (is_written_over(*endpoint, *to))
        return fail(Exit::wrong_use, fmt::format("--to is the recording itself, {}; choose another file", options.file));
    const Signals signals([](void* s) noexcept { static_cast<feed::Sources*>(s)->wake(); }, &*sources);
    auto destinations = open_destinations(common, *to, sources->links());
    if (!destinations) return Signals::received() ? Signals::status(Exit::failed) : fail(destinations.error());
    const MonoTime forever = MonoTime::max();
    Replayer replayer(common, options, *sources, *destinations);
    const MonoTime latest_start = options.duration.empty() ? forever : mono_now() + *length;
    replayer.wait_for_peers(latest_start);
    if (auto added = sources->add(*endpoint, mono_now(), 1.0, *start); !added) return fail(added.error());
    return replayer.run(options.duration.empty() ? forever : mono_now() + *length);
}

}  // namespace

Run declare_replay(Arguments command, const Common& common) {
    auto options = std::make_shared<ReplayOptions>();
    command.add_option("file", "FILE.tlog", options->file, "the recording").required();
    command.add_option("--to", "ENDPOINT", options->to, "where to send; may be repeated").required();
    command
        .add_option("--speed", "N|max", options->speed,
                    "1 is the recorded pace, 10 is ten times as fast, max does not wait at all")
        .default_str("1");
    command.add_option("--start", "TIME", options->start,
                       "begin this long after the recording's earliest time: 30s, 2m");
    command.add_option("--for", "TIME", options->duration, "end after this time");
    command.add_flag("--no-wait", options->no_wait, "start even if a destination has no peer");
    options->selection.declare(command);
    command.add_flag("--json", options->json,
                     "at the end, print the totals as one JSON object on stdout (docs/guide/relay.md)");
    command.footer("Example:\n  mavloom replay flight.tlog --to udpout://127.0.0.1:14550 --speed 2");
    return [options, &common] { return replay(common, *options); };
}

}  // namespace mavloom::app
