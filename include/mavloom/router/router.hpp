// SPDX-License-Identifier: MIT
// The router: links, the routing engine, a recording of all that arrives, and the router's own heartbeat, bound together on one thread. Bytes
// in are bytes out (DESIGN.md rule 1). Endpoints come and go while it runs; those that did not change keep their links and routes.
//
// Owned and driven by one thread; `wake` and `post` may be called from any. The frame path neither allocates, locks nor logs, unless an
// Explainer is set. DESIGN.md sections 3 and 4, docs/guide/route.md.
#pragma once

#include <atomic>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
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

namespace mavloom::ring {
class RingTap;
}

namespace mavloom::router {

class OwnMessages;
class SilenceWatch;

class Router : public control::Served, private link::LinkHandler {
public:
    // What a person should know: links that came and went, odd things. Called on the router's thread.
    using Notice = std::function<void(config::LogLevel, std::string_view)>;
    // Called for every frame that is good, with the engine's decision and its reasons by link.
    using Explainer =
        std::function<void(const link::RxFrame&, const route::Decision&, std::span<const route::Explanation>)>;

    // `dialect` must outlive the router.
    [[nodiscard]] static SetupResult<std::unique_ptr<Router>> create(const dialect::Dialect& dialect,
                                                                     const config::RouterConfig& config, Notice notice);
    Router(const Router&) = delete;
    Router& operator=(const Router&) = delete;
    ~Router() override;

    // The group_mode= that these endpoints name, by group. Two modes for one group are an error.
    using GroupModes = std::map<std::string, endpoint::GroupMode>;
    [[nodiscard]] static SetupResult<GroupModes> group_modes_of(std::span<const endpoint::Endpoint> endpoints);
    // Of all endpoints that will be there, before the first is added: one that names no mode takes that of its group.
    [[nodiscard]] SetupResult<void> learn_group_modes(std::span<const endpoint::Endpoint> endpoints);
    // A link endpoint, or tlog://PATH: a recording of every frame that arrives, taken before routing.
    [[nodiscard]] SetupResult<void> add(const endpoint::Endpoint& endpoint);
    // Every good frame that arrives is written once into a ring, whatever becomes of it, and a counter page tells of the links (docs/formats/ring.md).
    // Carries on in a ring whose router was killed; errors as of shm::RingWriter::open. At the end ring and page are removed. Once, before the
    // first turn.
    [[nodiscard]] SetupResult<void> open_ring(const config::RingConfig& config);
    // The socket by which who reads that ring sends frames: Links::add_inlet.
    [[nodiscard]] SetupResult<void> open_inlet(const config::RingConfig& config, const std::filesystem::path& socket);
    // An endpoint or recording by its label (`name=`, else the URL without its query), or a peer or client by its link's name: it is closed, and is
    // a new link if it speaks again. False when there is none.
    bool remove(std::string_view label);
    // Other [router] values. Links stay, and so does what was learned and counted.
    void configure(const config::RouterConfig& config);
    // The endpoints become these, which agree on their groups' modes (group_modes_of): those that are the same, and the keys in their files, stay as they are. What could not be opened is told and
    // left out; one of the same name that was there before is opened again.
    void become(const std::vector<endpoint::Endpoint>& endpoints);

    // Says something as the router itself does.
    void tell(config::LogLevel level, std::string_view text) const { notice_(level, text); }

    void explain(Explainer explainer) { explainer_ = std::move(explainer); }

    // One turn of the links; then what was posted, and what is due.
    void turn(MonoTime deadline);
    // Sends what is queued for at most `limit`, closes the recordings, and removes the ring.
    void finish(Nanoseconds limit);

    // Async-signal-safe.
    void wake() noexcept { links_->wake(); }
    // control::Served.
    void post(std::function<void()> work) override;
    void drop_posted() override;
    [[nodiscard]] control::Later<control::Lines> answer(std::string_view request) override;
    [[nodiscard]] control::Later<std::string> metrics() override;

    // For reports, on the router's thread.
    [[nodiscard]] link::Links& links() noexcept { return *links_; }
    [[nodiscard]] const route::Engine& engine() const noexcept { return engine_; }
    [[nodiscard]] const observe::TrafficTable& traffic() const noexcept { return traffic_; }
    [[nodiscard]] const std::vector<std::unique_ptr<record::Recorder>>& recorders() const noexcept {
        return recorders_;
    }
    [[nodiscard]] const dialect::Dialect& dialect() const noexcept { return dialect_; }
    [[nodiscard]] std::uint64_t heartbeats_sent() const noexcept;
    // Frames that left without our signature on a link with `sign=`, because they came from a link without `verify=`.
    [[nodiscard]] std::uint64_t not_signed() const noexcept { return not_signed_.value(); }
    [[nodiscard]] MonoTime started() const noexcept { return started_; }

private:
    static constexpr std::size_t most_told = 100;  // lines about links of one endpoint in a row
    struct OpenedEndpoint {
        link::EndpointId id;
        endpoint::Endpoint endpoint;
        route::LinkPolicy policy;
        bool verifies = false;
        std::size_t may_tell = most_told, not_told = 0;  // lines about its links
    };

    Router(const dialect::Dialect& dialect, const config::RouterConfig& config, Notice notice,
           std::unique_ptr<link::Links> links);

    void on_frame(const link::RxFrame& rx) override;
    void on_link_up(LinkId link, link::EndpointId endpoint, std::string_view name) override;
    void on_link_down(LinkId link, link::EndpointId endpoint, std::string_view why) override;
    void on_notice(link::EndpointId endpoint, std::string_view text) override;

    [[nodiscard]] SetupResult<void> add_recording(const endpoint::Endpoint& endpoint);
    [[nodiscard]] route::Decision decide(const link::RxFrame& rx, std::uint64_t mark);
    [[nodiscard]] SetupResult<route::LinkPolicy> policy_of(const endpoint::Endpoint& endpoint);
    [[nodiscard]] SetupResult<void> check_group(const endpoint::Endpoint& endpoint) const;
    [[nodiscard]] endpoint::GroupMode mode_of(const endpoint::EndpointOptions& options) const;
    [[nodiscard]] route::GroupId group_id(const std::string& name);
    void register_endpoint(OpenedEndpoint& opened);
    [[nodiscard]] bool has(const endpoint::Endpoint& endpoint) const;
    void order_as(const std::vector<endpoint::Endpoint>& endpoints);
    void put_back(const std::vector<endpoint::Endpoint>& gone, const std::string& label);
    void speak_on(LinkId link, link::EndpointId endpoint);
    void forget_link(LinkId link);
    bool close_link(std::string_view name);
    // Of a crowd of links of an endpoint that come and go a few are told, and how many there were.
    [[nodiscard]] bool may_tell_of_link(link::EndpointId endpoint) noexcept;
    void send(const link::RxFrame& rx, std::span<const LinkId> links);
    void count_loss(const link::RxFrame& rx);
    void run_posted();
    bool send_own(LinkId link, const wire::FrameView& frame);
    [[nodiscard]] bool is_answered(LinkId link) const;
    void look_after(MonoTime now);
    void look_after_ring();
    void tell_silence(MonoTime now);
    void refresh_page();
    void tell_more_links(OpenedEndpoint& opened);
    [[nodiscard]] MonoTime next_due() const noexcept;

    const dialect::Dialect& dialect_;
    config::RouterConfig config_;
    Notice notice_;
    std::unique_ptr<link::Links> links_;
    route::Engine engine_;
    Explainer explainer_;
    std::vector<route::Explanation> why_;
    observe::TrafficTable traffic_;
    std::vector<std::unique_ptr<OpenedEndpoint>> endpoints_;
    std::vector<OpenedEndpoint*> by_id_;  // by EndpointId; null: removed
    std::vector<std::string> groups_;     // by GroupId - 1
    GroupModes group_modes_;
    std::vector<std::unique_ptr<record::Recorder>> recorders_;
    std::vector<std::unique_ptr<record::Recorder>> ending_recorders_;  // removed, and still writing
    std::vector<endpoint::Endpoint> recordings_;                       // what each recorder was made from
    std::unique_ptr<OpenedEndpoint> inlet_;                            // null: none
    std::unique_ptr<ring::RingTap> ring_;                              // null: none
    std::unique_ptr<OwnMessages> own_messages_;                        // never null
    std::unique_ptr<SilenceWatch> silence_;                            // never null
    bool any_signs_ = false;
    bool a_link_went_ = false;  // for good or for a while: its rows in the table may be nobody's
    Counter not_signed_;
    std::size_t duplicate_ids_told_ = 0;
    MonoTime started_ = mono_now();
    MonoTime look_due_{};

    std::atomic<bool> has_posted_{false};
    std::mutex posted_mutex_;
    std::deque<std::function<void()>> posted_;  // guarded by posted_mutex_
};

}  // namespace mavloom::router
