// SPDX-License-Identifier: MIT
#include "tallies.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "mavloom/shm/counter_page.hpp"
#include "mavloom/shm/ring_info.hpp"
#include "page/page_hop.hpp"

namespace mavloom::app::demo_parts {

namespace {

using Json = nlohmann::ordered_json;
using observe::NamedCount;

// Of the router's link to the listener.
constexpr std::array<std::string_view, 3> queue_losses{"queue_bytes", "queue_age", "frames_not_sent"};
constexpr std::array listener_losses{LossName{"kernel_drop", "dropped by the kernel: the receive buffer was full"},
                                     LossName{"crc_error", "with a wrong checksum"},
                                     LossName{"missed", "missed because the ring was full"}};
// While the listener runs, these are on their way.
constexpr LossName not_written{"not_written", "not written because the program ended"};
constexpr std::array relay_losses{LossName{"lapped", "overwritten in the ring before they were read"},
                                  LossName{"bad_records", "in the ring without a whole valid frame"}};
constexpr LossName while_stopped{"stopped", "sent to this hop while it was stopped"};
constexpr LossName unexplained{"missing", "sent to this hop, and not sent on"};

void raise(std::uint64_t& count, std::uint64_t to) { count = std::max(count, to); }

void set_loss(Tally& tally, const LossName& loss, std::uint64_t count) {
    const auto at = std::ranges::find(tally.losses, loss.name, &NamedCount::name);
    if (at != tally.losses.end()) raise(at->count, count);
    else if (count != 0) tally.losses.push_back({std::string(loss.name), count, std::string(loss.help)});
}

// The value of a counter that is not of a link; 0 if the page does not have it.
std::uint64_t value_of(const shm::CounterSnapshot& page, std::string_view label) {
    const auto at = std::ranges::find_if(page.counters,
                                         [&](const shm::CounterValue& c) { return !c.link && c.label == label; });
    return at == page.counters.end() ? 0 : at->value;
}

// Calls take(link's name, label, value) for each counter of each link.
template <class Take>
void each_of_links(const shm::CounterSnapshot& page, Take take) {
    for (const auto& counter : page.counters) {
        if (!counter.link) continue;
        const auto name = page.links.find(*counter.link);
        if (name != page.links.end())
            take(std::string_view(name->second), std::string_view(counter.label), counter.value);
    }
}

// The last line with statistics that a program printed. Null if there is none yet.
Json last_stats(const Child* program) {
    if (program == nullptr) return {};
    const auto object = Json::parse(last_line(program->printed()), nullptr, false);
    return object.is_object() ? object.value("stats", Json()) : Json();
}

std::uint64_t number_at(const Json& object, std::string_view key) {
    const auto at = object.is_object() ? object.find(key) : object.end();
    return at != object.end() && at->is_number_unsigned() ? at->get<std::uint64_t>() : 0;
}

}  // namespace

Tallies::Tallies(const Chain& chain, const Places& places, bool is_simulated)
    : chain_(chain), places_(places), is_simulated_(is_simulated) {
    std::ranges::transform(stage_names, tallies_.begin(), [](std::string_view name) { return Tally{.name = name}; });
    tallies_.front().waits = !is_simulated;
    tallies_.back().name = station_name;
}

void Tallies::look(std::uint64_t arrived) {
    const Sent before = sent();
    read(arrived);
    judge(before, false);
}

void Tallies::read(std::uint64_t arrived) {
    for (std::size_t i = 0; i < stage_names.size(); ++i) tallies_[i].is_up = chain_.is_up(static_cast<Stage>(i));
    look_at_vehicle();
    look_at_router();
    look_at_listener();
    look_at_ring();
    look_at_relay();
    tallies_.back().in = arrived;
    raise(at(Stage::relay).out, arrived);
    raise(at(Stage::relay).in, arrived);
}

void Tallies::settle() { judge(sent(), true); }

void Tallies::look_at_vehicle() {
    if (!is_simulated_) return;
    const auto page = shm::read_counters(places_.simulator_name());
    if (!page) return;
    raise(at(Stage::vehicle).out, value_of(*page, "frames_sent"));
    set_loss(at(Stage::vehicle), {"gaps", "numbered, but not sent"}, value_of(*page, "gaps"));
}

// A real vehicle's frames are those that the router heard. Links that are closed count among the others.
void Tallies::look_at_router() {
    const auto page = shm::read_counters(places_.router_name());
    if (!page) return;
    std::uint64_t heard = 0, lost = 0, sent = 0, answers = 0;
    heard = value_of(*page, "others_frames_in");
    lost = value_of(*page, "others_lost");
    each_of_links(*page, [&](std::string_view link, std::string_view label, std::uint64_t value) {
        const bool is_listener = link == stage_names[static_cast<std::size_t>(Stage::listener)];
        if (label == "frames_in") (is_listener ? answers : heard) += value;
        if (label == "lost" && !is_listener) lost += value;
        if (is_listener && (label == "frames_out" || label == "refused")) sent += value;
        if (!is_listener) return;
        if (std::ranges::find(queue_losses, label) != queue_losses.end())
            set_loss(at(Stage::router), *std::ranges::find(link_losses, label, &LossName::name), value);
    });
    // The counters of an endpoint leave the page with it (Chain::stop_vehicle).
    if (!is_simulated_) raise(heard, sent);
    raise(at(Stage::router).in, heard);
    raise(at(Stage::router).out, sent);
    raise(answers_, answers);
    if (is_simulated_) return;
    raise(at(Stage::vehicle).out, heard);
    at(Stage::vehicle).is_up = at(Stage::vehicle).out != 0;
    at(Stage::vehicle).waits = !at(Stage::vehicle).is_up;
    set_loss(at(Stage::vehicle), {"lost", "missing in the sequence numbers that the router heard"}, lost);
}

void Tallies::look_at_listener() {
    const auto stats = last_stats(chain_.program(Stage::listener));
    raise(at(Stage::listener).in, number_at(stats, "frames_in"));
    raise(at(Stage::listener).out, number_at(stats, "written"));
    for (const auto& loss : listener_losses) set_loss(at(Stage::listener), loss, number_at(stats, loss.name));
    if (!chain_.is_up(Stage::listener)) set_loss(at(Stage::listener), not_written, number_at(stats, not_written.name));
}

// The ring has what the listener wrote, and how far the relay has read.
void Tallies::look_at_ring() {
    const auto ring = shm::ring_status(places_.name);
    if (!ring || ring->damaged) return;
    raise(at(Stage::listener).out, ring->records);
    raise(at(Stage::listener).in, ring->records);
    const Child* const relay = chain_.program(Stage::relay);
    for (const auto& reader : ring->readers)
        if (relay != nullptr && static_cast<pid_t>(reader.pid) == relay->pid())
            raise(at(Stage::relay).in, ring->records - std::min(ring->records, reader.behind_records));
}

// The relay prints its statistics at its end.
void Tallies::look_at_relay() {
    const auto stats = last_stats(chain_.program(Stage::relay));
    if (!stats.is_object()) return;
    raise(at(Stage::relay).in, number_at(stats.value("edit", Json()), "frames"));
    for (const auto& loss : relay_losses)
        set_loss(at(Stage::relay), loss, number_at(stats.value("totals", Json()), loss.name));
}

// The frames that each hop sent on. The last counts of one that is stopped may be older than what the next one heard.
Tallies::Sent Tallies::sent() const {
    Sent all{};
    all.back() = tallies_.back().in;
    for (std::size_t i = 0; i + 1 < hop_count; ++i)
        all[i] = tallies_[i].is_up ? tallies_[i].out : std::max(tallies_[i].out, tallies_[i + 1].in);
    return all;
}

void Tallies::judge(const Sent& before, bool is_settled) {
    const Sent now = sent();
    std::ranges::rotate(missing_, missing_.end() - 1);
    for (std::size_t i = 1; i < hop_count; ++i) {
        const std::uint64_t difference = before[i - 1] - std::min(before[i - 1], now[i]);
        missing_.front()[i] = difference;
        tallies_[i].lost = is_settled ? difference : missing_for_long(i);
    }
    for (std::size_t i = 0; i < hop_count; ++i) {
        name_losses(tallies_[i]);
        if (tallies_[i].is_up || i + 1 == hop_count) continue;
        raise(tallies_[i].out, now[i]);  // its last counts may be older
        if (i != 0) raise(tallies_[i].in, now[i]);
    }
}

// The least of the last looks: a page that is late on a busy machine is no loss.
std::uint64_t Tallies::missing_for_long(std::size_t hop) const {
    const std::size_t looks = tallies_[hop].is_up ? missing_.size() : 2;
    std::uint64_t least = missing_.front()[hop];
    for (std::size_t i = 1; i < looks; ++i) least = std::min(least, missing_[i][hop]);
    return least;
}

// The names of what was lost without a name of the program's own.
void Tallies::name_losses(Tally& tally) const {
    std::erase_if(tally.losses, [](const NamedCount& loss) {
        return loss.name == while_stopped.name || loss.name == unexplained.name;
    });
    std::uint64_t named = 0;
    for (const auto& loss : tally.losses) named += loss.count;
    if (&tally == &tallies_.front()) tally.lost = named;
    else if (tally.lost > named) set_loss(tally, tally.is_up ? unexplained : while_stopped, tally.lost - named);
}

bool Tallies::are_up() const noexcept {
    return std::all_of(tallies_.begin(), tallies_.end() - 1, [](const Tally& tally) { return tally.is_up; });
}

bool Tallies::are_equal() const noexcept {
    const auto frames = tallies_.front().out;
    return frames != 0 && tallies_.back().in == frames &&
           std::ranges::all_of(tallies_.begin() + 1, tallies_.end() - 1,
                               [&](const Tally& t) { return t.in == frames && t.out == frames; });
}

bool Tallies::are_whole() const noexcept {
    const auto is_good = [&](const Tally& tally) {
        if (tally.name == station_name) return tally.lost == 0;
        return tally.is_up && (tally.lost == 0 || (&tally == &tallies_.front() && !is_simulated_));
    };
    return tallies_.back().in != 0 && std::ranges::all_of(tallies_, is_good);
}

// ---- reports --------------------------------------------------------------------------------------------------------

std::vector<observe::Hop> hops_of(const Tallies& tallies) {
    using Kind = observe::Hop::Kind;
    const auto vehicle = tallies.is_simulated() ? Kind::sim : Kind::source;
    const std::array<Kind, hop_count> kinds{vehicle, Kind::router, Kind::listener, Kind::relay, Kind::station};
    std::vector<observe::Hop> hops;
    for (std::size_t i = 0; i < hop_count; ++i) {
        const Tally& tally = tallies.all()[i];
        hops.push_back({.name = std::string(tally.name),
                        .kind = kinds[i],
                        .is_up = tally.is_up,
                        .frames_in = tally.in,
                        .frames_out = tally.out,
                        .losses = tally.losses,
                        .hint = tally.hint});
    }
    return hops;
}

Json json_of(const Tallies& tallies) {
    Json hops = Json::array();
    for (const Tally& tally : tallies.all()) {
        Json losses = Json::array();
        for (const auto& loss : tally.losses) losses.push_back({{"name", loss.name}, {"count", loss.count}});
        hops.push_back({{"name", tally.name},
                        {"state", tally.is_up ? "up" : "down"},
                        {"frames_in", tally.in},
                        {"frames_out", tally.out},
                        {"lost", tally.lost},
                        {"losses", std::move(losses)},
                        {"hint", tally.hint.empty() ? Json() : Json(tally.hint)}});
    }
    return hops;
}

}  // namespace mavloom::app::demo_parts
