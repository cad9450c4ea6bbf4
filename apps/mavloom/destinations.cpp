// SPDX-License-Identifier: MIT
#include "destinations.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace mavloom::app {

SetupResult<Destinations> Destinations::open(const Common& common, const std::vector<std::string>& addresses, runtime::Links& links) {
    Destinations all(links);
    for (const auto& address : addresses) {
        const auto endpoint = runtime::parse_endpoint(address);
        if (!endpoint) return tl::unexpected(SetupError(endpoint.error()).within("--to"));
        const auto id = links.add(*endpoint);
        if (!id) return tl::unexpected(id.error());
        all.endpoints_.push_back(*id);
        all.queue_bytes_.push_back(endpoint->options.queue_bytes);
    }
    for (const auto& info : links.endpoints())
        if (all.has(info.id) && info.local_port != 0 && info.endpoint.address.port == 0)
            say(common, fmt::format("{}: on port {}", info.endpoint.label(), info.local_port));
    return all;
}

bool Destinations::send(const wire::FrameView& frame) {
    std::size_t takers = 0;
    for (const auto id : endpoints_) takers += links_->send(id, frame);
    takers == 0 ? ++nobody_there_ : ++sent_;
    return takers != 0;
}

bool Destinations::have_room() const {
    for (std::size_t i = 0; i < endpoints_.size(); ++i)
        if (links_->queued_bytes(endpoints_[i]) > queue_bytes_[i] / 4) return false;
    return true;
}

bool Destinations::all_up() const {
    const auto links = links_->links();
    return std::ranges::all_of(endpoints_, [&](auto id) {
        return std::ranges::any_of(links, [&](const auto& link) { return link.up && link.endpoint == id; });
    });
}

bool Destinations::has(runtime::EndpointId endpoint) const noexcept { return std::ranges::find(endpoints_, endpoint) != endpoints_.end(); }

void Destinations::say_sums(const Common& common) const {
    for (const auto& link : links_->links()) {
        if (!has(link.endpoint)) continue;
        const auto& c = *link.counters;
        say(common, fmt::format("{}: {} frames, {} bytes sent", link.name, c.frames_out.value(), c.bytes_out.value()));
        const auto dropped = c.queue_bytes.value() + c.queue_age.value();
        if (dropped != 0) say(common, fmt::format("{}: {} frames dropped, the far side was too slow", link.name, dropped));
    }
    if (nobody_there_ != 0) say(common, fmt::format("{} frames not sent: nobody was there", nobody_there_));
}

}  // namespace mavloom::app
