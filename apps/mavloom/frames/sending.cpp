// SPDX-License-Identifier: MIT
#include "frames/sending.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "mavloom/base/counted.hpp"

namespace mavloom::app {

namespace {

void log_renamed(const Common& common, const record::RotatingWriter& file) {
    if (const auto old = file.renamed_to(); !old.empty())
        print_notice(common, fmt::format("{} exists and is now {}", file.path().string(), old.string()));
}

void log_sums(const Common& common, const feed::Delivery& sums) {
    const auto frames = [&](std::uint64_t count, std::string_view what) {
        if (count != 0) print_notice(common, fmt::format("{}: {} {}", sums.name, counted(count, "frame"), what));
    };
    print_notice(common,
                 fmt::format("{}: {}, {} sent", sums.name, counted(sums.frames, "frame"), counted(sums.bytes, "byte")));
    frames(sums.dropped, "dropped: the far side was too slow or disconnected");
    frames(sums.refused, "refused: no program listens there, or the host cannot be reached");
    frames(sums.not_sent, "not sent: the system refused them");
    frames(sums.nobody_there, "not sent: there was no peer");
    if (sums.queued_bytes != 0)
        print_notice(common, fmt::format("{}: {} still queued at the end, not sent", sums.name,
                                         counted(sums.queued_bytes, "byte")));
}

}  // namespace

SetupResult<record::RotatingWriter> create_recording(const Common& common, const endpoint::Endpoint& endpoint,
                                                     std::string_view option) {
    auto file = feed::create_recording(endpoint);
    if (!file) return tl::unexpected(std::move(file.error()).within(option));
    log_renamed(common, *file);
    return file;
}

SetupResult<feed::Destinations> open_destinations(const Common& common, std::span<const endpoint::Endpoint> to,
                                                  link::Links& links) {
    auto all = feed::Destinations::open(to, links, [&](const auto& file) { log_renamed(common, file); });
    if (!all) return tl::unexpected(std::move(all.error()).within("--to"));
    for (const auto& info : links.endpoints())
        if (all->has(info.id) && info.local_port != 0 && info.endpoint.address.port == 0)
            print_notice(common, fmt::format("{}: on port {}", info.endpoint.label(), info.local_port));
    return all;
}

void log_sums(const Common& common, const feed::Destinations& destinations) {
    for (const auto& sums : destinations.deliveries()) log_sums(common, sums);
    for (const auto& file : destinations.files()) log_recorded(common, file);
}

Json sums_json(const feed::Destinations& destinations) {
    auto all = Json::array();
    for (const auto& sums : destinations.deliveries())
        all.push_back({{"endpoint", sums.name},
                       {"frames", sums.frames},
                       {"bytes", sums.bytes},
                       {"dropped", sums.dropped},
                       {"refused", sums.refused},
                       {"not_sent", sums.not_sent},
                       {"nobody_there", sums.nobody_there},
                       {"queued_bytes", sums.queued_bytes}});
    for (const auto& file : destinations.files()) all.push_back(recorded_json(file));
    return all;
}

void log_recorded(const Common& common, const record::RotatingWriter& file) {
    const auto files = file.segments() == 1 ? std::string() : fmt::format(" in {} files", file.segments());
    print_notice(common,
                 fmt::format("{}: {}, {} written{}", file.path().string(), counted(file.written_records(), "frame"),
                             counted(file.written_bytes(), "byte"), files));
    if (file.lost_records() != 0)
        print_notice(common,
                     fmt::format("{}: {} not written", file.path().string(), counted(file.lost_records(), "frame")));
}

Json recorded_json(const record::RotatingWriter& file) {
    return {{"endpoint", file.path().string()},
            {"frames", file.written_records()},
            {"bytes", file.written_bytes()},
            {"not_written", file.lost_records()},
            {"files", file.segments()}};
}

}  // namespace mavloom::app
