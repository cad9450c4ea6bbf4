// SPDX-License-Identifier: MIT
// A byte stream as a link: TCP or serial. Private to module link; single owner thread.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "link/core/core.hpp"
#include "link/core/read_budget.hpp"
#include "mavloom/net/io_result.hpp"
#include "mavloom/wire/stream_parser.hpp"

namespace mavloom::link::detail {

// Reads once per turn, and writes the queue in as few calls as possible. Bytes that the kernel does not accept stay in
// the queue. `Self` is the derived class (CRTP). Its function `accepts(bytes)` returns false if it closed the stream
// because of the bytes read, which are then not parsed. `wants(event)` decides whether an event of the parser goes to
// the handler.
template <class Self, class Stream>
class StreamPeer : public Link, public Outlet, public net::IoHandler, public Ticker {
public:
    ~StreamPeer() override { release(); }

    // Starts to read the stream, and to write the queued frames that are not too old.
    [[nodiscard]] SetupResult<void> attach(Stream stream) {
        assert(!stream_ && "detach comes first");
        auto watch = core_.loop().watch(stream.fd(), true, false, *this);
        if (!watch) return tl::unexpected(std::move(watch).error());
        stream_ = std::move(stream);
        watch_ = *watch;
        blocked_ = false;
        last_heard = core_.now();
        // Without a stream, no frame was dropped for its age. Catch up now.
        counters.queue_age.add(queue.expire(core_.now()));
        if (is_scheduled) schedule();
        return {};
    }
    // Closes the stream. A partly sent frame will be sent again, from its start, on the next stream.
    virtual void detach() noexcept { release(); }
    [[nodiscard]] const Stream& stream() const noexcept { return stream_; }

    void schedule() override { core_.outlets.schedule(*this); }
    void hear(ByteView bytes, WallTime time) override {
        if (!stream_) return;
        const auto take = sink(time);
        parser_.feed(bytes, core_.now(), take);
        parser_.report_junk(take);  // so that reports count all of it
        counters.implausible_unknown.set(parser_.counters().implausible_unknown.value());
        if (parser_.deadline()) core_.tickers.keep(*this);
    }
    void on_io(net::IoEvents events) override {
        if (events.writable && blocked_) {
            blocked_ = false;
            core_.loop().change(watch_, true, false);
            schedule();
        }
        if (events.readable || events.failed) read();
    }
    void flush() override {
        if (!blocked() && stream_) (void)write_queue(SIZE_MAX);
    }
    [[nodiscard]] bool blocked() const override { return blocked_; }
    void expire(MonoTime now) override { counters.queue_age.add(queue.expire(now)); }
    [[nodiscard]] std::optional<MonoTime> tick_due() const override { return parser_.deadline(); }
    void tick(MonoTime now) override { parser_.tick(now, sink(wall_now())); }

    MonoTime last_heard{};

protected:
    StreamPeer(Core& core, EndpointId endpoint_id, const endpoint::EndpointOptions& options)
        : Link(endpoint_id, options), core_(core), parser_(core.dialects.of(endpoint_id).table) {}

    // Called when the stream has ended, or reading or writing has failed permanently.
    virtual void on_end(net::IoError error) = 0;

    // Writes at most about `room` bytes. Returns false if more bytes remain in the queue. Returns true if the queue is
    // empty, or if the stream has ended or waits for the kernel.
    [[nodiscard]] bool write_queue(std::size_t room) {
        while (!queue.empty()) {
            if (room == 0) return false;
            std::array<iovec, pieces_per_write> pieces;
            const auto written = stream_.write({pieces.data(), queue.pieces(pieces, room)});
            if (!written) {
                fail_to_write(written.error());
                return true;
            }
            assert(*written <= queue.bytes());
            counters.bytes_out.add(*written);
            counters.frames_out.add(queue.consume(*written));
            room -= std::min(room, *written);
        }
        is_scheduled = false;
        return true;
    }
    // Delivers what stages and the parser still hold back.
    void finish_parsing() {
        if (border) border->release(Way::in);
        parser_.finish(sink(wall_now()));
    }

    Core& core_;
    Stream stream_;

private:
    static constexpr std::size_t pieces_per_write = 128, min_read = 4096;

    void release() noexcept {
        core_.outlets.forget(*this);
        core_.tickers.forget(*this);
        core_.loop().unwatch(watch_);
        stream_ = {};
        blocked_ = false;
        queue.rewind();
        if (border) border->drop(Way::in);
    }
    void read() {
        const auto most = core_.reads_all ? Core::stream_buffer_bytes : budget_.limit();
        const ByteSpan room = ByteSpan(core_.stream_buffer).first(most);
        const auto count = stream_.read(room);
        if (!count) {
            if (count.error() != net::IoError::would_block) on_end(count.error());
            return;
        }
        last_heard = core_.now();
        if (!static_cast<Self*>(this)->accepts(room.first(*count))) return;
        const ByteView bytes = room.first(*count);
        budget_.spend(*count, *count, [&] {
            if (!border) [[likely]] {
                hear(bytes, wall_now());
            } else {
                border->take(Way::in, {.bytes = bytes, .time = wall_now()});
            }
        });
    }
    void fail_to_write(net::IoError error) {
        if (error != net::IoError::would_block && error != net::IoError::no_buffers)
            return on_end(net::IoError::closed);
        blocked_ = true;
        core_.loop().change(watch_, true, true);
    }
    [[nodiscard]] auto sink(WallTime time) {
        return [this, time](const wire::ParseEvent& event) {
            if (static_cast<Self*>(this)->wants(event)) core_.on_event(*this, event, time);
        };
    }

    net::WatchId watch_;
    wire::StreamParser parser_;
    ReadBudget budget_{min_read, Core::stream_buffer_bytes};
    bool blocked_ = false;  // the kernel accepts no more
};

}  // namespace mavloom::link::detail
