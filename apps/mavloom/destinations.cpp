// SPDX-License-Identifier: MIT
#include "destinations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "counted.hpp"

namespace mavloom::app {

SetupResult<record::RotatingWriter> create_recording(const Common& common, const endpoint::Endpoint& endpoint,
                                                     std::string_view option) {
    const auto& options = endpoint.options;
    if (options.speed)
        return setup_error(SetupCode::usage,
                           fmt::format("{} {}: 'speed' is for a recording that is read; this one is written", option,
                                       endpoint.label()));
    auto file = record::RotatingWriter::create(endpoint.path, {options.rotate_bytes, options.rotate_every});
    if (!file) return tl::unexpected(std::move(file.error()).within(option));
    if (const auto old = file->renamed_to(); !old.empty())
        say(common, fmt::format("{} exists and is now {}", endpoint.path, old.string()));
    return file;
}

void say_recorded(const Common& common, const record::RotatingWriter& file) {
    const auto files = file.segments() == 1 ? std::string() : fmt::format(" in {} files", file.segments());
    say(common, fmt::format("{}: {}, {} written{}", file.path().string(), counted(file.written_records(), "frame"),
                            counted(file.written_bytes(), "byte"), files));
    if (file.lost_records() != 0)
        say(common, fmt::format("{}: {} not written", file.path().string(), counted(file.lost_records(), "frame")));
}

Json recorded_json(const record::RotatingWriter& file) {
    return {{"endpoint", file.path().string()},
            {"frames", file.written_records()},
            {"bytes", file.written_bytes()},
            {"not_written", file.lost_records()},
            {"files", file.segments()}};
}

SetupResult<Destinations> Destinations::open(const Common& common, const std::vector<std::string>& addresses,
                                             link::Links& links) {
    Destinations all(links);
    std::vector<endpoint::Endpoint> endpoints;
    for (const auto& address : addresses) {
        auto endpoint = endpoint::parse_endpoint(address);
        if (!endpoint) return tl::unexpected(std::move(endpoint.error()).within("--to"));
        endpoints.push_back(std::move(*endpoint));
    }
    // Files come last, because creating one renames an existing file. That must not happen if another address fails.
    std::ranges::stable_partition(endpoints, [](const auto& e) { return e.scheme != endpoint::Scheme::tlog; });
    for (const auto& endpoint : endpoints)
        if (auto added = all.add(common, endpoint); !added) return tl::unexpected(std::move(added.error()));
    for (const auto& info : links.endpoints())
        if (all.has(info.id) && info.local_port != 0 && info.endpoint.address.port == 0)
            say(common, fmt::format("{}: on port {}", info.endpoint.label(), info.local_port));
    return all;
}

SetupResult<void> Destinations::add(const Common& common, const endpoint::Endpoint& endpoint) {
    const auto& options = endpoint.options;
    if (endpoint.scheme != endpoint::Scheme::tlog) {
        const auto id = links_->add(endpoint);
        if (!id) return tl::unexpected(id.error());
        endpoints_.push_back(*id);
        queue_bytes_.push_back(options.queue_bytes);
        nobody_there_.push_back(0);
        return {};
    }
    auto file = create_recording(common, endpoint, "--to");
    if (!file) return tl::unexpected(std::move(file.error()));
    files_.push_back(std::move(*file));
    return {};
}

bool Destinations::send(const wire::FrameView& frame, WallTime time) {
    std::size_t takers = 0;
    ++given_;
    for (std::size_t i = 0; i < endpoints_.size(); ++i) {
        const std::size_t taken = links_->send(endpoints_[i], frame);
        nobody_there_[i] += taken == 0;
        takers += taken;
    }
    for (auto& file : files_) {
        auto written = file.write(time, frame);
        takers += written.has_value();
        keep(std::move(written));
    }
    sent_ += takers != 0;
    return takers != 0;
}

void Destinations::keep(SetupResult<void> result) {
    if (!result && !failure_) failure_ = std::move(result.error());
}

SetupResult<void> Destinations::close() {
    for (auto& file : files_) keep(file.close());
    if (failure_) return tl::unexpected(*failure_);
    return {};
}

std::size_t Destinations::room_in_frames() const {
    constexpr std::size_t largest_in_queue = 512;  // the longest frame plus the overhead of the queue
    std::size_t room = std::numeric_limits<std::size_t>::max();
    for (std::size_t i = 0; i < endpoints_.size(); ++i) {
        const std::size_t used = links_->queued_bytes(endpoints_[i]);
        room = std::min(room, used >= queue_bytes_[i] ? 0 : (queue_bytes_[i] - used) / largest_in_queue);
        if (used == 0) room = std::max<std::size_t>(room, 1);  // a queue smaller than that takes one frame at a time
    }
    return room;
}

bool Destinations::all_up() const {
    const auto links = links_->links();
    return std::ranges::all_of(endpoints_, [&](auto id) {
        return std::ranges::any_of(links, [&](const auto& link) { return link.up && link.endpoint == id; });
    });
}

bool Destinations::has(link::EndpointId endpoint) const noexcept {
    return std::ranges::find(endpoints_, endpoint) != endpoints_.end();
}

// Sums over the links that are there and those that are gone.
Destinations::Sums Destinations::sums_of(const link::EndpointInfo& info) const {
    link::LinkCounters all = info.counters->gone;
    for (const auto& link : links_->links())
        if (link.endpoint == info.id) all.add(*link.counters);
    return {all.frames_out.value(),
            all.bytes_out.value(),
            all.queue_bytes.value() + all.queue_age.value() + info.counters->gone_queued.value(),
            all.refused.value(),
            all.frames_not_sent.value(),
            info.counters->send_errors.value()};
}

bool Destinations::lost_any() const {
    const auto endpoints = links_->endpoints();
    return std::ranges::any_of(endpoints,
                               [&](const auto& info) {
                                   return has(info.id) && (sums_of(info).dropped != 0 || sums_of(info).came_back != 0 ||
                                                           links_->queued_bytes(info.id) != 0);
                               }) ||
           std::ranges::any_of(nobody_there_, [](auto frames) { return frames != 0; });
}

bool Destinations::reached_nobody() const {
    const auto endpoints = links_->endpoints();
    return files_.empty() &&
           std::ranges::none_of(endpoints, [&](const auto& info) { return has(info.id) && sums_of(info).frames != 0; });
}

void Destinations::say_sums(const Common& common) const {
    const auto endpoints = links_->endpoints();
    for (std::size_t i = 0; i < endpoints_.size(); ++i) {
        const auto& info = *std::ranges::find(endpoints, endpoints_[i], &link::EndpointInfo::id);
        const auto sums = sums_of(info);
        const auto name = info.label();
        say(common, fmt::format("{}: {}, {} sent", name, counted(sums.frames, "frame"), counted(sums.bytes, "byte")));
        if (sums.dropped != 0)
            say(common,
                fmt::format("{}: {} dropped, the far side was too slow or went", name, counted(sums.dropped, "frame")));
        if (sums.refused != 0)
            say(common, fmt::format("{}: {} refused: nobody listens there, or it cannot be reached", name,
                                    counted(sums.refused, "frame")));
        if (sums.not_sent != 0)
            say(common, fmt::format("{}: {} not sent, the system refused them", name, counted(sums.not_sent, "frame")));
        if (nobody_there_[i] != 0)
            say(common, fmt::format("{}: {} not sent, nobody was there", name, counted(nobody_there_[i], "frame")));
        if (const auto left = links_->queued_bytes(info.id); left != 0)
            say(common, fmt::format("{}: {} still queued at the end, not sent", name, counted(left, "byte")));
    }
    for (const auto& file : files_) say_recorded(common, file);
}

Json Destinations::sums_json() const {
    auto all = Json::array();
    const auto endpoints = links_->endpoints();
    for (std::size_t i = 0; i < endpoints_.size(); ++i) {
        const auto& info = *std::ranges::find(endpoints, endpoints_[i], &link::EndpointInfo::id);
        const auto sums = sums_of(info);
        all.push_back({{"endpoint", info.label()},
                       {"frames", sums.frames},
                       {"bytes", sums.bytes},
                       {"dropped", sums.dropped},
                       {"refused", sums.refused},
                       {"not_sent", sums.not_sent},
                       {"nobody_there", nobody_there_[i]},
                       {"queued_bytes", links_->queued_bytes(info.id)}});
    }
    for (const auto& file : files_) all.push_back(recorded_json(file));
    return all;
}

}  // namespace mavloom::app
