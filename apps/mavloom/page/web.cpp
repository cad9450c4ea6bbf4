// SPDX-License-Identifier: MIT
#include "mavloom/web/server.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <utility>

#include "command.hpp"
#include "frames/receiving.hpp"
#include "mavloom/endpoint/grammar.hpp"
#include "mavloom/net/interfaces.hpp"
#include "mavloom/web/token.hpp"
#include "output.hpp"
#include "page/discovery.hpp"
#include "page/hop_reporter.hpp"
#include "page/qr.hpp"
#include "page/serving.hpp"
#include "signals.hpp"

namespace mavloom::app {

namespace {

struct WebOptions {
    ReceiveOptions receive;
    Selection selection;
    std::string listen = "127.0.0.1:8088";
    std::vector<std::string> hosts, origins;
    std::string token_file;
    bool has_qr = false;
};

SetupResult<std::unique_ptr<web::Server>> listen(const WebOptions& options, const dialect::Dialect& dialect,
                                                 const std::string& token) {
    const auto place = endpoint::parse_server_address(options.listen);
    if (!place) return tl::unexpected(SetupError(place.error()).within("--listen"));
    std::vector<std::string> origins;
    for (const auto& given : options.origins) {
        const auto parsed = endpoint::parse_origins(given);
        if (!parsed) return tl::unexpected(SetupError(parsed.error()).within("--origin"));
        origins.insert(origins.end(), parsed->begin(), parsed->end());
    }
    return open_server(
        dialect, *place, "--listen",
        {.hosts = options.hosts, .hosts_option = "--host", .origins = std::move(origins), .token = token});
}

// After the end of a recording, clients still see its latest messages.
void serve(const Common& common, const WebOptions& options, std::vector<HopReporter::Program> programs,
           feed::Receiver& receiver, web::Server& server) {
    const auto end = options.receive.end(mono_now());
    receiver.start(end, Serving::rest);
    ServerAudience audience(server);
    Serving serving(common, {.filter = options.selection.filter, .count = options.receive.count}, receiver, audience);
    const HopReporter hops(hops_to(server, [&serving] { serving.note_counts(); }), std::move(programs));
    serving.run();
    while (serving.is_going() && !Signals::received() && mono_now() < end)
        ::poll(nullptr, 0, 100);  // a signal ends the wait
    receiver.stop();
    receiver.join();
}

SetupResult<void> check_qr(const WebOptions& options, const net::Address& address) {
    if (!options.has_qr || !address.is_loopback()) return {};
    return setup_error(SetupCode::usage,
                       fmt::format("--qr is for other devices, which cannot reach {}; type --listen 0.0.0.0:{} too",
                                   address.host_text(), address.port()));
}

// The address of the page for other devices, and its QR code.
Exit print_qr(const net::Address& address, const std::string& token) {
    const auto own = address.is_any() ? net::address_on_network() : address;
    if (!own) return fail(Exit::failed, "--qr: this machine has no address on a network");
    const auto url = fmt::format("http://{}/{}{}", own->with_port(address.port()).text(),
                                 token.empty() ? "" : "?token=", token);
    const auto code = qr_code(url, usual_glyphs(), ::isatty(STDOUT_FILENO) == 1);
    return code ? print_at_end(fmt::format("{}{}\n", *code, url), Exit::done) : fail(code.error());
}

Exit web(const Common& common, WebOptions& options) {
    const auto dialect = load_dialect(common);
    if (!dialect) return fail(dialect.error());
    if (auto compiled = options.selection.compile(*dialect); !compiled) return fail(compiled.error());
    const auto running = find_sources(common, options.receive.sources, {usual_source});
    if (!running) return fail(running.error());
    auto receiver = options.receive.open(common, *dialect);
    if (!receiver) return fail(receiver.error());
    const auto token = web::read_token(options.token_file);
    if (!token) return fail(SetupError(token.error()).within("--token-file"));
    const auto server = listen(options, *dialect, *token);
    if (!server) return fail(server.error());
    const auto& address = (*server)->addresses().front();
    if (auto good = check_qr(options, address); !good) return fail(good.error());
    const Signals signals([](void* r) noexcept { static_cast<feed::Receiver*>(r)->stop(); }, receiver->get());
    log_ports(common, (*receiver)->endpoints());
    print_notice(common, fmt::format("open http://{0}, or ws://{0} in Foxglove, Lichtblick or PlotJuggler",
                                     place_of(address, !token->empty())));
    if (options.has_qr)
        if (const auto printed = print_qr(address, *token); printed != Exit::done) return printed;
    serve(common, options, programs_of(options.receive.sources, *running), **receiver, **server);
    if (const auto* error = (*receiver)->error()) return fail(*error);
    return Signals::status(Exit::done);
}

}  // namespace

Run declare_web(Arguments command, const Common& common) {
    auto options = std::make_shared<WebOptions>();
    options->receive.declare(command, ReceiveOptions::Source::optional);
    options->selection.declare(command);
    command
        .add_option(
            "--listen", "HOST:PORT", options->listen,
            "where viewers and browsers connect; 0.0.0.0:8088 lets other machines in, and anybody there may read")
        .capture_default_str();
    command
        .add_option("--origin", "URL", options->origins,
                    "a web page that may connect, as in https://app.foxglove.dev; may be repeated")
        .one_value_each();
    command.add_flag("--qr", options->has_qr,
                     "print the address as a QR code, for a phone on the same network; with --listen 0.0.0.0:8088");
    command.add_option("--token-file", "FILE", options->token_file,
                       "clients must send the token that this file holds: 16 letters or more, chmod 600");
    command
        .add_option("--host", "NAME", options->hosts,
                    "a further name of this machine, under which clients may connect; may be repeated")
        .one_value_each();
    command.footer(
        "Serves each message of each vehicle to viewers, live (docs/guide/web.md). Without SOURCE, it reads the rings\n"
        "of this machine, and shows the counters of routers without one. If there is no ring, it listens on\n"
        "udpin://0.0.0.0:14550. Clients only read: nobody can change anything.\n\n"
        "Examples:\n  mavloom web shm://telemetry\n  mavloom web udpin://0.0.0.0:14550 --listen 0.0.0.0:8088\n"
        "  curl http://127.0.0.1:8088/api/v1/systems");
    return [options, &common] { return web(common, *options); };
}

}  // namespace mavloom::app
