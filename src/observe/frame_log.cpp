// SPDX-License-Identifier: MIT
#include "mavloom/observe/frame_log.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <unordered_map>

namespace mavloom::observe {

namespace {

using Print = FrameLog::Print;
using Prints = std::span<const Print>;
using Which = std::uint64_t Print::*;

// At the limits of the common time, frames may have changed places.
constexpr std::size_t margin = 64;
constexpr std::uint64_t least_anchors = 10;

std::uint64_t hash_of(ByteView bytes) noexcept {
    return std::hash<std::string_view>{}({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

ByteView without_zeros(ByteView payload) noexcept {
    while (payload.size() > 1 && payload.back() == 0) payload = payload.first(payload.size() - 1);
    return payload;
}

std::uint8_t target_system(const wire::FrameView& frame, const wire::MessageInfo* info) noexcept {
    if (info == nullptr || info->target_system_offset >= frame.payload_length()) return 0;
    return frame.payload()[info->target_system_offset];
}

using Counts = std::unordered_map<std::uint64_t, std::int64_t>;
Counts count(Prints prints, Which which) {
    Counts counts;
    for (const auto& print : prints) ++counts[print.*which];
    return counts;
}

// The positions in A and B of a frame that each of them heard exactly once.
struct Anchor {
    std::size_t a = 0, b = 0;
};

using Anchors = std::vector<Anchor>;

// Sorted by position in A.
Anchors anchors_of(Prints a, Prints b, Which which) {
    const auto in_a = count(a, which), in_b = count(b, which);
    std::unordered_map<std::uint64_t, std::size_t> places;
    for (std::size_t i = 0; i < b.size(); ++i)
        if (in_b.at(b[i].*which) == 1) places.emplace(b[i].*which, i);
    Anchors anchors;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (in_a.at(a[i].*which) != 1) continue;
        if (const auto place = places.find(a[i].*which); place != places.end()) anchors.push_back({i, place->second});
    }
    return anchors;
}

// The longest part of them that is also sorted by position in B (patience sorting). A frame whose equal comes again
// later may be a wrong anchor; few are, and they are not in order.
Anchors in_order(const Anchors& anchors) {
    std::vector<std::size_t> ends, before(anchors.size());  // ends[n]: the anchor that ends the best n + 1 ones
    for (std::size_t i = 0; i < anchors.size(); ++i) {
        const auto at = std::ranges::lower_bound(ends, anchors[i].b, {},
                                                 [&](std::size_t end) { return anchors[end].b; });
        before[i] = at == ends.begin() ? i : *std::prev(at);
        if (at == ends.end()) ends.push_back(i);
        else *at = i;
    }
    Anchors sorted(ends.size());
    std::size_t at = ends.empty() ? 0 : ends.back();
    for (auto place = sorted.rbegin(); place != sorted.rend(); ++place, at = before[at]) *place = anchors[at];
    return sorted;
}

bool are_near(const Anchor& one, const Anchor& other) { return other.a - one.a <= margin && other.b - one.b <= margin; }

// A wrong anchor may still be the first or the last one. Right ones have others near them.
void trim(Anchors& anchors) {
    std::size_t first = 0, size = anchors.size();
    while (size - first > 2 && !are_near(anchors[first], anchors[first + 2])) ++first;
    while (size - first > 2 && !are_near(anchors[size - 3], anchors[size - 1])) --size;
    anchors.resize(size);
    anchors.erase(anchors.begin(), anchors.begin() + static_cast<std::ptrdiff_t>(first));
}

struct Common {
    Anchor first, last;
    std::uint64_t anchors = 0;
};

std::optional<Common> common_of(Prints a, Prints b, Which which) {
    auto anchors = in_order(anchors_of(a, b, which));
    trim(anchors);
    if (anchors.empty()) return std::nullopt;
    return Common{anchors.front(), anchors.back(), anchors.size()};
}

// The frames between the first and the last anchor, and those just outside.
struct Part {
    Prints inside, before, behind;
};
Part part_of(Prints all, std::size_t first, std::size_t last) {
    const auto begin = first - std::min(first, margin);
    return {all.subspan(first, last - first + 1), all.subspan(begin, first - begin),
            all.subspan(last + 1, std::min(margin, all.size() - last - 1))};
}

struct CommonTally {
    std::uint64_t heard = 0, lost = 0;
};

// Calls take(print, is_missing) for the frames of `a` in the common time. Each frame of `b` stands for one of `a`. Near
// the limits of the common time, it may be just outside.
template <class Take>
void each_missing(const Part& a, const Part& b, Which which, Take take) {
    auto inside = count(b.inside, which), before = count(b.before, which), behind = count(b.behind, which);
    const auto is_in = [](Counts& counts, std::uint64_t print) {
        const auto at = counts.find(print);
        return at != counts.end() && at->second-- > 0;
    };
    for (std::size_t i = 0; i < a.inside.size(); ++i) {
        const auto print = a.inside[i].*which;
        const bool is_there = is_in(inside, print) || (i < margin && is_in(before, print)) ||
                              (i + margin >= a.inside.size() && is_in(behind, print));
        take(a.inside[i], !is_there);
    }
}

using Tallies = std::unordered_map<MessageId, CommonTally>;

// The loss of the messages of which some came through.
double usual_loss(const Tallies& tallies) {
    CommonTally sum{1, 1};  // one more was lost: nothing is certain
    for (const auto& [id, tally] : tallies) {
        if (tally.lost == tally.heard) continue;
        sum.heard += tally.heard;
        sum.lost += tally.lost;
    }
    return static_cast<double>(sum.lost) / static_cast<double>(sum.heard);
}

void judge_messages(Passage& passage, const Tallies& tallies) {
    constexpr double by_chance = 0.01;
    const double loss = usual_loss(tallies);
    for (const auto& [id, tally] : tallies) {
        if (tally.lost == 0) continue;
        const bool is_filtered = tally.lost == tally.heard &&
                                 std::pow(loss, static_cast<double>(tally.lost)) < by_chance;
        (is_filtered ? passage.filtered : passage.lost) += tally.lost;
        passage.messages.push_back({id, tally.heard, tally.lost, is_filtered});
    }
    std::ranges::sort(passage.messages,
                      [](const auto& x, const auto& y) { return x.lost != y.lost ? x.lost > y.lost : x.id < y.id; });
}

void judge_common(Passage& passage, Prints a, Prints b, const Common& common, Which which) {
    const auto in_a = part_of(a, common.first.a, common.last.a), in_b = part_of(b, common.first.b, common.last.b);
    Tallies tallies;
    each_missing(in_a, in_b, which, [&](const Print& print, bool is_missing) {
        if (print.is_targeted) {
            passage.targeted += is_missing ? 1 : 0;
            return;
        }
        ++passage.before;
        auto& tally = tallies[print.id];
        ++tally.heard;
        tally.lost += is_missing ? 1 : 0;
    });
    each_missing(in_b, in_a, which, [&](const Print&, bool is_missing) { passage.added += is_missing ? 1 : 0; });
    judge_messages(passage, tallies);
}

// Different streams of one vehicle have few frames in common. After a hop that loses or filters much, nearly all frames
// of B are in A.
bool is_same_stream(const Common& common, double share) {
    const auto in_a = common.last.a - common.first.a + 1, in_b = common.last.b - common.first.b + 1;
    const auto less = static_cast<double>(std::min(in_a, in_b));
    return common.anchors >= least_anchors && static_cast<double>(common.anchors) >= share * less;
}

Passage compare(Source source, Prints a, Prints b) {
    Passage passage{.source = source};
    constexpr double same_frames = 0.3, same_contents = 0.8;
    if (const auto common = common_of(a, b, &Print::frame); common && is_same_stream(*common, same_frames)) {
        passage.is_comparable = true;
        judge_common(passage, a, b, *common, &Print::frame);
    } else if (const auto by_content = common_of(a, b, &Print::content);
               by_content && is_same_stream(*by_content, same_contents)) {
        passage.is_comparable = passage.is_rewritten = true;
        judge_common(passage, a, b, *by_content, &Print::content);
    } else {
        passage.has_few = std::min(a.size(), b.size()) < 2 * least_anchors;
    }
    return passage;
}

}  // namespace

void FrameLog::add(const Heard& heard) {
    if (size_ == max_frames) {
        ++left_out_;
        return;
    }
    ++size_;
    const auto& frame = heard.frame;
    const auto bytes = frame.bytes().first(frame.size() - frame.signature().size());
    const auto target = target_system(frame, table_->find(frame.id()));
    senders_[frame.source()].push_back({hash_of(bytes),
                                        hash_of(without_zeros(frame.payload())) ^ std::hash<MessageId>{}(frame.id()),
                                        frame.id(), target != 0});
}

std::vector<Passage> compare(const FrameLog& a, const FrameLog& b) {
    std::vector<Passage> all;
    for (const auto& [source, prints] : a.senders()) {
        const auto other = b.senders().find(source);
        if (other != b.senders().end()) all.push_back(compare(source, prints, other->second));
    }
    return all;
}

}  // namespace mavloom::observe
