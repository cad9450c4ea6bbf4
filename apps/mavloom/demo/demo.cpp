// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "chain.hpp"
#include "command.hpp"
#include "latency.hpp"
#include "mavloom/base/counted.hpp"
#include "mavloom/base/durations.hpp"
#include "mavloom/base/thread.hpp"
#include "mavloom/endpoint/grammar.hpp"
#include "mavloom/net/port_holder.hpp"
#include "mavloom/router/report.hpp"
#include "mavloom/web/server.hpp"
#include "output.hpp"
#include "page/hop_reporter.hpp"
#include "page/ring_serving.hpp"
#include "page/serving.hpp"
#include "places.hpp"
#include "signals.hpp"
#include "summary.hpp"
#include "tallies.hpp"

namespace mavloom::app {

namespace {

using namespace std::chrono_literals;

using namespace demo_parts;

constexpr Nanoseconds look_interval = 500ms, break_after = 5s;
// A ground station sends a heartbeat a second.
constexpr Nanoseconds station_silence = 5s;
// The counters of pages are this old at most.
constexpr Nanoseconds page_age = 600ms;
constexpr Nanoseconds longest_start = 10s, longest_drain = 5s, longest_stillness = 1500ms;
constexpr std::size_t buffer_bytes = 8u << 20;

struct DemoOptions {
    std::string source, listen, ports = "usual", broken, duration, python;
    bool json = false;
};

// Hears the same frames at two places: in the router's ring, for the page, and at the end of the chain.
class Watchers {
public:
    Watchers(const Common& common, const dialect::Dialect& dialect) : common_(common), dialect_(dialect) {}
    ~Watchers() {
        ring_.reset();
        if (end_) end_->stop();
        if (end_thread_.joinable()) end_thread_.join();
    }
    Watchers(const Watchers&) = delete;
    Watchers& operator=(const Watchers&) = delete;

    // Opens the socket at the end of the chain. Returns its port. If `relay` is the port that the relay sends from,
    // frames of other programs are not part of the chain.
    [[nodiscard]] SetupResult<std::uint16_t> open_end(std::uint16_t port, std::optional<std::uint16_t> relay) {
        if (relay) relay_ = fmt::format("#127.0.0.1:{}", *relay);
        auto receiver = open(fmt::format("udpin://127.0.0.1:{}", port));
        if (!receiver) return tl::unexpected(std::move(receiver.error()));
        end_ = std::move(*receiver);
        end_->start();
        end_thread_ = thread_without_signals([this] { count_arrivals(); });
        return end_->endpoints().front().local_port;
    }
    [[nodiscard]] SetupResult<void> open_ring(const std::string& ring, web::Server& server) {
        const auto note = [this](const wire::FrameView& frame, WallTime time) { latency_.note_first(frame, time); };
        auto opened = RingServing::open(common_, dialect_, ring, server, common_.verbose > 0, note);
        if (!opened) return tl::unexpected(std::move(opened.error()));
        ring_ = std::move(*opened);
        return {};
    }

    void note_counts() { ring_->note_counts(); }
    [[nodiscard]] std::uint64_t arrived() const noexcept { return arrived_; }
    // Frames of other programs at the end of the chain, and the address of the newest one's sender.
    [[nodiscard]] std::uint64_t foreign() const noexcept { return foreign_; }
    [[nodiscard]] std::string foreigner() {
        const auto name = end_->name_of(LinkId{foreigner_});
        return std::string(name.substr(name.rfind('#') + 1));
    }
    [[nodiscard]] const Latency& latency() const noexcept { return latency_; }

private:
    SetupResult<std::unique_ptr<feed::Receiver>> open(const std::string& url) {
        const auto notice = [this](std::string_view text) {
            if (common_.verbose > 0) print_event(common_, text);
        };
        auto receiver = feed::Receiver::create(dialect_, buffer_bytes, notice);
        if (!receiver) return receiver;
        if (auto added = (*receiver)->add(*endpoint::parse_endpoint(url)); !added)
            return tl::unexpected(std::move(added.error()));
        return receiver;
    }
    void count_arrivals() {
        while (end_->wait())
            while (const auto entry = end_->next()) {
                if (end_->link_name(entry->link).ends_with(relay_)) {
                    latency_.note_second(entry->frame, entry->time);
                    ++arrived_;
                } else {
                    foreigner_ = entry->link.value;
                    ++foreign_;
                }
            }
    }

    const Common& common_;
    const dialect::Dialect& dialect_;
    Latency latency_;
    std::string relay_;  // how the name of the relay's link ends; empty: all frames are the relay's
    std::atomic<std::uint64_t> arrived_{0}, foreign_{0};
    std::atomic<decltype(LinkId::value)> foreigner_{};
    std::unique_ptr<feed::Receiver> end_;
    std::thread end_thread_;
    std::unique_ptr<RingServing> ring_;
};

class Demo {
public:
    Demo(const Common& common, const DemoOptions& options, const Places& places, Chain& chain, Watchers& watchers,
         web::Server& server, bool plays_station)
        : common_(common),
          options_(options),
          chain_(chain),
          watchers_(watchers),
          server_(server),
          plays_station_(plays_station),
          router_(places.router_name()),
          station_port_(places.station),
          tallies_(chain, places, options.source.empty()),
          summary_(::isatty(STDOUT_FILENO) == 1) {}

    Exit run() {
        const auto started = mono_now();
        const auto lasts = options_.duration.empty() ? std::optional<Nanoseconds>()
                                                     : *endpoint::parse_duration(options_.duration);
        const bool is_real = !options_.source.empty();
        await_first_frame(started + (is_real && lasts ? std::min(longest_start, *lasts) : longest_start));
        // A real vehicle may never come.
        const auto began = is_real && watchers_.arrived() == 0 ? started : mono_now();
        const auto end = lasts ? began + *lasts : MonoTime::max();
        auto break_due = options_.broken.empty() ? MonoTime::max() : began + break_after;
        while (!Signals::received() && mono_now() < end) {
            turn(std::min({end, break_due, mono_now() + look_interval}));
            if (mono_now() < break_due) continue;
            break_due = MonoTime::max();
            break_hop();
        }
        drain();
        return report();
    }

private:
    // The times of --for and --break begin when the chain is complete.
    void await_first_frame(MonoTime limit) {
        while (!Signals::received() && watchers_.arrived() == 0 && mono_now() < limit)
            turn(std::min(limit, mono_now() + look_interval));
    }

    // Looks at everything at `due`.
    void turn(MonoTime due) {
        while (!Signals::received() && mono_now() < due)
            for (const auto& ended : chain_.look(std::min(due, mono_now() + 100ms))) announce(ended);
        look();
        if (!options_.json && !common_.quiet) summary_.show(state());
    }

    void look() {
        watchers_.note_counts();
        const auto answers = tallies_.answers();
        tallies_.look(watchers_.arrived());
        if (tallies_.answers() != answers) last_answer_ = mono_now();
        const bool is_there = plays_station_ || (last_answer_ && mono_now() - *last_answer_ < station_silence);
        // Behind a hop that is down, nothing can be known of it.
        if (is_there || tallies_.are_up()) tallies_.set_station(is_there);
        set_hints(is_there);
        server_.set_hops(hops_of(tallies_));
        if (server_.wants_routes()) server_.set_routes({routes_of("router", router_)});
    }

    void set_hints(bool has_station) {
        tallies_.set_hint(0, tallies_.all().front().waits ? chain_.why_not_heard() : "");
        std::string hint;
        if (!has_station)
            hint = last_answer_ ? "silent for more than 5 s" : "none yet: start one, it connects by itself";
        if (const auto foreign = watchers_.foreign(); foreign != 0) {
            if (foreigner_.empty()) find_foreigner();
            hint = fmt::format("not counted: {} that {} sent to port {}", counted(foreign, "frame"), foreigner_,
                               station_port_);
        }
        tallies_.set_hint(hop_count - 1, std::move(hint));
    }

    void find_foreigner() {
        const auto text = watchers_.foreigner();
        const auto address = net::Address::parse(text.substr(0, text.rfind(':')), 0);
        std::uint16_t port = 0;
        (void)std::from_chars(text.data() + text.rfind(':') + 1, text.data() + text.size(), port);
        const auto holder = address ? net::port_holder(net::Transport::udp, address->with_port(port)) : std::string();
        foreigner_ = holder.empty() ? text : holder;
        announce(fmt::format("{} also sends to port {}: its frames are not the vehicle's, and are not counted",
                             foreigner_, station_port_));
    }

    [[nodiscard]] State state() const {
        return {tallies_, watchers_.latency().figures(), server_.alarms(), mono_now()};
    }

    void announce(std::string_view text) {
        print_event(common_, text);
        summary_.release();
    }

    void break_hop() {
        const auto at = std::ranges::find(stage_names, options_.broken);
        announce(fmt::format("--break: the {} is stopped", options_.broken));
        chain_.stop(static_cast<Stage>(at - stage_names.begin()));
    }

    // A second signal ends the wait: then frames that are still on their way are not called lost.
    void drain() {
        is_settled_ = tallies_.all().front().waits || await_last_frames();
        if (is_settled_) tallies_.settle();
        server_.set_hops(hops_of(tallies_));
    }

    // Ends the vehicle's stream, and waits until its frames have passed all hops: until all counts are equal, or do not
    // change any more. False after a second signal.
    bool await_last_frames() {
        chain_.stop_vehicle();
        const auto limit = mono_now() + longest_drain;
        auto changed = mono_now(), due = changed + page_age;
        for (auto arrived = watchers_.arrived(); mono_now() < limit; due = mono_now() + 100ms) {
            if (Signals::repeated()) return false;
            (void)chain_.look(due);
            watchers_.note_counts();
            tallies_.read(watchers_.arrived());
            server_.set_hops(hops_of(tallies_));
            if (std::exchange(arrived, watchers_.arrived()) != arrived) changed = mono_now();
            if (tallies_.are_equal() || mono_now() - changed > longest_stillness) break;
        }
        return true;
    }

    Exit report() {
        const bool is_whole = tallies_.are_whole();
        const auto status = Signals::status(is_whole ? Exit::done : Exit::mismatch);
        if (options_.json) return print_at_end(json(is_whole).dump() + "\n", status);
        if (!common_.quiet) summary_.finish(state());
        return status;
    }

    [[nodiscard]] nlohmann::ordered_json json(bool is_whole) const {
        const auto latency = watchers_.latency().figures();
        nlohmann::ordered_json object{
            {"ok", nullptr}, {"hops", json_of(tallies_)}, {"answers", tallies_.answers()}, {"latency_ms", nullptr}};
        if (is_settled_) object["ok"] = is_whole;
        if (latency)
            object["latency_ms"] = {{"median", milliseconds(latency->median)},
                                    {"p99", milliseconds(latency->p99)},
                                    {"longest", milliseconds(latency->most)}};
        return object;
    }

    const Common& common_;
    const DemoOptions& options_;
    Chain& chain_;
    Watchers& watchers_;
    web::Server& server_;
    bool plays_station_;
    std::string router_;
    std::uint16_t station_port_;
    Tallies tallies_;
    Summary summary_;
    bool is_settled_ = false;  // no second signal ended the wait for the last frames
    std::optional<MonoTime> last_answer_;
    std::string foreigner_;  // another program that sends to the ground station's port
};

SetupResult<void> check_words(const DemoOptions& options) {
    if (!options.duration.empty())
        if (auto time = endpoint::parse_duration(options.duration); !time)
            return tl::unexpected(std::move(time.error()).within("--for"));
    if (!options.source.empty())
        if (auto source = router::parse_router_endpoint(options.source); !source)
            return tl::unexpected(std::move(source.error()).within("--source"));
    if (options.broken == stage_names.front() && !options.source.empty())
        return setup_error(SetupCode::usage, "--break vehicle: the vehicle of --source is not the demo's");
    return {};
}

SetupResult<Places> choose_places(const DemoOptions& options) {
    if (options.ports == "free") return free_places();
    auto places = usual_places();
    if (!places) return places;
    for (const auto port : {places->vehicle, places->router, places->listener}) {
        if (port == places->vehicle && !options.source.empty()) continue;
        if (auto free = check_free(port); !free) {
            free.error().text += "; end that program, or choose other ports with --ports free";
            return tl::unexpected(std::move(free.error()));
        }
    }
    return places;
}

SetupResult<std::unique_ptr<web::Server>> open_page(const DemoOptions& options, const dialect::Dialect& dialect) {
    const auto usual = options.ports == "free" ? "127.0.0.1:0" : "127.0.0.1:8088";
    const auto place = endpoint::parse_server_address(options.listen.empty() ? usual : options.listen);
    if (!place) return tl::unexpected(SetupError(place.error()).within("--listen"));
    return open_server(dialect, *place, "--listen");
}

void say_where(const Common& common, const DemoOptions& options, const Places& places, const web::Server& server) {
    print_notice(common, fmt::format("open http://{}", place_of(server.addresses().front())));
    print_notice(common, fmt::format("a ground station that listens on UDP port {} connects by itself", places.station));
    if (options.source.empty())
        print_notice(common, fmt::format("to take off: mavloom ctl {} takeoff 10", places.simulator_name()));
}

Exit demo(const Common& common, const DemoOptions& options) {
    const auto dialect = load_dialect(common);
    if (!dialect) return fail(dialect.error());
    if (auto good = check_words(options); !good) return fail(good.error());
    const auto places = choose_places(options);
    if (!places) return fail(places.error());
    const auto server = open_page(options, *dialect);
    if (!server) return fail(server.error());
    // A demo of a given duration is its own ground station, if there is none.
    const bool plays_station = !options.duration.empty() && check_free(places->station).has_value();
    Watchers watchers(common, *dialect);
    const auto end_port = plays_station ? watchers.open_end(places->station, places->relay)
                                        : watchers.open_end(0, std::nullopt);
    if (!end_port) return fail(end_port.error());
    Chain chain({.places = *places,
                 .source = options.source,
                 .python = options.python,
                 .copy = plays_station ? std::optional<std::uint16_t>() : *end_port});
    const Signals signals([](void*) noexcept {}, nullptr, Signals::OnHangup::stop, Signals::OnRepeat::hurry);
    if (auto opened = watchers.open_ring(places->router_name(), **server); !opened) return fail(opened.error());
    if (auto started = chain.start([] { return Signals::received(); }); !started) return fail(started.error());
    say_where(common, options, *places, **server);
    return Demo(common, options, *places, chain, watchers, **server, plays_station).run();
}

}  // namespace

Run declare_demo(Arguments command, const Common& common) {
    auto options = std::make_shared<DemoOptions>();
    command.add_option("--source", "ENDPOINT", options->source,
                       "where a real vehicle is, as for `mavloom route`; without it, one is simulated");
    command.add_option("--listen", "HOST:PORT", options->listen, "where the page is (default: 127.0.0.1:8088)");
    command
        .add_option("--ports", "WHICH", options->ports,
                    "usual: those of PX4 and ground stations; free: any free ones, for several demos at once")
        .members({"usual", "free"})
        .capture_default_str();
    command
        .add_option("--break", "HOP", options->broken,
                    "stop this program after 5 s: the page and the summary name it, and the frames that it lost")
        .members({stage_names.begin(), stage_names.end()});
    command.add_option("--for", "TIME", options->duration,
                       "end after this time, with status 4 if a frame is missing: 20s; the demo is then its own ground "
                       "station, if there is none");
    command.add_flag("--json", options->json, "print only the counts of each hop at the end, as a JSON object");
    command.add_option("--python", "PROGRAM", options->python,
                       "the Python that has the package mavloom (default: of the active environment, or of ./run)");
    command.footer(
        "Runs the whole system on this machine, each part a program of its own:\n"
        "  mavloom sim -> mavloom route -> python -m mavloom.hear -> ring -> mavloom relay -> ground station\n"
        "The page reads the router's ring (docs/guide/demo.md).\n\n"
        "Examples:\n"
        "  mavloom demo\n"
        "  mavloom demo --break relay\n"
        "  mavloom demo --ports free --for 20s --json");
    return [options, &common] { return demo(common, *options); };
}

}  // namespace mavloom::app
