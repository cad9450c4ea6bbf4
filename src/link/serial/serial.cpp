// SPDX-License-Identifier: MIT
#include "link/serial/serial.hpp"

#include <array>

namespace mavloom::link::detail {

static constexpr std::size_t pieces_per_turn = 32;

SetupResult<void> SerialPeer::attach(net::SerialPort port) {
    auto watch = core_.loop().watch(port.fd(), true, false, *this);
    if (!watch) return tl::unexpected(std::move(watch).error());
    pacer_ = SerialPacer(port.baud());
    port_ = std::move(port);
    watch_ = *watch;
    // Nothing expired while there was no port.
    counters.queue_age.add(queue.expire(core_.now()));
    if (queued) core_.schedule(*this);
    return {};
}

void SerialPeer::detach() noexcept {
    core_.forget(static_cast<Outlet&>(*this));
    core_.forget(static_cast<Core::Ticker&>(*this));
    core_.loop().cancel_timer(pace_);
    core_.loop().unwatch(watch_);
    port_ = {};
    blocked_ = false;
    queue.rewind();
}

void SerialPeer::close(std::string_view why) {
    parser_.finish(sink(wall_now()));
    detach();
    owner_.on_gone(why);
}

bool SerialPeer::set_baud(std::uint32_t baud) {
    if (!port_.set_baud(baud)) return false;
    pacer_ = SerialPacer(port_.baud());
    return true;
}

void SerialPeer::on_io(net::IoEvents events) {
    if (events.writable && blocked_ && !pace_.valid()) {
        blocked_ = false;
        core_.loop().change(watch_, true, false);
        core_.schedule(*this);
    }
    if (events.readable || events.failed) read();
}

// A hang-up also shows as a read of no bytes or a read error.
void SerialPeer::read() {
    const auto count = port_.read(core_.stream_buffer());
    if (!count) {
        if (count.error() != net::IoError::would_block) close("unplugged");
        return;
    }
    parser_.feed(core_.stream_buffer().first(*count), core_.now(), sink(wall_now()));
    counters.implausible_unknown.set(parser_.counters().implausible_unknown.value());
    if (parser_.deadline()) core_.keep_ticking(*this);
}

void SerialPeer::tick(MonoTime now) { parser_.tick(now, sink(wall_now())); }

void SerialPeer::flush() {
    if (blocked_ || !port_) return;
    std::size_t room = pacer_.room(port_.unsent_bytes());
    while (!queue.empty()) {
        if (room == 0) return wait_for_room();
        std::array<iovec, pieces_per_turn> pieces;
        const auto written = port_.write({pieces.data(), queue.pieces(pieces, room)});
        if (!written) {
            if (written.error() != net::IoError::would_block && written.error() != net::IoError::no_buffers)
                return close("unplugged");
            return wait_for_driver();
        }
        counters.bytes_out.add(*written);
        counters.frames_out.add(queue.consume(*written));
        room -= std::min(room, *written);
    }
    queued = false;
}

void SerialPeer::wait_for_room() {
    blocked_ = true;
    pace_ = core_.loop().start_timer(core_.now() + SerialPacer::interval(), *this);
}

void SerialPeer::wait_for_driver() {
    blocked_ = true;
    core_.loop().change(watch_, true, true);
}

void SerialPeer::on_timer(MonoTime) {
    pace_ = {};
    pacer_.learn(port_.unsent_bytes());
    blocked_ = false;
    core_.schedule(*this);
}

}  // namespace mavloom::link::detail
