// SPDX-License-Identifier: MIT
// Decides which unknown senders an endpoint that listens admits, and which peer it evicts for one when max_peers is
// reached. So a flood of invented addresses costs little, and no crowd keeps all others out. The rules are those of
// docs/guide/queues.md, "Peers of a UDP port". Private to module link; single owner thread.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/ids.hpp"
#include "mavloom/base/pace.hpp"
#include "mavloom/net/address.hpp"

namespace mavloom::link::detail {

class PeerPolicy {
public:
    // The first senders enter at once, later ones at a steady rate. A refused sender enters when it sends again 0.5 to
    // 10 s later. Every MAVLink program does that; invented addresses mostly do not. If many senders repeat, they enter
    // at a steady rate, too.
    static constexpr std::chrono::milliseconds newcomer_interval{20}, repeater_interval{10};
    static constexpr int repeaters_at_once = 100;
    static constexpr std::chrono::milliseconds repeats_after{500};
    static constexpr std::chrono::seconds remembered_for{10};
    // An address that was first seen less than this ago is not replaced by a newer one. So a flood does not make the
    // endpoint forget a program before its next heartbeat. Above 44,000 new addresses a second, the table is full, and
    // a sender may need several tries.
    static constexpr std::chrono::milliseconds kept_for{1500};
    static constexpr std::size_t max_remembered = 1u << 16;
    // A peer that has talked and was heard within this time is active, and no newcomer evicts it. MAVLink programs
    // regard a sender as lost after about as long: four or five heartbeats.
    static constexpr std::chrono::seconds active_for{5};
    // If all of at least `many_peers` are active, one of the younger half may be displaced this often.
    static constexpr std::size_t many_peers = 16;
    static constexpr std::chrono::seconds displacement_interval{2};
    static constexpr int displacements_at_once = 4;

    // A peer that may be evicted.
    struct Candidate {
        LinkId id{};              // grows in the order of arrival
        bool has_talked = false;  // if not, it may be a forged datagram, or a client that never sends
        MonoTime silent_since{};
        std::uint16_t crowd = 0;  // `crowd_of` its address; 0 if that may be forged
    };
    // Equal for addresses of one host, rarely for others.
    [[nodiscard]] static std::uint16_t crowd_of(const net::Address& peer) noexcept {
        return static_cast<std::uint16_t>(peer.host_part().hash() % crowd_count);
    }

    enum class Answer : std::uint8_t {
        admitted,
        refused,  // too many new senders; it may enter when it repeats
        limited,  // it repeated, but so did too many others
    };

    explicit PeerPolicy(std::size_t max_peers, std::uint32_t seed = std::random_device{}());

    // Returns whether this sender may become a peer now. After `admitted`, call `note_entry` if it is a peer, even if
    // the endpoint then has no room for it. Allocates once: a table of senders, when the first is refused.
    [[nodiscard]] Answer ask(const net::Address& sender, MonoTime now);
    void note_entry(MonoTime now) noexcept;
    // Returns whether the sender was first seen 0.5 to 10 s ago. If it was not seen in the last 10 s, remembers it.
    [[nodiscard]] bool repeats(const net::Address& sender, MonoTime now);

    // The first to be evicted; empty if all peers are active. Peers that have not talked go first: the longest silent
    // one of the largest crowd of such peers. So a host that connects again and again evicts only itself.
    [[nodiscard]] static std::optional<LinkId> to_evict(std::span<const Candidate> peers, MonoTime now);
    // Whether one more peer of the crowd would still leave it smaller than the largest one, without those that talk.
    [[nodiscard]] static bool is_small(std::uint16_t crowd, std::span<const Candidate> peers);
    // If all peers are active and another sender repeats: a random one of the younger half, if it is time for that. So
    // a late vehicle gets a place among hundreds of others, and usually keeps it for minutes.
    [[nodiscard]] std::optional<LinkId> to_displace(std::vector<Candidate> peers, MonoTime now);

private:
    struct Seen {
        std::uint32_t tag = 0;  // 0: free
        std::uint32_t at_ms = 0;

        [[nodiscard]] std::chrono::milliseconds age(std::uint32_t now_ms) const noexcept {
            constexpr auto never = std::chrono::milliseconds::max();
            return tag == 0 ? never : std::chrono::milliseconds{now_ms - at_ms};  // modulo 2^32, 50 days
        }
    };
    using Bucket = std::array<Seen, 8>;  // a cache line
    static constexpr std::size_t bucket_count = max_remembered / std::tuple_size_v<Bucket>;
    static constexpr std::size_t crowd_count = 1024;
    using CrowdSizes = std::array<std::uint32_t, crowd_count>;
    [[nodiscard]] static CrowdSizes crowd_sizes(std::span<const Candidate> peers) noexcept;

    Pace newcomers_, repeaters_{repeater_interval, repeaters_at_once};
    Pace displacements_{displacement_interval, displacements_at_once};
    std::unique_ptr<Bucket[]> seen_;  // by hash of the address
    std::minstd_rand random_;
};

}  // namespace mavloom::link::detail
