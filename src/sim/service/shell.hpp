// SPDX-License-Identifier: MIT
// PX4's shell over SERIAL_CONTROL, with the few commands that a simulated vehicle can answer. Private to module sim;
// single owner.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "flight/firmware/firmware.hpp"
#include "sim/radio/radio.hpp"
#include "sim/service/service.hpp"

namespace mavloom::sim {

class Shell final : public Service {
public:
    Shell(const Firmware& firmware, std::size_t max_clients, Radio& radio) noexcept
        : firmware_(firmware), max_clients_(max_clients), radio_(radio) {}

    [[nodiscard]] std::span<const MessageId> handled() const noexcept override;
    void receive(const Client& from, MessageId id, ByteView payload, Moment now) override;
    void reboot() override { sessions_.clear(); }
    void forget(LinkId link) override;

private:
    struct Session {
        Client client;
        std::string line{};  // what came since the last line feed
    };
    static constexpr std::size_t longest_line = 128;

    // Null if there are too many clients.
    Session* session_of(const Client& client);
    void read(Session& session, ByteView bytes);
    [[nodiscard]] std::string answer(std::string_view line) const;
    void send(const Client& to, std::string_view text);

    const Firmware& firmware_;
    const std::size_t max_clients_;
    Radio& radio_;
    std::vector<Session> sessions_;
};

}  // namespace mavloom::sim
