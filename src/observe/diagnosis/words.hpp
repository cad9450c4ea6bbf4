// SPDX-License-Identifier: MIT
// The words of all findings: what is wrong, why, and what to do. Private to module observe. The rules decide; these
// functions, in words_*.cpp, only write. docs/guide/doctor.md has an entry for each id.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "mavloom/observe/diagnosis.hpp"

namespace mavloom::observe::words {

// ---- sources and ports
[[nodiscard]] Finding port_taken(const Listened& source);
[[nodiscard]] Finding cannot_open(const Listened& source);
[[nodiscard]] Finding port_refused(const Listened& source);
[[nodiscard]] Finding port_refused(const Hop& hop, const HopLink& link, std::uint64_t frames);
[[nodiscard]] Finding not_connected(const Listened& source);
[[nodiscard]] Finding nothing_heard(const Evidence& evidence, const Listened& source);
// Nothing at all: none of the sources that were tried has brought a frame.
[[nodiscard]] Finding nothing_heard(const Evidence& evidence);
[[nodiscard]] Finding wrong_baud(const Listened& source, std::uint64_t bytes);
[[nodiscard]] Finding not_mavlink(const Listened& source, std::uint64_t bytes);
[[nodiscard]] Finding long_datagrams(const Listened& source, std::uint64_t count);

// ---- frames that cannot be read
[[nodiscard]] Finding damaged_frames(const Listened& source, std::uint64_t damaged, std::uint64_t good);
[[nodiscard]] Finding damaged_recording(const Listened& source, std::uint64_t places);
struct WrongMessage {
    MessageId id{};
    std::string_view name{};  // empty: it has no definition
    std::uint64_t count = 0;
};
[[nodiscard]] Finding wrong_dialect(const std::string& link, std::span<const WrongMessage> messages);

// ---- losses
// Whether a program that was examined injects faults: losses may be theirs.
enum class Faults : std::uint8_t { off, on };
[[nodiscard]] Finding lost_before(const Evidence& evidence, const SenderLoss& loss, const RadioReport* radio,
                                  Faults faults);
[[nodiscard]] Finding regular_gaps(const Evidence& evidence, const SenderLoss& loss, double station_loss);
[[nodiscard]] Finding kernel_drop(const Listened& source, std::uint64_t datagrams, std::uint64_t lost_frames);
[[nodiscard]] Finding receive_buffer(const Listened& source, double frames_per_s);
[[nodiscard]] Finding ring_lapped(const Listened& source, std::uint64_t records);
[[nodiscard]] Finding too_slow(std::uint64_t frames);
[[nodiscard]] Finding queue_drop(const Hop& hop, const HopLink& link, const NamedCount& loss);
[[nodiscard]] Finding faults_on(const Hop& hop, const HopLink& link, std::span<const NamedCount> injected);
[[nodiscard]] Finding ring_dropped(const Hop& hop, const NamedCount& loss);
[[nodiscard]] Finding lost_between(const Evidence& evidence, std::size_t first, const Passage& passage);
[[nodiscard]] Finding filtered_between(const Evidence& evidence, std::size_t first, const Passage& passage);

// ---- senders
struct TwoSenders {
    std::string where;
    std::string reason;  // how it was noticed: "their sequence numbers mix"
};
[[nodiscard]] Finding two_senders(Source sender, const TwoSenders& senders);
[[nodiscard]] Finding two_links(const Evidence& evidence, std::size_t source, const SenderStream& sender);
[[nodiscard]] Finding split_stream(const Evidence& evidence, std::size_t source, const SenderStream& sender,
                                   double worst_loss);
[[nodiscard]] Finding duplicates(const Evidence& evidence, std::size_t source, const SenderStream& sender);
[[nodiscard]] Finding no_heartbeat(const Evidence& evidence, std::size_t source, SystemId system, std::uint64_t frames);
[[nodiscard]] Finding unsigned_frames(const Listened& source, std::span<const Source> with,
                                      std::span<const Source> without);
[[nodiscard]] Finding partly_signed(const Listened& source, const SenderStream& sender);
[[nodiscard]] Finding of_alarm(const Alarm& alarm);  // clock, restart or silent

// ---- rates and radios
struct Rate {
    double hz = 0;        // that came
    double seconds = 0;   // in which they came
    bool is_low = false;  // else it is too high
};
[[nodiscard]] Finding rate_not_met(const Evidence& evidence, const AskedRate& asked, const Rate& rate);
[[nodiscard]] Finding rate_contested(const Evidence& evidence, const AskedRate& one, const AskedRate& other);
// `streams`: the largest ones first. `asked`: whether somebody asked for them while we listened.
struct Load {
    Stream stream;
    double share = 0;
    bool was_asked = false;
};
[[nodiscard]] Finding link_full(const Listened& source, double bytes_per_s, std::span<const Load> loads);
[[nodiscard]] Finding radio_full(const Evidence& evidence, const RadioReport& radio, std::span<const Load> loads);
[[nodiscard]] Finding radio_weak(const RadioReport& radio);

}  // namespace mavloom::observe::words
