// SPDX-License-Identifier: MIT
#include "link/peer_policy.hpp"

#include <algorithm>
#include <cassert>
#include <tuple>

#include "mavloom/base/secret_hash.hpp"

namespace mavloom::link::detail {

// At least as many senders as peers fit, twice, may enter at once.
PeerPolicy::PeerPolicy(std::size_t max_peers, std::uint32_t seed)
    : newcomers_(newcomer_interval, static_cast<int>(std::max<std::size_t>(64, 2 * max_peers))), random_(seed) {}

PeerPolicy::Answer PeerPolicy::ask(const net::Address& sender, MonoTime now) {
    if (newcomers_.allows(now)) return Answer::admitted;
    if (!repeats(sender, now)) return Answer::refused;
    return repeaters_.allows(now) ? Answer::admitted : Answer::limited;
}

void PeerPolicy::note_entry(MonoTime now) noexcept {
    [[maybe_unused]] const bool may_enter = newcomers_.take(now) || repeaters_.take(now);
    assert(may_enter && "ask() must have admitted the sender");
}

bool PeerPolicy::repeats(const net::Address& sender, MonoTime now) {
    if (seen_ == nullptr) seen_ = std::make_unique<Bucket[]>(bucket_count);
    const std::uint64_t hash = secret_hash(sender.hash());  // twice: spreads successive ports evenly
    Bucket& bucket = seen_[hash % bucket_count];
    const auto tag = static_cast<std::uint32_t>(hash >> 32) | 1u;
    const auto now_ms = static_cast<std::uint32_t>(now.time_since_epoch() / std::chrono::milliseconds{1});
    const auto age = [&](const Seen& seen) { return seen.age(now_ms); };
    const auto found = std::ranges::find(bucket, tag, &Seen::tag);
    if (found != bucket.end() && age(*found) <= remembered_for) return age(*found) >= repeats_after;
    Seen& oldest = found != bucket.end() ? *found : *std::ranges::max_element(bucket, {}, age);
    if (age(oldest) >= kept_for) oldest = {tag, now_ms};
    return false;
}

PeerPolicy::CrowdSizes PeerPolicy::crowd_sizes(std::span<const Candidate> peers) noexcept {
    CrowdSizes sizes{};
    for (const Candidate& peer : peers) sizes[peer.crowd] += peer.has_talked ? 0 : 1;
    return sizes;
}

std::optional<LinkId> PeerPolicy::to_evict(std::span<const Candidate> peers, MonoTime now) {
    const CrowdSizes sizes = crowd_sizes(peers);
    const auto rank = [&](const Candidate& peer) {
        return std::tuple(peer.has_talked, peer.has_talked ? std::int64_t{0} : -std::int64_t{sizes[peer.crowd]},
                          peer.silent_since);
    };
    const auto first = std::ranges::min_element(peers, {}, rank);
    if (first == peers.end() || (first->has_talked && now - first->silent_since < active_for)) return std::nullopt;
    return first->id;
}

bool PeerPolicy::is_small(std::uint16_t crowd, std::span<const Candidate> peers) {
    const CrowdSizes sizes = crowd_sizes(peers);
    return sizes[crowd] + 1 < *std::ranges::max_element(sizes);
}

std::optional<LinkId> PeerPolicy::to_displace(std::vector<Candidate> peers, MonoTime now) {
    if (peers.size() < many_peers || !displacements_.take(now)) return std::nullopt;
    const auto middle = peers.begin() + static_cast<std::ptrdiff_t>(peers.size() / 2);
    std::ranges::nth_element(peers, middle, {}, &Candidate::id);
    return middle[static_cast<std::ptrdiff_t>(random_() % (peers.size() - peers.size() / 2))].id;
}

}  // namespace mavloom::link::detail
