// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "command.hpp"
#include "frames/receiving.hpp"
#include "mavloom/base/thread.hpp"
#include "mavloom/view/draw.hpp"
#include "output.hpp"
#include "page/discovery.hpp"
#include "page/hop_reporter.hpp"
#include "page/serving.hpp"
#include "signals.hpp"
#include "top/model.hpp"
#include "top/playback.hpp"
#include "top/rate_question.hpp"
#include "top/routes.hpp"
#include "top/screen.hpp"

namespace mavloom::app {

namespace {

using namespace std::chrono_literals;

constexpr auto once_lasts = 2s;
constexpr int usual_width = 120;

struct TopOptions {
    ReceiveOptions receive;
    Selection selection;
    bool once = false;
};

// Where the frames come from, and what time it is there.
class Feed {
public:
    virtual ~Feed() = default;
    [[nodiscard]] virtual view::Now now() = 0;
    [[nodiscard]] virtual std::optional<view::Playing> playing() { return std::nullopt; }
    virtual void take(view::Effect) {}
    virtual void ask(const view::RateRequest&) {}
    [[nodiscard]] virtual view::RateRequest::Answer answer() { return {}; }
    // For --once. Returns false after a time if there is more to come.
    [[nodiscard]] virtual bool has_ended() = 0;
    [[nodiscard]] virtual const SetupError* error() { return nullptr; }
};

class LiveFeed : public Feed {
public:
    LiveFeed(const Common& common, const TopOptions& options, feed::Receiver& receiver, Model& model,
             std::vector<HopReporter::Program> programs)
        : receiver_(receiver),
          has_sources_(!options.receive.sources.empty()),
          question_(receiver),
          serving_(common,
                   {.filter = options.selection.filter,
                    .count = options.receive.count,
                    .on_arrival = [this](const wire::FrameView& frame) { question_.hear(frame); }},
                   receiver, model) {
        receiver_.start(options.receive.end(mono_now()), Serving::rest);
        hops_.emplace(
            HopReporter::To{.set_hops = [&model](auto all) { model.set_hops(std::move(all)); },
                            .note_counts = [this] { serving_.note_counts(); },
                            .wants_routes = [&model] { return model.wants_routes(); },
                            .set_routes = [&model](const auto& all) { model.set_routes(routes_to_show(all)); }},
            std::move(programs));
        thread_ = thread_without_signals([this] {
            serving_.run();
            has_ended_ = true;
        });
    }
    ~LiveFeed() override {
        receiver_.stop();
        thread_.join();
        receiver_.join();
    }
    [[nodiscard]] view::Now now() override { return {wall_now(), mono_now()}; }
    void ask(const view::RateRequest& request) override { question_.ask(request); }
    [[nodiscard]] view::RateRequest::Answer answer() override { return question_.answer(); }
    // Without a source, the counters of programs change until the user ends it.
    [[nodiscard]] bool has_ended() override { return has_ended_ && has_sources_; }
    [[nodiscard]] const SetupError* error() override { return has_ended_ ? receiver_.error() : nullptr; }

private:
    feed::Receiver& receiver_;
    const bool has_sources_;
    RateQuestion question_;
    Serving serving_;
    std::optional<HopReporter> hops_;
    std::atomic<bool> has_ended_{false};
    std::thread thread_;
};

class RecordedFeed : public Feed {
public:
    RecordedFeed(std::unique_ptr<Playback> playback, bool at_once) : playback_(std::move(playback)) {
        if (at_once) playback_->play_all();
        else playback_->start();
    }
    [[nodiscard]] view::Now now() override { return playback_->now(); }
    [[nodiscard]] std::optional<view::Playing> playing() override { return playback_->playing(); }
    void take(view::Effect effect) override { playback_->take(effect); }
    [[nodiscard]] bool has_ended() override { return true; }

private:
    std::unique_ptr<Playback> playback_;
};

Exit print_once(const TopOptions& options, Feed& feed, Model& model) {
    model.want_routes(true);
    const auto end = options.receive.duration.empty() ? mono_now() + once_lasts : options.receive.end(mono_now());
    while (!feed.has_ended() && !Signals::received() && mono_now() < end) {
        (void)model.snapshot(feed.now(), view::Rates::recent);  // lets the model notice what comes and goes
        ::poll(nullptr, 0, 100);                                // a signal ends the wait
    }
    const auto rates = feed.playing() ? view::Rates::average : view::Rates::recent;
    const auto shown = model.snapshot(feed.now(), rates);
    const auto printed = print_at_end(view::whole_text(shown, width_of_output(usual_width), Screen::glyphs()),
                                      Exit::done);
    if (const auto* const error = feed.error()) return fail(*error);
    return printed == Exit::done ? Signals::status(Exit::done) : printed;
}

// Draws at most ten times a second. A table of very many messages takes longer, and is drawn less often.
class Session {
public:
    Session(Screen& screen, Feed& feed, Model& model) : screen_(screen), feed_(feed), model_(model) {}

    void run(MonoTime end) {
        while (going_ && !Signals::received() && mono_now() < end) {
            const auto begin = mono_now();
            draw();
            const auto took = mono_now() - begin;
            take_keys(std::max<Nanoseconds>(period, 10 * took));
        }
    }

private:
    static constexpr auto period = 100ms, first_look = 5ms, answer_is_shown = 10'000ms;

    [[nodiscard]] const std::shared_ptr<const view::Snapshot>& shown() const {
        return state_.paused ? state_.paused : latest_;
    }

    void draw() {
        model_.want_routes(state_.tab == view::Tab::routes);
        model_.watch(state_.is_open ? state_.selected : std::nullopt);
        auto snapshot = model_.snapshot(feed_.now(), view::Rates::recent);
        snapshot.playing = feed_.playing();
        latest_ = std::make_shared<const view::Snapshot>(std::move(snapshot));
        if (mono_now() > asked_ + answer_is_shown) state_.asked.reset();
        if (state_.asked) state_.asked->answer = feed_.answer();
        show();
    }
    void show() { screen_.show(view::draw(*shown(), state_, screen_.size(), glyphs_)); }

    // A key is shown at once, and so is the first message.
    void take_keys(Nanoseconds time) {
        const auto end = mono_now() + time;
        const bool is_empty = latest_->rows.empty();
        for (auto now = mono_now(); going_ && now < end && !Signals::received(); now = mono_now()) {
            const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - now);
            if (!Screen::wait(is_empty ? std::min(left, first_look) : left)) going_ = false;
            bool was_pressed = false;
            while (const auto key = screen_.key()) {
                was_pressed = true;
                press(*key);
            }
            if (was_pressed && going_) return draw();
            if (is_empty && model_.has_rows()) return;
            if (screen_.size() != size_) show();
            size_ = screen_.size();
        }
    }
    void press(const view::Key& key) {
        const auto effect = view::press(state_, shown(), key, screen_.size());
        if (effect == view::Effect::quit) going_ = false;
        if (effect == view::Effect::ask_rate) {
            asked_ = mono_now();
            feed_.ask(*state_.asked);
        }
        feed_.take(effect);
    }

    Screen& screen_;
    Feed& feed_;
    Model& model_;
    const view::Glyphs glyphs_ = Screen::glyphs();
    view::State state_;
    view::Size size_{};
    std::shared_ptr<const view::Snapshot> latest_;
    MonoTime asked_{};
    bool going_ = true;
};

Exit show(const TopOptions& options, Feed& feed, Model& model) {
    if (options.once) return print_once(options, feed, model);
    (void)Screen::glyphs();  // ncurses reads the locale
    {
        const auto screen = Screen::open();
        if (screen == nullptr) return print_once(options, feed, model);
        Session(*screen, feed, model).run(options.receive.end(mono_now()));
    }
    if (const auto* const error = feed.error()) return fail(*error);
    return Signals::status(Exit::done);
}

// A recording of which the user gave no speed can be halted and searched.
const endpoint::Endpoint* recording_of(const std::vector<endpoint::Endpoint>& endpoints) {
    if (endpoints.size() != 1 || !endpoints.front().is_recording() || endpoints.front().options.speed) return nullptr;
    return std::filesystem::is_fifo(endpoints.front().path) ? nullptr : &endpoints.front();
}

std::string title_of(const std::vector<std::string>& sources) {
    std::string title;
    for (const auto& source : sources) title += (title.empty() ? "" : ", ") + source;
    return title;
}

// For a user who gave no source. A small screen has no room for the last ones.
std::vector<std::string> hints_for(const std::vector<std::string>& sources, const Running& running) {
    std::vector<std::string> hints;
    if (!running.port_taken.empty()) hints.push_back(running.port_taken);
    if (auto serial = serial_hint(); !serial.empty()) hints.push_back(std::move(serial));
    if (!sources.empty()) hints.push_back(fmt::format("reading {}", fmt::join(sources, ", ")));
    hints.emplace_back("what else to check: docs/guide/troubleshooting.md");
    return hints;
}

Exit show_recording(const TopOptions& options, const dialect::Dialect& dialect, const std::string& path, Model& model) {
    auto playback = Playback::open(path, dialect, options.selection.filter, model);
    if (!playback) return fail(of_input_file(std::move(playback.error())));
    const Signals signals([](void*) noexcept {}, nullptr);
    RecordedFeed feed(std::move(*playback), options.once);
    return show(options, feed, model);
}

Exit show_live(const Common& common, TopOptions& options, const dialect::Dialect& dialect,
               std::vector<HopReporter::Program> programs, Model& model) {
    auto logging = common;
    logging.quiet = common.quiet || !options.once;  // the screen is no place for log lines
    const auto notice = [&](std::string_view text) {
        model.add_notice(text);
        print_event(logging, text);
    };
    auto receiver = options.receive.open(common, dialect, notice);
    if (!receiver) return fail(receiver.error());
    const Signals signals([](void* r) noexcept { static_cast<feed::Receiver*>(r)->stop(); }, receiver->get());
    log_ports(common, (*receiver)->endpoints());
    LiveFeed feed(logging, options, **receiver, model, std::move(programs));
    return show(options, feed, model);
}

// Why the views are printed once; empty if they need not be.
std::string_view reason_for_once() {
    if (::isatty(STDIN_FILENO) != 1 || ::isatty(STDOUT_FILENO) != 1) return "this is no terminal";
    if (!Screen::is_possible()) return "this terminal (TERM) cannot place its cursor, or its description is missing";
    return {};
}

Exit top(const Common& common, TopOptions& options) {
    const auto dialect = load_dialect(common);
    if (!dialect) return fail(dialect.error());
    if (auto compiled = options.selection.compile(*dialect); !compiled) return fail(compiled.error());
    if (const auto reason = options.once ? "" : reason_for_once(); !reason.empty()) {
        print_notice(common, fmt::format("{}: printing once, as with --once", reason));
        options.once = true;
    }
    auto& sources = options.receive.sources;
    const bool are_given = !sources.empty();
    const auto running = find_sources(common, sources, {usual_source, second_source});
    if (!running) return fail(running.error());
    const auto endpoints = endpoint::parse_endpoints(sources);
    if (!endpoints) return fail(endpoints.error());
    Model model(*dialect, title_of(sources));
    if (!are_given) model.set_hints(hints_for(sources, *running));
    if (const auto* const recording = recording_of(*endpoints))
        return show_recording(options, *dialect, recording->path, model);
    return show_live(common, options, *dialect, programs_of(sources, *running), model);
}

}  // namespace

Run declare_top(Arguments command, const Common& common) {
    auto options = std::make_shared<TopOptions>();
    options->receive.declare(command, ReceiveOptions::Source::optional);
    options->selection.declare(command);
    command.add_flag("--once", options->once,
                     "print the views once as text: after 2 s, after --for, or all of a recording");
    command.footer(
        "Shows vehicles, messages, links and alarms in the terminal, live (docs/guide/top.md). Press ? for the keys.\n"
        "Without SOURCE, it reads the rings of this machine, and shows the counters of routers without one. If there\n"
        "is no ring, it listens on udpin://0.0.0.0:14550 and 14540. A recording is played; the arrows move in it.\n\n"
        "Examples:\n  mavloom top\n  mavloom top udpin://0.0.0.0:14550 --only ATTITUDE,HEARTBEAT\n"
        "  mavloom top flight.tlog\n  mavloom top shm://px4 --once --for 5s");
    return [options, &common] { return top(common, *options); };
}

}  // namespace mavloom::app
