// SPDX-License-Identifier: MIT
// The table of faults: name, form, and how to parse the value; and the presets (docs/guide/faults.md).
#include "mavloom/endpoint/fault.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "mavloom/base/suggest.hpp"
#include "mavloom/dialect/terms.hpp"
#include "mavloom/endpoint/grammar.hpp"

namespace mavloom::endpoint {

namespace {

using namespace std::chrono_literals;
using std::chrono::nanoseconds;

struct Fault {
    std::string_view name, example;
    SetupResult<void> (*set)(Faults& faults, std::string_view value);
};

// "A", or "A" and "B" of "A/B".
struct Parts {
    std::string_view first, second;
    bool has_second = false;
};

Parts parts_of(std::string_view value, char between = '/') {
    const auto at = value.find(between);
    if (at == std::string_view::npos) return {value, {}, false};
    return {value.substr(0, at), value.substr(at + 1), true};
}

SetupResult<double> parse_real(std::string_view text, double least, double most, std::string_view what) {
    double value = 0;
    const bool has_sign = text.starts_with('-') || text.starts_with('+');
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_number = !has_sign && error == std::errc{} && end == text.data() + text.size();
    if (!is_number || !(value >= least && value <= most))
        return usage(fmt::format("{} is not {} from {} to {}", in_quotes(text), what, least, most));
    return value;
}

SetupResult<double> parse_share(std::string_view text) {
    if (text.ends_with('%')) return usage(fmt::format("{} is a percentage; for 5 %, type 0.05", in_quotes(text)));
    return parse_real(text, 0, 1, "a share");
}

// A time without a unit might be meant in seconds or in milliseconds.
SetupResult<nanoseconds> parse_time(std::string_view text, nanoseconds least, nanoseconds most) {
    const bool has_unit = !text.empty() && text.back() >= 'a' && text.back() <= 'z';
    if (!has_unit && text != "0") return usage(fmt::format("{} has no unit; type 80ms or 2s", in_quotes(text)));
    auto time = parse_duration(text);
    const auto shown_ms = [](nanoseconds t) { return std::chrono::duration<double, std::milli>(t).count(); };
    if (time && (*time < least || *time > most))
        return usage(fmt::format("{} is not a time from {} to {} ms", in_quotes(text), shown_ms(least), shown_ms(most)));
    return time;
}

SetupResult<std::uint64_t> parse_bytes(std::string_view text, std::uint64_t least, std::uint64_t most) {
    auto size = parse_size(text);
    if (size && (*size < least || *size > most))
        return usage(fmt::format("{} is not from {} to {} bytes", in_quotes(text), least, most));
    return size;
}

// ---- the values -----------------------------------------------------------------------------------------------------

template <double Faults::*member>
SetupResult<void> set_share(Faults& faults, std::string_view value) {
    return put(parse_share(value), faults.*member);
}

// From the good state, the chance to enter a burst is loss / ((1 - loss) * burst). It is at most 1.
SetupResult<void> check_burst(const Faults& faults) {
    const double most = faults.burst / (faults.burst + 1);
    if (faults.loss <= most) return {};
    return usage(fmt::format("in bursts of {}, at most {:.3f} of all can be lost; type a longer burst", faults.burst,
                             std::floor(most * 1000) / 1000));
}

SetupResult<void> set_loss(Faults& faults, std::string_view value) {
    const Parts parts = parts_of(value);
    faults.burst = 0;
    if (auto done = put(parse_share(parts.first), faults.loss); !done || !parts.has_second) return done;
    constexpr double longest = 10'000;
    if (auto done = put(parse_real(parts.second, 1, longest, "a length of bursts"), faults.burst); !done) return done;
    return check_burst(faults);
}

SetupResult<void> set_delay(Faults& faults, std::string_view value) {
    const Parts parts = parts_of(value, '~');
    faults.jitter = {};
    if (auto done = put(parse_time(parts.first, 0ns, 10min), faults.delay); !done || !parts.has_second) return done;
    if (auto done = put(parse_time(parts.second, 0ns, 10min), faults.jitter); !done) return done;
    if (faults.jitter <= faults.delay) return {};
    return usage(fmt::format("the jitter {} exceeds the delay {}", in_quotes(parts.second), in_quotes(parts.first)));
}

SetupResult<void> set_reorder(Faults& faults, std::string_view value) {
    const Parts parts = parts_of(value);
    if (auto done = put(parse_share(parts.first), faults.reorder); !done) return done;
    return put(parse_time(parts.has_second ? parts.second : "20ms", 1ms, 10s), faults.reorder_by);
}

// The usual queue holds what is sent in a second.
SetupResult<void> set_rate(Faults& faults, std::string_view value) {
    constexpr std::uint64_t most = std::uint64_t{1} << 30, least_queue = 280;
    const Parts parts = parts_of(value);
    if (auto done = put(parse_bytes(parts.first, 1, most), faults.rate_bytes_s); !done) return done;
    faults.rate_queue_bytes = std::max<std::uint64_t>(faults.rate_bytes_s, 1024);
    return parts.has_second ? put(parse_bytes(parts.second, least_queue, most), faults.rate_queue_bytes)
                            : SetupResult<void>{};
}

template <Episodes Faults::*member>
SetupResult<void> set_episodes(Faults& faults, std::string_view value) {
    const Parts parts = parts_of(value);
    if (!parts.has_second) return usage(fmt::format("{} does not state how often; type 1s/30s", in_quotes(value)));
    auto& [length, every] = faults.*member;
    if (auto done = put(parse_time(parts.first, 1ms, 24h), length); !done) return done;
    if (auto done = put(parse_time(parts.second, 1ms, 24h), every); !done) return done;
    if (length < every) return {};
    return usage(fmt::format("{} is not shorter than {}, so nothing would ever pass", in_quotes(parts.first),
                             in_quotes(parts.second)));
}

constexpr std::array faults_table{
    Fault{"blackout", "blackout:1s/30s", set_episodes<&Faults::blackout>},
    Fault{"loss", "loss:0.05 or loss:0.05/8", set_loss},
    Fault{"duplicate", "duplicate:0.01", set_share<&Faults::duplicate>},
    Fault{"corrupt", "corrupt:0.01", set_share<&Faults::corrupt>},
    Fault{"cut", "cut:0.01", set_share<&Faults::cut>},
    Fault{"delay", "delay:80ms or delay:80ms~20ms", set_delay},
    Fault{"stall", "stall:1s/30s", set_episodes<&Faults::stall>},
    Fault{"reorder", "reorder:0.01 or reorder:0.01/50ms", set_reorder},
    Fault{"rate", "rate:2400 or rate:2400/2k", set_rate},
};

constexpr auto names_of_faults = [] {
    std::array<std::string_view, faults_table.size()> names;
    for (std::size_t i = 0; i < names.size(); ++i) names[i] = faults_table[i].name;
    return names;
}();

// docs/guide/faults.md has what they stand for, and where the figures come from.
constexpr std::array presets{
    FaultPreset{"sik", "delay:66ms~64ms,rate:2400/2k"},
    FaultPreset{"sik-edge", "loss:0.2/6,delay:66ms~64ms,rate:2400/2k"},
    FaultPreset{"lte", "loss:0.005,delay:50ms~20ms,stall:1s/60s"},
    FaultPreset{"lte-bad", "loss:0.03/4,delay:150ms~80ms,stall:2s/20s,rate:16k/64k"},
    FaultPreset{"satcom", "delay:40s~20s,rate:20/512"},
    FaultPreset{"wifi", "loss:0.01/5,delay:11ms~9ms"},
};

// ---- the terms ------------------------------------------------------------------------------------------------------

const FaultPreset* find_preset(std::string_view name) {
    const auto found = std::ranges::find(presets, name, &FaultPreset::name);
    return found == presets.end() ? nullptr : &*found;
}

tl::unexpected<SetupError> unknown_word(std::string_view word) {
    std::vector<std::string_view> names(names_of_faults.begin(), names_of_faults.end());
    for (const FaultPreset& preset : presets) names.push_back(preset.name);
    auto hint = did_you_mean(word, names);
    if (hint.empty()) hint = fmt::format("; there are {}", fmt::join(names, ", "));
    return usage(fmt::format("there is no fault {}{}", in_quotes(word), hint));
}

// Parses the terms of one list, in which each fault may stand once.
class TermReader {
public:
    explicit TermReader(Faults& faults) : faults_(faults) {}

    SetupResult<void> read(std::string_view term) {
        const bool is_first = std::exchange(is_first_, false);
        const auto colon = term.find(':');
        if (colon == std::string_view::npos) return read_word(term, is_first);
        const auto name = term.substr(0, colon);
        const auto fault = std::ranges::find(faults_table, name, &Fault::name);
        if (fault == faults_table.end()) return unknown_word(name);
        if (std::exchange(seen_[static_cast<std::size_t>(fault - faults_table.begin())], true))
            return usage(fmt::format("{} stands twice", in_quotes(name)));
        auto done = fault->set(faults_, term.substr(colon + 1));
        if (!done) return tl::unexpected(std::move(done.error()).within(name));
        return {};
    }

private:
    SetupResult<void> read_word(std::string_view word, bool is_first) {
        if (const auto fault = std::ranges::find(faults_table, word, &Fault::name); fault != faults_table.end())
            return usage(fmt::format("{} needs a value, as in {}", in_quotes(word), fault->example));
        if (word == "off") return usage("'off' stands alone");
        const FaultPreset* const preset = find_preset(word);
        if (preset == nullptr) return unknown_word(word);
        if (!is_first) return usage(fmt::format("the preset {} stands before all others", in_quotes(word)));
        TermReader reader(faults_);
        return dialect::for_each_term(preset->faults, [&](std::string_view term) { return reader.read(term); });
    }

    Faults& faults_;
    std::array<bool, faults_table.size()> seen_{};
    bool is_first_ = true;
};

std::string names_of_streams() {
    std::vector<std::string_view> names;
    for (const SchemeRow& row : scheme_rows)
        if (row.is_stream) names.push_back(row.name);
    return fmt::format("{}", fmt::join(names, ", "));
}

const Faults no_faults{};

}  // namespace

bool Faults::any() const noexcept {
    return blackout.length.count() != 0 || loss > 0 || duplicate > 0 || corrupt > 0 || cut > 0 || delay.count() != 0 ||
           stall.length.count() != 0 || reorder > 0 || rate_bytes_s != 0;
}

std::span<const FaultPreset> fault_presets() noexcept { return presets; }

SetupResult<Faults> parse_faults(std::string_view text) {
    if (text == "off") return Faults{};
    if (text.empty())
        return usage("no fault is given; write some, such as loss:0.05,delay:80ms, a preset such as sik, or off");
    Faults faults;
    TermReader reader(faults);
    auto done = dialect::for_each_term(text, [&](std::string_view term) { return reader.read(term); });
    if (!done) return tl::unexpected(std::move(done.error()));
    faults.text = std::string(text);
    return faults;
}

SetupResult<std::uint64_t> parse_fault_seed(std::string_view text) {
    return parse_integer(text, 0, std::numeric_limits<std::uint64_t>::max());
}

SetupResult<void> check_faults(const Faults& faults, const SchemeRow& scheme) {
    if (faults.cut == 0 || scheme.is_stream) return {};
    return usage(fmt::format("'cut' is a fault of byte streams ({}), not of {}", names_of_streams(), scheme.name));
}

const Faults& inward_faults(const EndpointOptions& options) noexcept {
    return options.in_fault ? *options.in_fault : options.fault ? *options.fault : no_faults;
}

const Faults& outward_faults(const EndpointOptions& options) noexcept {
    return options.out_fault ? *options.out_fault : options.fault ? *options.fault : no_faults;
}

}  // namespace mavloom::endpoint
