// SPDX-License-Identifier: MIT
#include "receiving.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "mavloom/dialect/terms.hpp"

namespace mavloom::app {

namespace {

constexpr std::uint64_t smallest_buffer = 64 * 1024;  // the longest datagram

template <class T>
std::optional<T> whole_number(std::string_view text, std::uint32_t largest) {
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || value > largest) return std::nullopt;
    return T{static_cast<typename T::rep>(value)};
}

}  // namespace

void Selection::declare(Arguments command) {
    command.add_option("--only", "NAMES", only, "only these messages: names or ids, separated by commas").delimiter(',');
    command.add_option("--from", "SYS[/COMP]", from, "only from this system, or from this component of it");
}

SetupResult<void> Selection::resolve(const dialect::Dialect& dialect) {
    for (const auto& word : only) {
        auto id = dialect::find_message_id(dialect, word);
        if (!id) return tl::unexpected(std::move(id.error()).within("--only"));
        ids_.push_back(*id);
    }
    std::ranges::sort(ids_);
    if (from.empty()) return {};
    const auto slash = from.find('/');
    system_ = whole_number<SystemId>(std::string_view(from).substr(0, slash), 255);
    if (slash != std::string::npos)
        component_ = whole_number<ComponentId>(std::string_view(from).substr(slash + 1), 255);
    if (!system_ || (slash != std::string::npos && !component_))
        return setup_error(
            SetupCode::usage,
            fmt::format("--from {}: expected SYS or SYS/COMP, numbers from 0 to 255, for example --from 1/1", from));
    return {};
}

bool Selection::takes(const wire::FrameView& frame) const noexcept {
    if (system_ && frame.system() != *system_) return false;
    if (component_ && frame.component() != *component_) return false;
    return ids_.empty() || std::ranges::binary_search(ids_, frame.id());
}

void ReceiveOptions::declare(Arguments command) {
    command
        .add_option("source", "SOURCE", sources,
                    "where to receive: udpin://0.0.0.0:14550, tcpout://HOST:PORT, shm://NAME, flight.tlog, ... "
                    "(docs/guide/endpoints.md)")
        .required();
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

SetupResult<std::unique_ptr<feed::Receiver>> ReceiveOptions::open(const Common& common, const dialect::Dialect& dialect) {
    if (auto counted = parse_count(); !counted) return tl::unexpected(std::move(counted.error()));
    const auto bytes = endpoint::parse_size(buffer);
    if (!bytes) return tl::unexpected(SetupError(bytes.error()).within("--buffer"));
    if (*bytes < smallest_buffer)
        return setup_error(SetupCode::usage, fmt::format("--buffer {}: at least 64k", buffer));
    if (!duration.empty())
        if (auto time = endpoint::parse_duration(duration); !time)
            return tl::unexpected(std::move(time.error()).within("--for"));
    const auto notice = [&common](std::string_view text) { print_notice(common, text); };
    auto receiver = feed::Receiver::create(dialect, *bytes, notice);
    if (!receiver) return receiver;
    for (const auto& text : sources) {
        const auto endpoint = endpoint::parse_endpoint(text);
        if (!endpoint) return tl::unexpected(endpoint.error());
        if (auto added = (*receiver)->add(*endpoint); !added) return tl::unexpected(std::move(added.error()));
    }
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
