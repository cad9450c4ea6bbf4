// SPDX-License-Identifier: MIT
#include "mavloom/observe/diagnosis.hpp"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "observe/diagnosis/rules.hpp"

namespace mavloom::observe {

std::string_view name_of(Finding::Severity severity) noexcept {
    return severity == Finding::Severity::error ? "error" : "warning";
}

std::uint64_t Listened::count(std::string_view counter) const noexcept {
    std::uint64_t sum = 0;
    for (const auto& one : counts)
        if (one.name == counter) sum += one.count;
    return sum;
}

const HeardLink* Evidence::link(LinkId id) const noexcept {
    const auto at = std::ranges::find(links, id, &HeardLink::id);
    return at == links.end() ? nullptr : &*at;
}

const Listened* Evidence::source_of(LinkId of) const noexcept {
    const auto* const known = link(of);
    return known == nullptr || known->source >= sources.size() ? nullptr : &sources[known->source];
}

std::string_view Evidence::name_of(LinkId of) const noexcept {
    const auto* const known = link(of);
    return known == nullptr ? std::string_view() : std::string_view(known->name);
}

std::vector<Stream> streams_of(const LatestTable& latest) {
    std::map<std::tuple<LinkId, Source, MessageId>, Stream> streams;
    for (const auto& row : latest.rows()) {
        if (row.born == 0) continue;
        const auto& its = row.traffic;
        auto& stream = streams[{its.link, its.source, its.id}];
        stream.link = its.link;
        stream.source = its.source;
        stream.id = its.id;
        if (row.message != nullptr) stream.name = row.message->name;
        stream.bytes += its.bytes;
        stream.count = std::max(stream.count, its.count);
        stream.hz = std::max(stream.hz, its.rate_hz());
    }
    std::vector<Stream> all;
    all.reserve(streams.size());
    for (auto& [key, stream] : streams) all.push_back(stream);
    return all;
}

namespace {

// Two sources may show the same thing.
std::vector<Finding> without_repeats(std::vector<Finding> findings) {
    std::vector<Finding> all;
    for (auto& finding : findings) {
        const bool is_known = std::ranges::any_of(all, [&](const Finding& one) {
            return one.id == finding.id && one.where == finding.where && one.what == finding.what;
        });
        if (!is_known) all.push_back(std::move(finding));
    }
    return all;
}

}  // namespace

std::vector<Finding> diagnose(const Evidence& evidence) {
    std::vector<Finding> findings;
    for (const auto rule :
         {rules::find_unheard, rules::find_unreadable, rules::find_own_losses, rules::find_hop_losses,
          rules::find_losses, rules::find_passages, rules::find_senders, rules::find_missing_heartbeats,
          rules::find_unsigned, rules::find_clocks, rules::find_rates, rules::find_full_links})
        rule(evidence, findings);
    std::ranges::stable_sort(findings, {}, &Finding::severity);
    return without_repeats(std::move(findings));
}

}  // namespace mavloom::observe
