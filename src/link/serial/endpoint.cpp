// SPDX-License-Identifier: MIT
// serial: opens the port and reopens it indefinitely after it was unplugged. With baud=auto it also finds the baud
// rate. The endpoint is one link, and its queued frames survive a lost port until they are too old.
#include <fmt/format.h>

#include <array>

#include "link/retry.hpp"
#include "link/serial/serial.hpp"

namespace mavloom::link::detail {

namespace {

// Changes in /dev come in bursts (names, permissions, links). Wait this long before reopening.
constexpr std::chrono::milliseconds settle{20};

// Rates that baud=auto tries, most common on telemetry radios and autopilots first.
constexpr std::array<std::uint32_t, 11> auto_bauds{57600,  115200,  921600,  460800,  230400, 38400,
                                                   500000, 1500000, 1000000, 2000000, 19200};
// How long to try a rate. Heartbeats come once a second.
constexpr std::chrono::seconds auto_window{2};
// A single good frame may be chance. A second one must follow within this time, or the search continues.
constexpr std::chrono::seconds auto_confirm{10};

class Serial final : public OpenEndpoint, public SerialOwner, public net::IoHandler, public net::TimerHandler {
public:
    explicit Serial(Opening& opening)
        : OpenEndpoint(opening),
          core_(opening.core),
          device_(opening.endpoint.path),
          searching_(opening.endpoint.options.baud == 0),
          peer_(core_, *this, opening.id, opening.endpoint.options),
          retry_(core_, *this, *this) {
        peer_.name = opening.endpoint.label();
        peer_.signature = signature.get();
        core_.add_link(peer_);
    }
    ~Serial() override {
        watch_folders(false);
        core_.remove_link(peer_, "closed");
    }

    [[nodiscard]] SetupResult<void> open();
    void fail(const SetupError& error) { retry_.fail(error); }

    std::size_t send(const wire::FrameView& frame) override { return peer_.up && core_.send(peer_, frame) ? 1 : 0; }
    [[nodiscard]] std::size_t queued_bytes() const override { return peer_.queued_bytes(); }
    void on_good_frame() override {
        if (automatic() && good_frames_ < 2) [[unlikely]]
            count_good_frame();
    }
    void on_gone(std::string_view why) override;
    void on_io(net::IoEvents events) override;
    void on_timer(MonoTime now) override;

private:
    [[nodiscard]] bool automatic() const noexcept { return info.endpoint.options.baud == 0; }
    [[nodiscard]] std::uint32_t baud() const noexcept {
        return automatic() ? auto_bauds[auto_index_] : info.endpoint.options.baud;
    }
    SetupResult<void> open_as(const std::string& name);
    void report_settings();
    void count_good_frame();
    void search_on();
    void watch_folders(bool on);

    Core& core_;
    net::SerialDevice device_;
    bool searching_;
    std::size_t auto_index_ = 0;
    std::uint32_t good_frames_ = 0;  // at this rate; stops at 2
    SerialPeer peer_;
    net::FolderWatch folders_;  // watched while there is no port
    net::WatchId folders_watch_;
    Retry retry_;  // without a port: reopen; searching: next rate
    MonoTime up_since_{};
    bool was_up_ = false;
};

// Watches the folders before trying to open, so that a device that appears in between is not missed.
SetupResult<void> Serial::open() {
    watch_folders(true);
    SetupError last{SetupCode::not_found, 0,
                    fmt::format("{} is new and has no link in /dev/serial/by-id yet", device_.path())};
    for (const std::string& name : device_.places()) {
        auto done = open_as(name);
        if (done) return done;
        last = std::move(done).error();
    }
    return tl::unexpected(std::move(last));
}

SetupResult<void> Serial::open_as(const std::string& name) {
    const auto& options = info.endpoint.options;
    auto port = net::SerialPort::open(name, {baud(), options.flow == "rtscts", options.low_latency});
    if (!port) return tl::unexpected(std::move(port).error());
    if (auto done = peer_.attach(std::move(*port)); !done) return done;
    device_.note_opened(name);
    watch_folders(false);
    retry_.cancel();
    up_since_ = core_.now();
    if (!was_up_ || name != device_.path()) report_settings();
    retry_.settle();
    if (std::exchange(was_up_, true)) counters.reconnects.add();
    if (automatic()) {
        searching_ = true;
        good_frames_ = 0;
        retry_.after(auto_window);
    } else {
        core_.events.mark_up(peer_);
    }
    return {};
}

void Serial::report_settings() {
    const auto& options = info.endpoint.options;
    const auto got = peer_.stream().baud();
    const auto apart = got > baud() ? got - baud() : baud() - got;
    // The deviation of the baud rate that a receiver of ten-bit characters tolerates.
    constexpr std::uint32_t tolerance_percent = 3;
    if (apart > std::uint64_t{baud()} * tolerance_percent / 100)
        core_.events.notice(
            info.id, fmt::format("{}: requested {} baud, but the driver set {}", info.endpoint.label(), baud(), got));
    if (options.low_latency && !peer_.stream().low_latency())
        core_.events.notice(info.id, fmt::format("{}: its driver does not support low_latency", info.endpoint.label()));
    if (was_up_ && peer_.stream())
        core_.events.notice(info.id, fmt::format("{}: is back as {}", info.endpoint.label(), device_.id_link()));
}

void Serial::on_gone(std::string_view why) {
    const bool lasted = core_.now() - up_since_ >= Retry::lasting;
    core_.events.mark_down(peer_, why);
    if (lasted) retry_.reset();
    retry_.later();
    watch_folders(true);
}

// The first good frame reports the rate; the second confirms it.
void Serial::count_good_frame() {
    ++good_frames_;
    if (!std::exchange(searching_, false)) return;
    core_.events.notice(info.id, fmt::format("{}: {} baud", info.endpoint.label(), baud()));
    retry_.after(auto_confirm);
    core_.events.mark_up(peer_);
}

void Serial::search_on() {
    core_.events.mark_down(peer_, "no more good frames at this baud rate");
    searching_ = true;
    good_frames_ = 0;
    auto_index_ = (auto_index_ + 1) % auto_bauds.size();
    if (peer_.set_baud(baud())) {
        retry_.after(auto_window);
    } else {
        peer_.close("unplugged");
    }
}

void Serial::on_io(net::IoEvents) {
    folders_.drain();
    if (!retry_.within(settle)) retry_.after(settle);
}

void Serial::on_timer(MonoTime now) {
    retry_.fired(now);
    if (peer_.stream()) {
        if (automatic() && good_frames_ < 2) search_on();
    } else if (auto done = open(); !done) {
        fail(done.error());
    }
}

void Serial::watch_folders(bool on) {
    if (!on) {
        core_.loop().unwatch(folders_watch_);
        folders_ = {};
        return;
    }
    if (!folders_) {
        auto made = net::FolderWatch::create();
        if (!made) return;  // the retry timer also finds the device
        auto watch = core_.loop().watch(made->fd(), true, false, *this);
        if (!watch) return;
        folders_ = std::move(*made);
        folders_watch_ = *watch;
    }
    for (const std::string& folder : device_.folders()) folders_.add(folder);
}

}  // namespace

Opened open_serial(Opening opening) {
    const endpoint::Endpoint& endpoint = opening.endpoint;
    auto opened = std::make_unique<Serial>(opening);
    auto done = opened->open();
    if (done) return opened;
    if (done.error().code != SetupCode::not_found || opening.is_required())
        return tl::unexpected(std::move(done.error()).within(endpoint.label()));
    opened->fail(done.error());
    return opened;
}

}  // namespace mavloom::link::detail
