// SPDX-License-Identifier: MIT
#include "mavloom/observe/radio_reports.hpp"

#include <algorithm>

#include "mavloom/msg/radio.hpp"
#include "mavloom/msg/radio_status.hpp"

namespace mavloom::observe {

namespace {

// 0 and UINT8_MAX stand for values that the radio does not have.
void note_margin(RadioReport& report, std::uint8_t signal, std::uint8_t noise) {
    if (signal == 0 || signal == UINT8_MAX || noise == 0 || noise == UINT8_MAX) return;
    const int above_noise = int{signal} - int{noise};
    report.lowest_margin = std::min(report.lowest_margin.value_or(above_noise), above_noise);
}

}  // namespace

bool is_of_radio(MessageId id) noexcept { return id == msg::RadioStatus::id || id == msg::Radio::id; }

void RadioReports::take(const Heard& heard) {
    if (heard.frame.id() != msg::RadioStatus::id) return;
    const auto status = msg::RadioStatus::decode(heard.frame.payload());
    auto at = std::ranges::find_if(
        all_, [&](const RadioReport& one) { return one.link == heard.link && one.source == heard.frame.source(); });
    if (at == all_.end()) {
        if (all_.size() == max_radios) return;
        auto& added = all_.emplace_back();
        added.link = heard.link;
        added.link_name = heard.link_name;
        added.source = heard.frame.source();
        at = std::prev(all_.end());
    } else {  // the counters wrap
        at->rxerrors += static_cast<std::uint16_t>(status.rxerrors - at->last_rxerrors_);
        at->fixed += static_cast<std::uint16_t>(status.fixed - at->last_fixed_);
    }
    ++at->count;
    at->last_rxerrors_ = status.rxerrors;
    at->last_fixed_ = status.fixed;
    at->lowest_txbuf_percent = std::min(at->lowest_txbuf_percent, status.txbuf);
    note_margin(*at, status.rssi, status.noise);
    note_margin(*at, status.remrssi, status.remnoise);
}

}  // namespace mavloom::observe
