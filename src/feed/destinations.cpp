// SPDX-License-Identifier: MIT
#include "mavloom/feed/destinations.hpp"

#include <algorithm>
#include <limits>

#include "mavloom/endpoint/checks.hpp"
#include "mavloom/fault/faults.hpp"

namespace mavloom::feed {

SetupResult<record::RotatingWriter> create_recording(const endpoint::Endpoint& endpoint) {
    if (auto good = endpoint::check_written(endpoint); !good) return tl::unexpected(std::move(good.error()));
    return record::RotatingWriter::create(endpoint.path, {endpoint.options.rotate_bytes, endpoint.options.rotate_every});
}

SetupResult<Destinations> Destinations::open(std::span<const endpoint::Endpoint> endpoints, link::Links& links,
                                             const OnFile& on_file) {
    Destinations all(links);
    for (const bool opens_files : {false, true})
        for (const auto& endpoint : endpoints) {
            if (endpoint.is_recording() != opens_files) continue;
            auto added = opens_files ? all.add_file(endpoint, on_file) : all.add_link(endpoint);
            if (!added) return tl::unexpected(std::move(added.error()));
        }
    return all;
}

SetupResult<void> Destinations::add_link(const endpoint::Endpoint& endpoint) {
    auto id = fault::add(*links_, endpoint);
    if (!id) return tl::unexpected(std::move(id.error()));
    outputs_.push_back({*id, static_cast<std::size_t>(endpoint.options.queue_bytes)});
    return {};
}

SetupResult<void> Destinations::add_file(const endpoint::Endpoint& endpoint, const OnFile& on_file) {
    auto file = create_recording(endpoint);
    if (!file) return tl::unexpected(std::move(file.error()));
    files_.push_back(std::move(*file));
    if (on_file) on_file(files_.back());
    return {};
}

bool Destinations::send(const wire::FrameView& frame, WallTime time) {
    std::size_t takers = 0;
    ++given_;
    for (auto& output : outputs_) {
        const std::size_t taken = links_->send(output.endpoint, frame);
        output.nobody_there += taken == 0;
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

void Destinations::maintain_files(MonoTime now, const OnNotice& on_notice) {
    for (auto& file : files_) report_removed(file, file.maintain(now), on_notice);
}

void Destinations::report_removed(const record::RotatingWriter& file, SetupResult<std::filesystem::path> removed,
                                  const OnNotice& on_notice) {
    if (!removed) keep(tl::unexpected(std::move(removed.error())));
    else if (!removed->empty()) on_notice(file.removal_notice(*removed));
}

void Destinations::keep(SetupResult<void> result) {
    if (!result && !failure_) failure_ = std::move(result.error());
}

SetupResult<void> Destinations::close(const OnNotice& on_notice) {
    for (auto& file : files_) report_removed(file, file.close(), on_notice);
    if (failure_) return tl::unexpected(*failure_);
    return {};
}

std::size_t Destinations::room_in_frames() const {
    constexpr std::size_t largest_in_queue = 512;  // the longest frame plus the overhead of the queue
    std::size_t room = std::numeric_limits<std::size_t>::max();
    for (const auto& output : outputs_) {
        const std::size_t used = links_->queued_bytes(output.endpoint);
        room = std::min(room, used >= output.queue_bytes ? 0 : (output.queue_bytes - used) / largest_in_queue);
        if (used == 0) room = std::max<std::size_t>(room, 1);  // a queue smaller than that takes one frame at a time
    }
    return room;
}

bool Destinations::all_up() const {
    const auto links = links_->links();
    return std::ranges::all_of(outputs_, [&](const auto& output) {
        return std::ranges::any_of(links, [&](const auto& link) { return link.up && link.endpoint == output.endpoint; });
    });
}

bool Destinations::has(link::EndpointId endpoint) const noexcept {
    return std::ranges::find(outputs_, endpoint, &Output::endpoint) != outputs_.end();
}

std::vector<Delivery> Destinations::deliveries() const {
    const auto endpoints = links_->endpoints();
    const auto links = links_->links();
    std::vector<Delivery> all;
    for (const auto& output : outputs_) {
        const auto& info = *std::ranges::find(endpoints, output.endpoint, &link::EndpointInfo::id);
        link::LinkCounters sums = info.counters->gone;
        for (const auto& link : links)
            if (link.endpoint == info.id) sums.add(*link.counters);
        all.push_back({.name = info.label(),
                       .frames = sums.frames_out.value(),
                       .bytes = sums.bytes_out.value(),
                       .dropped = sums.queue_bytes.value() + sums.queue_age.value() + info.counters->gone_queued.value(),
                       .refused = sums.refused.value(),
                       .not_sent = sums.frames_not_sent.value(),
                       .nobody_there = output.nobody_there,
                       .send_errors = info.counters->send_errors.value(),
                       .queued_bytes = links_->queued_bytes(info.id)});
    }
    return all;
}

bool Destinations::lost_any() const { return std::ranges::any_of(deliveries(), &Delivery::lost_any); }

bool Destinations::reached_no_destination() const {
    return files_.empty() && std::ranges::all_of(deliveries(), [](const auto& d) { return d.frames == 0; });
}

}  // namespace mavloom::feed
