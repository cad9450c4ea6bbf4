// SPDX-License-Identifier: MIT
// The Foxglove WebSocket protocol, as text and bytes. Source: its specification, version 1
// (https://github.com/foxglove/ws-protocol/blob/main/docs/spec.md). Private to module web. Pure functions.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/base/bytes.hpp"
#include "mavloom/base/clock.hpp"
#include "mavloom/base/result.hpp"
#include "web/channels.hpp"

namespace mavloom::web::foxglove {

// By preference.
inline const std::vector<std::string> subprotocols{"foxglove.sdk.v1", "foxglove.websocket.v1"};

struct Subscription {
    std::uint32_t id = 0;  // that the client chose
    std::uint32_t channel = 0;
};
struct Request {
    std::vector<Subscription> subscribe;
    std::vector<std::uint32_t> unsubscribe;  // ids of subscriptions
    std::string unknown_op;                  // an operation that is not supported; else empty
};
// The request in a client's text. The error states what is wrong with the text.
[[nodiscard]] SetupResult<Request> parse(std::string_view text);

[[nodiscard]] std::string server_info();
enum class Level : std::uint8_t { info, warning, error };
// A status with an id replaces the one before it with that id.
[[nodiscard]] std::string status(Level level, std::string_view text, std::string_view id = {});

// The part of an advertisement that all channels of one type share, for Kind::description.
[[nodiscard]] std::string description(std::string_view type, std::string_view schema);

// Advertises at least one channel, if there is one behind the id `last`, until the text has `up_to` bytes. Moves
// `last`.
[[nodiscard]] std::string advertise(const Channels& channels, std::uint32_t& last, std::size_t up_to);
[[nodiscard]] std::string unadvertise(std::span<const std::uint32_t> channels);

// Writes the message with the channel's latest frame, which must be there, to `out`. The id of the subscription is
// written later, because each client has its own.
void encode(const Channel& channel, std::vector<std::uint8_t>& out);
// The same for a text of a channel with the encoding "json".
void encode(std::string_view json, WallTime time, std::vector<std::uint8_t>& out);
void set_subscription(std::vector<std::uint8_t>& message, std::uint32_t id) noexcept;

}  // namespace mavloom::web::foxglove
