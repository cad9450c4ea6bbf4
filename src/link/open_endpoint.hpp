// SPDX-License-Identifier: MIT
// An open endpoint of any scheme, and all open endpoints of one Links object. Private to module link; single owner
// thread.
#pragma once

#include <cstddef>
#include <map>
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

private:
    std::vector<std::unique_ptr<OpenEndpoint>> endpoints_;  // index: id; null: removed
};

// Decides which link id an endpoint signs with. A reopened endpoint keeps the signing id of its label, so that the far
// side sees the same link. If several open endpoints have one label, the first one has that id.
class SigningIds {
public:
    // `fresh` is the id of the endpoint that is about to be opened.
    [[nodiscard]] EndpointId id_for(const std::string& label, EndpointId fresh, const OpenEndpoints& endpoints) const;
    // Notes that the endpoint was opened: `holder` now signs with the id `signs_as`.
    void keep(const std::string& label, EndpointId signs_as, EndpointId holder);

private:
    struct Held {
        EndpointId id, holder;
    };
    std::map<std::string, Held> by_label_;
};

[[nodiscard]] net::BlockQueue::Limits queue_limits(const endpoint::EndpointOptions& options);

}  // namespace mavloom::link::detail
