// SPDX-License-Identifier: MIT
#include "frames/traffic_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <nlohmann/json.hpp>
#include <span>
#include <tuple>
#include <variant>
#include <vector>

#include "mavloom/base/counted.hpp"
#include "mavloom/base/durations.hpp"
#include "mavloom/base/shown.hpp"
#include "mavloom/observe/loss.hpp"

namespace mavloom::app {

namespace {

struct Named {
    std::string_view name, noun, rest;
    std::uint64_t value;

    // For example "crc_error: 2 frames with a bad checksum".
    [[nodiscard]] std::string text() const { return fmt::format("{}: {} {}", name, counted(value, noun), rest); }
};

// Every counter of lost, damaged or omitted data, with its text.
auto losses_of(const feed::Totals& t) {
    return std::array{
        Named{"kernel_drop", "datagram", "dropped by the kernel: the receive buffer was full", t.kernel_drop},
        Named{"buffer_full", "frame", "dropped: the output was slower than --buffer allows", t.buffer_full},
        Named{"lapped", "record", "missed in the ring: its writer was faster", t.lapped},
        Named{"bad_records", "record", "in the ring without a whole valid frame", t.bad_records},
        Named{"other_kinds", "record", "in the ring whose kind is not MAVLink", t.other_kinds},
        Named{"copies", "record", "in the ring that its router marked as a copy or an echo", t.copies},
        Named{"echo", "record", "in the ring that this program itself sent to the inlet", t.echo},
        Named{"crc_error", "frame", "with a bad checksum", t.crc_error},
        Named{"junk_bytes", "byte", "outside every intact frame", t.junk_bytes},
        Named{"damaged_places", "damaged place", "in recordings", t.damaged_places},
        Named{"unknown_flags", "frame", "with an unknown incompatibility flag", t.unknown_flags},
        Named{"bad_signature", "frame", "without a good signature", t.bad_signature},
        Named{"wrong_peer", "datagram", "from an address other than the destination", t.wrong_peer},
        Named{"bad_source", "datagram", "from an address that can be no peer's", t.bad_source},
        Named{"stray_bytes", "byte",
              "from unknown senders, in datagrams without a valid (verify=: correctly signed) frame", t.stray_bytes},
        Named{"peers_refused", "peer", "refused because max_peers was reached, or because too many addresses sent",
              t.peers_refused},
        Named{"http_refused", "TCP client", "refused: spoke HTTP or TLS, as a web page in a browser does",
              t.http_refused},
        Named{"wrong_origin", "WebSocket", "refused: of a web page that origin= does not list", t.wrong_origin},
        Named{"bad_handshake", "connection", "refused: no good WebSocket handshake", t.bad_handshake},
        Named{"bad_message", "WebSocket", "ended by a message that cannot be MAVLink", t.bad_message},
    };
}

void append_source(std::string& out, const feed::ReceivedLoss& loss, std::string_view link) {
    fmt::format_to(std::back_inserter(out), "\n{} {}/{}: {}, {} lost ({:.2f} %), {} late, {} duplicate, {} resync\n",
                   link, loss.source.system.value, loss.source.component.value, counted(loss.received, "frame"),
                   loss.lost, 100 * observe::loss_ratio(loss), loss.late, loss.duplicate, loss.resync);
    fmt::format_to(std::back_inserter(out), "  {:<38} {:>9} {:>9} {:>10} {:>10} {:>10} {:>9} {:>11} {:>7}\n", "message",
                   "count", "Hz", "gap min ms", "mean ms", "max ms", "jitter ms", "bytes", "share %");
}

// "BATTERY_STATUS/1"
std::string row_name(const observe::LatestRow& row) {
    auto name = row.message == nullptr ? fmt::format("#{}", row.traffic.id.value) : std::string(row.message->name);
    if (const auto instance = row.instance()) name += "/" + printable(message::text_of(*instance));
    return name;
}

void append_row(std::string& out, const observe::LatestRow& row) {
    const auto& its = row.traffic;
    fmt::format_to(std::back_inserter(out),
                   "  {:<38} {:>9} {:>9.3f} {:>10.3f} {:>10.3f} {:>10.3f} {:>9.3f} {:>11} {:>7.2f}\n", row_name(row),
                   its.count, its.rate_hz(), milliseconds(its.shortest_gap), milliseconds(its.mean_gap()),
                   milliseconds(its.longest_gap), milliseconds(row.jitter), its.bytes, 100 * row.share());
}

using Rows = std::vector<const observe::LatestRow*>;

// Returns the rows of one source. Both lists are sorted alike, so `from` moves on to the next source's rows.
std::span<const observe::LatestRow* const> rows_of(const feed::ReceivedLoss& loss, const Rows& rows, std::size_t& from) {
    const auto key = [](const auto& x) { return std::tuple(x.link, x.source); };
    while (from < rows.size() && key(rows[from]->traffic) < key(loss)) ++from;
    const std::size_t begin = from;
    while (from < rows.size() && key(rows[from]->traffic) == key(loss)) ++from;
    return std::span(rows).subspan(begin, from - begin);
}

Json instance_json(const observe::LatestRow& row) {
    const auto instance = row.instance();
    if (!instance) return nullptr;
    return std::visit([](const auto& value) { return Json(value); }, *instance);
}

Json row_json(const observe::LatestRow& row) {
    const auto& its = row.traffic;
    return {{"id", its.id.value},
            {"name", row.message == nullptr ? Json(nullptr) : Json(row.message->name)},
            {"instance", instance_json(row)},
            {"count", its.count},
            {"bytes", its.bytes},
            {"share", row.share()},
            {"rate_hz", its.rate_hz()},
            {"gap_min_ms", milliseconds(its.shortest_gap)},
            {"gap_mean_ms", milliseconds(its.mean_gap())},
            {"gap_max_ms", milliseconds(its.longest_gap)},
            {"jitter_ms", milliseconds(row.jitter)}};
}

}  // namespace

std::string traffic_text(const observe::LatestTable& traffic, feed::Receiver& receiver) {
    std::string out;
    const auto rows = traffic.sorted();
    std::size_t from = 0;
    for (const auto& loss : receiver.losses()) {
        append_source(out, loss, receiver.link_name(loss.link));
        for (const auto* const row : rows_of(loss, rows, from)) append_row(out, *row);
    }
    if (traffic.unlisted() != 0)
        fmt::format_to(std::back_inserter(out), "\n{} of further sources not listed\n",
                       counted(traffic.unlisted(), "frame"));
    const auto& totals = receiver.totals();
    fmt::format_to(std::back_inserter(out), "\ntotal heard: {}, {}\n", counted(totals.frames, "frame"),
                   counted(totals.bytes, "byte"));
    for (const auto& loss : losses_of(totals))
        if (loss.value != 0) fmt::format_to(std::back_inserter(out), "  {}\n", loss.text());
    return out;
}

std::string traffic_json(const observe::LatestTable& traffic, feed::Receiver& receiver, std::uint64_t unprinted) {
    const auto rows = traffic.sorted();
    std::size_t from = 0;
    auto sources = Json::array();
    for (const auto& loss : receiver.losses()) {
        auto messages = Json::array();
        for (const auto* const row : rows_of(loss, rows, from)) messages.push_back(row_json(*row));
        sources.push_back({{"link", receiver.link_name(loss.link)},
                           {"sys", loss.source.system.value},
                           {"comp", loss.source.component.value},
                           {"frames", loss.received},
                           {"lost", loss.lost},
                           {"loss_percent", 100 * observe::loss_ratio(loss)},
                           {"late", loss.late},
                           {"duplicate", loss.duplicate},
                           {"resync", loss.resync},
                           {"messages", std::move(messages)}});
    }
    const auto& totals = receiver.totals();
    Json sums{
        {"frames", totals.frames}, {"bytes", totals.bytes}, {"unlisted", traffic.unlisted()}, {"unprinted", unprinted}};
    sums.update(losses_json(totals));
    return stats_line({{"sources", std::move(sources)}, {"totals", std::move(sums)}});
}

Json losses_json(const feed::Totals& totals) {
    Json sums;
    for (const auto& loss : losses_of(totals)) sums[std::string(loss.name)] = loss.value;
    return sums;
}

// Others are no frames, or were never meant to arrive. A damaged frame of a stranger is in no link's counts.
std::vector<observe::NamedCount> loss_counts(const feed::Totals& totals) {
    constexpr std::array<std::string_view, 8> kinds{"kernel_drop", "buffer_full",   "lapped",        "bad_records",
                                                    "crc_error",   "unknown_flags", "bad_signature", "stray_bytes"};
    std::vector<observe::NamedCount> all;
    for (const auto& loss : losses_of(totals))
        if (std::ranges::find(kinds, loss.name) != kinds.end())
            all.push_back({std::string(loss.name), loss.value, fmt::format("{}s {}", loss.noun, loss.rest)});
    return all;
}

std::string stats_line(Json stats) {
    return Json{{"stats", std::move(stats)}}.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

void log_losses(const Common& common, const feed::Totals& totals) {
    for (const auto& loss : losses_of(totals))
        if (loss.value != 0) print_notice(common, loss.text());
}

}  // namespace mavloom::app
