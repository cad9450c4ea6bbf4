// SPDX-License-Identifier: MIT
#include "sim/service/shell.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "mavloom/base/text.hpp"
#include "mavloom/msg/enums/serial_control_dev.hpp"
#include "mavloom/msg/enums/serial_control_flag.hpp"
#include "mavloom/msg/serial_control.hpp"
#include "sim/service/shares.hpp"

namespace mavloom::sim {

namespace {

constexpr std::array shell_messages{msg::SerialControl::id};
constexpr std::string_view prompt = "nsh> ";

}  // namespace

std::span<const MessageId> Shell::handled() const noexcept { return shell_messages; }

void Shell::receive(const Client& from, MessageId /*id*/, ByteView payload, Moment /*now*/) {
    const auto message = msg::SerialControl::decode(payload);
    const bool is_reply = (message.flags & msg::SERIAL_CONTROL_FLAG_REPLY) != 0;
    if (!firmware_.is_px4() || message.device != msg::SERIAL_CONTROL_DEV_SHELL || is_reply) return;
    const std::size_t count = std::min<std::size_t>(message.count, message.data.size());
    if (Session* const session = session_of(from)) read(*session, ByteView(message.data).first(count));
}

Shell::Session* Shell::session_of(const Client& client) {
    const auto at = std::ranges::find(sessions_, client, &Session::client);
    if (at != sessions_.end()) return &*at;
    if (!make_room(sessions_, client.link, max_clients_)) return nullptr;
    return &sessions_.emplace_back(Session{.client = client});
}

// As a terminal does, the shell repeats what it reads.
void Shell::read(Session& session, ByteView bytes) {
    std::string output;
    for (const std::uint8_t byte : bytes) {
        const char character = static_cast<char>(byte);
        output += character;
        if (character == '\n') {
            output += answer(trimmed(session.line));
            output += prompt;
            session.line.clear();
        } else if (session.line.size() < longest_line) {
            session.line += character;
        }
    }
    send(session.client, output);
}

std::string Shell::answer(std::string_view line) const {
    if (line.empty()) return {};
    const std::uint32_t version = firmware_.version().flight;
    if (line == "help") return "help usage:  help\n\n  help  ver\n";
    if (line == "ver" || line.starts_with("ver "))
        return fmt::format("HW arch: MAVLOOM_SIM\nPX4 version: {}.{}.{}\n", version >> 24, version >> 16 & 0xff,
                           version >> 8 & 0xff);
    return fmt::format("nsh: {}: command not found\n", line.substr(0, line.find(' ')));
}

void Shell::send(const Client& to, std::string_view text) {
    while (!text.empty()) {
        msg::SerialControl reply{.device = msg::SERIAL_CONTROL_DEV_SHELL,
                                 .flags = msg::SERIAL_CONTROL_FLAG_REPLY,
                                 .target_system = to.id.system.value,
                                 .target_component = to.id.component.value};
        const std::size_t count = std::min(text.size(), reply.data.size());
        reply.count = static_cast<std::uint8_t>(count);
        std::memcpy(reply.data.data(), text.data(), count);
        radio_.send(to.link, reply);
        text.remove_prefix(count);
    }
}

void Shell::forget(LinkId link) {
    std::erase_if(sessions_, [&](const Session& session) { return session.client.link == link; });
}

}  // namespace mavloom::sim
