// SPDX-License-Identifier: MIT
// Opens an endpoint whose host must be looked up first: one that listens, or one that sends to a destination. Private
// to module link.
#pragma once

#include <fmt/format.h>

#include <chrono>
#include <memory>

#include "link/core/core.hpp"
#include "mavloom/endpoint/checks.hpp"

namespace mavloom::link::detail {

// For schemes that listen. `Listener` is the class of the endpoint; its `open(addresses)` binds the addresses. A
// look-up that takes longer than a second continues in the background.
template <class Listener>
Opened open_listening(Opening opening) {
    constexpr std::chrono::seconds look_up_limit{1};
    const endpoint::Endpoint& endpoint = opening.endpoint;
    auto opened = std::make_unique<Listener>(opening);
    auto answer = opened->look_up_now(endpoint.address, look_up_limit);
    if (!answer) return opened;
    auto done = *answer ? opened->open(**answer) : tl::unexpected(std::move(answer->error()));
    if (!done) return tl::unexpected(std::move(done.error()).within(endpoint.label()));
    return opened;
}

// For schemes that call. `Destination` is the class of the endpoint. Its `begin(answer, required)` starts to
// send to the addresses of the look-up. If the host is not reached, it returns the error, or tries again later if not
// `required`. Other errors, such as a port in use, are always returned. A look-up that takes longer than 250 ms
// continues in the background, unless `required`.
template <class Destination>
Opened open_destination(Opening opening) {
    const endpoint::Endpoint& endpoint = opening.endpoint;
    if (auto checked = endpoint::check_destination(endpoint); !checked)
        return tl::unexpected(std::move(checked).error());
    auto local = endpoint::local_address(endpoint);
    if (!local) return tl::unexpected(std::move(local).error());
    const bool required = opening.is_required();
    auto opened = std::make_unique<Destination>(opening, *local);
    const std::chrono::milliseconds limit(required ? 5000 : 250);
    auto answer = opened->look_up_now(endpoint.address, limit);
    if (!answer && !required) return opened;
    auto done = answer
                    ? opened->begin(std::move(*answer), required)
                    : setup_error(SetupCode::unreachable, fmt::format("the look-up of host '{}' took longer than {} s",
                                                                      endpoint.address.host, limit.count() / 1000));
    if (!done) return tl::unexpected(std::move(done.error()).within(endpoint.label()));
    return opened;
}

}  // namespace mavloom::link::detail
