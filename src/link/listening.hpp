// SPDX-License-Identifier: MIT
// Opens an endpoint that listens on a local address: udpin or tcpin. Private to module link.
#pragma once

#include <chrono>
#include <memory>

#include "link/core/core.hpp"

namespace mavloom::link::detail {

// `Listener` is the class of the endpoint; its `open(addresses)` binds the addresses. A look-up that takes longer than
// a second continues in the background.
template <class Listener>
SetupResult<std::unique_ptr<OpenEndpoint>> open_listening(Opening opening) {
    constexpr std::chrono::seconds look_up_limit{1};
    const endpoint::Endpoint& endpoint = opening.endpoint;
    auto opened = std::make_unique<Listener>(opening);
    auto answer = opened->look_up_now(endpoint.address, look_up_limit);
    if (!answer) return opened;
    auto done = *answer ? opened->open(**answer) : tl::unexpected(std::move(answer->error()));
    if (!done) return tl::unexpected(std::move(done.error()).within(endpoint.label()));
    return opened;
}

}  // namespace mavloom::link::detail
