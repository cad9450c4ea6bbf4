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

#include "mavloom/observe/traffic_table.hpp"
#include "mavloom/route/engine.hpp"
#include "mavloom/runtime/config.hpp"
#include "mavloom/runtime/links.hpp"
#include "mavloom/runtime/recorder.hpp"

namespace mavloom::runtime {

class RingTap;
class OwnMessages;
class SilenceWatch;

class Router : private LinkHandler {
public:
    // What a person should know: links that came and went, odd things. Called on the router's thread.
    using Notice = std::function<void(LogLevel, std::string_view)>;
    // Called for every frame that is good, with the engine's decision and its reasons by link.
    using Explainer = std::function<void(const RxFrame&, const route::Decision&, std::span<const route::Explanation>)>;

    // `dialect` must outlive the router.
    [[nodiscard]] static SetupResult<std::unique_ptr<Router>> create(const dialect::Dialect& dialect,
                                                                     const RouterConfig& config, Notice notice);
    Router(const Router&) = delete;
    Router& operator=(const Router&) = delete;
    ~Router() override;

    // The group_mode= that these endpoints name, by group. Two modes for one group are an error.
    using GroupModes = std::map<std::string, GroupMode>;
    [[nodiscard]] static SetupResult<GroupModes> group_modes_of(std::span<const Endpoint> endpoints);
    // Of all endpoints that will be there, before the first is added: one that names no mode takes that of its group.
    [[nodiscard]] SetupResult<void> learn_group_modes(std::span<const Endpoint> endpoints);
    // A link endpoint, or tlog://PATH: a recording of every frame that arrives, taken before routing.
    [[nodiscard]] SetupResult<void> add(const Endpoint& endpoint);
    // Every good frame that arrives is written once into a ring, whatever becomes of it, and a counter page tells of the links (docs/formats/ring.md).
    // Carries on in a ring whose router was killed; errors as of shm::RingWriter::open. At the end ring and page are removed. Once, before the
    // first turn.
    [[nodiscard]] SetupResult<void> open_ring(const RingConfig& config);
    // The socket by which who reads that ring sends frames: Links::add_inlet.
    [[nodiscard]] SetupResult<void> open_inlet(const RingConfig& config, const std::filesystem::path& socket);
    // An endpoint or recording by its label (`name=`, else the URL without its query), or a peer or client by its link's name: it is closed, and is
    // a new link if it speaks again. False when there is none.
    bool remove(std::string_view label);
    // Other [router] values. Links stay, and so does what was learned and counted.
    void configure(const RouterConfig& config);
    // The endpoints become these, which agree on their groups' modes (group_modes_of): those that are the same, and the keys in their files, stay as they are. What could not be opened is told and
    // left out; one of the same name that was there before is opened again.
    void become(const std::vector<Endpoint>& endpoints);

    // Says something as the router itself does.
    void tell(LogLevel level, std::string_view text) const { notice_(level, text); }

    void explain(Explainer explainer) { explainer_ = std::move(explainer); }

    // One turn of the links; then what was posted, and what is due.
    void turn(MonoTime deadline);
    // Sends what is queued for at most `limit`, closes the recordings, and removes the ring.
    void finish(Nanoseconds limit);

    // Async-signal-safe.
    void wake() noexcept { links_->wake(); }
    // Any thread: `work` is run on the router's thread between two turns. What is still waiting when the router goes is destroyed unrun.
    void post(std::function<void(Router&)> work);
    // Destroys what was posted and not yet run; for who posted it and is about to go.
    void drop_posted();

    // For reports, on the router's thread.
    [[nodiscard]] Links& links() noexcept { return *links_; }
    [[nodiscard]] const route::Engine& engine() const noexcept { return engine_; }
    [[nodiscard]] const observe::TrafficTable& traffic() const noexcept { return traffic_; }
    [[nodiscard]] const std::vector<std::unique_ptr<Recorder>>& recorders() const noexcept { return recorders_; }
    [[nodiscard]] const dialect::Dialect& dialect() const noexcept { return dialect_; }
    [[nodiscard]] std::uint64_t heartbeats_sent() const noexcept;
    // Frames that left without our signature on a link with `sign=`, because they came from a link without `verify=`.
    [[nodiscard]] std::uint64_t not_signed() const noexcept { return not_signed_.value(); }
    [[nodiscard]] MonoTime started() const noexcept { return started_; }

private:
    static constexpr std::size_t most_told = 100;  // lines about links of one endpoint in a row
    struct OpenedEndpoint {
        EndpointId id;
        Endpoint endpoint;
        route::LinkPolicy policy;
        bool verifies = false;
        std::size_t may_tell = most_told, not_told = 0;  // lines about its links
    };

    Router(const dialect::Dialect& dialect, const RouterConfig& config, Notice notice, std::unique_ptr<Links> links);

    void on_frame(const RxFrame& rx) override;
    void on_link_up(LinkId link, EndpointId endpoint, std::string_view name) override;
    void on_link_down(LinkId link, EndpointId endpoint, std::string_view why) override;
    void on_notice(EndpointId endpoint, std::string_view text) override;

    [[nodiscard]] SetupResult<void> add_recording(const Endpoint& endpoint);
    [[nodiscard]] route::Decision decide(const RxFrame& rx, std::uint64_t mark);
    [[nodiscard]] SetupResult<route::LinkPolicy> policy_of(const Endpoint& endpoint);
    [[nodiscard]] SetupResult<void> check_group(const Endpoint& endpoint) const;
    [[nodiscard]] GroupMode mode_of(const EndpointOptions& options) const;
    [[nodiscard]] route::GroupId group_id(const std::string& name);
    void register_endpoint(OpenedEndpoint& opened);
    [[nodiscard]] bool has(const Endpoint& endpoint) const;
    void order_as(const std::vector<Endpoint>& endpoints);
    void put_back(const std::vector<Endpoint>& gone, const std::string& label);
    void speak_on(LinkId link, EndpointId endpoint);
    void forget_link(LinkId link);
    bool close_link(std::string_view name);
    // Of a crowd of links of an endpoint that come and go a few are told, and how many there were.
    [[nodiscard]] bool may_tell_of_link(EndpointId endpoint) noexcept;
    void send(const RxFrame& rx, std::span<const LinkId> links);
    void count_loss(const RxFrame& rx);
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
    RouterConfig config_;
    Notice notice_;
    std::unique_ptr<Links> links_;
    route::Engine engine_;
    Explainer explainer_;
    std::vector<route::Explanation> why_;
    observe::TrafficTable traffic_;
    std::vector<std::unique_ptr<OpenedEndpoint>> endpoints_;
    std::vector<OpenedEndpoint*> by_id_;  // by EndpointId; null: removed
    std::vector<std::string> groups_;     // by GroupId - 1
    GroupModes group_modes_;
    std::vector<std::unique_ptr<Recorder>> recorders_;
    std::vector<std::unique_ptr<Recorder>> ending_recorders_;  // removed, and still writing
    std::vector<Endpoint> recordings_;                         // what each recorder was made from
    std::unique_ptr<OpenedEndpoint> inlet_;                    // null: none
    std::unique_ptr<RingTap> ring_;                            // null: none
    std::unique_ptr<OwnMessages> own_messages_;                // never null
    std::unique_ptr<SilenceWatch> silence_;                    // never null
    bool any_signs_ = false;
    bool a_link_went_ = false;  // for good or for a while: its rows in the table may be nobody's
    Counter not_signed_;
    std::size_t duplicate_ids_told_ = 0;
    MonoTime started_ = mono_now();
    MonoTime look_due_{};

    std::atomic<bool> has_posted_{false};
    std::mutex posted_mutex_;
    std::deque<std::function<void(Router&)>> posted_;  // guarded by posted_mutex_
};

}  // namespace mavloom::runtime
