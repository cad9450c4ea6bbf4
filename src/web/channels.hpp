// SPDX-License-Identifier: MIT
// Channels: each message of each source, and each instance of it (battery 1, battery 2), with its latest frame. Private
// to module web; the caller serializes all calls.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "mavloom/dialect/dialect.hpp"
#include "mavloom/message/cdr.hpp"
#include "mavloom/message/instance.hpp"
#include "mavloom/observe/latest_table.hpp"
#include "web/standard.hpp"

namespace mavloom::web {

// For the queue of a client: never dropped for telemetry.
inline constexpr std::uint8_t essential_class = 0;

struct Kind {  // of message
    const dialect::Message* message;
    bool has_instances;
    message::CdrEncoder encoder;
    const Standard* standard;       // null: the encoder is used
    std::string type, description;  // as foxglove::description makes it
    std::uint8_t block_class;       // for the queues of clients
    bool is_replaceable;            // by a newer frame of the channel
};

struct Channel {
    std::uint32_t id;  // from 1, never used again
    Source source;
    const Kind& kind;
    std::string topic;                  // "/1/1/BATTERY_STATUS/0"
    observe::TrafficRow traffic{};      // of all links together
    const Channel* of = nullptr;        // shows the latest frame of this channel as a standard type
    const Channel* other = nullptr;     // likewise, of the message Standard::other; null: none has arrived
    std::vector<Channel*> standards{};  // that show the frames of this one
    bool is_gone = false;               // about to be forgotten

    // The row of the latest frame, of whichever link; null if it was forgotten.
    [[nodiscard]] const observe::LatestRow* latest() const noexcept {
        if (of != nullptr) return of->latest();
        return row != nullptr && row->born == born ? row : nullptr;
    }
    const observe::LatestRow* row = nullptr;
    std::uint64_t born = 0;  // of the row
};

class Channels {
public:
    explicit Channels(std::size_t limit) : limit_(limit) {}

    // `row` has a new latest frame. Null, and counted, if the message has no definition or there is no room for another
    // channel. If there is none, channels that were silent for LatestTable::forgotten_after are forgotten.
    Channel* take(const observe::LatestRow& row);
    // The channel that showed the row's frames.
    [[nodiscard]] const Channel* find(const observe::LatestRow& row) const noexcept;

    [[nodiscard]] const Channel* find(std::uint32_t id) const noexcept {
        const auto at = all_.find(id);
        return at == all_.end() ? nullptr : &at->second;
    }
    [[nodiscard]] const std::map<std::uint32_t, Channel>& all() const noexcept { return all_; }              // by id
    [[nodiscard]] std::uint32_t newest() const noexcept { return all_.empty() ? 0 : all_.rbegin()->first; }  // its id
    // The ids of channels that were forgotten since the last call, in their order.
    [[nodiscard]] bool has_forgotten() const noexcept { return !forgotten_.empty(); }
    [[nodiscard]] std::vector<std::uint32_t> take_forgotten() noexcept { return std::exchange(forgotten_, {}); }
    [[nodiscard]] std::uint64_t unknown() const noexcept { return unknown_; }
    [[nodiscard]] std::uint64_t left_out() const noexcept { return left_out_; }

private:
    struct Key {
        MessageId id;
        Source source;
        message::Instance instance;
        friend auto operator<=>(const Key&, const Key&) = default;
    };
    struct OfRow {
        std::uint64_t born = 0;
        Channel* channel = nullptr;  // null: there was no room
    };
    const Kind& kind_of(const dialect::Message& message);
    Channel* find_or_add(const observe::LatestRow& row);
    Channel* add(const Key& key, const Kind& kind, const observe::LatestRow& row);
    void forget_silent(MonoTime now);
    Channel& append(Source source, const Kind& kind, std::string topic);
    void add_standard(Channel& channel, const Standard& standard);
    void find_other(Channel& standard) const;

    const std::size_t limit_;
    std::unordered_map<MessageId, std::unique_ptr<Kind>> kinds_;
    std::unordered_map<const Standard*, std::unique_ptr<Kind>> standard_kinds_;
    std::map<std::uint32_t, Channel> all_;
    std::uint32_t last_id_ = 0;
    std::map<Key, Channel*> by_key_;
    std::vector<OfRow> by_row_;  // by place
    std::vector<std::uint32_t> forgotten_;
    MonoTime may_forget_at_{};
    std::uint64_t unknown_ = 0, left_out_ = 0;
};

}  // namespace mavloom::web
