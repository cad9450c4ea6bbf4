// SPDX-License-Identifier: MIT
#include "web/clients/foxglove.hpp"

#include <fmt/format.h>

#include <limits>

#include "mavloom/base/version.hpp"
#include "web/json.hpp"

namespace mavloom::web::foxglove {

namespace {

constexpr std::uint8_t message_data = 1;
constexpr std::size_t header_bytes = 1 + 4 + 8;
constexpr int max_depth = 8;  // of the values in a request

bool is_id(const nlohmann::json& json) {
    return json.is_number_unsigned() && json.get<std::uint64_t>() <= std::numeric_limits<std::uint32_t>::max();
}

SetupResult<std::vector<Subscription>> subscriptions_in(const nlohmann::json& json) {
    const auto wrong = [] { return setup_error(SetupCode::bad_input, "subscriptions must be [{id, channelId}, ...]"); };
    std::vector<Subscription> all;
    if (!json.is_array()) return wrong();
    for (const auto& one : json) {
        if (!one.is_object() || !one.contains("id") || !one.contains("channelId")) return wrong();
        if (!is_id(one["id"]) || !is_id(one["channelId"])) return wrong();
        all.push_back({one["id"].get<std::uint32_t>(), one["channelId"].get<std::uint32_t>()});
    }
    return all;
}

SetupResult<std::vector<std::uint32_t>> ids_in(const nlohmann::json& json) {
    std::vector<std::uint32_t> all;
    const auto wrong = [] { return setup_error(SetupCode::bad_input, "subscriptionIds must be numbers"); };
    if (!json.is_array()) return wrong();
    for (const auto& one : json) {
        if (!is_id(one)) return wrong();
        all.push_back(one.get<std::uint32_t>());
    }
    return all;
}

}  // namespace

SetupResult<Request> parse(std::string_view text) {
    // Not an ordered_json: that one searches all keys for each one. Deep values are left out: it copies and destroys
    // them by recursion.
    bool is_deep = false;
    const auto json = nlohmann::json::parse(
        text,
        [&](int depth, auto, auto&) {
            is_deep = is_deep || depth > max_depth;
            return depth <= max_depth;
        },
        false);
    if (is_deep || !json.is_object() || !json.contains("op") || !json["op"].is_string())
        return setup_error(SetupCode::bad_input, "a message must be a JSON object with a text \"op\"");
    const auto& op = json["op"].get_ref<const std::string&>();
    static const nlohmann::json nothing;
    const auto value = [&](const char* key) -> const nlohmann::json& {
        const auto at = json.find(key);
        return at == json.end() ? nothing : *at;
    };
    Request request;
    if (op == "subscribe") {
        auto all = subscriptions_in(value("subscriptions"));
        if (!all) return tl::unexpected(std::move(all.error()));
        request.subscribe = std::move(*all);
    } else if (op == "unsubscribe") {
        auto all = ids_in(value("subscriptionIds"));
        if (!all) return tl::unexpected(std::move(all.error()));
        request.unsubscribe = std::move(*all);
    } else {
        request.unknown_op = op;
    }
    return request;
}

std::string server_info() {
    return text_of({{"op", "serverInfo"},
                    {"name", fmt::format("mavloom {}", version())},
                    {"capabilities", Json::array()},
                    {"supportedEncodings", Json::array()},
                    {"metadata", Json::object()}});
}

std::string status(Level level, std::string_view text, std::string_view id) {
    Json all{{"op", "status"}, {"level", static_cast<int>(level)}, {"message", text}};
    if (!id.empty()) all["id"] = id;
    return text_of(all);
}

std::string description(std::string_view type, std::string_view schema) {
    const auto json = text_of(
        {{"encoding", "cdr"}, {"schemaName", type}, {"schema", schema}, {"schemaEncoding", "ros2msg"}});
    return json.substr(1);  // without the brace
}

std::string advertise(const Channels& channels, std::uint32_t& last, std::size_t up_to) {
    std::string text = R"({"op":"advertise","channels":[)";
    bool is_first = true;
    for (auto at = channels.all().upper_bound(last); at != channels.all().end() && (is_first || text.size() < up_to);
         ++at, is_first = false) {
        const Channel& channel = at->second;
        last = channel.id;
        text += fmt::format(R"({}{{"id":{},"topic":{},{})", is_first ? "" : ",", channel.id, text_of(channel.topic),
                            channel.kind.description);
    }
    return text += "]}";
}

std::string unadvertise(std::span<const std::uint32_t> channels) {
    return fmt::format(R"({{"op":"unadvertise","channelIds":[{}]}})", fmt::join(channels, ","));
}

namespace {

void encode_standard(const Channel& channel, const observe::LatestRow& latest, std::vector<std::uint8_t>& out) {
    const auto* const other_row = channel.other == nullptr ? nullptr : channel.other->latest();
    std::optional<message::MessageView> other;
    if (other_row != nullptr) other.emplace(*other_row->message, other_row->payload());
    channel.kind.standard->encode({.view = {*latest.message, latest.payload()},
                                   .other = other ? &*other : nullptr,
                                   .source = channel.source,
                                   .time = latest.traffic.last},
                                  out);
}

}  // namespace

void encode(const Channel& channel, std::vector<std::uint8_t>& out) {
    const auto& kind = channel.kind;
    const auto& latest = *channel.latest();
    out.assign(header_bytes, message_data);
    store_le(out.data() + 5, static_cast<std::uint64_t>(latest.traffic.last.time_since_epoch().count()));
    if (kind.standard != nullptr) return encode_standard(channel, latest, out);
    out.resize(header_bytes + kind.encoder.max_size());
    out.resize(header_bytes + kind.encoder.encode(latest.payload(), std::span(out).subspan(header_bytes)));
}

void encode(std::string_view json, WallTime time, std::vector<std::uint8_t>& out) {
    out.assign(header_bytes, message_data);
    store_le(out.data() + 5, static_cast<std::uint64_t>(time.time_since_epoch().count()));
    out.insert(out.end(), json.begin(), json.end());
}

void set_subscription(std::vector<std::uint8_t>& message, std::uint32_t id) noexcept {
    store_le(message.data() + 1, id);
}

}  // namespace mavloom::web::foxglove
