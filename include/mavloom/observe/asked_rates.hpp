// SPDX-License-Identifier: MIT
// The message rates that programs asked for, and how many messages came since. For a diagnosis.
// Sources: MAVLink's common.xml, MAV_CMD_SET_MESSAGE_INTERVAL, MESSAGE_INTERVAL, REQUEST_DATA_STREAM.
//
// One owner thread. Bounded: the oldest request leaves first.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <unordered_set>
#include <vector>

#include "mavloom/base/secret_hash.hpp"
#include "mavloom/observe/heard.hpp"

namespace mavloom::observe {

struct AskedRate {
    enum class How : std::uint8_t { set_message_interval, request_data_stream, reported };

    How how = How::set_message_interval;
    Source asker{};   // of a report, the vehicle itself
    Source target{};  // component 0: all
    MessageId id{};   // of a data stream, the message that stands for it
    double hz = 0;    // 0: the message shall not come
    WallTime time{};
    std::optional<std::uint8_t> result{};       // MAV_RESULT of the answer
    std::map<LinkId, std::uint64_t> heard{};    // messages since then
    [[nodiscard]] std::uint64_t count() const;  // on the link that has the most
};

class AskedRates {
public:
    static constexpr std::size_t max_asked = 256, max_links = 64;

    void take(const Heard& heard);
    // The oldest first.
    [[nodiscard]] const std::vector<AskedRate>& all() const noexcept { return all_; }

private:
    struct KeyHash {
        std::size_t operator()(std::uint64_t key) const noexcept { return secret_hash(key); }
    };
    [[nodiscard]] static std::uint64_t key_of(SystemId system, MessageId id) noexcept {
        return std::uint64_t{id.value} << 8 | system.value;
    }
    void note_command(const Heard& heard, Source target, float id, float interval_us);
    void note_stream(const Heard& heard);
    void note_report(const Heard& heard);
    void note_answer(const Heard& heard);
    void ask(AskedRate asked);
    void forget(SystemId target, MessageId id);
    void count(const Heard& heard);

    std::vector<AskedRate> all_;
    std::unordered_set<std::uint64_t, KeyHash> watched_;  // keys of `all_`
};

}  // namespace mavloom::observe
