// SPDX-License-Identifier: MIT
#include "mavloom/link/links.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "link/core/core.hpp"
#include "link/local/inlet.hpp"
#include "link/threaded/threaded_endpoint.hpp"
#include "mavloom/endpoint/checks.hpp"
#include "mavloom/net/run_folder.hpp"

namespace mavloom::link {

using namespace detail;

SetupResult<std::filesystem::path> Links::inlet_path(std::string_view ring) {
    return net::run_path(ring, inlet_suffix, "inlet");
}

std::optional<uid_t> Links::owner_of_inlets() { return net::run_folder_owner(); }

Links::Links(std::unique_ptr<Core> core, endpoint::RoutingOptions routing) noexcept
    : core_(std::move(core)), routing_(routing) {}
Links::~Links() = default;

SetupResult<std::unique_ptr<Links>> Links::create(const dialect::Dialect& dialect, endpoint::RoutingOptions routing) {
    auto loop = net::EventLoop::create();
    if (!loop) return tl::unexpected(std::move(loop).error());
    auto batch = net::ReceiveBatch::create();
    if (!batch) return tl::unexpected(std::move(batch).error());
    auto core = std::make_unique<Core>(dialect, std::move(*loop), std::move(*batch));
    if (routing == endpoint::RoutingOptions::by_owner) core->leave_loss_to_owner();
    return std::unique_ptr<Links>(new Links(std::move(core), routing));
}

namespace {

struct OwnTransport {
    endpoint::Scheme scheme;
    Open* open;
};

constexpr OwnTransport transports[] = {
    {endpoint::Scheme::udpin, open_udpin},       {endpoint::Scheme::udpout, open_udpout},
    {endpoint::Scheme::udpbcast, open_udpbcast}, {endpoint::Scheme::udpmcast, open_udpmcast},
    {endpoint::Scheme::tcpin, open_tcpin},       {endpoint::Scheme::tcpout, open_tcpout},
    {endpoint::Scheme::serial, open_serial},     {endpoint::Scheme::shm, open_shm},
};

// Null: the scheme is not one of this module.
Open* own_transport(endpoint::Scheme scheme) noexcept {
    const auto* const found = std::ranges::find(transports, scheme, &OwnTransport::scheme);
    return found == std::ranges::end(transports) ? nullptr : found->open;
}

}  // namespace

bool Links::can_open(endpoint::Scheme scheme) noexcept {
    return own_transport(scheme) != nullptr || has_transport(scheme);
}

static Opened open(Opening opening) {
    if (auto* const own = own_transport(opening.endpoint.scheme)) return own(std::move(opening));
    if (has_transport(opening.endpoint.scheme)) return open_threaded(std::move(opening));
    return setup_error(SetupCode::usage, fmt::format("this program has no {} links", opening.endpoint.row().name));
}

// Several endpoints may request port 0; each gets its own port.
static bool has_address_of_its_own(const endpoint::Endpoint& endpoint) noexcept {
    return !endpoint.has_address() || endpoint.address.port != 0;
}

SetupResult<EndpointId> Links::add(const endpoint::Endpoint& endpoint, const dialect::Dialect* dialect) {
    core_->refresh_now();
    if (auto checked = endpoint::check_supported(endpoint, routing_); !checked)
        return tl::unexpected(std::move(checked).error());
    const std::string label = endpoint.label();
    const bool is_named = has_address_of_its_own(endpoint);
    if (is_named && !allows_same_address(endpoint) && core_->endpoints.has(label))
        return setup_error(
            SetupCode::usage,
            fmt::format("two endpoints are named {}; remove one of them, or give it another name=", label));
    const EndpointId id = core_->endpoints.next_id();
    const std::string signs_by = is_named ? label : std::string();
    const auto signs_as = core_->signing_ids.choose(signs_by, id, core_->endpoints);
    const bool is_signing = !endpoint.options.sign_key_file.empty();
    if (is_signing && !signs_as)
        return setup_error(SetupCode::usage, fmt::format("{}: 256 endpoints sign already, and a signature has no more "
                                                         "link ids; remove sign= from one of them",
                                                         label));
    if (auto opened = open_as(id, signs_as.value_or(0), endpoint, dialect); !opened)
        return tl::unexpected(std::move(opened).error());
    if (is_signing) core_->signing_ids.keep(signs_by, *signs_as, id);
    core_->coalescing.allow(!core_->endpoints.any_low_latency());
    return id;
}

SetupResult<void> Links::open_as(EndpointId id, std::uint8_t signs_as, const endpoint::Endpoint& endpoint,
                                 const dialect::Dialect* dialect) {
    std::vector<std::string> notices;
    auto signature = Signature::load(endpoint.options, signs_as, core_->key_store, notices);
    if (!signature) return tl::unexpected(std::move(signature.error()).within(endpoint.label()));
    for (auto& text : notices) core_->events.notice(id, std::move(text));
    if (dialect != nullptr) core_->dialects.set(id, *dialect);
    auto opened = open({*core_, endpoint, id, std::move(*signature)});
    if (!opened) {
        core_->dialects.forget(id);
        core_->links_added.erase(id);
        return tl::unexpected(std::move(opened).error());
    }
    core_->endpoints.add(std::move(*opened));
    return {};
}

void Links::make_independent() noexcept { allows_same_address_ = core_->key_store.endpoints_are_independent = true; }

bool Links::allows_same_address(const endpoint::Endpoint& endpoint) const noexcept {
    return allows_same_address_ && endpoint.options.name.empty();
}

SetupResult<EndpointId> Links::add_inlet(const std::string& ring, const std::filesystem::path& socket, unsigned mode) {
    core_->refresh_now();
    endpoint::Endpoint endpoint;
    endpoint.scheme = endpoint::Scheme::shm;
    endpoint.path = ring;
    const EndpointId id = core_->endpoints.next_id();
    auto opened = open_inlet({*core_, endpoint, id, nullptr}, socket, mode);
    if (!opened) return tl::unexpected(std::move(opened).error());
    core_->endpoints.add(std::move(*opened));
    return id;
}

const SetupError* Links::failure(EndpointId endpoint) const noexcept {
    const OpenEndpoint* const found = core_->endpoints.find(endpoint);
    return found == nullptr || !found->failure ? nullptr : &*found->failure;
}

void Links::remove(EndpointId endpoint) {
    assert(core_->events.handler() == nullptr && "remove must not be called inside a callback");
    core_->endpoints.remove(endpoint);
    core_->stages.erase(endpoint);
    core_->links_added.erase(endpoint);
    core_->dialects.forget(endpoint);
    core_->coalescing.allow(!core_->endpoints.any_low_latency());
}

static bool may_have_stages(const OpenEndpoint* endpoint) {
    return endpoint != nullptr && !endpoint->info.endpoint.is_ring();
}

bool Links::set_stages(EndpointId endpoint, CreateStages create) {
    assert(core_->events.handler() == nullptr && "set_stages must not be called inside a callback");
    const bool may = may_have_stages(core_->endpoints.find(endpoint));
    if (may) core_->set_stages(endpoint, std::move(create));
    return may;
}

bool Links::set_stages(LinkId link, const CreateStages& create) {
    assert(core_->events.handler() == nullptr && "set_stages must not be called inside a callback");
    Link* const found = core_->links.find(link);
    const bool may = found != nullptr && may_have_stages(core_->endpoints.find(found->endpoint));
    if (may) core_->set_stages(*found, create);
    return may;
}

const CreateStages* Links::stages_by(EndpointId endpoint) const noexcept {
    const auto found = core_->stages.find(endpoint);
    return found == core_->stages.end() ? nullptr : &found->second;
}

const CreateStages* Links::stages_by(LinkId link) const noexcept {
    const Link* const found = core_->links.find(link);
    return found == nullptr || !found->border || !found->border->made_by() ? nullptr : &found->border->made_by();
}

void Links::report(EndpointId endpoint, std::string text) { core_->events.notice(endpoint, std::move(text)); }

LinkId Links::take_link_id() noexcept { return core_->links.take_id(); }
EndpointId Links::take_endpoint_id() { return core_->endpoints.take_id(); }

bool Links::close(LinkId link) {
    assert(core_->events.handler() == nullptr && "close must not be called inside a callback");
    const Link* const found = core_->links.find(link);
    OpenEndpoint* const endpoint = found == nullptr ? nullptr : core_->endpoints.find(found->endpoint);
    return endpoint != nullptr && endpoint->close_link(link);
}

bool Links::has_other_keys(EndpointId endpoint) const {
    const OpenEndpoint* const found = core_->endpoints.find(endpoint);
    return found != nullptr && found->signature != nullptr && found->signature->has_other_keys();
}

void Links::count_from(LinkId last) noexcept { core_->links.count_from(last); }

std::size_t Links::turn(LinkHandler& handler, MonoTime deadline) { return core_->turn(handler, deadline); }

void Links::read_all() noexcept { core_->reads_all = true; }

std::size_t Links::send(std::span<const LinkId> links, const wire::FrameView& frame) {
    OutgoingFrame outgoing(frame);
    std::size_t taken = 0;
    for (const LinkId id : links) {
        Link* const link = core_->links.find(id);
        if (link != nullptr && link->up && Core::send(*link, outgoing, core_->now())) ++taken;
    }
    return taken;
}

std::size_t Links::forward(std::span<const LinkId> links, const wire::FrameView& frame, Rank from) {
    OutgoingFrame outgoing(frame);
    std::size_t not_signed = 0;
    for (const LinkId id : links) {
        Link* const link = core_->links.find(id);
        if (link == nullptr || !link->up) continue;
        const bool is_signed = link->signs(from);
        const bool is_queued = is_signed ? Core::send(*link, outgoing, core_->now())
                                         : Core::send_unsigned(*link, outgoing, from, core_->now());
        if (is_queued && !is_signed && link->signature != nullptr && link->signature->signs()) ++not_signed;
    }
    return not_signed;
}

std::size_t Links::send(LinkId link, const wire::FrameView& frame) { return send(std::span(&link, 1), frame); }

std::size_t Links::send(EndpointId endpoint, const wire::FrameView& frame) {
    OpenEndpoint* const found = core_->endpoints.find(endpoint);
    return found == nullptr ? 0 : found->send(frame);
}

MonoTime Links::now() const noexcept { return core_->now(); }

bool Links::pending() const {
    bool is_sending = false;
    core_->endpoints.each([&](const OpenEndpoint& endpoint) { is_sending = is_sending || endpoint.is_sending(); });
    return is_sending || core_->links.any_queued(core_->now());
}

std::size_t Links::queued_bytes(EndpointId endpoint) const {
    const OpenEndpoint* const found = core_->endpoints.find(endpoint);
    return found == nullptr ? 0 : found->queued_bytes();
}

std::size_t Links::queued_bytes(LinkId link) const noexcept {
    const Link* const found = core_->links.find(link);
    return found == nullptr ? 0 : found->queued_bytes();
}

void Links::wake() noexcept { core_->loop().wake(); }

void Links::refresh_counters() {
    core_->endpoints.each([](OpenEndpoint& endpoint) { endpoint.refresh_counters(); });
}

std::vector<LinkInfo> Links::links() const { return links(link_ids()); }

std::vector<LinkId> Links::link_ids() const {
    std::vector<LinkId> ids;
    ids.reserve(core_->links.size());
    core_->links.each([&](const Link& link) { ids.push_back(link.id); });
    std::ranges::sort(ids);
    return ids;
}

std::vector<LinkInfo> Links::links(std::span<const LinkId> ids) const {
    std::vector<LinkInfo> infos;
    for (const LinkId id : ids) {
        const Link* const l = core_->links.find(id);
        if (l == nullptr) continue;
        if (auto* const endpoint = core_->endpoints.find(l->endpoint)) endpoint->settle_sent();
        infos.push_back({l->id, l->endpoint, l->name, l->up, l->rank, &l->counters, l->queued_bytes(),
                         l->max_held_bytes, l->border ? l->border->text() : ""});
    }
    return infos;
}

std::vector<EndpointInfo> Links::endpoints() const {
    std::vector<EndpointInfo> infos;
    core_->endpoints.each([&](const OpenEndpoint& endpoint) {
        infos.push_back(endpoint.info);
        infos.back().counters = &endpoint.counters;
    });
    return infos;
}

Rank Links::rank(LinkId link) const noexcept {
    const Link* const found = core_->links.find(link);
    return found == nullptr ? Rank::stranger : found->rank;
}

std::string_view Links::link_name(LinkId link) const {
    const Link* const found = core_->links.find(link);
    return found == nullptr ? std::string_view{} : std::string_view(found->name);
}

std::span<const wire::SequenceStats> Links::sources(LinkId link) const noexcept {
    const Link* const found = core_->links.find(link);
    return found == nullptr ? std::span<const wire::SequenceStats>{} : found->loss.tracker.sources();
}

const LinkCounters* Links::counters(LinkId link) const noexcept {
    const Link* const found = core_->links.find(link);
    return found == nullptr ? nullptr : &found->counters;
}

}  // namespace mavloom::link
