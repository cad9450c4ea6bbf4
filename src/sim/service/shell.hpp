// SPDX-License-Identifier: MIT
// PX4's shell over SERIAL_CONTROL, with the few commands that a simulated vehicle can answer. Private to module sim;
// single owner.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sim/service/service.hpp"

namespace mavloom::sim {

struct Parts;

class Shell final : public Service {
public:
    explicit Shell(Parts& parts) noexcept : parts_(parts) {}

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

    Parts& parts_;
    std::vector<Session> sessions_;
};

}  // namespace mavloom::sim
