// SPDX-License-Identifier: MIT
// `mavloom doctor [SOURCE...]`: states what is wrong with links or recordings.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "command.hpp"
#include "doctor/listening.hpp"
#include "doctor/reports.hpp"
#include "mavloom/endpoint/checks.hpp"
#include "mavloom/shm/counter_page.hpp"
#include "output.hpp"
#include "page/discovery.hpp"
#include "page/page_hop.hpp"
#include "signals.hpp"

namespace mavloom::app {

namespace {

struct DoctorOptions {
    std::vector<std::string> sources;
    std::string duration = "10s";
    bool json = false;
};

SetupResult<void> check_kinds(const std::vector<endpoint::Endpoint>& endpoints) {
    const auto recordings = std::ranges::count_if(endpoints, &endpoint::Endpoint::is_recording);
    if (recordings == 0 || static_cast<std::size_t>(recordings) == endpoints.size()) return {};
    return setup_error(SetupCode::usage,
                       "recordings and live sources have different times: examine them one after the other");
}

bool sends_to_one(const observe::Hop& hop, const std::vector<endpoint::Endpoint>& sources) {
    return std::ranges::any_of(hop.links, [&](const observe::HopLink& link) {
        const auto to = endpoint::parse_endpoint(link.destination());
        return to && std::ranges::any_of(sources, [&](const endpoint::Endpoint& source) {
                   return endpoint::leads_back(source, source.address.port, *to);
               });
    });
}

// Programs of this machine that send to the sources: frames may be lost in them.
void add_programs_before(const std::vector<endpoint::Endpoint>& sources, std::vector<HopReporter::Program>& programs) {
    for (const auto& name : shm::counter_page_names()) {
        const auto hop = hop_of_page(name);
        if (hop && sends_to_one(*hop, sources) &&
            std::ranges::find(programs, name, &HopReporter::Program::page) == programs.end())
            programs.push_back({name});
    }
}

SetupResult<std::unique_ptr<Listening>> open(const Common& common, DoctorOptions& options,
                                             const dialect::Dialect& dialect) {
    const auto asked = options.sources.empty() ? Listening::Asked::no : Listening::Asked::yes;
    auto running = find_sources(common, options.sources, {usual_source, second_source});
    if (!running && running.error().code != SetupCode::in_use) return tl::unexpected(std::move(running.error()));
    // If another program has the first port, that is a finding.
    if (options.sources.empty() || (asked == Listening::Asked::no && options.sources.front() == second_source))
        options.sources = {std::string(usual_source), std::string(second_source)};
    const auto endpoints = endpoint::parse_endpoints(options.sources);
    if (!endpoints) return tl::unexpected(endpoints.error());
    if (auto checked = check_kinds(*endpoints); !checked) return tl::unexpected(std::move(checked.error()));
    auto programs = programs_of(options.sources, running.value_or(Running{}));
    add_programs_before(*endpoints, programs);
    auto listening = Listening::create(common, dialect, std::move(programs));
    if (!listening) return listening;
    for (const auto& endpoint : *endpoints)
        if (auto added = (*listening)->add(endpoint, asked); !added)
            return tl::unexpected(endpoint.is_recording() ? of_input_file(std::move(added.error()))
                                                          : std::move(added.error()));
    return listening;
}

// https://no-color.org
TextStyle style_of_output() {
    constexpr int widest = 120;
    const char* const terminal = std::getenv("TERM");
    const bool is_dumb = terminal == nullptr || std::string_view(terminal) == "dumb";
    return {std::min(width_of_output(80), widest), ::isatty(STDOUT_FILENO) == 1 && wants_color() && !is_dumb};
}

Exit doctor(const Common& common, DoctorOptions& options) {
    const auto dialect = load_dialect(common);
    if (!dialect) return fail(dialect.error());
    const auto time = endpoint::parse_duration(options.duration);
    if (!time) return fail(SetupError(time.error()).within("--for"));
    const auto listening = open(common, options, *dialect);
    if (!listening) return fail(listening.error());
    {
        const Signals signals([](void* its) noexcept { static_cast<Listening*>(its)->stop(); }, listening->get());
        (*listening)->run(*time);
        if (const auto* const error = (*listening)->error()) return fail(of_input_file(*error));
        const auto evidence = (*listening)->evidence();
        const auto findings = observe::diagnose(evidence);
        const auto status = findings.empty() ? Exit::done : Exit::mismatch;
        return print_at_end(
            options.json ? doctor_json(evidence, findings) : doctor_text(evidence, findings, style_of_output()),
            Signals::status(status));
    }
}

}  // namespace

Run declare_doctor(Arguments command, const Common& common) {
    auto options = std::make_shared<DoctorOptions>();
    command.add_option("source", "SOURCE", options->sources,
                       "what to examine: udpin://0.0.0.0:14550, serial:///dev/ttyUSB0, shm://NAME, flight.tlog, ... "
                       "(docs/guide/endpoints.md); with two sources, also what is lost between them");
    command
        .add_option("--for", "TIME", options->duration, "listen for this time: 10s, 500ms; recordings are read whole")
        .capture_default_str();
    command.add_flag("--json", options->json, "print one JSON object");
    command.footer(
        "Listens, then says in sentences what is wrong, where, why, and what to do (docs/guide/doctor.md).\n"
        "Without SOURCE, it reads the rings of this machine and the counters of routers, or listens on\n"
        "udpin://0.0.0.0:14550 and 14540. It sends no frame.\n\n"
        "Examples:\n"
        "  mavloom doctor udpin://0.0.0.0:14550\n"
        "  mavloom doctor serial:///dev/ttyUSB0?baud=57600 --for 30s\n"
        "  mavloom doctor before.tlog after.tlog\n\n"
        "Exit status: 0 nothing is wrong, 4 something was found, 3 a recording cannot be read.");
    return [options, &common] { return doctor(common, *options); };
}

}  // namespace mavloom::app
