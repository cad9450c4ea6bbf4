// SPDX-License-Identifier: MIT
// An open endpoint of any scheme, and all open endpoints of one Links object. Private to module link; single owner
// thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "link/link.hpp"
#include "link/signing/signature.hpp"
#include "mavloom/endpoint/endpoint.hpp"
#include "mavloom/link/links.hpp"

namespace mavloom::link::detail {

class Core;

// The arguments for opening an endpoint.
struct Opening {
    Core& core;
    const endpoint::Endpoint& endpoint;
    EndpointId id;
    std::unique_ptr<Signature> signature;

    // Whether the endpoint must open at once. Once frames flow, nothing waits for a host or a device.
    [[nodiscard]] bool is_required() const noexcept;
};

class OpenEndpoint {
public:
    explicit OpenEndpoint(Opening& opening) : signature(std::move(opening.signature)) {
        info.id = opening.id;
        info.endpoint = opening.endpoint;
    }
    OpenEndpoint(const OpenEndpoint&) = delete;
    OpenEndpoint& operator=(const OpenEndpoint&) = delete;
    virtual ~OpenEndpoint() = default;
    virtual std::size_t send(const wire::FrameView& frame) = 0;
    [[nodiscard]] virtual std::size_t queued_bytes() const = 0;
    virtual void refresh_kernel_drops() {}
    // Counts as sent all frames that no ICMP message has refused so far.
    virtual void settle_sent() {}
    // Closes one peer or client. Returns false if the endpoint cannot have several links.
    virtual bool close_link(LinkId) { return false; }
    // Adds the counters of a removed link to the endpoint's sums.
    void count_gone(const Link& link) noexcept;

    EndpointInfo info;
    EndpointCounters counters;
    std::unique_ptr<Signature> signature;
    std::optional<SetupError> failure;  // see Links::failure
};

class OpenEndpoints {
public:
    [[nodiscard]] EndpointId next_id() const noexcept {
        return EndpointId{static_cast<EndpointId::rep>(endpoints_.size())};
    }
    // The endpoint's id must be `next_id`.
    void add(std::unique_ptr<OpenEndpoint> endpoint) { endpoints_.push_back(std::move(endpoint)); }
    void remove(EndpointId id) noexcept;
    [[nodiscard]] OpenEndpoint* find(EndpointId id) const noexcept {
        return id.value < endpoints_.size() ? endpoints_[id.value].get() : nullptr;
    }
    template <class F>
    void each(F&& f) const {
        for (const auto& endpoint : endpoints_)
            if (endpoint) f(*endpoint);
    }
    [[nodiscard]] bool has(const std::string& label) const;
    [[nodiscard]] bool any_low_latency() const;
    // Returns whether a UDP endpoint is bound to the port.
    [[nodiscard]] bool has_udp_port(std::uint16_t port) const;

private:
    std::vector<std::unique_ptr<OpenEndpoint>> endpoints_;  // index: id; null: removed
};

}  // namespace mavloom::link::detail
