// SPDX-License-Identifier: MIT
#include "link/tcp/tcp.hpp"

#include <array>

namespace mavloom::link::detail {

static constexpr std::size_t pieces_per_write = 128;

SetupResult<void> TcpPeer::attach(net::TcpStream stream) {
    auto watch = core_.loop().watch(stream.fd(), true, false, *this);
    if (!watch) return tl::unexpected(std::move(watch).error());
    stream_ = std::move(stream);
    watch_ = *watch;
    blocked_ = false;
    last_heard = core_.now();
    // Nothing expired while there was no stream.
    counters.queue_age.add(queue.expire(core_.now()));
    if (queued) core_.schedule(*this);
    return {};
}

void TcpPeer::detach() noexcept {
    core_.forget(static_cast<Outlet&>(*this));
    core_.forget(static_cast<Core::Ticker&>(*this));
    core_.loop().unwatch(watch_);
    stream_ = {};
    blocked_ = false;
    queue.rewind();
}

void TcpPeer::close(std::string_view why) {
    parser_.finish(sink(wall_now()));
    drop(why);
}

void TcpPeer::drop(std::string_view why) {
    detach();
    owner_.on_closed(*this, why);
}

void TcpPeer::on_io(net::IoEvents events) {
    if (events.writable && blocked_) {
        blocked_ = false;
        core_.loop().change(watch_, true, false);
        core_.schedule(*this);
    }
    if (events.readable || events.failed) read();
}

void TcpPeer::read() {
    const auto count = stream_.read(core_.stream_buffer());
    if (!count) {
        if (count.error() != net::IoError::would_block)
            close(count.error() == net::IoError::closed ? "closed by the far side" : "failed");
        return;
    }
    last_heard = core_.now();
    parser_.feed(core_.stream_buffer().first(*count), core_.now(), sink(wall_now()));
    counters.implausible_unknown.set(parser_.counters().implausible_unknown.value());
    if (parser_.deadline()) core_.keep_ticking(*this);
}

void TcpPeer::tick(MonoTime now) { parser_.tick(now, sink(wall_now())); }

void TcpPeer::flush() {
    if (blocked_ || !stream_) return;
    while (!queue.empty()) {
        std::array<iovec, pieces_per_write> room;
        const auto written = stream_.write({room.data(), queue.pieces(room)});
        if (!written) {
            if (written.error() != net::IoError::would_block && written.error() != net::IoError::no_buffers) {
                close("closed by the far side");
                return;
            }
            blocked_ = true;
            core_.loop().change(watch_, true, true);
            return;
        }
        counters.bytes_out.add(*written);
        counters.frames_out.add(queue.consume(*written));
    }
    queued = false;
}

}  // namespace mavloom::link::detail
