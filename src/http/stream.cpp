// SPDX-License-Identifier: MIT
#include "http/stream.hpp"

#include <array>
#include <boost/asio/steady_timer.hpp>
#include <utility>
#include <vector>

namespace mavloom::http {

namespace {

class Stream : public OpenSession, public std::enable_shared_from_this<Stream> {
public:
    Stream(Tcp::socket socket, StreamSetup setup)
        : setup_(std::move(setup)), socket_(std::move(socket)), timer_(socket_.get_executor()) {
        setup_.session.pack_bytes = write_size;
        error_code ignored;
        socket_.non_blocking(true, ignored);
    }

    void start() {
        const std::weak_ptr<Stream> self = weak_from_this();
        session_ = std::make_shared<Session>(
            setup_.session, setup_.peer,
            Session::Orders{on_thread<>(setup_.core, self, [](Stream& stream) { stream.write(); }),
                            on_thread<std::uint16_t, std::string>(
                                setup_.core, self,
                                [](Stream& stream, std::uint16_t, const std::string&) { stream.close_after_writing(); }),
                            [] {}});
        events_ = std::exchange(setup_.on_open, {})(session_);
        output_.assign(setup_.first.begin(), setup_.first.end());
        send(0);
        await_end();
    }

    void abandon() override {
        events_ = {};
        setup_.on_ended = {};
        end({Ended::by_us, 0, ""});
    }
    void cut() override { end({Ended::by_us, 0, ""}); }
    [[nodiscard]] bool is_closing() const override { return has_ended_ || is_closing_; }

private:
    // The client sends nothing more that matters; the end of its input ends the stream.
    void await_end() {
        socket_.async_wait(Tcp::socket::wait_read, [self = shared_from_this()](error_code error) {
            std::array<char, 512> room{};
            if (!error) self->socket_.read_some(asio::buffer(room), error);
            if (error && error != asio::error::would_block) self->end({Ended::by_peer, 0, "closed by the far side"});
            else self->await_end();
        });
    }

    void write() {
        if (is_writing_ || has_ended_) return;
        output_.clear();
        session_->take_unframed(output_, write_size, mono_now());
        if (!output_.empty()) send(0);
        else if (is_closing_) end({Ended::by_us, 0, ""});
    }
    void send(std::size_t from) {
        is_writing_ = true;
        wait_for_client();
        socket_.async_write_some(asio::buffer(output_) + from,
                                 [self = shared_from_this(), from](error_code error, std::size_t size) {
                                     if (error) return self->end({Ended::lost, 0, error.message()});
                                     if (from + size < self->output_.size()) return self->send(from + size);
                                     self->is_writing_ = false;
                                     self->timer_.cancel();
                                     self->write();
                                 });
    }
    // A new deadline does not cancel a wait whose handler is already queued.
    void wait_for_client() {
        timer_.expires_after(setup_.patience);
        timer_.async_wait([self = shared_from_this()](error_code error) {
            if (error || !self->is_writing_ || self->timer_.expiry() > std::chrono::steady_clock::now()) return;
            self->end({Ended::silent, 0, "it reads nothing"});
        });
    }
    void close_after_writing() {
        is_closing_ = true;
        write();
    }

    void end(const Closed& closed) {
        if (std::exchange(has_ended_, true)) return;
        session_->end();
        timer_.cancel();
        error_code ignored;
        socket_.close(ignored);
        if (setup_.on_ended) std::exchange(setup_.on_ended, {})(closed.why);
        if (events_.on_closed) events_.on_closed(closed);
    }

    StreamSetup setup_;
    Tcp::socket socket_;
    asio::steady_timer timer_;  // until the client must have read something
    std::vector<std::uint8_t> output_;
    bool is_writing_ = false, is_closing_ = false;
    bool has_ended_ = false;  // and was reported
    std::shared_ptr<Session> session_;
    SessionEvents events_;
};

}  // namespace

std::shared_ptr<OpenSession> open_stream(Tcp::socket socket, StreamSetup setup) {
    const auto made = std::make_shared<Stream>(std::move(socket), std::move(setup));
    made->start();
    return made;
}

}  // namespace mavloom::http
