// SPDX-License-Identifier: MIT
#include "frames/receiving.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <charconv>
#include <filesystem>
#include <system_error>

#include "mavloom/base/shown.hpp"
#include "mavloom/endpoint/grammar.hpp"

namespace mavloom::app {

namespace {

constexpr std::uint64_t smallest_buffer = 64 * 1024;  // the longest datagram

SetupError with_next_step(SetupError error) {
    if (error.sys_errno == EADDRINUSE) error.text += "; end that program, or choose another port";
    return error;
}

}  // namespace

void Selection::declare(Arguments command) {
    command.add_option("--only", "NAMES", only, "only these messages: names or ids, separated by commas").delimiter(',');
    command.add_option("--from", "SYS[/COMP]", from, "only from this system, or from this component of it");
}

SetupResult<void> Selection::compile(const dialect::Dialect& dialect) {
    if (auto done = filter.allow(dialect, {.messages = only}); !done)
        return tl::unexpected(std::move(done.error()).within("--only"));
    if (from.empty()) return {};
    auto terms = endpoint::parse_sender(from);
    return terms ? filter.allow(dialect, *terms) : tl::unexpected(std::move(terms.error()).within("--from"));
}

void ReceiveOptions::declare(Arguments command, Source source) {
    auto option = command.add_option(
        "source", "SOURCE", sources,
        "where to receive: udpin://0.0.0.0:14550, tcpout://HOST:PORT, shm://NAME, flight.tlog, ... "
        "(docs/guide/endpoints.md)");
    if (source == Source::required) option.required();
    command.add_option("--for", "TIME", duration, "end after this time: 10s, 2m, 500ms");
    command.add_option("--count", "N", count_text, "end after this many messages");
    command
        .add_option("--buffer", "BYTES", buffer,
                    "memory for received frames that are not handled yet (bytes, k, M); when it is full, frames are "
                    "dropped and counted")
        .capture_default_str();
}

void log_ports(const Common& common, const std::vector<link::EndpointInfo>& endpoints) {
    for (const auto& info : endpoints)
        if (info.endpoint.address.port == 0 && info.local_port != 0)
            print_notice(common, fmt::format("{}: listening on port {}", info.endpoint.label(), info.local_port));
}

std::uint64_t recorded_bytes(const endpoint::Endpoint& endpoint) {
    std::error_code none;
    const auto size = endpoint.is_recording() ? std::filesystem::file_size(endpoint.path, none) : 0;
    return none ? 0 : size;
}

std::uint64_t bytes_read(feed::Receiver& receiver) {
    std::uint64_t sum = 0;
    for (const auto& source : receiver.counts().sources)
        for (const auto& its : source.counts)
            if (its.name == "bytes_in") sum += its.value;
    return sum;
}

std::optional<double> part_read(const feed::Sources& sources) {
    std::uint64_t read = 0, all = 0;
    for (const auto& recording : sources.recordings()) {
        read += recording->reader.position();
        all += recording->reader.size();
    }
    if (all == 0) return std::nullopt;
    return static_cast<double>(read) / static_cast<double>(all);
}

SetupResult<std::unique_ptr<feed::Receiver>> ReceiveOptions::open(const Common& common, const dialect::Dialect& dialect,
                                                                  feed::Receiver::Notice notice) {
    if (auto counted = parse_count(); !counted) return tl::unexpected(std::move(counted.error()));
    const auto bytes = endpoint::parse_size(buffer);
    if (!bytes) return tl::unexpected(SetupError(bytes.error()).within("--buffer"));
    if (*bytes < smallest_buffer)
        return setup_error(SetupCode::usage, fmt::format("--buffer {}: at least 64k", buffer));
    if (!duration.empty())
        if (auto time = endpoint::parse_duration(duration); !time)
            return tl::unexpected(std::move(time.error()).within("--for"));
    if (!notice) notice = [&common](std::string_view text) { print_event(common, text); };
    const auto endpoints = endpoint::parse_endpoints(sources);
    if (!endpoints) return tl::unexpected(endpoints.error());
    auto receiver = feed::Receiver::create(dialect, *bytes, std::move(notice));
    if (!receiver) return receiver;
    for (const auto& endpoint : *endpoints)
        if (auto added = (*receiver)->add(endpoint); !added) return tl::unexpected(with_next_step(added.error()));
    return receiver;
}

SetupResult<void> ReceiveOptions::parse_count() {
    if (count_text.empty()) return {};
    const auto [end, error] = std::from_chars(count_text.data(), count_text.data() + count_text.size(), count);
    if (error == std::errc{} && end == count_text.data() + count_text.size() && count != 0) return {};
    return setup_error(SetupCode::usage, fmt::format("--count {}: expected a whole number from 1", count_text));
}

MonoTime ReceiveOptions::end(MonoTime start) const {
    return duration.empty() ? MonoTime::max() : start + *endpoint::parse_duration(duration);
}

}  // namespace mavloom::app
