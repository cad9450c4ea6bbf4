// SPDX-License-Identifier: MIT
// Rules about rates: those that programs asked for, and links and radios that are full.
#include <algorithm>

#include "observe/diagnosis/rules.hpp"
#include "observe/diagnosis/words.hpp"

namespace mavloom::observe::rules {

namespace {

constexpr double tolerance = 0.2;         // of the rate
constexpr double frames_tolerance = 1.5;  // at the begin and the end
constexpr double least_expected = 5, least_seconds = 1.5;

struct OfSource {
    const std::vector<SenderStream>& senders;
    const std::vector<AskedRate>& asked;
    std::size_t number;
};

// When its target was last heard.
WallTime last_heard(const OfSource& source, Source target) {
    WallTime last = WallTime::min();
    for (const auto& sender : source.senders)
        if (sender.source.system == target.system) last = std::max(last, sender.last);
    return last;
}

double arriving_share(const Evidence& evidence, const OfSource& source, Source target) {
    double worst = 0;
    for (const auto& loss : evidence.losses) {
        const auto* const link = evidence.link(loss.link);
        if (loss.source.system == target.system && link != nullptr && link->source == source.number)
            worst = std::max(worst, loss_ratio(loss));
    }
    return 1 - worst;
}

bool is_same_message(const AskedRate& one, const AskedRate& other) {
    return one.target.system == other.target.system && one.id == other.id;
}

bool is_report(const AskedRate& asked) { return asked.how == AskedRate::How::reported; }

// A later request counts, and a request counts more than the vehicle's own report.
bool is_outdone(const OfSource& source, const AskedRate& asked) {
    return std::ranges::any_of(source.asked, [&](const AskedRate& other) {
        if (&other == &asked || !is_same_message(other, asked)) return false;
        return is_report(asked) == is_report(other) ? other.time > asked.time : is_report(asked);
    });
}

void find_rate(const Evidence& evidence, const OfSource& source, const AskedRate& asked, Findings& findings) {
    if (is_outdone(source, asked)) return;
    const auto last = last_heard(source, asked.target);
    if (last == WallTime::min()) return;
    const words::Rate rate{.seconds = seconds(last - asked.time)};
    const double expected = asked.hz * rate.seconds;
    if (rate.seconds < least_seconds || (asked.hz > 0 && expected < least_expected)) return;
    const auto count = static_cast<double>(asked.count());
    const double share = arriving_share(evidence, source, asked.target);
    const bool is_low = count < expected * (1 - tolerance) * share - frames_tolerance;
    const bool is_high = count > expected * (1 + tolerance) + frames_tolerance + (asked.hz == 0 ? least_expected : 0);
    if (is_low || is_high)
        findings.push_back(words::rate_not_met(evidence, asked, {count / rate.seconds, rate.seconds, is_low}));
}

// Another request for the same message, which asks for another rate. Null if there is none.
const AskedRate* contest_of(const OfSource& source, const AskedRate& asked) {
    if (is_report(asked)) return nullptr;
    const auto other = std::ranges::find_if(source.asked, [&](const AskedRate& one) {
        return !is_report(one) && is_same_message(one, asked) && one.asker != asked.asker && one.hz != asked.hz;
    });
    return other == source.asked.end() ? nullptr : &*other;
}

}  // namespace

void find_rates(const Evidence& evidence, Findings& findings) {
    for (std::size_t number = 0; number < evidence.asked.size(); ++number) {
        const OfSource source{evidence.senders[number], evidence.asked[number], number};
        for (const auto& asked : source.asked) {
            const auto* const other = contest_of(source, asked);
            if (other == nullptr) find_rate(evidence, source, asked, findings);
            else if (other > &asked) findings.push_back(words::rate_contested(evidence, asked, *other));
        }
    }
}

namespace {

constexpr double full_limit = 0.8, least_share = 0.05;
constexpr double bits_per_byte = 10;  // with start and stop bit
constexpr std::uint8_t full_txbuf_percent = 20;
constexpr int least_margin = 20;                                  // about 10 dB for a SiK radio, whose unit is 1/1.9 dB
constexpr std::uint64_t many_errors = 3, reports_per_error = 20;  // radios report about once a second

bool was_asked(const Evidence& evidence, const Stream& stream) {
    return std::ranges::any_of(evidence.asked, [&](const auto& of_source) {
        return std::ranges::any_of(of_source, [&](const AskedRate& asked) {
            return asked.id == stream.id && asked.target.system == stream.source.system;
        });
    });
}

// The largest streams of the links for which `is_there` returns true.
template <class IsThere>
std::vector<words::Load> loads_of(const Evidence& evidence, IsThere is_there) {
    constexpr std::size_t most = 3;
    std::vector<words::Load> loads;
    double all = 0;
    for (const auto& stream : evidence.streams) {
        if (!is_there(stream.link)) continue;
        all += static_cast<double>(stream.bytes);
        loads.push_back({stream, 0, was_asked(evidence, stream)});
    }
    std::ranges::sort(loads, std::ranges::greater{}, [](const words::Load& load) { return load.stream.bytes; });
    if (loads.size() > most) loads.resize(most);
    for (auto& load : loads) load.share = static_cast<double>(load.stream.bytes) / all;
    std::erase_if(loads, [](const words::Load& load) { return load.share < least_share; });
    return loads;
}

}  // namespace

void find_full_links(const Evidence& evidence, Findings& findings) {
    for (const auto& source : evidence.sources) {
        if (source.baud == 0 || evidence.seconds() == 0) continue;
        const auto bytes = static_cast<double>(source.count("bytes_in") + source.count("junk_bytes"));
        if (source.count("frames_in") == 0 || bytes * bits_per_byte < full_limit * source.baud * evidence.seconds())
            continue;
        const auto loads = loads_of(evidence, [&](LinkId link) { return evidence.source_of(link) == &source; });
        findings.push_back(words::link_full(source, bytes / evidence.seconds(), loads));
    }
    for (const auto& radio : evidence.radios) {
        if (radio.lowest_txbuf_percent <= full_txbuf_percent)
            findings.push_back(words::radio_full(evidence, radio,
                                                 loads_of(evidence, [&](LinkId link) { return link == radio.link; })));
        const bool has_errors = radio.rxerrors >= many_errors && radio.rxerrors * reports_per_error >= radio.count;
        if (has_errors || (radio.lowest_margin && *radio.lowest_margin < least_margin))
            findings.push_back(words::radio_weak(radio));
    }
}

}  // namespace mavloom::observe::rules
