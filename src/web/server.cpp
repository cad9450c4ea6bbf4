// SPDX-License-Identifier: MIT
#include "mavloom/web/server.hpp"

#include <fmt/format.h>

#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "mavloom/http/server.hpp"
#include "mavloom/http/thread.hpp"
#include "mavloom/http/timer.hpp"
#include "web/api.hpp"
#include "web/channels.hpp"
#include "web/clients/foxglove.hpp"
#include "web/clients/streams.hpp"
#include "web/clients/viewers.hpp"
#include "web/page.hpp"
#include "web/report/cached_text.hpp"
#include "web/report/reporter.hpp"

namespace mavloom::web {

namespace {

constexpr auto json_type = "application/json";
constexpr auto report_period = std::chrono::milliseconds(500);

}  // namespace

class Server::Impl {
public:
    explicit Impl(const dialect::Dialect& dialect)
        : dialect_(dialect),
          inspector_(dialect),
          channels_(max_channels),
          reporter_(dialect, inspector_, channels_, mutex_),
          streams_(dialect) {}

    SetupResult<void> listen(const Options& options) {
        auto thread = http::Thread::start();
        if (!thread) return tl::unexpected(std::move(thread.error()));
        thread_.emplace(std::move(*thread));
        reporter_.tick();
        auto server = http::Server::listen(*thread_, server_options(options));
        if (!server) return tl::unexpected(std::move(server.error()));
        {
            const std::lock_guard lock(mutex_);
            server_.emplace(std::move(*server));
        }
        timer_.emplace(*thread_, report_period, [this] { report(); });
        return {};
    }

    void take(const observe::Heard& heard) {
        const std::lock_guard lock(mutex_);
        streams_.publish(heard);
        const auto* const row = inspector_.add(heard);
        if (row == nullptr) return;
        const auto before = channels_.newest();
        const Channel* const channel = channels_.take(*row);
        if (channels_.has_forgotten()) viewers_.unadvertise(channels_.take_forgotten(), heard.now);
        if (channels_.newest() != before) viewers_.advertise_to_all(heard.now);
        if (channel == nullptr) return;
        viewers_.publish(*channel, heard.now);
        for (const Channel* const standard : channel->standards) viewers_.publish(*standard, heard.now);
    }
    void set_hops(std::vector<observe::Hop> hops) { reporter_.set_hops(std::move(hops)); }
    void note_counts(observe::OwnCounts counts) { reporter_.note_counts(std::move(counts)); }
    void note_end(LinkId link) {
        const std::lock_guard lock(mutex_);
        inspector_.note_end(link);
    }
    bool wants_routes() {
        const std::lock_guard lock(mutex_);
        return !ask_routes_.empty();
    }
    void set_routes(const std::vector<RoutesOf>& routers) {
        std::unique_lock lock(mutex_);
        const auto asking = std::exchange(ask_routes_, {});
        lock.unlock();
        const auto text = std::make_shared<const std::string>(routes_json(routers));
        for (const auto& respond : asking) respond({.content_type = json_type, .body = text});
    }
    void flush() {
        const std::lock_guard lock(mutex_);
        const auto now = mono_now();
        viewers_.flush(now);
        streams_.flush(now);
    }
    [[nodiscard]] std::vector<observe::Alarm> alarms() {
        const std::lock_guard lock(mutex_);
        return inspector_.alarms();
    }
    [[nodiscard]] std::uint64_t left_out() {
        const std::lock_guard lock(mutex_);
        return inspector_.latest().unlisted() + channels_.left_out();
    }
    [[nodiscard]] const std::vector<net::Address>& addresses() const noexcept { return server_->addresses(); }

private:
    http::ServerOptions server_options(const Options& options) {
        http::ServerOptions all{.addresses = options.addresses};
        all.access = {.hosts = options.hosts,
                      .hosts_option = options.hosts_option,
                      .origins = options.origins,
                      .token = options.token};
        all.routes = {
            text_route("/metrics", "text/plain; version=0.0.4; charset=utf-8",
                       [this] { return reporter_.metrics(server_counts()); }),
            text_route("/api/v1/systems", json_type, [this] { return systems_json(reporter_.vehicles(), dialect_); }),
            text_route("/api/v1/messages", json_type, [this] { return messages_json(channels_, mutex_, wall_now()); })};
        for (auto& route : page_routes()) all.routes.push_back(std::move(route));
        for (const auto report : reports) all.routes.push_back(report_route(report));
        all.routes.push_back({"/api/v1/routes", [this](const auto&, const auto& respond) {
                                  const std::lock_guard lock(mutex_);
                                  ask_routes_.push_back(respond);
                              }});
        all.streams = {{.path = "/api/v1/stream",
                        .content_type = "application/x-ndjson",
                        .session = viewer_options(),
                        .get = [this](const http::Request& request) { return open_stream(request.query); }}};
        all.web_sockets = {{.path = "/",
                            .subprotocols = foxglove::subprotocols,
                            .session = viewer_options(),
                            .on_open = [this](const auto& session) { return open(session); }}};
        return all;
    }

    template <class Make>
    static http::Route text_route(const std::string& path, const std::string& type, Make make) {
        return {path, [type, make, text = std::make_shared<CachedText>()](const auto&, const auto& respond) {
                    respond({.content_type = type, .body = text->get(make)});
                }};
    }

    // While the server is being opened, those of HTTP are not there.
    std::vector<observe::NamedCount> server_counts() {
        const std::lock_guard lock(mutex_);
        auto all = viewers_.refused();
        for (std::size_t i = 0; server_ && i < http::Counters::size; ++i) {
            const auto what = static_cast<http::Count>(i);
            all.push_back({std::string(http::Counters::name(what)), server_->counters().value(what),
                           std::string(http::Counters::help(what))});
        }
        return all;
    }

    http::Route report_route(Report report) {
        return {fmt::format("/api/v1/{}", name_of(report)), [this, report](const auto&, const auto& respond) {
                    respond({.content_type = json_type, .body = reporter_.text(report)});
                }};
    }

    void report() {
        reporter_.tick();
        for (const auto report : reports)
            if (report != Report::traffic && wants(report)) publish(report);
        const std::lock_guard lock(mutex_);
        if (viewers_.wants(Report::traffic)) reporter_.begin_turn();
        viewers_.publish_traffic(mono_now());
        viewers_.flush(mono_now());
    }
    bool wants(Report report) {
        const std::lock_guard lock(mutex_);
        return viewers_.wants(report);
    }
    void publish(Report report) {
        auto text = reporter_.text(report);
        const std::lock_guard lock(mutex_);
        viewers_.publish(report, std::move(text), {wall_now(), mono_now()});
    }

    // The latest reports, for a client that is about to subscribe to them.
    void prepare(const SetupResult<foxglove::Request>& request) {
        if (!request) return;
        for (const auto& wanted : request->subscribe) {
            const auto* const report = report_of(wanted.channel);
            if (report == nullptr || *report == Report::traffic) continue;
            auto text = reporter_.text(*report);
            const std::lock_guard lock(mutex_);
            viewers_.note(*report, std::move(text), wall_now());
        }
    }

    // The callbacks do not own the session, which owns them.
    http::SessionEvents open(const std::shared_ptr<http::Session>& opened) {
        const std::lock_guard lock(mutex_);
        viewers_.add(opened, mono_now());
        http::Session& session = *opened;
        return {
            .on_message =
                [this, &session](ByteView bytes, http::Kind) {
                    const auto request = foxglove::parse({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
                    prepare(request);
                    const std::lock_guard locked(mutex_);
                    viewers_.take(session, request, mono_now());
                    return true;
                },
            .on_sent =
                [this, &session](std::size_t) {
                    const std::lock_guard locked(mutex_);
                    viewers_.send_more(session, mono_now());
                },
            .on_closed =
                [this, &session](const http::Closed&) {
                    const std::lock_guard locked(mutex_);
                    viewers_.remove(session);
                }};
    }

    SetupResult<http::StreamRoute::Open> open_stream(const std::string& query) {
        auto terms = parse_stream_terms(dialect_, query);
        if (!terms) return tl::unexpected(std::move(terms.error()));
        return [this, terms = std::move(*terms)](const std::shared_ptr<http::Session>& opened) {
            const std::lock_guard lock(mutex_);
            streams_.add(opened, terms);
            return http::SessionEvents{.on_closed = [this, &session = *opened](const http::Closed&) {
                const std::lock_guard locked(mutex_);
                streams_.remove(session);
            }};
        };
    }

    const dialect::Dialect& dialect_;
    std::mutex mutex_;  // for all down to streams_, of reporter_ only what it states
    observe::Inspector inspector_;
    Channels channels_;
    Reporter reporter_;
    Viewers viewers_{channels_, reporter_.traffic_pages()};
    Streams streams_;
    std::vector<http::Respond> ask_routes_;  // clients that wait for routes
    std::optional<http::Thread> thread_;
    std::optional<http::Server> server_;  // its callbacks use all above
    std::optional<http::Timer> timer_;    // and so do its calls
};

Server::Server(std::unique_ptr<Impl> impl) noexcept : impl_(std::move(impl)) {}
Server::~Server() = default;

SetupResult<std::unique_ptr<Server>> Server::listen(const dialect::Dialect& dialect, const Options& options) {
    auto impl = std::make_unique<Impl>(dialect);
    if (auto done = impl->listen(options); !done) return tl::unexpected(std::move(done.error()));
    return std::unique_ptr<Server>(new Server(std::move(impl)));
}

void Server::take(const observe::Heard& heard) { impl_->take(heard); }
void Server::set_hops(std::vector<observe::Hop> hops) { impl_->set_hops(std::move(hops)); }
void Server::note_counts(observe::OwnCounts counts) { impl_->note_counts(std::move(counts)); }
void Server::note_end(LinkId link) { impl_->note_end(link); }
bool Server::wants_routes() const { return impl_->wants_routes(); }
void Server::set_routes(const std::vector<RoutesOf>& routers) { impl_->set_routes(routers); }
void Server::flush() { impl_->flush(); }
std::vector<observe::Alarm> Server::alarms() const { return impl_->alarms(); }
std::uint64_t Server::left_out() const { return impl_->left_out(); }
const std::vector<net::Address>& Server::addresses() const noexcept { return impl_->addresses(); }

}  // namespace mavloom::web
