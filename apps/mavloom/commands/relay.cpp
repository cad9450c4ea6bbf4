// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "command.hpp"
#include "fault_log.hpp"
#include "frames/receiving.hpp"
#include "frames/sending.hpp"
#include "frames/traffic_report.hpp"
#include "mavloom/base/counted.hpp"
#include "mavloom/edit/stage.hpp"
#include "mavloom/endpoint/checks.hpp"
#include "mavloom/fault/faults.hpp"
#include "mavloom/feed/relay.hpp"
#include "mavloom/link/signing_times.hpp"
#include "output.hpp"
#include "progress.hpp"
#include "signals.hpp"

namespace mavloom::app {

namespace {

struct RelayOptions {
    std::string fault_log;
    std::vector<std::string> sources, to;
    std::string duration;
    Selection selection;
    edit::Options edit;
    std::string sign_file;
    bool as_v1 = false, as_v2 = false;
    bool json = false;
};

// Keeps the times of --sign, so that the next run, or a router with the same key, signs later ones.
class KeptTimes {
public:
    KeptTimes(const Common& common, const edit::Stage& stage, std::optional<link::SigningTimes>& times)
        : common_(common), stage_(stage), times_(times) {}
    ~KeptTimes() { keep(); }
    KeptTimes(const KeptTimes&) = delete;
    KeptTimes& operator=(const KeptTimes&) = delete;

    void keep() {
        if (!times_) return;
        std::vector<std::string> notices;
        times_->keep(stage_.last_signed(), mono_now(), notices);
        for (const auto& notice : notices) print_event(common_, notice);
    }

private:
    const Common& common_;
    const edit::Stage& stage_;
    std::optional<link::SigningTimes>& times_;
};

// Logs the events of the relay, and shows how far it is. A signal ends it.
class Events final : public feed::RelayHandler {
public:
    Events(const Common& common, KeptTimes& times, feed::Sources& sources, const edit::Stage& stage, MonoTime end)
        : common_(common), times_(times), sources_(sources), stage_(stage), end_(end), progress_(common) {}

    void clear() { progress_.clear(); }

private:
    bool should_stop() override {
        times_.keep();
        show_progress();
        return Signals::received();
    }
    void on_waiting() override { print_event(common_, "waiting until every destination has a peer"); }
    void on_started() override { print_event(common_, "every destination has a peer: starting"); }
    void on_link_up(std::string_view name) override {
        if (common_.verbose > 0) print_event(common_, fmt::format("{}: up", name));
    }
    void on_link_down(std::string_view name, std::string_view why) override {
        if (common_.verbose > 0) print_event(common_, fmt::format("{}: down, {}", name, why));
    }
    void on_notice(std::string_view text) override { print_event(common_, text); }

    void show_progress() {
        if (!progress_.is_due()) return;
        const auto part = sources_.are_recordings() ? part_read(sources_) : part_of_time(begin_, end_);
        const auto& counters = stage_.counters();
        progress_.show({.frames = counters.frames.value(), .bytes = counters.bytes.value(), .part = part});
    }

    const Common& common_;
    KeptTimes& times_;
    feed::Sources& sources_;
    const edit::Stage& stage_;
    const MonoTime begin_ = mono_now(), end_;
    Progress progress_;
};

std::string_view filters_of(const Selection& selection) {
    if (selection.from.empty()) return "that --only leaves out";
    return selection.only.empty() ? "that --from leaves out" : "that --only and --from leave out";
}

// Prints the relay's results: as log lines, and as one JSON object.
void log_report(const Common& common, const RelayOptions& options, const feed::Destinations& destinations,
                const edit::Counters& c, const feed::RelayOutcome& outcome) {
    log_sums(common, destinations);
    print_notice(
        common, fmt::format("{} in, {} decoded and re-encoded, {} passed untouched", counted(c.frames.value(), "frame"),
                            c.reencoded.value(), c.passed_untouched.value()));
    const auto unless_zero = [&](std::string_view name, std::uint64_t count, std::string_view noun,
                                 std::string_view rest) {
        if (count != 0) print_notice(common, fmt::format("{}: {} {}", name, counted(count, noun), rest));
    };
    unless_zero("rewrapped", c.rewrapped.value(), "frame", "without full definition, with a new header and checksum");
    unless_zero("filtered", c.filtered.value(), "frame", filters_of(options.selection));
    unless_zero("rate_limited", c.rate_limited.value(), "frame", "over --max-rate");
    unless_zero("not_v1", c.not_v1.value(), "frame", "that MAVLink 1 cannot carry");
    unless_zero("not_signed", c.not_signed.value(), "MAVLink 1 frame", "which cannot carry a signature (--as-v2 helps)");
    unless_zero("signature_removed", c.signature_removed.value(), "changed frame",
                "sent without a signature (--sign adds a new one)");
    unless_zero("unheard_answers", outcome.unheard_answers, "answer", "from the far side for which there was no source");
    log_losses(common, outcome.totals);
}

std::string summary(const feed::Destinations& destinations, const edit::Counters& c, const feed::RelayOutcome& outcome) {
    return stats_line({{"destinations", sums_json(destinations)},
                       {"edit",
                        {{"frames", c.frames.value()},
                         {"reencoded", c.reencoded.value()},
                         {"rewrapped", c.rewrapped.value()},
                         {"passed_untouched", c.passed_untouched.value()},
                         {"filtered", c.filtered.value()},
                         {"rate_limited", c.rate_limited.value()},
                         {"not_v1", c.not_v1.value()},
                         {"not_signed", c.not_signed.value()},
                         {"signature_removed", c.signature_removed.value()},
                         {"backward", c.backward.value()},
                         {"unheard_answers", outcome.unheard_answers}}},
                       {"totals", losses_json(outcome.totals)}});
}

Exit status_of(const feed::RelayOutcome& outcome, Exit printed) {
    if (outcome.write_error) return fail(*outcome.write_error);
    if (printed != Exit::done) return printed;
    if (outcome.is_incomplete || outcome.reached_no_destination) return Signals::status(Exit::mismatch);
    if (outcome.read_error) return fail(*outcome.read_error);
    return Signals::status(Exit::done);
}

SetupResult<void> check_words(RelayOptions& options) {
    if (options.as_v1) options.edit.as_version = wire::Version::v1;
    if (options.as_v2) options.edit.as_version = wire::Version::v2;
    if (!options.duration.empty())
        if (auto time = endpoint::parse_duration(options.duration); !time)
            return tl::unexpected(std::move(time.error()).within("--for"));
    return {};
}

// Loads the key of --sign, and the last time that was signed with it. Empty without --sign.
SetupResult<std::optional<link::SigningTimes>> open_key(const Common& common, RelayOptions& options) {
    if (options.sign_file.empty()) return std::nullopt;
    auto key = wire::SigningKey::load(options.sign_file);
    if (!key) return tl::unexpected(std::move(key.error()).within("--sign"));
    std::vector<std::string> notices;
    auto times = link::SigningTimes::open(options.sign_file, *key, notices);
    for (const auto& notice : notices) print_notice(common, notice);
    if (!times) return tl::unexpected(std::move(times.error()).within("--sign"));
    options.edit.sign_key = *key;
    options.edit.sign_after = times->last();
    return std::move(*times);
}

using Endpoints = std::span<const endpoint::Endpoint>;

// `port`: where the source listens.
SetupResult<void> check_no_loop(const endpoint::Endpoint& source, std::uint16_t port, Endpoints to) {
    const auto loop = std::ranges::find_if(
        to, [&](const endpoint::Endpoint& endpoint) { return endpoint::leads_back(source, port, endpoint); });
    if (loop == to.end()) return {};
    return setup_error(
        SetupCode::usage,
        source.is_ring()
            ? fmt::format("--to {} would send the ring its own records; choose another destination", loop->label())
            : fmt::format("--to {} is where {} listens: every frame would loop forever; choose another port",
                          loop->label(), source.label()));
}

SetupResult<void> open_sources(Endpoints given, Endpoints to, feed::Sources& sources) {
    for (auto source : given) {
        if (source.is_ring()) {
            if (auto good = check_no_loop(source, 0, to); !good) return good;
            if (!source.options.lossless) source.options.lossless = true;
        }
        if (auto added = sources.add(source, mono_now()); !added) return tl::unexpected(std::move(added.error()));
    }
    for (const auto& info : sources.links().endpoints())
        if (auto good = check_no_loop(info.endpoint, info.local_port, to); !good) return good;
    return {};
}

Exit relay(const Common& common, RelayOptions& options) {
    if (auto opened = fault::log_to(options.fault_log); !opened) return fail(opened.error());
    const auto dialect = load_dialect(common);
    if (!dialect) return fail(dialect.error());
    if (auto checked = check_words(options); !checked) return fail(checked.error());
    auto times = open_key(common, options);
    if (!times) return fail(times.error());
    if (auto compiled = options.selection.compile(*dialect); !compiled) return fail(compiled.error());
    options.edit.filter = options.selection.filter;
    auto stage = edit::Stage::create(*dialect, options.edit);
    if (!stage) return fail(stage.error());
    for (const auto& warning : (*stage)->warnings()) print_notice(common, warning);
    const auto given = endpoint::parse_endpoints(options.sources), to = endpoint::parse_endpoints(options.to, "--to");
    if (!given || !to) return fail(given ? to.error() : given.error());
    auto sources = feed::Sources::create(*dialect, feed::Copies::left_out);
    if (!sources) return fail(sources.error());
    if (auto opened = open_sources(*given, *to, *sources); !opened) return fail(opened.error());
    const Signals signals([](void* s) noexcept { static_cast<feed::Sources*>(s)->wake(); }, &*sources);
    log_ports(common, sources->links().endpoints());
    auto destinations = open_destinations(common, *to, sources->links());
    if (!destinations) return Signals::received() ? Signals::status(Exit::failed) : fail(destinations.error());
    const auto end = options.duration.empty() ? MonoTime::max()
                                              : mono_now() + *endpoint::parse_duration(options.duration);
    KeptTimes kept(common, **stage, *times);
    Events events(common, kept, *sources, **stage, end);
    using Signing = feed::Relay::Signing;
    feed::Relay relaying(*sources, *destinations, **stage, events, options.edit.sign_key ? Signing::on : Signing::off);
    const auto outcome = relaying.run(end);
    events.clear();
    const auto& counters = (*stage)->counters();
    log_report(common, options, *destinations, counters, outcome);
    const auto printed = options.json ? print_at_end(summary(*destinations, counters, outcome), Exit::done) : Exit::done;
    return status_of(outcome, printed);
}

// The options that change frames.
void declare_edits(Arguments command, RelayOptions& options) {
    auto& edit = options.edit;
    command.add_option("--set", "MESSAGE.FIELD=VALUE", edit.set,
                       "give a field this value: ATTITUDE.roll=0.1; may be repeated");
    command.add_option("--remap-system", "A=B", edit.remap_system,
                       "change system id A to B; in answers from the far side, change B back to A");
    options.selection.declare(command);
    command
        .add_option("--max-rate", "MESSAGE:HZ", edit.max_rate,
                    "limit a message from each source to this rate; * is all telemetry: ATTITUDE:10,*:50")
        .delimiter(',');
    auto v1 = command.add_flag(
        "--as-v1", options.as_v1,
        "send MAVLink 1: extension fields are cut; messages with ids over 255 are dropped and counted");
    command.add_flag("--as-v2", options.as_v2, "send MAVLink 2").excludes(v1);
    auto sign = command
                    .add_option("--sign", "FILE", options.sign_file,
                                "sign sent frames with the key in this file (64 hexadecimal digits, mode 0600)")
                    .excludes(v1);
    command.add_option("--sign-link-id", "N", edit.sign_link_id, "the link id in the signatures of --sign, 0 to 255")
        .default_str(std::to_string(edit.sign_link_id))
        .range(0, 255)
        .needs(sign);
    command.add_flag("--resequence", edit.resequence,
                     "assign new sequence numbers, so that a filtered stream shows no loss");
}

}  // namespace

Run declare_relay(Arguments command, const Common& common) {
    auto options = std::make_shared<RelayOptions>();
    command.add_option("source", "SOURCE", options->sources, "where to receive").required();
    command.add_option("--to", "ENDPOINT", options->to, "where to send; may be repeated").required();
    declare_edits(command, *options);
    command.add_flag("--json", options->json,
                     "at the end, print the totals as one JSON object on stdout (docs/guide/relay.md)");
    command.add_option("--for", "TIME", options->duration, "end after this time: 10s, 2m");
    declare_fault_log(command, options->fault_log);
    command.footer(
        "Without options, the output is byte for byte the input. Answers from the far side go back to the\n"
        "sources. A ring is read losslessly unless ?lossless=false.\n\nExamples:\n"
        "  mavloom relay udpin://0.0.0.0:14540 --to udpout://192.168.1.20:14550\n"
        "  mavloom relay shm://px4 --to udpout://127.0.0.1:14550\n"
        "  mavloom relay flight.tlog?speed=1 --to udpout://127.0.0.1:14550 --only ATTITUDE --resequence");
    return [options, &common] { return relay(common, *options); };
}

}  // namespace mavloom::app
