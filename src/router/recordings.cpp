// SPDX-License-Identifier: MIT
#include "router/recordings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "mavloom/endpoint/checks.hpp"

namespace mavloom::router {

namespace {

SetupResult<void> refuse_fifo(const std::string& path) {
    std::error_code unknown;
    if (!std::filesystem::is_fifo(path, unknown)) return {};
    return setup_error(
        SetupCode::usage,
        fmt::format("{} is a FIFO, and the router would wait for its reader; use mavloom record instead", path));
}

}  // namespace

SetupResult<void> Recordings::add(const endpoint::Endpoint& endpoint) {
    const auto is_same = [&](const Open& open) {
        return endpoint::canonical_path(open.endpoint.path) == endpoint::canonical_path(endpoint.path) ||
               open.endpoint.label() == endpoint.label();
    };
    if (std::ranges::any_of(open_, is_same))
        return setup_error(SetupCode::usage, fmt::format("another recording already writes to {}", endpoint.label()));
    if (auto good = endpoint::check_written(endpoint); !good) return good;
    if (auto good = refuse_fifo(endpoint.path); !good) return good;
    const auto& o = endpoint.options;
    auto recorder = record::Recorder::create(endpoint.label(), endpoint.path, {o.rotate_bytes, o.rotate_every},
                                             [this](std::string_view text) { warn_(std::string(text)); });
    if (!recorder) return tl::unexpected(std::move(recorder.error()));
    if (const auto& old = (*recorder)->renamed_to(); !old.empty())
        notice_(config::LogLevel::info, fmt::format("{} existed and is now {}", endpoint.path, old.string()));
    open_.push_back({endpoint, std::move(*recorder)});
    return {};
}

bool Recordings::remove(std::string_view label) {
    const auto open = std::ranges::find_if(open_, [&](const Open& o) { return o.recorder->label() == label; });
    if (open == open_.end()) return false;
    open->recorder->end();
    ending_.push_back(std::move(open->recorder));
    open_.erase(open);
    return true;
}

bool Recordings::has(const endpoint::Endpoint& endpoint) const {
    return std::ranges::find(open_, endpoint, &Open::endpoint) != open_.end();
}

std::vector<endpoint::Endpoint> Recordings::endpoints() const {
    std::vector<endpoint::Endpoint> all(open_.size());
    std::ranges::transform(open_, all.begin(), &Open::endpoint);
    return all;
}

void Recordings::maintain() {
    for (const auto& open : open_) open.recorder->maintain();
    std::erase_if(ending_, [](const auto& recorder) { return recorder->finished(); });
}

void Recordings::stop() {
    for (const auto& open : open_) open.recorder->stop();
    for (const auto& recorder : ending_) recorder->stop();
}

}  // namespace mavloom::router
