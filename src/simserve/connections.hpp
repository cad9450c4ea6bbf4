// SPDX-License-Identifier: MIT
// Connects the endpoints of a simulator with its vehicles: opens the vehicles on links that come up, closes them on
// links that go down, and passes frames on. Private to module simserve; single owner thread.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/base/line_budget.hpp"
#include "mavloom/link/links.hpp"
#include "mavloom/ring/sources.hpp"
#include "mavloom/simserve/simulator.hpp"
#include "simserve/fleet.hpp"
#include "simserve/flight_clock.hpp"
#include "simserve/flight_recording.hpp"
#include "simserve/shared_memory.hpp"
#include "simserve/slow_lines.hpp"

namespace mavloom::simserve {

class Connections final : public link::LinkHandler {
public:
    // All must outlive the object.
    struct Parts {
        const dialect::Dialect& dialect;
        link::Links& links;
        const FlightClock& clock;
        SharedMemory& shared;
        FlightRecording& recording;
        FlightRecording& received;  // gets what partners send
        SlowLines& lines;
        Fleet& fleet;
        const SimulatorOptions& options;
        const Simulator::Notice& notice;
        std::function<bool()> catch_up;  // in a repeatable session: flies until now; false: the flight has ended
    };
    explicit Connections(const Parts& parts) : parts_(parts) {}

    [[nodiscard]] SetupResult<void> add(const SimEndpoint& endpoint);
    [[nodiscard]] SetupResult<void> open_inlet(const config::RingConfig& config, const std::filesystem::path& socket);
    // The endpoint of the inlet of the simulator's own ring.
    [[nodiscard]] std::optional<link::EndpointId> inlet() const noexcept { return inlet_; }
    bool remove(std::string_view label);
    void close_inlet();

    // Whether the vehicles stream on another link than the simulator's own.
    [[nodiscard]] bool has_partners() const noexcept;
    // Opens the vehicles on the simulator's own ring and recording.
    void open_own_links();
    // When to call `play_rings` next. That function delivers the frames of the rings that are read.
    [[nodiscard]] MonoTime rings_due();
    void play_rings();
    // Call about once a second.
    void refill_lines();

    [[nodiscard]] std::vector<LinkReport> reports() const;
    [[nodiscard]] std::uint64_t frames_received() const noexcept { return frames_received_; }

    void on_frame(const link::RxFrame& rx) override;
    void on_link_up(LinkId link, link::EndpointId endpoint, std::string_view name) override;
    void on_link_down(LinkId link, link::EndpointId endpoint, std::string_view why) override;
    void on_notice(link::EndpointId endpoint, std::string_view text) override;

private:
    struct EndpointState {
        LinkRates rates{};
        // For several links that count as one: the senders of a ring's inlet, and the links in a ring that is read.
        std::optional<LinkId> link{};
        bool is_one_link = false;
        std::optional<link::EndpointId> ring{};  // for the endpoint that sends to a ring's inlet: the ring
        LineBudget lines{};
    };
    static constexpr std::size_t max_closed_reports = 64;

    [[nodiscard]] SetupResult<void> add_ring(const endpoint::Endpoint& endpoint, const LinkRates& rates);
    [[nodiscard]] sim::Moment now() const { return parts_.clock.at(parts_.links.now()); }
    void open(LinkId link, const LinkRates& rates, std::string_view name);
    void close(LinkId link);
    void forget(link::EndpointId endpoint);
    [[nodiscard]] bool close_by_name(std::string_view name);
    [[nodiscard]] LinkReport report_of(LinkId link, std::string_view name) const;

    const Parts parts_;
    std::unique_ptr<ring::RingSources> rings_;  // created with the first ring that is read
    std::map<link::EndpointId, EndpointState> states_;
    std::map<LinkId, std::string> open_;  // the links on which the vehicles stream, with their names
    std::vector<LinkReport> closed_;
    std::optional<link::EndpointId> inlet_;
    std::uint64_t frames_received_ = 0;
};

}  // namespace mavloom::simserve
