// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "command.hpp"
#include "destinations.hpp"
#include "output.hpp"
#include "receiving.hpp"
#include "signals.hpp"
#include "traffic_report.hpp"

namespace mavloom::app {

namespace {

struct Options {
    ReceiveOptions receive;
    Selection selection;
    std::string file;
    bool json = false;
};

// Takes frames until the end; hands them to the system whenever there is nothing else to do, so that a kill loses little.
SetupResult<void> record_all(const Options& options, runtime::Receiver& receiver, record::RotatingWriter& writer) {
    while (receiver.wait()) {
        while (const auto entry = receiver.next()) {
            if (!options.selection.takes(entry->frame)) continue;
            if (auto written = writer.write(entry->time, entry->frame); !written) return written;
            if (writer.taken_records() == options.receive.count) return {};
        }
        if (auto flushed = writer.flush(); !flushed) return flushed;
    }
    return {};
}

// FILE, whatever its name; or tlog://PATH or PATH.tlog?rotate_every=... with options.
SetupResult<record::RotatingWriter> create_output(const Common& common, const std::string& text) {
    const bool is_endpoint = text.find("://") != std::string::npos ||
                             (text.find(".tlog?") != std::string::npos && !text.ends_with(".tlog"));
    runtime::Endpoint endpoint;
    endpoint.scheme = runtime::Scheme::tlog;
    endpoint.path = text;
    if (!is_endpoint) return create_recording(common, endpoint, "--output");
    auto parsed = runtime::parse_endpoint(text);
    if (!parsed) return tl::unexpected(std::move(parsed.error()).within("--output"));
    if (parsed->scheme != runtime::Scheme::tlog)
        return setup_error(SetupCode::usage,
                           fmt::format("--output {}: record writes a .tlog file; relay sends to endpoints", text));
    return create_recording(common, *parsed, "--output");
}

// What was received and still waits when writing has failed.
void give_up_the_rest(const Options& options, runtime::Receiver& receiver, record::RotatingWriter& writer) {
    while (const auto entry = receiver.next())
        if (options.selection.takes(entry->frame)) writer.give_up();
}

std::string summary(const record::RotatingWriter& file, const runtime::Totals& heard) {
    Json totals{{"frames", heard.frames}, {"bytes", heard.bytes}};
    totals.update(losses_json(heard));
    return stats_line({{"destinations", Json::array({recorded_json(file)})}, {"totals", std::move(totals)}});
}

Exit record(const Common& common, Options& options) {
    const auto dialect = load_dialect(common);
    if (!dialect) return fail(dialect.error());
    if (auto resolved = options.selection.resolve(*dialect); !resolved) return fail(resolved.error());
    auto receiver = options.receive.open(common, *dialect);
    if (!receiver) return fail(receiver.error());
    const Signals signals([](void* r) noexcept { static_cast<runtime::Receiver*>(r)->stop(); }, receiver->get());
    say_ports(common, (*receiver)->endpoints());
    auto writer = create_output(common, options.file);
    if (!writer) return Signals::received() ? Signals::status(Exit::failed) : fail(writer.error());
    (*receiver)->start(options.receive.end(mono_now()));
    auto recorded = record_all(options, **receiver, *writer);
    (*receiver)->stop();
    (*receiver)->join();
    if (!recorded) give_up_the_rest(options, **receiver, *writer);
    auto closed = writer->close();
    say_recorded(common, *writer);
    say_losses(common, (*receiver)->totals());
    const auto status = options.json ? print_at_end(summary(*writer, (*receiver)->totals()), Exit::done) : Exit::done;
    if (!recorded) return fail(recorded.error());
    if (!closed) return fail(closed.error());
    if (status != Exit::done) return status;
    if (const auto* error = (*receiver)->error()) return fail(*error);
    return Signals::status(Exit::done);
}

}  // namespace

Run declare_record(Arguments command, const Common& common) {
    auto options = std::make_shared<Options>();
    options->receive.declare(command);
    options->selection.declare(command);
    command
        .add_option("-o,--output", options->file,
                    "the file to write; an existing one is first renamed FILE.1. FILE.tlog?rotate_bytes=100M or "
                    "?rotate_every=1h goes "
                    "on in new files")
        .required()
        .type_name("FILE");
    command.add_flag("--json", options->json, "end with the sums as one JSON object on stdout (docs/guide/relay.md)");
    command.footer(
        "Records every good frame with the kernel's receive time, in the tlog format (docs/formats/tlog.md).\n\n"
        "Examples:\n  mavloom record udpin://0.0.0.0:14550 -o flight.tlog --for 10m\n"
        "  mavloom record udpin://0.0.0.0:14550 -o 'flight.tlog?rotate_every=1h'");
    return [options, &common] { return record(common, *options); };
}

}  // namespace mavloom::app
