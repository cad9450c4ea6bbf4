// SPDX-License-Identifier: MIT
// What radios report of themselves in RADIO_STATUS. For a diagnosis. One owner thread. Bounded.
// Source: MAVLink's common.xml, RADIO_STATUS.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mavloom/observe/heard.hpp"

namespace mavloom::observe {

struct RadioReport {
    LinkId link{};
    std::string link_name{};
    Source source{};
    std::uint64_t count = 0;
    std::uint64_t rxerrors = 0, fixed = 0;    // that were added since the first report
    std::uint8_t lowest_txbuf_percent = 100;  // free space of its send buffer
    // Of the signal above the noise, on the side that is worse. In the radio's own unit.
    std::optional<int> lowest_margin{};

private:
    friend class RadioReports;
    std::uint16_t last_rxerrors_ = 0, last_fixed_ = 0;
};

// Whether a radio sends this of itself, unsigned and without a HEARTBEAT: RADIO_STATUS, and RADIO of old SiK radios.
[[nodiscard]] bool is_of_radio(MessageId id) noexcept;

class RadioReports {
public:
    static constexpr std::size_t max_radios = 64;

    void take(const Heard& heard);
    [[nodiscard]] const std::vector<RadioReport>& all() const noexcept { return all_; }

private:
    std::vector<RadioReport> all_;
};

}  // namespace mavloom::observe
