// SPDX-License-Identifier: MIT
// Rates, full links and radios.
#include <fmt/format.h>

#include "mavloom/base/counted.hpp"
#include "mavloom/base/source_text.hpp"
#include "mavloom/msg/enums/mav_result.hpp"
#include "observe/diagnosis/word_parts.hpp"
#include "observe/diagnosis/words.hpp"

namespace mavloom::observe::words {

using Severity = Finding::Severity;

namespace {

std::string stream_name(const Stream& stream) {
    return stream.name.empty() ? fmt::format("#{}", stream.id.value) : std::string(stream.name);
}

// "The largest streams: ATTITUDE of 1/1 at 50 Hz (40 %), ... Nobody asked for ATTITUDE while we listened."
std::string loads_text(std::span<const Load> loads) {
    std::string text, unasked;
    for (const auto& load : loads) {
        text += fmt::format("{}{} of {} at {} ({})", text.empty() ? "" : ", ", stream_name(load.stream),
                            source_text(load.stream.source), hertz(load.stream.hz), percent(load.share));
        if (!load.was_asked) unasked += (unasked.empty() ? "" : ", ") + stream_name(load.stream);
    }
    if (!unasked.empty()) unasked = fmt::format(" Nobody asked for {} while we listened.", unasked);
    return fmt::format("The largest streams: {}.{}", text, unasked);
}

}  // namespace

Finding rate_not_met(const Evidence& evidence, const AskedRate& asked, const Rate& rate) {
    using How = AskedRate::How;
    const auto name = message_name(evidence, asked.id);
    Finding finding{.id = rate.is_low ? "rate-low" : "rate-high"};
    finding.where = fmt::format("{} of {}", name, source_text(asked.target));
    finding.sender = asked.target;
    finding.message = asked.id;
    finding.what = fmt::format("{} came at {}, {}.", name, hertz(rate.hz),
                               asked.how == How::reported ? fmt::format("and the vehicle reports {}", hertz(asked.hz))
                               : asked.hz == 0
                                   ? fmt::format("and {} asked to stop it", source_text(asked.asker))
                                   : fmt::format("{} asked by {}", hertz(asked.hz), source_text(asked.asker)));
    if (asked.how == How::request_data_stream)
        finding.why = "It was asked for by REQUEST_DATA_STREAM, which PX4 ignores.";
    else if (asked.result && *asked.result != msg::MAV_RESULT_ACCEPTED)
        finding.why = fmt::format("The vehicle refused the request (MAV_RESULT {}).", *asked.result);
    else if (asked.how == How::set_message_interval && !asked.result)
        finding.why = "The vehicle did not answer the request: it did not arrive, or nobody routes it there.";
    else finding.why = "The link is too slow for it, its rate is limited on the way, or the vehicle cannot send it so.";
    finding.remedy = asked.how == How::request_data_stream
                         ? "Use MAV_CMD_SET_MESSAGE_INTERVAL."
                         : "Ask again, lower the other rates of the link, and look for max_rate= on the way.";
    return finding;
}

Finding rate_contested(const Evidence& evidence, const AskedRate& one, const AskedRate& other) {
    const auto name = message_name(evidence, one.id);
    Finding finding{.id = "rate-contested"};
    finding.where = fmt::format("{} of {}", name, source_text(one.target));
    finding.sender = one.target;
    finding.message = one.id;
    finding.what = fmt::format("{} asks for {}, {} for {}.", source_text(one.asker), hertz(one.hz),
                               source_text(other.asker), hertz(other.hz));
    finding.why = "A link has one rate for a message. The last request counts, for all programs behind it.";
    finding.remedy = "Let one program set the rates, and limit the others with max_rate= on their own endpoints.";
    return finding;
}

Finding link_full(const Listened& source, double bytes_per_s, std::span<const Load> loads) {
    auto finding = of_source("link-full", Severity::warning, source);
    finding.what = fmt::format("The line carries {:.0f} bytes/s, which is {} of its {} baud.", bytes_per_s,
                               percent(bytes_per_s * 10 / source.baud), source.baud);
    finding.why = loads_text(loads);
    finding.remedy =
        "Ask for lower rates (MAV_CMD_SET_MESSAGE_INTERVAL; MAV_n_RATE on PX4, SRn_ on ArduPilot), or raise the baud "
        "rate.";
    return finding;
}

Finding radio_full(const Evidence& evidence, const RadioReport& radio, std::span<const Load> loads) {
    auto finding = of_link("radio-full", Severity::warning, evidence, radio.link, radio.source);
    finding.what = fmt::format("The radio's send buffer had only {} % free (RADIO_STATUS.txbuf).",
                               radio.lowest_txbuf_percent);
    finding.why = "More is sent than the radio carries. " + loads_text(loads);
    finding.remedy = "Ask for lower rates, or limit them before the radio: max_rate= or max_bytes= of its endpoint.";
    return finding;
}

Finding radio_weak(const RadioReport& radio) {
    auto finding = of_sender("radio-weak", Severity::warning, radio.source, radio.link_name);
    finding.link = radio.link_name;
    finding.what = fmt::format(
        "The radio reports {}, {} corrected ones{}.", counted(radio.rxerrors, "receive error"), radio.fixed,
        radio.lowest_margin ? fmt::format(", and a signal of {} units above the noise", *radio.lowest_margin) : "");
    finding.why = "The signal is weak, or another transmitter disturbs it.";
    finding.remedy = "Check antennas, distance and frequency; a lower air rate reaches farther.";
    return finding;
}

}  // namespace mavloom::observe::words
