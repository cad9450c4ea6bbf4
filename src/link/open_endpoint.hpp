// SPDX-License-Identifier: MIT
// An open endpoint of any scheme, and all open endpoints of one Links object. Private to module link; single owner
// thread.
#pragma once

#include <array>
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

// Decides which link id an endpoint signs with. A signature has 8 bits for it, and two endpoints that are open must not
// share one: the far side would take frames of one endpoint for replays. A reopened endpoint keeps the link id of its
// label, so that the far side sees the same link. Ids are given out from 255 downwards, because vehicles and ground
// stations mostly sign with 0 and small ids.
class SigningIds {
public:
    // Returns the link id for an endpoint that is about to be opened with id `fresh`: the first of these that exists
    // and that no open endpoint uses.
    // - the link id that this label had (an empty label had none)
    // - 255 - `fresh`, if it was never used
    // - any that was never used
    // - the one that was opened longest ago
    // Empty if open endpoints use all 256.
    [[nodiscard]] std::optional<std::uint8_t> choose(const std::string& label, EndpointId fresh,
                                                     const OpenEndpoints& endpoints) const;
    // Notes that the endpoint was opened: `holder` now signs with `link_id`.
    void keep(const std::string& label, std::uint8_t link_id, EndpointId holder);

private:
    struct Use {
        std::string label;
        EndpointId holder;
        std::uint64_t number = 0;  // uses are counted; 0: nobody used it
    };
    std::array<Use, 256> uses_;  // by link id
    std::uint64_t count_ = 0;
};

[[nodiscard]] net::BlockQueue::Limits queue_limits(const endpoint::EndpointOptions& options);

}  // namespace mavloom::link::detail
