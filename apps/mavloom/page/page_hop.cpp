// SPDX-License-Identifier: MIT
#include "page/page_hop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <string_view>

#include "mavloom/link/links.hpp"

namespace mavloom::app {

namespace {

using observe::Hop;
using observe::HopLink;
using observe::NamedCount;

constexpr std::string_view others_prefix = "others_";  // of links that have no counters of their own

constexpr std::array program_losses{LossName{"unknown_target", "frames for a system that was not heard on any link"},
                                    LossName{"ring_dropped", "frames that are not in the ring"},
                                    LossName{"gaps", "frames that vehicles numbered and that were not sent"}};

template <class Names>
void add_loss(std::vector<NamedCount>& losses, const Names& names, std::string_view label, std::uint64_t value) {
    const auto name = std::ranges::find(names, label, &LossName::name);
    if (name != names.end() && value != 0) losses.push_back({std::string(name->name), value, std::string(name->help)});
}

void count(HopLink& link, std::string_view label, std::uint64_t value) {
    if (label == "frames_in") link.frames_in = value;
    else if (label == "frames_out") link.frames_out = value;
    else if (label == "bytes_in") link.bytes_in = value;
    else if (label == "bytes_out") link.bytes_out = value;
    else if (label == "up") link.is_up = value != 0;
    else if (label == "refused") link.refused = value;
    else if (label == "queued_bytes") link.queued_bytes = value;
    else if (label == "queue_limit_bytes") link.queue_limit_bytes = value;
    else add_loss(link.losses, link_losses, label, value);
}

// A simulator sends to its ring as to a link. Of the hop, that is not one more frame: other links get the same ones.
void add_ring(Hop& hop, std::uint64_t records) {
    if (records == 0) return;
    hop.links.push_back({.name = "its ring", .is_up = hop.is_up, .frames_out = records});
    hop.frames_out = std::max(hop.frames_out, records);
}

}  // namespace

HopLink hop_link_of(const feed::Receiver::OfSource& source) {
    HopLink link{.name = source.name, .is_up = source.is_up, .has_ended = source.has_ended};
    for (const auto& its : source.counts) count(link, its.name, its.value);
    link.losses.clear();
    return link;
}

bool is_of_simulator(const shm::CounterSnapshot& page) {
    return std::ranges::any_of(page.counters, [](const auto& c) { return !c.link && c.label == "vehicles"; });
}

Hop hop_of(const std::string& name, const shm::CounterSnapshot& page) {
    const bool is_sim = is_of_simulator(page);
    Hop hop{.name = name, .kind = is_sim ? Hop::Kind::sim : Hop::Kind::router, .is_up = page.owner_alive};
    std::map<LinkId, HopLink> links;
    HopLink others{.name = "all other links, and closed links", .is_sum = true};
    std::uint64_t ring_records = 0;
    for (const auto& counter : page.counters) {
        const std::string_view label = counter.label;
        if (counter.link) count(links[*counter.link], label, counter.value);
        else if (label.starts_with(others_prefix)) count(others, label.substr(others_prefix.size()), counter.value);
        else if (label == "ring_records") ring_records = counter.value;
        else add_loss(hop.losses, program_losses, label, counter.value);
    }
    for (auto& [id, link] : links) {
        if (const auto known = page.links.find(id); known != page.links.end()) link.name = known->second;
        if (const auto known = page.sends_to.find(id); known != page.sends_to.end()) link.sends_to = known->second;
        hop.links.push_back(std::move(link));
    }
    if (others.frames_in + others.frames_out != 0) hop.links.push_back(std::move(others));
    for (auto& link : hop.links) {
        link.is_up = link.is_up && hop.is_up;
        hop.frames_in += link.frames_in;
        hop.frames_out += link.frames_out;
    }
    add_ring(hop, is_sim ? ring_records : 0);
    return hop;
}

std::optional<Hop> hop_of_page(const std::string& name) {
    const auto page = shm::read_counters(name, {.user = link::Links::owner_of_inlets()});
    return page ? std::optional(hop_of(name, *page)) : std::nullopt;
}

}  // namespace mavloom::app
