// SPDX-License-Identifier: MIT
#include "sim/service/announcer.hpp"

#include <algorithm>
#include <cstring>

#include "mavloom/msg/statustext.hpp"

namespace mavloom::sim {

namespace {

constexpr std::size_t chunk_length = 50;
constexpr std::size_t longest_text = 254 * chunk_length;

}  // namespace

void Announcer::say(Severity severity, std::string_view text, FlightTime now) {
    std::uint16_t id = 0;
    if (text.size() > chunk_length) {
        last_id_ = static_cast<std::uint16_t>(last_id_ == 0xffff ? 1 : last_id_ + 1);
        id = last_id_;
    }
    if (past_.size() == kept) past_.erase(past_.begin());
    past_.push_back({severity, std::string(text.substr(0, longest_text)), now, id});
    for (const LinkId link : radio_.links()) send(link, past_.back());
}

void Announcer::greet(LinkId link, FlightTime now) {
    if (std::ranges::find(greeted_, link) != greeted_.end()) return;
    greeted_.push_back(link);
    for (const Past& past : past_)
        if (now - past.at <= repeated_for) send(link, past);
}

void Announcer::forget(LinkId link) { std::erase(greeted_, link); }

// A text of several chunks ends with a chunk that holds a NUL; if its length is a multiple of 50, that is an empty one.
void Announcer::send(LinkId link, const Past& past) {
    std::string_view rest = past.text;
    msg::Statustext message{.severity = static_cast<std::uint8_t>(past.severity), .id_ = past.id};
    do {
        message.text = {};
        const std::size_t length = std::min(rest.size(), chunk_length);
        std::memcpy(message.text.data(), rest.data(), length);
        radio_.send(link, message);
        rest.remove_prefix(length);
        ++message.chunk_seq;
        if (length < chunk_length || past.id == 0) break;
    } while (true);
}

}  // namespace mavloom::sim
