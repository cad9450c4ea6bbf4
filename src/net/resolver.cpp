// SPDX-License-Identifier: MIT
#include "mavloom/net/resolver.hpp"

#include <fmt/format.h>
#include <netdb.h>

#include <algorithm>
#include <cassert>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

namespace mavloom::net {

static SetupError look_up_error(std::string_view host, int code) {
    const SetupCode kind = code == EAI_AGAIN || code == EAI_FAIL      ? SetupCode::unreachable
                           : code == EAI_SYSTEM || code == EAI_MEMORY ? SetupCode::system
                                                                      : SetupCode::not_found;
    return {kind, code == EAI_SYSTEM ? errno : 0, fmt::format("cannot find host '{}': {}", host, gai_strerror(code))};
}

SetupResult<std::vector<Address>> look_up(std::string_view host, std::uint16_t port) {
    addrinfo hints{};
    hints.ai_family = AF_UNSPEC;
    hints.ai_socktype = SOCK_DGRAM;  // one entry per address; the addresses hold for streams too
    addrinfo* found = nullptr;
    const int code = getaddrinfo(std::string(host).c_str(), nullptr, &hints, &found);
    if (code != 0) return tl::unexpected(look_up_error(host, code));
    const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, &freeaddrinfo);
    std::vector<Address> addresses;
    for (const addrinfo* info = found; info != nullptr; info = info->ai_next) {
        const auto address = Address::from_sockaddr(info->ai_addr, info->ai_addrlen);
        if (!address) continue;
        const Address with_port = address->with_port(port);
        if (std::find(addresses.begin(), addresses.end(), with_port) == addresses.end()) addresses.push_back(with_port);
    }
    if (addresses.empty()) return tl::unexpected(look_up_error(host, EAI_NONAME));
    std::stable_partition(addresses.begin(), addresses.end(), [](const Address& a) { return a.is_v4(); });
    return addresses;
}

struct Resolver::State {
    struct Question {
        std::uint64_t ticket;
        std::string host;
        std::uint16_t port;
    };
    std::mutex mutex;  // guards everything below
    std::condition_variable changed;
    std::deque<Question> questions;
    std::deque<Done> answers;
    std::uint64_t last_ticket = 0;
    bool stopping = false, looking = false;
    std::thread thread;
    std::function<void()> notify;

    // Takes shared ownership of the state: the thread may outlive the Resolver while getaddrinfo blocks.
    static void answer_questions(const std::shared_ptr<State>& state);
};

Resolver::Resolver(std::function<void()> notify) : state_(std::make_shared<State>()) {
    state_->notify = std::move(notify);
}

Resolver::~Resolver() {
    std::unique_lock lock(state_->mutex);
    state_->stopping = true;
    state_->changed.notify_all();
    if (!state_->thread.joinable()) return;
    if (state_->looking) {
        state_->thread.detach();
        return;
    }
    lock.unlock();
    state_->thread.join();
}

std::uint64_t Resolver::ask(std::string host, std::uint16_t port) {
    const std::lock_guard lock(state_->mutex);
    if (!state_->thread.joinable()) state_->thread = std::thread([state = state_] { State::answer_questions(state); });
    state_->questions.push_back({++state_->last_ticket, std::move(host), port});
    state_->changed.notify_all();
    return state_->last_ticket;
}

std::optional<Resolver::Done> Resolver::take() {
    const std::lock_guard lock(state_->mutex);
    if (state_->answers.empty()) return std::nullopt;
    Done done = std::move(state_->answers.front());
    state_->answers.pop_front();
    return done;
}

std::optional<Resolver::Answer> Resolver::wait(std::uint64_t ticket, std::chrono::milliseconds limit) {
    std::unique_lock lock(state_->mutex);
    const auto mine = [&] {
        return std::find_if(state_->answers.begin(), state_->answers.end(),
                            [&](const Done& d) { return d.ticket == ticket; });
    };
    if (!state_->changed.wait_for(lock, limit, [&] { return mine() != state_->answers.end(); })) return std::nullopt;
    const auto done = mine();
    Answer answer = std::move(done->answer);
    state_->answers.erase(done);
    return answer;
}

void Resolver::State::answer_questions(const std::shared_ptr<State>& state) {
    std::unique_lock lock(state->mutex);
    for (;;) {
        state->changed.wait(lock, [&] { return state->stopping || !state->questions.empty(); });
        if (state->stopping) return;
        assert(!state->looking && "one question at a time");
        auto question = std::move(state->questions.front());
        state->questions.pop_front();
        state->looking = true;
        lock.unlock();
        Resolver::Answer answer = look_up(question.host, question.port);
        lock.lock();
        state->looking = false;
        if (state->stopping) return;
        state->answers.push_back({question.ticket, std::move(answer)});
        state->changed.notify_all();
        lock.unlock();
        state->notify();
        lock.lock();
    }
}

}  // namespace mavloom::net
