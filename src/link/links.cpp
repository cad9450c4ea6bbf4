// SPDX-License-Identifier: MIT
#include "mavloom/link/links.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "link/core.hpp"
#include "link/local/inlet.hpp"
#include "link/local/shm.hpp"
#include "link/serial/serial.hpp"
#include "link/tcp/tcp.hpp"
#include "link/udp/udp.hpp"
#include "mavloom/endpoint/checks.hpp"
#include "mavloom/net/run_folder.hpp"

namespace mavloom::link {

using namespace detail;

void LinkCounters::add(const LinkCounters& other) noexcept {
    for (const auto& counter : link_counters) (this->*counter.word).add((other.*counter.word).value());
}

void LinkCounters::add(const wire::SequenceTracker::Update& update) noexcept {
    const auto change = [](Counter& counter, std::int32_t by) {
        if (by != 0) counter.set(counter.value() + static_cast<std::uint64_t>(std::int64_t{by}));
    };
    change(lost, update.lost);
    change(late, update.late);
    change(duplicate, update.duplicate);
    change(resync, update.resync);
}

class Links::Impl {
public:
    Impl(Language language, std::unique_ptr<net::EventLoop> loop, net::ReceiveBatch batch)
        : core(std::move(language), std::move(loop), std::move(batch)) {}

    [[nodiscard]] OpenEndpoint* find(EndpointId id) const noexcept {
        return id.value < endpoints.size() ? endpoints[id.value].get() : nullptr;
    }
    void choose_coalescing() {
        core.allow_coalescing(std::ranges::none_of(
            endpoints, [](const auto& e) { return e != nullptr && e->info.endpoint.options.low_latency; }));
    }

    Core core;
    endpoint::RoutingOptions routing = endpoint::RoutingOptions::refused;
    std::vector<std::unique_ptr<OpenEndpoint>> endpoints;  // index: id; null: removed
    bool may_repeat = false;
    // By label. An endpoint that is reopened keeps signing with its old link id, so that the far side sees the same
    // link. Of several endpoints with one label, the first open one (`holder`) has the id.
    struct SignsAs {
        EndpointId id, holder;
    };
    std::map<std::string, SignsAs> signs_as;
};

SetupResult<std::filesystem::path> Links::inlet_path(std::string_view ring) {
    return net::run_path(ring, inlet_suffix, "inlet");
}

Links::Links(std::unique_ptr<Impl> impl) noexcept : impl_(std::move(impl)) {}
Links::~Links() = default;

template <class Make>
static auto with_system_parts(Make&& make) -> SetupResult<std::unique_ptr<Links>> {
    auto loop = net::EventLoop::create();
    if (!loop) return tl::unexpected(std::move(loop).error());
    auto batch = net::ReceiveBatch::create();
    if (!batch) return tl::unexpected(std::move(batch).error());
    return make(std::move(*loop), std::move(*batch));
}

SetupResult<std::unique_ptr<Links>> Links::create(const wire::MessageTable& table) {
    return with_system_parts([&](auto loop, auto batch) {
        return std::unique_ptr<Links>(new Links(
            std::make_unique<Impl>(Language{table, MessageClasses(table)}, std::move(loop), std::move(batch))));
    });
}

SetupResult<std::unique_ptr<Links>> Links::create(const dialect::Dialect& dialect, endpoint::RoutingOptions routing) {
    return with_system_parts([&](auto loop, auto batch) {
        auto impl = std::make_unique<Impl>(Language{dialect.wire_table(), MessageClasses(dialect)}, std::move(loop),
                                           std::move(batch));
        impl->routing = routing;
        if (routing == endpoint::RoutingOptions::by_owner) impl->core.leave_loss_to_owner();
        return std::unique_ptr<Links>(new Links(std::move(impl)));
    });
}

static SetupResult<std::unique_ptr<OpenEndpoint>> open(Opening opening) {
    switch (opening.endpoint.scheme) {
        case endpoint::Scheme::udpin: return open_udpin(std::move(opening));
        case endpoint::Scheme::udpout: return open_udpout(std::move(opening));
        case endpoint::Scheme::udpbcast: return open_udpbcast(std::move(opening));
        case endpoint::Scheme::udpmcast: return open_udpmcast(std::move(opening));
        case endpoint::Scheme::tcpin: return open_tcpin(std::move(opening));
        case endpoint::Scheme::serial: return open_serial(std::move(opening));
        case endpoint::Scheme::shm: return open_shm(std::move(opening));
        default: return open_tcpout(std::move(opening));
    }
}

SetupResult<EndpointId> Links::add(const endpoint::Endpoint& endpoint, const dialect::Dialect* dialect) {
    impl_->core.refresh_now();
    if (auto checked = endpoint::check_supported(endpoint, impl_->routing); !checked)
        return tl::unexpected(std::move(checked).error());
    // Several endpoints may request port 0; each gets its own port.
    const bool has_name = endpoint.scheme == endpoint::Scheme::serial || endpoint.scheme == endpoint::Scheme::shm ||
                          endpoint.address.port != 0;
    for (const auto& other : impl_->endpoints) {
        if (other && other->info.endpoint.label() == endpoint.label() && has_name && !may_repeat(endpoint)) {
            return setup_error(SetupCode::usage,
                               fmt::format("two endpoints are called {}; name= tells them apart", endpoint.label()));
        }
    }
    const EndpointId id{static_cast<EndpointId::rep>(impl_->endpoints.size())};
    std::vector<std::string> notices;
    const auto before = impl_->signs_as.find(endpoint.label());
    const bool is_back = has_name && before != impl_->signs_as.end() && impl_->find(before->second.holder) == nullptr;
    const EndpointId signs_as = is_back ? before->second.id : id;
    auto signature = Signature::load(endpoint.options, signs_as, impl_->core.key_states(), notices);
    if (!signature) return tl::unexpected(std::move(signature.error()).within(endpoint.label()));
    for (auto& text : notices) impl_->core.notice(id, std::move(text));
    if (dialect != nullptr) impl_->core.speaks(id, *dialect);
    auto opened = open({impl_->core, endpoint, id, std::move(*signature)});
    if (!opened) {
        impl_->core.forget_language(id);
        return tl::unexpected(std::move(opened).error());
    }
    impl_->endpoints.push_back(std::move(*opened));
    if (is_back) before->second.holder = id;
    else impl_->signs_as.try_emplace(endpoint.label(), Impl::SignsAs{id, id});
    impl_->choose_coalescing();
    return id;
}

void Links::let_repeat() noexcept { impl_->may_repeat = true; }

bool Links::may_repeat(const endpoint::Endpoint& endpoint) const noexcept {
    return impl_->may_repeat && endpoint.options.name.empty();
}

SetupResult<EndpointId> Links::add_inlet(const std::string& ring, const std::filesystem::path& socket, unsigned mode) {
    impl_->core.refresh_now();
    endpoint::Endpoint endpoint;
    endpoint.scheme = endpoint::Scheme::shm;
    endpoint.path = ring;
    const EndpointId id{static_cast<EndpointId::rep>(impl_->endpoints.size())};
    auto opened = open_inlet({impl_->core, endpoint, id, nullptr}, socket, mode);
    if (!opened) return tl::unexpected(std::move(opened).error());
    impl_->endpoints.push_back(std::move(*opened));
    return id;
}

const SetupError* Links::failure(EndpointId endpoint) const noexcept {
    const OpenEndpoint* const found = impl_->find(endpoint);
    return found == nullptr || !found->failure ? nullptr : &*found->failure;
}

void Links::remove(EndpointId endpoint) {
    if (impl_->find(endpoint) != nullptr) impl_->endpoints[endpoint.value].reset();
    impl_->core.forget_language(endpoint);
    impl_->choose_coalescing();
}

bool Links::close(LinkId link) {
    const Link* const found = impl_->core.links().find(link);
    OpenEndpoint* const endpoint = found == nullptr ? nullptr : impl_->find(found->endpoint);
    return endpoint != nullptr && endpoint->close_link(link);
}

bool Links::has_other_keys(EndpointId endpoint) const {
    const OpenEndpoint* const found = impl_->find(endpoint);
    return found != nullptr && found->signature != nullptr && found->signature->has_other_keys();
}

void Links::count_from(LinkId last) noexcept { impl_->core.count_links_from(last); }

std::size_t Links::turn(LinkHandler& handler, MonoTime deadline) { return impl_->core.turn(handler, deadline); }

std::size_t Links::send(LinkId link, wire::FrameView frame) {
    Link* const found = impl_->core.links().find(link);
    return found != nullptr && found->up && impl_->core.send(*found, frame) ? 1 : 0;
}

std::size_t Links::send(EndpointId endpoint, wire::FrameView frame) {
    OpenEndpoint* const found = impl_->find(endpoint);
    return found == nullptr ? 0 : found->send(frame);
}

bool Links::send_unsigned(LinkId link, wire::FrameView frame) {
    Link* const found = impl_->core.links().find(link);
    return found != nullptr && found->up && impl_->core.queue(*found, frame) && found->signature != nullptr &&
           found->signature->signs();
}

wire::SequenceTracker::Update Links::count_loss(const RxFrame& rx) {
    Link* const found = impl_->core.links().find(rx.link);
    return found == nullptr ? wire::SequenceTracker::Update{} : Core::count_loss(*found, rx.frame, rx.info);
}

MonoTime Links::now() const noexcept { return impl_->core.now(); }

bool Links::pending() const { return impl_->core.pending(); }

std::size_t Links::queued_bytes(EndpointId endpoint) const {
    const OpenEndpoint* const found = impl_->find(endpoint);
    return found == nullptr ? 0 : found->queued_bytes();
}

void Links::wake() noexcept { impl_->core.loop().wake(); }

void Links::refresh_kernel_drops() {
    for (const auto& endpoint : impl_->endpoints)
        if (endpoint) endpoint->refresh_kernel_drops();
}

std::vector<LinkInfo> Links::links() const {
    for (const auto& endpoint : impl_->endpoints)
        if (endpoint) endpoint->settle_sent();
    std::vector<LinkInfo> infos;
    impl_->core.links().each([&](const Link& l) { infos.push_back({l.id, l.endpoint, l.name, l.up, &l.counters}); });
    std::sort(infos.begin(), infos.end(), [](const LinkInfo& a, const LinkInfo& b) { return a.id < b.id; });
    return infos;
}

std::vector<EndpointInfo> Links::endpoints() const {
    std::vector<EndpointInfo> infos;
    for (const auto& endpoint : impl_->endpoints) {
        if (!endpoint) continue;
        infos.push_back(endpoint->info);
        infos.back().counters = &endpoint->counters;
    }
    return infos;
}

std::string_view Links::link_name(LinkId link) const {
    const Link* const found = impl_->core.links().find(link);
    return found == nullptr ? std::string_view{} : std::string_view(found->name);
}

std::span<const wire::SequenceStats> Links::sources(LinkId link) const noexcept {
    const Link* const found = impl_->core.links().find(link);
    return found == nullptr ? std::span<const wire::SequenceStats>{} : found->tracker.sources();
}

const LinkCounters* Links::counters(LinkId link) const noexcept {
    const Link* const found = impl_->core.links().find(link);
    return found == nullptr ? nullptr : &found->counters;
}

}  // namespace mavloom::link
