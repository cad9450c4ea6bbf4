// SPDX-License-Identifier: MIT
#include "page/serving.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "frames/traffic_report.hpp"
#include "page/page_hop.hpp"

namespace mavloom::app {

static constexpr std::string_view lost_help = "frames that were sent, by their sequence numbers, and did not arrive";

// Of all senders of the link. A ring has no link of its own: what its frames' links lost was lost before it.
static std::uint64_t lost_on(LinkId link, const std::vector<feed::ReceivedLoss>& losses) {
    if (link == LinkId{}) return 0;
    std::uint64_t lost = 0;
    for (const auto& loss : losses) lost += loss.link == link ? loss.lost : 0;
    return lost;
}

void Serving::run() {
    while (going_ && receiver_.wait()) {
        pass_some(mono_now());
        audience_.flush();
        if (audience_.left_out() != 0 && !std::exchange(has_said_, true))
            print_event(common_, fmt::format("there are {} topics already; further ones are not served",
                                             web::Server::max_channels));
    }
    note_counts();
}

void Serving::pass_some(MonoTime now) {
    const auto wall = wall_now();
    for (int i = 0; i < frames_at_once && going_; ++i) {
        const auto entry = receiver_.next();
        if (!entry) return;
        if (options_.on_arrival) options_.on_arrival(entry->frame);
        if (!options_.filter.admits(entry->frame)) continue;
        if (options_.on_frame) options_.on_frame(entry->frame, entry->time);
        audience_.take({entry->frame, entry->link, receiver_.link_name(entry->link), entry->time, now,
                        observe::waited_since(entry->time, wall)});
        going_ = ++frames_ != options_.count;
    }
}

void Serving::note_counts() {
    const auto counts = receiver_.counts();
    observe::OwnCounts own{.frames = counts.totals.frames, .losses = loss_counts(counts.totals)};
    own.on_links.reserve(counts.losses.size());
    for (const auto& loss : counts.losses)
        own.on_links.push_back({loss.link, std::string(receiver_.name_of(loss.link)), loss.source, loss.received,
                                loss.lost, loss.late, loss.duplicate, loss.resync});
    own.links.reserve(counts.sources.size());
    std::uint64_t lost = counts.lost;
    for (const auto& source : counts.sources) {
        auto& link = own.links.emplace_back(hop_link_of(source));
        if (const auto its = lost_on(source.link, counts.losses); its != 0) {
            link.losses.push_back({"lost", its, std::string(lost_help)});
            lost -= std::min(lost, its);
        }
        if (source.has_ended) audience_.note_end(source.link);
    }
    own.losses.push_back({"lost", lost, std::string(lost_help)});  // on links that are gone
    audience_.note_counts(std::move(own));
}

SetupResult<std::unique_ptr<web::Server>> open_server(const dialect::Dialect& dialect, const endpoint::HostPort& place,
                                                      std::string_view option, web::Options access) {
    access.addresses = {*net::Address::parse(place.host, place.port)};
    auto server = web::Server::listen(dialect, access);
    if (server) return server;
    auto error = std::move(server.error()).within(option);
    if (error.code == SetupCode::in_use) error.text += fmt::format("; choose another with {}", option);
    return tl::unexpected(std::move(error));
}

std::string place_of(const net::Address& address, bool has_token) {
    const auto place = address.is_any() ? fmt::format("localhost:{}", address.port()) : address.text();
    return place + (has_token ? "/?token=TOKEN" : "");
}

}  // namespace mavloom::app
