// SPDX-License-Identifier: MIT
// An open endpoint of any scheme, and all open endpoints of one Links object. Private to module link; single owner
// thread.
#pragma once

#include <cassert>
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

inline bool Link::signs(Rank from) const noexcept {
    if (signature == nullptr || !signature->signs()) return false;
    return from == Rank::verified || (from == Rank::own && signature->signs_own());
}

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
    // Reads the counters that the kernel or a transport keeps.
    virtual void refresh_counters() {}
    // Counts as sent all frames that no ICMP message has refused so far.
    virtual void settle_sent() {}
    // Whether a transport's thread has frames that it has not sent yet.
    [[nodiscard]] virtual bool is_sending() const { return false; }
    // Called after another thread has woken the turn.
    virtual void on_wake() {}
    // Closes one peer or client. Returns false if the endpoint cannot have several links.
    virtual bool close_link(LinkId) { return false; }
    // Adds the counters of a removed link to the endpoint's sums.
    void count_gone(const Link& link) noexcept;

    EndpointInfo info;
    EndpointCounters counters;
    std::unique_ptr<Signature> signature;
    std::optional<SetupError> failure;  // see Links::failure
};

using Opened = SetupResult<std::unique_ptr<OpenEndpoint>>;
using Open = Opened(Opening);

// The schemes of this module; `open_threaded` opens those of a registered transport (transport.hpp).
Open open_udpin, open_udpout, open_udpbcast, open_udpmcast, open_tcpin, open_tcpout, open_serial, open_shm,
    open_threaded;

class OpenEndpoints {
public:
    [[nodiscard]] EndpointId next_id() const noexcept {
        return EndpointId{static_cast<EndpointId::rep>(endpoints_.size())};
    }
    // An id for something that is no endpoint here.
    [[nodiscard]] EndpointId take_id() {
        endpoints_.emplace_back();
        return EndpointId{static_cast<EndpointId::rep>(endpoints_.size() - 1)};
    }
    // The endpoint's id must be `next_id`.
    void add(std::unique_ptr<OpenEndpoint> endpoint) {
        assert(endpoint->info.id == next_id());
        endpoints_.push_back(std::move(endpoint));
    }
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
