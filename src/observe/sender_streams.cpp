// SPDX-License-Identifier: MIT
#include "mavloom/observe/sender_streams.hpp"

#include <algorithm>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>

#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/system_time.hpp"
#include "mavloom/observe/radio_reports.hpp"

namespace mavloom::observe {

namespace {

// A frame as far behind the newest one is late or repeated; one that is farther away begins another sequence.
constexpr std::int8_t farthest_behind = -100;
// A number comes again after 256 frames of one sequence. Frames of two links count together.
constexpr std::uint64_t frames_until_again = 250;
// So many frames in a row behind the newest one are a sequence that began again.
constexpr int restarted_after = 8;
constexpr int constant_after = 8;

std::uint64_t print_of(const wire::FrameView& frame) noexcept {
    const auto bytes = frame.bytes();
    return std::hash<std::string_view>{}({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace

void SenderStream::Windows::add(double missing_in_window, double sent_in_window) noexcept {
    ++count;
    missing += missing_in_window;
    sent += sent_in_window;
    missing_squared += missing_in_window * missing_in_window;
    missing_sent += missing_in_window * sent_in_window;
    sent_squared += sent_in_window * sent_in_window;
}

// By chance, the number has a binomial distribution. A window in which more frames came, after a pause, may miss more.
double SenderStream::Windows::variation() const noexcept {
    const double share = sent == 0 ? 0 : missing / sent;
    const double by_chance = share * (1 - share) * sent;
    if (count < 2 || by_chance == 0) return 1;
    const double squares = missing_squared - 2 * share * missing_sent + share * share * sent_squared;
    return squares / by_chance * static_cast<double>(count) / static_cast<double>(count - 1);
}

// Losses in bursts vary more than by chance. A stream that is left out has nearly the same number of frames in each
// window. Chance is as even in one of 60 cases with 8 windows, and in one of 100,000 with 20.
bool SenderStream::has_regular_gaps() const noexcept {
    constexpr std::uint64_t least_windows = 8;
    constexpr double least_missing = 2, limit = 0.2;
    return windows.count >= least_windows && windows.missing >= least_missing * static_cast<double>(windows.count) &&
           windows.variation() < limit;
}

// When the sender's time_boot_ms was 0, in UTC. Empty: it has no UTC, or one after 2116. Two of them do not overflow
// when they are subtracted.
static std::optional<Nanoseconds> start_of(const msg::SystemTime& time) noexcept {
    constexpr std::uint64_t most = INT64_MAX / 2 / 1000;
    if (time.time_unix_usec == 0 || time.time_unix_usec > most) return std::nullopt;
    return std::chrono::microseconds(time.time_unix_usec) - std::chrono::milliseconds(time.time_boot_ms);
}

struct SenderStreams::State {
    struct Print {
        std::uint64_t bytes = 0, number = 0;  // of the frame, from 1; 0: none
        LinkId link{};
    };

    // On one of several links, the frame follows the one before it: the link has a sequence of its own, or carries all.
    [[nodiscard]] bool follows_on_link(LinkId link, std::uint8_t sequence) {
        if (!newest_on_link.contains(link) && newest_on_link.size() == max_links) return false;
        const auto [at, is_new] = newest_on_link.try_emplace(link, sequence);
        return std::exchange(at->second, sequence) == static_cast<std::uint8_t>(sequence - 1) && !is_new &&
               its.links.size() > 1;
    }

    // Of a frame with the same number that was heard so short ago that it is of the same round of numbers. Null: none.
    [[nodiscard]] const Print* print_of_number(std::uint8_t sequence) const {
        const auto& known = prints[sequence];
        return known.number == 0 || its.frames - known.number >= frames_until_again ? nullptr : &known;
    }

    // Of the newest SYSTEM_TIME on a link.
    struct Clock {
        Nanoseconds start{};  // when time_boot_ms was 0, in UTC
        WallTime heard{};
    };

    SenderStream its;
    std::map<LinkId, std::uint8_t> newest_on_link;
    std::map<LinkId, Clock> clocks;
    std::array<Print, 256> prints{};  // by sequence number
    std::uint8_t newest = 0;
    std::uint8_t heard_last = 0;  // also if it is late
    int behind_in_row = 0, equal_in_row = 0;
    std::optional<std::uint16_t> kind;
    WallTime window_begin{};
    std::uint64_t missing_before_window = 0, frames_before_window = 0;
};

SenderStreams::SenderStreams() = default;
SenderStreams::SenderStreams(SenderStreams&&) noexcept = default;
SenderStreams& SenderStreams::operator=(SenderStreams&&) noexcept = default;
SenderStreams::~SenderStreams() = default;

SenderStreams::State* SenderStreams::find_or_add(const Heard& heard) {
    const auto source = heard.frame.source();
    if (last_ != nullptr && last_->its.source == source) return last_;
    const auto known = index_.find(source);
    if (known == index_.end() && states_.size() == max_senders) return nullptr;
    if (known == index_.end()) {
        index_.emplace(source, states_.size());
        auto& state = *states_.emplace_back(std::make_unique<State>());
        state.its.source = source;
        state.its.first = state.window_begin = heard.time;
        return last_ = &state;
    }
    return last_ = states_[known->second].get();
}

void SenderStreams::add(const Heard& heard) {
    auto* const state = find_or_add(heard);
    if (state == nullptr) {
        ++unlisted_;
        return;
    }
    auto& its = state->its;
    const auto& frame = heard.frame;
    ++its.frames;
    its.last = heard.time;
    if (its.links.size() < max_links || its.links.contains(heard.link)) ++its.links[heard.link];
    if (!is_of_radio(frame.id())) ++(frame.is_signed() ? its.signed_frames : its.unsigned_frames);
    if (frame.id() == msg::Heartbeat::id) {
        const auto heartbeat = msg::Heartbeat::decode(frame.payload());
        const auto kind = static_cast<std::uint16_t>(heartbeat.type << 8 | heartbeat.autopilot);
        if (state->kind && *state->kind != kind) ++its.changes_of_kind;
        state->kind = kind;
        ++its.heartbeats;
    }
    note_sequence(*state, heard);
    note_window(*state, heard.time);
}

void SenderStreams::note_sequence(State& state, const Heard& heard) {
    auto& its = state.its;
    const auto sequence = heard.frame.sequence();
    const bool is_first = its.frames == 1;
    if (!is_first) its.station_lost += static_cast<std::uint8_t>(sequence - state.heard_last - 1);
    state.equal_in_row = !is_first && sequence == state.heard_last ? state.equal_in_row + 1 : 0;
    if (state.equal_in_row >= constant_after) its.has_sequence = false;
    state.heard_last = sequence;

    const bool follows = state.follows_on_link(heard.link, sequence);
    const auto ahead = static_cast<std::int8_t>(sequence - state.newest);
    const auto print = print_of(heard.frame);
    if (heard.frame.id() == msg::SystemTime::id) note_clock(state, heard);
    if (is_first || ahead > 0 || ahead < farthest_behind) {
        if (!is_first && ahead != 1 && follows) ++its.conflicts_across;
        else if (!is_first && ahead > 0 && -ahead >= farthest_behind)
            its.missing += static_cast<std::uint64_t>(ahead - 1);
        state.newest = sequence;
        state.behind_in_row = 0;
    } else if (!count_copy(state, heard, print)) {
        if (follows) ++its.conflicts_across;
        if (++state.behind_in_row == restarted_after) state.newest = sequence;
    }
    state.prints[sequence] = {print, its.frames, heard.link};
}

// One vehicle has one start on all links, but for the milliseconds of time_boot_ms. A start that moves from one
// SYSTEM_TIME of a link to the next one counts nothing: the time of day was set, the vehicle began again, or it is
// simulated faster or slower than real time.
void SenderStreams::note_clock(State& state, const Heard& heard) {
    using namespace std::chrono_literals;
    constexpr Nanoseconds lately = 2s, tolerance = 2ms;
    const auto start = start_of(msg::SystemTime::decode(heard.frame.payload()));
    if (!start) return;
    const auto is_lately = [&](const State::Clock& clock) { return heard.time - clock.heard < lately; };
    const auto is_same = [&](const State::Clock& clock) { return std::chrono::abs(clock.start - *start) <= tolerance; };
    const auto own = state.clocks.find(heard.link);
    const bool is_steady = own != state.clocks.end() && is_lately(own->second) && is_same(own->second);
    const bool contradicts = std::ranges::any_of(
        state.clocks, [&](const auto& entry) { return is_lately(entry.second) && !is_same(entry.second); });
    if (is_steady && contradicts) ++state.its.clocks_across;
    if (state.clocks.size() < max_links || own != state.clocks.end()) state.clocks[heard.link] = {*start, heard.time};
}

// For a frame that is not newer than all before it. Returns false if it is no copy.
bool SenderStreams::count_copy(State& state, const Heard& heard, std::uint64_t print) {
    auto& its = state.its;
    const auto* const known = state.print_of_number(heard.frame.sequence());
    if (known == nullptr) {
        if (its.missing != 0) --its.missing;  // it is only late
        return false;
    }
    const bool is_across = known->link != heard.link;
    if (known->bytes == print) ++(is_across ? its.copies_across : its.copies_on_link);
    else if (!is_across) ++its.conflicts_on_link;
    return known->bytes == print;
}

void SenderStreams::note_window(State& state, WallTime time) {
    auto& its = state.its;
    if (time - state.window_begin < window) return;
    const auto missing = its.missing - std::min(its.missing, state.missing_before_window);
    const auto received = its.frames - state.frames_before_window;
    its.windows.add(static_cast<double>(missing), static_cast<double>(missing + received));
    state.window_begin = time;
    state.missing_before_window = its.missing;
    state.frames_before_window = its.frames;
}

std::vector<SenderStream> SenderStreams::all() const {
    std::vector<SenderStream> all;
    all.reserve(states_.size());
    for (const auto& [source, place] : index_) all.push_back(states_[place]->its);
    return all;
}

}  // namespace mavloom::observe
