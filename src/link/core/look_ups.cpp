// SPDX-License-Identifier: MIT
#include "link/core/look_ups.hpp"

#include <algorithm>

namespace mavloom::link::detail {

void LookUps::deliver() {
    while (auto done = resolver_.take()) {
        const auto question = std::ranges::find_if(questions_, [&](const auto& q) { return q.first == done->ticket; });
        if (question == questions_.end()) continue;
        NameUser* const user = question->second;
        questions_.erase(question);
        user->on_resolved(std::move(done->answer));
    }
}

NameUser::~NameUser() {
    std::erase_if(look_ups_.questions_, [&](const auto& question) { return question.second == this; });
}

void NameUser::look_up(const endpoint::HostPort& host) {
    if (auto answer = look_up_now(host, {})) on_resolved(std::move(*answer));
}

std::optional<net::Resolver::Answer> NameUser::look_up_now(const endpoint::HostPort& host,
                                                           std::chrono::milliseconds limit) {
    if (const auto numeric = net::Address::parse(host.host, host.port)) return std::vector<net::Address>{*numeric};
    const std::uint64_t ticket = look_ups_.resolver_.ask(host.host, host.port);
    auto answer = look_ups_.may_wait_ ? look_ups_.resolver_.wait(ticket, limit) : std::nullopt;
    if (!answer) look_ups_.questions_.emplace_back(ticket, this);
    return answer;
}

}  // namespace mavloom::link::detail
