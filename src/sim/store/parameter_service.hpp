// SPDX-License-Identifier: MIT
// The parameter protocol. Private to module sim; single owner. Source: MAVLink guide, "Parameter Protocol".
//
// Each client has a list of its own. A list is sent at the pace of its link. PX4 begins a list with `_HASH_CHECK`, a
// checksum of all values. A client that already has these values sets `_HASH_CHECK`, and the list ends.
#pragma once

#include <functional>
#include <string_view>
#include <utility>
#include <vector>

#include "flight/firmware/firmware.hpp"
#include "flight/firmware/parameters.hpp"
#include "sim/radio/radio.hpp"
#include "sim/service/announcer.hpp"
#include "sim/service/service.hpp"

namespace mavloom::sim {

class ParameterService final : public Service {
public:
    ParameterService(const Firmware& firmware, Parameters& parameters, Radio& radio, Announcer& announcer,
                     std::size_t max_clients, std::function<void()> on_change) noexcept
        : firmware_(firmware),
          parameters_(parameters),
          radio_(radio),
          announcer_(announcer),
          max_clients_(max_clients),
          on_change_(std::move(on_change)) {}

    [[nodiscard]] std::span<const MessageId> handled() const noexcept override;
    void receive(const Client& from, MessageId id, ByteView payload, Moment now) override;
    [[nodiscard]] bool is_busy() const noexcept override { return !lists_.empty(); }
    void pump(Moment now) override;
    void reboot() override { lists_.clear(); }
    void forget(LinkId link) override;

    // Sends the value of a parameter to all links.
    void announce(ParamIndex index);
    // Sets the parameters whose names begin with `prefix` to their initial values, and reports those that changed. The
    // system id stays.
    void reset(std::string_view prefix = {});

private:
    struct List {
        Client client;
        bool has_hash_ahead = false;  // `_HASH_CHECK` comes next
        ParamIndex next = 0;
    };
    struct Refusal {
        std::string_view name{};
        int index = -1;
        std::uint8_t error = 0;  // MAV_PARAM_ERROR
    };

    void on_list(const Client& from, Moment now);
    void on_read(const Client& from, ByteView payload);
    void on_set(const Client& from, ByteView payload);
    void change(const Client& from, ParamIndex index, std::uint8_t type, float value);
    // Returns the MAV_PARAM_ERROR for a new value.
    [[nodiscard]] std::uint8_t check(ParamIndex index, std::uint8_t type, float value) const noexcept;
    void stop(const Client& client);
    // Returns false once the list is complete.
    bool send_next(List& list);
    void send_value(LinkId link, ParamIndex index);
    void send_hash(LinkId link);
    void refuse(const Client& to, const Refusal& refusal);

    const Firmware& firmware_;
    Parameters& parameters_;
    Radio& radio_;
    Announcer& announcer_;
    std::size_t max_clients_;
    std::function<void()> on_change_;
    std::vector<List> lists_;
};

}  // namespace mavloom::sim
