// SPDX-License-Identifier: MIT
// The router forwards frames between links and never changes their bytes. It runs links, the routing engine,
// recordings, an optional shared-memory ring and the router's own heartbeat on one thread. Endpoints can be added and
// removed while it runs; unchanged endpoints keep their links and routes. See docs/guide/route.md.
//
// One thread owns and drives a router; any thread may call `wake` and `post`. The frame path does not allocate, lock or
// log, unless an Explainer is set.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/config/config.hpp"
#include "mavloom/control/served.hpp"
#include "mavloom/link/links.hpp"
#include "mavloom/observe/traffic_table.hpp"
#include "mavloom/record/recorder.hpp"
#include "mavloom/route/engine.hpp"

namespace mavloom::control {
class PostBox;
}
namespace mavloom::link {
class SilenceWatch;
}
namespace mavloom::ring {
class OwnPage;
class RingTap;
struct OwnCount;
}  // namespace mavloom::ring

namespace mavloom::router {

class Forwarder;
class NewestHeartbeats;
class Recordings;
class RoutedEndpoints;
class Snapshots;

// Whether the metrics distinguish the components of a system.
enum class MetricsDetail : std::uint8_t { systems, components };

class Router : public control::Served, private link::LinkHandler {
public:
    // Receives log lines about links that come and go, and about anything unusual. Called on the router's thread.
    using Notice = std::function<void(config::LogLevel, std::string_view)>;
    // Called for every good frame, with the engine's decision and its reason for each link.
    using Explainer =
        std::function<void(const link::RxFrame&, const route::Decision&, std::span<const route::Explanation>)>;

    // `dialect` must outlive the router.
    [[nodiscard]] static SetupResult<std::unique_ptr<Router>> create(const dialect::Dialect& dialect,
                                                                     const config::RouterConfig& config, Notice notice);
    Router(const Router&) = delete;
    Router& operator=(const Router&) = delete;
    ~Router() override;

    // The modes that these endpoints set by `group_mode=`, by group name. Fails if a group has two modes.
    using GroupModes = std::map<std::string, endpoint::GroupMode>;
    [[nodiscard]] static SetupResult<GroupModes> group_modes_of(std::span<const endpoint::Endpoint> endpoints);
    // Learns the group modes of all endpoints that will be added; call it before the first `add`. An endpoint without
    // `group_mode=` then gets the mode of its group.
    [[nodiscard]] SetupResult<void> learn_group_modes(std::span<const endpoint::Endpoint> endpoints);
    // Adds a link endpoint or a recording. A recording, tlog://PATH, gets every good frame on arrival, before routing.
    [[nodiscard]] SetupResult<void> add(const endpoint::Endpoint& endpoint);
    // Opens a shared-memory ring and its counter page (docs/formats/ring.md). The router writes every good frame that
    // arrives into the ring once, whatever its verdict. The page holds the counters of the links. If a killed router
    // left the ring, this router continues it. `finish` and the destructor remove ring and page. Call once, before the
    // first turn. Errors are those of shm::RingWriter::open.
    [[nodiscard]] SetupResult<void> open_ring(const config::RingConfig& config);
    // Opens a counter page of this name. Call it only if there is no ring. Errors are those of CounterPage::create.
    [[nodiscard]] SetupResult<void> open_page(const std::string& name);
    // Opens the ring's inlet, the socket through which readers of the ring send frames. See Links::add_inlet.
    [[nodiscard]] SetupResult<void> open_inlet(const config::RingConfig& config, const std::filesystem::path& socket);
    // Removes an endpoint or recording by its label: `name=`, or else the URL without its query. If `label` is the name
    // of a link, closes only that link; if its peer or client sends again, it gets a new link. Returns false if nothing
    // has that name.
    bool remove(std::string_view label);
    // Applies new [router] values. Links, routes and counters stay.
    void configure(const config::RouterConfig& config);
    // Makes `endpoints` the router's endpoints and recordings. group_modes_of must succeed for them. An endpoint stays
    // untouched if its options, its group's mode and the contents of its key files are unchanged. If an endpoint cannot
    // be opened, the router reports it and leaves it out, and reopens the former endpoint of the same label, if any.
    void apply(const std::vector<endpoint::Endpoint>& endpoints);

    // Logs a line through the router's Notice.
    void notify(config::LogLevel level, std::string_view text) const { notice_(level, text); }

    void explain(Explainer explainer);
    void set_metrics_detail(MetricsDetail detail) noexcept { metrics_detail_ = detail; }

    // Runs one turn of the links, which waits until `deadline` at most. Then runs one piece of posted work and the
    // periodic tasks that are due.
    void turn(MonoTime deadline);
    // Handles frames that have already arrived and sends queued frames. This takes at most `limit`, and then the rest
    // of a turn. Then closes the recordings and removes the ring.
    void finish(Nanoseconds limit);

    // Async-signal-safe.
    void wake() noexcept { links_->wake(); }
    // control::Served.
    void post(std::function<void()> work) override;
    void drop_posted() override;
    [[nodiscard]] control::Report answer(std::string_view request) override;
    [[nodiscard]] control::Report metrics() override;

    // For reports; on the router's thread only.
    [[nodiscard]] Snapshots& snapshots() noexcept { return *snapshots_; }
    [[nodiscard]] MetricsDetail metrics_detail() const noexcept { return metrics_detail_; }
    [[nodiscard]] link::Links& links() noexcept { return *links_; }
    [[nodiscard]] const route::Engine& engine() const noexcept;
    // The verdicts on a link's frames, also while the link is down. Null for a link that is gone.
    [[nodiscard]] const route::LinkCounters* verdicts(LinkId link) const;
    [[nodiscard]] const observe::TrafficTable& traffic() const noexcept;
    [[nodiscard]] const NewestHeartbeats& newest_heartbeats() const noexcept;
    // Valid until the next `add`, `remove`, `apply` or `finish`.
    [[nodiscard]] std::vector<const record::Recorder*> recorders() const;
    [[nodiscard]] std::uint64_t heartbeats_sent() const noexcept;
    // Frames sent unsigned on a link with `sign=`, because they arrived on a link without `verify=`.
    [[nodiscard]] std::uint64_t not_signed() const noexcept;
    [[nodiscard]] const dialect::Dialect& dialect() const noexcept { return dialect_; }
    [[nodiscard]] MonoTime started() const noexcept { return started_; }

private:
    Router(const dialect::Dialect& dialect, const config::RouterConfig& config, Notice notice,
           std::unique_ptr<link::Links> links);

    void on_frame(const link::RxFrame& rx) override;
    void on_link_up(LinkId link, link::EndpointId endpoint, std::string_view name) override;
    void on_link_down(LinkId link, link::EndpointId endpoint, std::string_view why) override;
    void on_notice(link::EndpointId endpoint, std::string_view text) override;
    void forget_link(LinkId link);

    bool close_link(std::string_view name);
    void remove_unwanted(std::span<const endpoint::Endpoint> wanted, std::vector<endpoint::Endpoint>& gone);
    void add_missing(std::span<const endpoint::Endpoint> wanted, std::span<const endpoint::Endpoint> gone);
    void put_back(std::span<const endpoint::Endpoint> gone, const std::string& label);

    [[nodiscard]] MonoTime next_due() const noexcept;
    void handle_arrived(MonoTime end);
    void maintain(MonoTime now);
    void maintain_ring();
    void note_turn(std::size_t frames, MonoTime now);
    void refresh_page();
    void sum_verdicts();
    void run_posted(MonoTime now);
    void report_silence(MonoTime now);

    const dialect::Dialect& dialect_;
    MetricsDetail metrics_detail_ = MetricsDetail::systems;
    bool has_heartbeat_;  // the router has an id of its own
    Notice notice_;
    // None of these is null, except `ring_` if there is no ring, and `page_` if there is one.
    std::unique_ptr<link::Links> links_;
    std::unique_ptr<RoutedEndpoints> endpoints_;
    std::unique_ptr<Forwarder> forwarder_;
    std::unique_ptr<link::SilenceWatch> silence_;
    std::unique_ptr<control::PostBox> posted_;
    std::unique_ptr<Recordings> recordings_;
    std::unique_ptr<Snapshots> snapshots_;
    std::unique_ptr<ring::RingTap> ring_;
    std::unique_ptr<ring::OwnPage> page_;
    std::vector<ring::OwnCount> page_counts_;
    MonoTime started_ = mono_now();
    MonoTime maintain_due_{}, work_due_{};
};

}  // namespace mavloom::router
