// SPDX-License-Identifier: MIT
// Alarms: what a person who watches a link should know, each with its beginning and its end.
//
// One owner thread. Bounded: the oldest leaves first; ended ones and texts before others.
#pragma once

#include <cstdint>
#include <list>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/ids.hpp"
#include "mavloom/base/secret_hash.hpp"

namespace mavloom::observe {

struct Alarm {
    enum class Severity : std::uint8_t { error, warning, info };
    // docs/guide/web.md describes each.
    enum class Kind : std::uint8_t {
        silent,
        loss,
        drop,
        two_senders,
        clock,
        restart,
        battery,
        health,
        ekf,
        failsafe,
        text
    };

    std::uint64_t id = 0;  // from 1, never used again
    Kind kind = Kind::silent;
    Severity severity = Severity::warning;
    std::string link{};  // its name; empty: of no link
    Source source{};     // 0/0: of no source
    std::string text{};  // for people. May be from outside: never markup
    WallTime since{};
    std::optional<WallTime> ended{};
};

// "silent", "two_senders"
[[nodiscard]] std::string_view name_of(Alarm::Kind kind) noexcept;

class Alarms {
public:
    static constexpr std::size_t max_alarms = 256;
    static constexpr Nanoseconds kept_after_end = std::chrono::minutes{10};
    // An alarm that comes back within this time continues.
    static constexpr Nanoseconds pause = std::chrono::seconds{10};

    // Two alarms with one key are the same alarm.
    struct Key {
        Alarm::Kind kind;
        Source source{};
        std::uint64_t detail = 0;  // a battery's number, a hash of a name or a text
        friend bool operator==(const Key&, const Key&) = default;
    };
    struct What {
        Alarm::Severity severity;
        std::string text;
        std::string_view link{};
    };

    // Begins the alarm, or updates its text and severity.
    Alarm& raise(const Key& key, What what, WallTime time) { return raise(key, std::move(what), time, time); }
    // The same for an alarm that began earlier.
    Alarm& raise(const Key& key, What what, WallTime time, WallTime since);
    // The same for something that happens at one moment: it ends by itself after `pause` without another call.
    Alarm& happened(const Key& key, What what, WallTime time, MonoTime now);
    // Ends the alarm, if there is one.
    void clear(const Key& key, WallTime time);
    [[nodiscard]] bool is_raised(const Key& key) const;
    // Call it about once a second.
    void tick(WallTime time, MonoTime now);

    [[nodiscard]] std::vector<Alarm> newest_first() const;
    // Those that left because there was no room.
    [[nodiscard]] std::uint64_t evicted() const noexcept { return evicted_; }

private:
    struct Entry {
        Key key;
        Alarm alarm;
        MonoTime ends_at = MonoTime::max();
    };
    struct KeyHash {
        std::size_t operator()(const Key& key) const noexcept {
            const auto source = std::uint64_t{key.source.system.value} << 8 | key.source.component.value;
            return secret_hash(key.detail, source << 8 | static_cast<std::uint8_t>(key.kind));
        }
    };
    using Entries = std::list<Entry>;  // by beginning

    [[nodiscard]] Entry& begin(const Key& key, WallTime time, WallTime since);
    void make_room();
    Entries::iterator drop(Entries::iterator entry);

    Entries all_;
    std::unordered_map<Key, Entries::iterator, KeyHash> newest_;  // of each key
    std::uint64_t last_id_ = 0, evicted_ = 0;
};

}  // namespace mavloom::observe
