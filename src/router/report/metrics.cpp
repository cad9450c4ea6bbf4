// SPDX-License-Identifier: MIT
// The metrics of a router. Their size is bounded, because senders choose their ids and addresses: the busiest series
// are listed, and the rest are summed under the label "other".
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <set>
#include <tuple>
#include <utility>

#include "mavloom/control/metrics_text.hpp"
#include "mavloom/router/report.hpp"
#include "router/report/snapshot.hpp"

namespace mavloom::router {

namespace {

using control::MetricsText;
using link::NamedCount;
using OfLink = link::Snapshot::OfLink;

// At most so many of each kind are listed. docs/guide/route.md states these numbers.
constexpr std::size_t max_links = 1024, max_systems = 256, max_components = 256;
constexpr std::size_t max_messages = 256, max_messages_with_detail = 1024;

constexpr std::int32_t other = -1;  // an id: the sum over those that are not listed
constexpr std::string_view other_text = "other";

// Counters of one sender or message on one link.
struct Series {
    const OfLink* link;  // null: the links that are not listed
    std::int32_t system, component, message;
    std::array<std::uint64_t, 3> counts;

    [[nodiscard]] auto key() const noexcept { return std::tuple(link, system, component, message); }
};

// The highest count that is not among the `most` highest.
std::uint64_t limit_of(std::vector<std::uint64_t> counts, std::size_t most) {
    std::ranges::nth_element(counts, counts.begin() + static_cast<std::ptrdiff_t>(most), std::greater{});
    return counts[most];
}

// Adds up the rows that have the same key.
void sum_equal(std::vector<Series>& rows) {
    std::ranges::sort(rows, {}, &Series::key);
    std::size_t kept = 0;
    for (const auto& row : rows) {
        if (kept == 0 || rows[kept - 1].key() != row.key()) {
            rows[kept++] = row;
            continue;
        }
        for (std::size_t i = 0; i < row.counts.size(); ++i) rows[kept - 1].counts[i] += row.counts[i];
    }
    rows.erase(rows.begin() + static_cast<std::ptrdiff_t>(kept), rows.end());
}

void make_other(Series& row) { row.system = row.component = row.message = other; }

// Keeps the `most` rows that count most frames, and adds up the others of each link. Equal rows are kept together, or
// not at all.
std::vector<Series> busiest(std::vector<Series> rows, std::size_t most) {
    sum_equal(rows);
    if (rows.size() <= most) return rows;
    std::vector<std::uint64_t> frames;
    frames.reserve(rows.size());
    for (const auto& row : rows) frames.push_back(row.counts[0]);
    const std::uint64_t limit = limit_of(std::move(frames), most);
    for (auto& row : rows)
        if (row.counts[0] <= limit) make_other(row);
    sum_equal(rows);
    return rows;
}

std::string id_label(std::string_view name, std::int32_t id) {
    return id == other ? MetricsText::label(name, other_text) : fmt::format("{}=\"{}\"", name, id);
}

class RouterMetrics {
public:
    RouterMetrics(const Snapshot& snapshot, MetricsDetail detail)
        : s_(snapshot), has_components_(detail == MetricsDetail::components) {
        choose_links();
    }

    [[nodiscard]] std::string text() {
        metrics_.add("router", s_.counts, "");
        add_endpoints();
        add_links();
        add_sources();
        add_messages();
        for (const auto& recording : s_.recordings)
            metrics_.add("recording", recording.counts, MetricsText::label("endpoint", recording.label));
        return metrics_.text();
    }

private:
    void choose_links() {
        const auto frames_of = [](const OfLink& link) {
            std::uint64_t sum = 0;
            for (const auto& count : link.counts)
                if (count.name == "frames_in" || count.name == "frames_out") sum += count.value;
            return sum;
        };
        std::vector<std::pair<std::uint64_t, const OfLink*>> links;
        links.reserve(s_.links.size());
        for (const auto& link : s_.links) links.emplace_back(frames_of(link), &link);
        std::ranges::stable_sort(links, std::greater{}, &decltype(links)::value_type::first);
        links.resize(std::min(links.size(), max_links));
        for (const auto& [frames, link] : links) listed_.insert(link);
    }

    [[nodiscard]] const OfLink* listed(const OfLink* link) const { return listed_.contains(link) ? link : nullptr; }

    [[nodiscard]] static std::string link_label(const OfLink* link) {
        return MetricsText::label("link", link == nullptr ? other_text : std::string_view(link->name));
    }

    void add_endpoints() {
        for (const auto& endpoint : s_.endpoints) {
            metrics_.add("endpoint", endpoint.counts, MetricsText::label("endpoint", endpoint.label));
            metrics_.add("gone", endpoint.gone, MetricsText::label("endpoint", endpoint.label));
        }
    }

    void add_links() {
        std::vector<NamedCount> others;
        for (const auto& link : s_.links) {
            if (listed(&link) != nullptr) metrics_.add("link", link.counts, link_label(&link));
            else add_up(others, link.counts);
        }
        metrics_.add("link", others, link_label(nullptr));
    }

    // Links beyond the router's table lack the last counters.
    static void add_up(std::vector<NamedCount>& sums, const std::vector<NamedCount>& counts) {
        for (std::size_t i = 0; i < counts.size(); ++i) {
            if (i == sums.size()) sums.push_back({counts[i].name, 0, counts[i].help});
            sums[i].value += counts[i].value;
        }
    }

    void add_sources() {
        std::vector<Series> rows;
        for (const auto& link : s_.links)
            for (const auto& s : link.sources)
                rows.push_back(
                    {listed(&link), s.source.system.value, s.source.component.value, 0, {s.received, s.lost, s.late}});
        for (auto& row : rows)
            if (row.link == nullptr) make_other(row);
        if (has_components_)
            for (const auto& row : busiest(rows, max_components)) add_source("source", row, component_labels(row));
        for (auto& row : rows)
            if (row.component != other) row.component = 0;
        for (const auto& row : busiest(std::move(rows), max_systems)) add_source("system", row, system_labels(row));
    }

    void add_source(std::string_view kind, const Series& row, const std::string& labels) {
        metrics_.add(kind,
                     std::vector<NamedCount>{
                         {"frames", row.counts[0], "frames from this sender"},
                         {"lost", row.counts[1], "frames that the link lost, by gaps in the sequence numbers"},
                         {"late", row.counts[2], "frames that arrived late, by the sequence numbers"}},
                     labels);
    }

    void add_messages() {
        std::vector<Series> rows;
        for (const auto& row : s_.messages) {
            const auto* const link = s_.link(row.link);
            if (link == nullptr) continue;
            rows.push_back({listed(link),
                            row.source.system.value,
                            has_components_ ? std::int32_t{row.source.component.value} : 0,
                            static_cast<std::int32_t>(row.id.value),
                            {row.count, row.bytes, 0}});
            if (rows.back().link == nullptr) make_other(rows.back());
        }
        for (const auto& row : busiest(std::move(rows), has_components_ ? max_messages_with_detail : max_messages))
            metrics_.add("message",
                         std::vector<NamedCount>{{"frames", row.counts[0], "frames of this kind"},
                                                 {"bytes", row.counts[1], "bytes of the frames"}},
                         fmt::format("{},{}", has_components_ ? component_labels(row) : system_labels(row),
                                     MetricsText::label("message", message_name(row.message))));
    }

    [[nodiscard]] std::string message_name(std::int32_t id) const {
        if (id == other) return std::string(other_text);
        const auto* const message = s_.dialect->find(MessageId{static_cast<std::uint32_t>(id)});
        return message == nullptr ? fmt::format("{}", id) : std::string(message->name);
    }

    [[nodiscard]] static std::string system_labels(const Series& row) {
        return fmt::format("{},{}", link_label(row.link), id_label("sys", row.system));
    }
    [[nodiscard]] static std::string component_labels(const Series& row) {
        return fmt::format("{},{}", system_labels(row), id_label("comp", row.component));
    }

    const Snapshot& s_;
    bool has_components_;
    std::set<const OfLink*> listed_;
    MetricsText metrics_;
};

}  // namespace

Report report_metrics(Router& router) {
    auto s = router.snapshots().request(Contents::all);
    Report report = control::report_of(
        [s, detail = router.metrics_detail()] { return RouterMetrics(*s, detail).text(); });
    report.copy_more = copying(router, std::move(s));
    return report;
}

}  // namespace mavloom::router
