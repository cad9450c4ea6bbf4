// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>

#include "command.hpp"
#include "explain.hpp"
#include "fault_log.hpp"
#include "mavloom/control/service_manager.hpp"
#include "mavloom/fault/faults.hpp"
#include "mavloom/router/router.hpp"
#include "open_control.hpp"
#include "page/web_beside.hpp"
#include "plan.hpp"
#include "signals.hpp"

namespace mavloom::app {

namespace {

using namespace std::chrono_literals;

constexpr auto send_limit = 2s;  // to send what is still queued

// Adds either the recordings or all other endpoints. Recordings are added last: creating one renames an existing file,
// which must not happen if the router cannot start because a port is in use.
SetupResult<void> add_endpoints(router::Router& router, const Plan& plan, bool recordings) {
    for (const auto& endpoint : plan.endpoints())
        if (endpoint.is_recording() == recordings)
            if (auto added = router.add(endpoint); !added) return added;
    return {};
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
        auto config = reread_config(options_, dialect_, plan_);
        if (!config) return write_stderr_line(fmt::format("mavloom: {}; nothing was changed", config.error().text));
        const bool same_rules = config->router == plan_.config.router;
        if (config->ring != plan_.config.ring)
            write_stderr_line("mavloom: a changed [ring] takes effect when the router restarts");
        if (config->service != plan_.config.service)
            write_stderr_line("mavloom: changed name and metrics take effect when the router restarts");
        if (config->web != plan_.config.web)
            write_stderr_line("mavloom: a changed [web] takes effect when the router restarts");
        config->ring = plan_.config.ring;
        config->service = plan_.config.service;
        config->web = plan_.config.web;
        plan_.config = std::move(*config);
        log_level_ = plan_.config.log_level;
        if (!same_rules) router_.configure(plan_.config.router);
        router_.apply(plan_.endpoints());
        print_event(common_, fmt::format("{} was read again", options_.config));
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

SetupResult<std::unique_ptr<control::Control>> open_router_control(const Common& common, const config::Config& config,
                                                                   router::Router& router) {
    control::ControlOptions control;
    control.on_notice = [&router](std::string_view text) { router.notify(config::LogLevel::warning, text); };
    control.metrics = config.service.metrics;
    return open_control(common, router, std::move(control), config.service.name,
                        config.ring.name.empty() ? "router" : config.ring.name);
}

// Opens the counter page of a router without a ring. Returns the page's name; empty if there is none: another router of
// the usual name keeps its page.
std::string open_page(const Common& common, const config::Config& config, router::Router& router) {
    if (!config.ring.name.empty()) return config.ring.name;
    auto name = config.service.name.empty() ? std::string("router") : config.service.name;
    const auto opened = router.open_page(name);
    if (opened) return name;
    if (opened.error().code != SetupCode::in_use) print_notice(common, opened.error().text);
    return {};
}

Exit route(const Common& common, const RouteOptions& options) {
    if (auto opened = fault::log_to(options.fault_log); !opened) return fail(opened.error());
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
        if (level >= log_level || common.verbose > 0) print_event(common, text);
    };
    auto router = router::Router::create(*dialect, plan->config.router, notice);
    if (!router) return fail(router.error());
    if (plan->config.service.has_metrics_detail) (*router)->set_metrics_detail(router::MetricsDetail::components);
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
    const auto control = open_router_control(common, plan->config, **router);
    if (!control) return fail(control.error());
    const auto page = open_page(common, plan->config, **router);
    const auto web = WebBeside::open(common, *dialect, plan->config.web,
                                     {page, plan->config.ring.name, plan->config.service.name});
    if (!web) return fail(web.error());
    if (auto added = add_endpoints(**router, *plan, true); !added) return fail(added.error());
    return Routing(common, options, *dialect, **router, std::move(*plan), log_level).run(explain);
}

// The options of the configuration keys. They take precedence over the file's.
void declare_keys(Arguments command, RouteOptions& options) {
    for (std::size_t i = 0; i < options.keys.size(); ++i) {
        const config::KeyOption& option = config::config_keys()[i].option;
        if (option.name == nullptr) continue;
        if (option.placeholder == nullptr) command.add_flag(option.name, options.flags[i], option.description);
        else command.add_option(option.name, option.placeholder, options.keys[i], option.description);
    }
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
    declare_keys(command, *options);
    command.add_option("--for", "TIME", options->duration, "end after this time: 10s, 2m");
    declare_fault_log(command, options->fault_log);
    command.footer(
        "Forwards every frame byte for byte: broadcasts to all other links, targeted frames to the links where their\n"
        "target was heard. Each peer of udpin:// and each client of tcpin:// is its own link. tlog://PATH records\n"
        "every frame that arrives.\n\nExamples:\n"
        "  mavloom route --config examples/px4-qgc.toml\n"
        "  mavloom route udpin://0.0.0.0:14540 udpout://192.168.1.20:14550\n"
        "  mavloom route serial:///dev/ttyACM0?baud=921600 tcpin://0.0.0.0:5760 tlog://flight.tlog\n"
        "  mavloom route udpin://0.0.0.0:14540 udpout://192.168.1.20:14550 --ring px4\n"
        "  mavloom route --config router.toml --explain COMMAND_LONG");
    return [options, &common] { return route(common, *options); };
}

}  // namespace mavloom::app
