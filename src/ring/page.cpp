// SPDX-License-Identifier: MIT
#include "mavloom/ring/page.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "mavloom/route/engine.hpp"

namespace mavloom::ring {

static_assert(RingPage::max_gone < route::Engine::max_links);

static void set(Counter* counter, std::uint64_t value) noexcept {
    if (counter != nullptr) counter->set(value);
}

SetupResult<RingPage> RingPage::create(const std::string& ring, unsigned mode) {
    constexpr std::uint32_t of_ring = 32, gauges_of_row = 3;
    shm::CounterPageOptions options;
    options.counters = of_ring + max_own_counts + (paged_counters.size() + gauges_of_row) * max_rows;
    options.links = route::Engine::max_links;
    options.mode = mode;
    options.sets_aside = true;
    auto page = shm::CounterPage::create(ring, options);
    if (!page) return tl::unexpected(std::move(page.error()));
    return RingPage(std::move(*page));
}

RingPage::RingPage(shm::CounterPage page)
    : page_(std::move(page)),
      records_(page_.add("ring_records")),
      dropped_(page_.add("ring_dropped")),
      links_(page_.add("links", shm::CounterType::gauge)),
      stray_bytes_(page_.add("inlet_stray_bytes")),
      refused_(page_.add("inlet_refused")),
      evicted_(page_.add("inlet_evicted")) {
    others_ = add_words("others_", shm::CounterType::gauge, std::nullopt);
}

RingPage::Words RingPage::add_words(std::string_view before, shm::CounterType type, std::optional<LinkId> link) {
    Words words;
    std::ranges::transform(paged_counters, words.begin(), [&](const link::LinkCounter& counter) {
        return page_.add(fmt::format("{}{}", before, counter.name), type, link);
    });
    return words;
}

void RingPage::name_link(LinkId link, std::string_view name) {
    std::erase(gone_, link);  // in case the link comes back
    if (rows_.size() < max_rows) add_row(link);
    if (const auto row = rows_.find(link); row != rows_.end()) row->second.has_destination = false;
    while (!page_.name_link(link, name) && !gone_.empty()) {
        page_.forget_link(gone_.front());
        gone_.pop_front();
    }
}

void RingPage::link_removed(LinkId link) {
    gone_.push_back(link);
    if (gone_.size() <= max_gone) return;
    page_.forget_link(gone_.front());
    gone_.pop_front();
}

void RingPage::inherit(const std::map<LinkId, std::string>& names) {
    const auto skipped = names.size() - std::min(names.size(), max_gone);
    for (auto name = std::next(names.begin(), static_cast<std::ptrdiff_t>(skipped)); name != names.end(); ++name)
        if (page_.name_link(name->first, name->second)) gone_.push_back(name->first);
}

void RingPage::remove_row(std::map<LinkId, Row>::iterator row) {
    for (Counter* const word : row->second.words) page_.remove(word);
    for (Counter* const gauge : {row->second.up, row->second.queued, row->second.queue_limit}) page_.remove(gauge);
    rows_.erase(row);
}

void RingPage::choose_rows(const std::vector<const link::LinkInfo*>& busiest) {
    const auto is_chosen = [&](LinkId id) {
        return std::ranges::binary_search(busiest, id, {}, [](const link::LinkInfo* l) { return l->id; });
    };
    for (auto row = rows_.begin(); row != rows_.end();) {
        const auto next = std::next(row);
        if (!is_chosen(row->first)) remove_row(row);
        row = next;
    }
    for (const link::LinkInfo* link : busiest)
        if (!rows_.contains(link->id)) name_link(link->id, link->name);  // it has never been up
}

void RingPage::add_row(LinkId link) {
    if (rows_.contains(link)) return;
    const auto add_gauge = [&](std::string_view label) { return page_.add(label, shm::CounterType::gauge, link); };
    rows_.emplace(link, Row{add_words("", shm::CounterType::counter, link), add_gauge("up"), add_gauge("queued_bytes"),
                            add_gauge("queue_limit_bytes")});
}

// A link that has name= does not show by its name where it sends.
void RingPage::set_destination(const link::LinkInfo& link, const std::vector<link::EndpointInfo>& endpoints, Row& row) {
    if (row.has_destination) return;
    const auto its = std::ranges::find(endpoints, link.endpoint, &link::EndpointInfo::id);
    if (its == endpoints.end()) return;
    row.has_destination = true;
    const auto& given = its->endpoint;
    const auto url = endpoint::Endpoint{given.scheme, given.address, given.path, {}}.label();
    if (given.calls() && link.name != url) static_cast<void>(page_.name_link(link.id, link.name, url));
}

void RingPage::refresh(const std::vector<link::LinkInfo>& links, const std::vector<link::EndpointInfo>& endpoints,
                       std::optional<link::EndpointId> inlet, const OfRing& ring, std::span<const OwnCount> own) {
    choose_rows(busiest_links(links, max_rows));
    link::LinkCounters others;
    for (const link::LinkInfo& link : links) {
        const auto row = rows_.find(link.id);
        if (row == rows_.end()) {
            others.add(*link.counters);
            continue;
        }
        set_destination(link, endpoints, row->second);
        set(row->second.up, link.up ? 1 : 0);
        set(row->second.queued, link.queued_bytes);
        set(row->second.queue_limit, link.queue_limit_bytes);
        for (std::size_t i = 0; i < paged_counters.size(); ++i)
            set(row->second.words[i], (link.counters->*paged_counters[i].word).value());
    }
    for (const link::EndpointInfo& endpoint : endpoints) {
        others.add(endpoint.counters->gone);
        if (endpoint.id != inlet) continue;
        set(stray_bytes_, endpoint.counters->stray_bytes.value());
        set(refused_, endpoint.counters->peers_refused.value());
        set(evicted_, endpoint.counters->peers_evicted.value());
    }
    for (std::size_t i = 0; i < paged_counters.size(); ++i) set(others_[i], (others.*paged_counters[i].word).value());
    set(records_, ring.records);
    set(dropped_, ring.dropped);
    set(links_, links.size());
    for (const OwnCount& count : own.subspan(own_.size())) own_.push_back(page_.add(count.label, count.type));
    for (std::size_t i = 0; i < own.size(); ++i) set(own_[i], own[i].value);
}

std::vector<const link::LinkInfo*> busiest_links(const std::vector<link::LinkInfo>& links, std::size_t most) {
    std::vector<const link::LinkInfo*> all;
    all.reserve(links.size());
    for (const link::LinkInfo& link : links) all.push_back(&link);
    const auto busier = [](const link::LinkInfo* a, const link::LinkInfo* b) {
        const auto frames = [](const link::LinkInfo* l) {
            return l->counters->frames_in.value() + l->counters->frames_out.value();
        };
        return frames(a) != frames(b) ? frames(a) > frames(b) : a->id < b->id;
    };
    if (all.size() > most) {
        std::ranges::nth_element(all, all.begin() + static_cast<std::ptrdiff_t>(most), busier);
        all.resize(most);
    }
    std::ranges::sort(all, {}, [](const link::LinkInfo* l) { return l->id; });
    return all;
}

}  // namespace mavloom::ring
