// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <set>
#include <string_view>

#include "command.hpp"
#include "counted.hpp"
#include "mavloom/base/shown.hpp"
#include "mavloom/config/config.hpp"
#include "mavloom/control/control.hpp"
#include "mavloom/control/service_manager.hpp"
#include "mavloom/router/report.hpp"
#include "mavloom/router/router.hpp"
#include "output.hpp"
#include "signals.hpp"

namespace mavloom::app {

namespace {

using namespace std::chrono_literals;

constexpr auto send_limit = 2s;  // to send what is still queued
constexpr auto output_retry = 100ms;

struct RouteOptions {
    std::vector<std::string> endpoints;
    std::string config;
    std::string duration;
    std::string explain;  // a message's name or id; "*": all
    std::string ring;     // overrides the ring of the file
    std::string name;     // empty: the ring's name, else "router"
    std::string metrics;  // HOST:PORT
    bool has_metrics_detail = false;
};

// The endpoints to route between: first those of the configuration file, then those of the command line. A reload
// changes only those of the file.
struct Plan {
    config::Config config;
    std::vector<endpoint::Endpoint> from_command_line;

    [[nodiscard]] std::vector<endpoint::Endpoint> endpoints() const {
        auto all = config.endpoints;
        all.insert(all.end(), from_command_line.begin(), from_command_line.end());
        if (!config.record.path.empty()) all.push_back(recording());
        return all;
    }

private:
    [[nodiscard]] endpoint::Endpoint recording() const {
        endpoint::Endpoint endpoint;
        endpoint.scheme = endpoint::Scheme::tlog;
        endpoint.path = config.record.path;
        endpoint.options.rotate_bytes = config.record.rotate_bytes;
        endpoint.options.rotate_every = config.record.rotate_every;
        return endpoint;
    }
};

// Reads the configuration file and applies the overrides of the command line.
SetupResult<config::Config> read_config(const RouteOptions& options, const dialect::Dialect& dialect) {
    const auto environment = config::environment_of(environ);
    auto config = options.config.empty() ? config::parse_config("", "", environment)
                                         : config::load_config(options.config, environment);
    if (!config) return config;
    if (!options.ring.empty()) config->ring.name = options.ring;
    if (auto checked = config::check_for_router(*config, options.config, dialect); !checked)
        return tl::unexpected(std::move(checked.error()));
    return config;
}

SetupResult<void> check_recordings(std::span<const endpoint::Endpoint> endpoints) {
    std::set<std::filesystem::path> recordings;
    for (const auto& e : endpoints)
        if (e.scheme == endpoint::Scheme::tlog && !recordings.insert(endpoint::canonical_path(e.path)).second)
            return setup_error(SetupCode::usage,
                               fmt::format("another recording already writes to {}", in_quotes(e.path)));
    return {};
}

SetupResult<Plan> make_plan(const RouteOptions& options, const dialect::Dialect& dialect) {
    Plan plan;
    if (endpoint::parse_endpoint(options.explain))
        return setup_error(
            SetupCode::usage,
            fmt::format("--explain takes a message's name, not '{}'; put it after the endpoints", options.explain));
    for (const auto& text : options.endpoints) {
        auto endpoint = router::parse_router_endpoint(text);
        if (!endpoint) return tl::unexpected(std::move(endpoint.error()));
        plan.from_command_line.push_back(std::move(*endpoint));
    }
    auto config = read_config(options, dialect);
    if (!config) return tl::unexpected(of_input_file(std::move(config.error())));
    plan.config = std::move(*config);
    const auto endpoints = plan.endpoints();
    if (endpoints.empty())
        return setup_error(SetupCode::usage, "nothing to route between: give endpoints, or a --config with some");
    if (auto good = check_recordings(endpoints); !good) return tl::unexpected(std::move(good.error()));
    return plan;
}

// Adds either the recordings or all other endpoints. Recordings are added last: creating one renames an existing file,
// which must not happen if the router cannot start because a port is in use.
SetupResult<void> add_endpoints(router::Router& router, const Plan& plan, bool recordings) {
    for (const auto& endpoint : plan.endpoints())
        if ((endpoint.scheme == endpoint::Scheme::tlog) == recordings)
            if (auto added = router.add(endpoint); !added) return added;
    return {};
}

// Prints "ATTITUDE 1/1 seq 7 from udpin://…#127.0.0.1:1234: forwarded" for a frame, then a line for each link. Routing
// never waits for the output: if the reader stalls, explanations that do not fit are left out and counted.
class ExplainPrinter {
public:
    ExplainPrinter(const Common& common, const dialect::Dialect& dialect, link::Links& links,
                   std::optional<MessageId> only)
        : common_(common), dialect_(dialect), links_(links), only_(only) {}

    void operator()(const link::RxFrame& rx, const route::Decision& decision, std::span<const route::Explanation> why) {
        if (only_ && rx.frame.id() != *only_) return;
        if (output_.full()) (void)output_.flush_what_fits();
        if (output_.full()) return leave_out(1 + why.size());
        auto out = fmt::appender(output_.buffer());
        const auto* message = dialect_.find(rx.frame.id());
        const auto source = rx.frame.source();
        fmt::format_to(out, "{} {}/{} seq {} from {}: {}\n",
                       message != nullptr ? std::string(message->name) : fmt::format("id {}", rx.frame.id().value),
                       source.system.value, source.component.value, rx.frame.sequence(), links_.link_name(rx.link),
                       route::verdict_name(decision.verdict));
        for (const auto& [link, reason] : why)
            fmt::format_to(out, "  {} {}: {}\n",
                           reason == route::Reason::sent || reason == route::Reason::tap ? "->" : " x",
                           links_.link_name(link), route::reason_text(reason));
    }
    Output::State flush() { return output_.flush_what_fits(); }
    // When to call `flush` again if no frame arrives.
    [[nodiscard]] MonoTime due() { return output_.buffer().size() == 0 ? MonoTime::max() : mono_now() + output_retry; }
    // Writes the rest, as long as the reader keeps accepting data.
    void finish() {
        output_.end_at(mono_now());
        while (flush() == Output::State::open && output_.buffer().size() != 0 && output_.wait_for_room()) {}
        left_out_ += static_cast<std::uint64_t>(std::ranges::count(output_.buffer(), '\n'));
        report_left_out();
    }
    void report_left_out() const {
        if (left_out_ != 0) print_notice(common_, fmt::format("--explain left out {}", counted(left_out_, "line")));
    }
    [[nodiscard]] const Output& output() const noexcept { return output_; }

private:
    void leave_out(std::size_t lines) {
        if (left_out_ == 0 && output_.state() == Output::State::open)
            print_notice(
                common_,
                "the output of --explain is read too slowly; explanations are left out, and routing continues");
        left_out_ += lines;
    }

    const Common& common_;
    const dialect::Dialect& dialect_;
    link::Links& links_;
    std::optional<MessageId> only_;
    Output output_;
    std::uint64_t left_out_ = 0;  // lines
};

SetupResult<std::optional<MessageId>> explained_id(const dialect::Dialect& dialect, const std::string& text) {
    if (text == "*") return std::nullopt;
    const auto id = dialect::find_message_id(dialect, text);
    if (!id) return tl::unexpected(SetupError(id.error()).within("--explain"));
    return *id;
}

class Routing {
public:
    Routing(const Common& common, const RouteOptions& options, const dialect::Dialect& dialect, router::Router& router,
            Plan plan, config::LogLevel& log_level)
        : common_(common),
          options_(options),
          dialect_(dialect),
          router_(router),
          plan_(std::move(plan)),
          log_level_(log_level) {}

    Exit run(std::optional<ExplainPrinter>& explain) {
        if (explain) router_.explain([&](const auto&... args) { (*explain)(args...); });
        const auto end = options_.duration.empty() ? MonoTime::max()
                                                   : mono_now() + *endpoint::parse_duration(options_.duration);
        manager_.ready();
        while (!Signals::received() && mono_now() < end) {
            router_.turn(std::min({end, manager_.watchdog_due(), explain ? explain->due() : MonoTime::max()}));
            manager_.feed(mono_now());
            if (explain && explain->flush() != Output::State::open) stop_explaining(explain);
            if (Signals::take_hangup()) {
                manager_.reloading();
                reload();
                manager_.ready();
            }
        }
        manager_.stopping();
        router_.finish(send_limit);
        if (explain) explain->finish();
        return Signals::status(explain_failed_ ? Exit::failed : Exit::done);
    }

private:
    // Ends --explain when its output is closed or fails. Routing continues.
    void stop_explaining(std::optional<ExplainPrinter>& explain) {
        router_.explain({});
        explain_failed_ = explain->output().state() == Output::State::failed;
        if (explain_failed_) (void)fail(explain->output().error());
        print_notice(common_, explain_failed_
                                  ? "--explain ended; routing continues"
                                  : "the reader closed the output of --explain, which ended; routing continues");
        explain->report_left_out();
        explain.reset();
    }

    void reload() {
        if (options_.config.empty()) return print_notice(common_, "SIGHUP: there is no --config to reread");
        std::error_code unknown;
        const auto type = std::filesystem::status(options_.config, unknown).type();
        if (type == std::filesystem::file_type::fifo || type == std::filesystem::file_type::character)
            return write_stderr_line(
                fmt::format("mavloom: {} is a pipe or a terminal, which can be read only once; nothing was changed",
                            options_.config));
        auto config = read_config(options_, dialect_);
        if (!config) return write_stderr_line(fmt::format("mavloom: {}; nothing was changed", config.error().text));
        const bool would_be_idle = Plan{*config, plan_.from_command_line}.endpoints().empty();
        // An editor may have truncated the file before rewriting it.
        if (would_be_idle || (config->endpoints.empty() && !plan_.config.endpoints.empty()))
            return write_stderr_line(fmt::format("mavloom: {} has no endpoint; nothing was changed", options_.config));
        if (auto agreed = router::Router::group_modes_of(Plan{*config, plan_.from_command_line}.endpoints()); !agreed)
            return write_stderr_line(fmt::format("mavloom: {}; nothing was changed", agreed.error().text));
        const bool same_rules = config->router == plan_.config.router;
        if (config->ring != plan_.config.ring)
            write_stderr_line("mavloom: a changed [ring] takes effect when the router restarts");
        config->ring = plan_.config.ring;
        plan_.config = std::move(*config);
        log_level_ = plan_.config.log_level;
        if (!same_rules) router_.configure(plan_.config.router);
        router_.apply(plan_.endpoints());
        print_notice(common_, fmt::format("{} was read again", options_.config));
    }

    const Common& common_;
    const RouteOptions& options_;
    const dialect::Dialect& dialect_;
    router::Router& router_;
    Plan plan_;
    config::LogLevel& log_level_;  // of the router's notices
    bool explain_failed_ = false;
    control::ServiceManager manager_ = control::ServiceManager::from_environment();
};

// Another user may have taken the name or filled the memory. That must not end the routing.
bool may_be_others_doing(const SetupError& error) {
    return error.code == SetupCode::permission || error.code == SetupCode::bad_input ||
           error.code == SetupCode::no_space || error.code == SetupCode::system;
}

// Opens the ring, and the inlet through which its readers send. Without a folder for sockets there is no inlet.
SetupResult<void> open_ring(const Common& common, const config::RingConfig& ring, router::Router& router) {
    if (ring.name.empty()) return {};
    if (auto opened = router.open_ring(ring); !opened) {
        if (!may_be_others_doing(opened.error())) return opened;
        print_notice(common, fmt::format("{}; the router runs without a ring", opened.error().text));
        return {};
    }
    const auto path = link::Links::inlet_path(ring.name);
    auto opened = path ? router.open_inlet(ring, *path) : SetupResult<void>(tl::unexpected(path.error()));
    if (opened || !may_be_others_doing(opened.error())) return opened;
    print_notice(common, fmt::format("{}; programs cannot send through ring {}", opened.error().text, ring.name));
    return {};
}

// Opens the control socket and the metrics port. Without --name, the router starts even if another router already has
// the default name; `ctl` then reaches that other router.
SetupResult<std::unique_ptr<control::Control>> open_control(const Common& common, const RouteOptions& options,
                                                            const std::string& ring, router::Router& router) {
    control::ControlOptions control;
    control.on_notice = [&router](std::string_view text) { router.notify(config::LogLevel::warning, text); };
    if (!options.metrics.empty()) {
        const auto address = endpoint::parse_endpoint("tcpin://" + options.metrics);
        if (!address)
            return setup_error(
                SetupCode::usage,
                fmt::format("--metrics takes HOST:PORT, as in 127.0.0.1:9090, not '{}'", options.metrics));
        control.metrics = address->address;
    }
    const std::string_view usual_name = ring.empty() ? "router" : std::string_view(ring);
    auto path = control::control_path(options.name.empty() ? usual_name : options.name);
    if (path) control.socket = *path;
    else if (!options.name.empty()) return tl::unexpected(std::move(path.error()));
    else print_notice(common, path.error().text);
    auto opened = control::Control::create(router, control);
    if (opened || !options.name.empty() || opened.error().code != SetupCode::in_use) return opened;
    control.socket.clear();
    auto without = control::Control::create(router, control);  // fails again if the port of --metrics was in use
    if (without) print_notice(common, fmt::format("no control socket: {}", opened.error().text));
    return without;
}

Exit route(const Common& common, const RouteOptions& options) {
    const auto dialect = load_dialect(common);
    if (!dialect) return fail(dialect.error());
    if (!options.duration.empty())
        if (auto time = endpoint::parse_duration(options.duration); !time)
            return fail(std::move(time.error()).within("--for"));
    auto plan = make_plan(options, *dialect);
    if (!plan) return fail(plan.error());
    for (const auto& note : plan->config.notes) print_notice(common, note);
    auto log_level = plan->config.log_level;
    const auto notice = [&](config::LogLevel level, std::string_view text) {
        if (level >= log_level || common.verbose > 0) print_notice(common, text);
    };
    auto router = router::Router::create(*dialect, plan->config.router, notice);
    if (!router) return fail(router.error());
    if (options.has_metrics_detail) (*router)->set_metrics_detail(router::MetricsDetail::components);
    const Signals signals([](void* r) noexcept { static_cast<router::Router*>(r)->wake(); }, router->get(),
                          Signals::OnHangup::remember);
    std::optional<ExplainPrinter> explain;
    if (!options.explain.empty()) {
        const auto id = explained_id(*dialect, options.explain);
        if (!id) return fail(id.error());
        explain.emplace(common, *dialect, (*router)->links(), *id);
    }
    if (auto opened = open_ring(common, plan->config.ring, **router); !opened) return fail(opened.error());
    if (auto learned = (*router)->learn_group_modes(plan->endpoints()); !learned) return fail(learned.error());
    if (auto added = add_endpoints(**router, *plan, false); !added) return fail(added.error());
    const auto control = open_control(common, options, plan->config.ring.name, **router);
    if (!control) return fail(control.error());
    if (auto added = add_endpoints(**router, *plan, true); !added) return fail(added.error());
    if (const auto port = (*control)->metrics_port(); port != 0 && options.metrics.ends_with(":0"))
        print_notice(common, fmt::format("metrics on port {}", port));
    return Routing(common, options, *dialect, **router, std::move(*plan), log_level).run(explain);
}

}  // namespace

Run declare_route(Arguments command, const Common& common) {
    auto options = std::make_shared<RouteOptions>();
    command.add_option("endpoint", "ENDPOINT", options->endpoints,
                       "an endpoint to route between; give any number of them");
    command.add_option("--config", "FILE", options->config,
                       "a configuration file (docs/guide/configuration.md); SIGHUP rereads it");
    command
        .add_option("--explain", "[MESSAGE]", options->explain,
                    "print where each frame went and why; with MESSAGE, only for frames of that message")
        .expected(0, 1)
        .default_str("*");
    command.add_option("--ring", "NAME", options->ring,
                       "write every good frame into the ring /dev/shm/mavloom.NAME for programs on this machine, and "
                       "forward the frames that they send");
    command.add_option("--name", "NAME", options->name,
                       "the router's name for `mavloom ctl` and `stat`: A-Z a-z 0-9 _ - (default: the name of the "
                       "ring, or router)");
    command.add_option("--metrics", "HOST:PORT", options->metrics,
                       "serve Prometheus metrics at http://HOST:PORT/metrics");
    command.add_flag("--metrics-detail", options->has_metrics_detail,
                     "let the metrics distinguish the components of each system, and list more messages");
    command.add_option("--for", "TIME", options->duration, "end after this time: 10s, 2m");
    command.footer(
        "Forwards every frame byte for byte: broadcasts to all other links, targeted frames to the links where their "
        "target was heard.\nEach peer of udpin:// and each client of tcpin:// is its own link. tlog://PATH records "
        "every frame that arrives.\n\nExamples:\n"
        "  mavloom route --config examples/px4-qgc.toml\n"
        "  mavloom route udpin://0.0.0.0:14540 udpout://192.168.1.20:14550\n"
        "  mavloom route serial:///dev/ttyACM0?baud=921600 tcpin://0.0.0.0:5760 tlog://flight.tlog\n"
        "  mavloom route udpin://0.0.0.0:14540 udpout://192.168.1.20:14550 --ring px4\n"
        "  mavloom route --config router.toml --explain COMMAND_LONG");
    return [options, &common] { return route(common, *options); };
}

}  // namespace mavloom::app
