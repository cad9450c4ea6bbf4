// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "command.hpp"
#include "mavloom/record/tlog_writer.hpp"
#include "receiving.hpp"
#include "signals.hpp"
#include "traffic_report.hpp"

namespace mavloom::app {

namespace {

struct Options {
    ReceiveOptions receive;
    Selection selection;
    std::string file;
};

// Takes frames until the end; hands them to the system whenever there is nothing else to do, so that a kill loses little.
SetupResult<void> record_all(const Options& options, runtime::Receiver& receiver, record::TlogWriter& writer) {
    while (receiver.wait()) {
        while (const auto entry = receiver.next()) {
            if (!options.selection.takes(entry->frame)) continue;
            if (auto written = writer.write(entry->time, entry->frame); !written) return written;
            if (writer.records() == options.receive.count) return {};
        }
        if (auto flushed = writer.flush(); !flushed) return flushed;
    }
    return {};
}

Exit record(const Common& common, Options& options) {
    const auto dialect = load_dialect(common);
    if (!dialect) return fail(dialect.error());
    if (auto resolved = options.selection.resolve(*dialect); !resolved) return fail(resolved.error());
    auto receiver = options.receive.open(common, *dialect);
    if (!receiver) return fail(receiver.error());
    auto writer = record::TlogWriter::create(options.file);
    if (!writer) return fail(writer.error());
    if (!writer->renamed_to().empty())
        say(common, fmt::format("{} exists and is now {}", options.file, writer->renamed_to().string()));

    const Signals signals([](void* r) noexcept { static_cast<runtime::Receiver*>(r)->stop(); }, receiver->get());
    (*receiver)->start(options.receive.end(mono_now()));
    auto recorded = record_all(options, **receiver, *writer);
    (*receiver)->stop();
    (*receiver)->join();
    auto closed = writer->close();
    if (!recorded) return fail(recorded.error());
    if (!closed) return fail(closed.error());
    say(common, fmt::format("{}: {} frames, {} bytes", options.file, writer->records(), writer->size()));
    say_losses(common, (*receiver)->totals());
    if (const auto* error = (*receiver)->error()) return fail(*error);
    return Signals::status(Exit::done);
}

}  // namespace

Run declare_record(CLI::App& command, const Common& common) {
    auto options = std::make_shared<Options>();
    options->receive.declare(command);
    options->selection.declare(command);
    command.add_option("-o,--output", options->file, "the file to write; an existing one is first renamed FILE.1")
        ->required()
        ->type_name("FILE");
    command.footer(
        "Records every good frame with the kernel's receive time, in the tlog format (docs/formats/tlog.md).\n\n"
        "Example:\n  mavloom record udpin://0.0.0.0:14550 -o flight.tlog --for 10m");
    return [options, &common] { return record(common, *options); };
}

}  // namespace mavloom::app
