// SPDX-License-Identifier: MIT
#include "link/serial/serial.hpp"

namespace mavloom::link::detail {

SetupResult<void> SerialPeer::attach(net::SerialPort port) {
    pacer_ = SerialPacer(port.baud());
    return StreamPeer::attach(std::move(port));
}

void SerialPeer::detach() noexcept {
    core_.loop().cancel_timer(pace_);
    StreamPeer::detach();
}

void SerialPeer::close(std::string_view why) {
    finish_parsing();
    detach();
    owner_.on_gone(why);
}

bool SerialPeer::set_baud(std::uint32_t baud) {
    if (!stream_.set_baud(baud)) return false;
    pacer_ = SerialPacer(stream_.baud());
    return true;
}

void SerialPeer::flush() {
    if (blocked() || !stream_) return;
    if (!write_queue(pacer_.room(stream_.unsent_bytes())))
        pace_ = core_.loop().start_timer(core_.now() + SerialPacer::interval(), *this);
}

void SerialPeer::on_timer(MonoTime) {
    pace_ = {};
    pacer_.learn(stream_.unsent_bytes());
    schedule();
}

}  // namespace mavloom::link::detail
