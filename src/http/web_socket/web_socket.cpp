// SPDX-License-Identifier: MIT
#include "http/web_socket/web_socket.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/websocket/detail/hybi13.hpp>
#include <functional>
#include <utility>
#include <vector>

#include "http/web_socket/frames.hpp"
#include "mavloom/base/shown.hpp"

namespace mavloom::http {

namespace {

// After the last frame, the peer has so long to close the connection. Then it is closed here, and bytes that were not
// read may cost the peer our last frame.
constexpr std::chrono::seconds linger_time{1};
constexpr std::size_t read_size = 65'536;

std::string fault_text(Ended why, std::uint16_t code, Accepts accepts) {
    switch (why) {
        case Ended::size: return "a message is longer than the limit";
        case Ended::fragments: return "a message has more fragments than the limit";
        case Ended::kind:
            return accepts == Accepts::binary ? "a text message came; only binary ones are accepted here"
                                              : "a binary message came; only texts are accepted here";
        default: return code == close_code::bad_text ? "a text is not UTF-8" : "a frame breaks the protocol";
    }
}

class WebSocket : public OpenSession, public std::enable_shared_from_this<WebSocket>, private FrameEvents {
public:
    WebSocket(Tcp::socket socket, WebSocketSetup setup)
        : setup_(std::move(setup)),
          socket_(std::move(socket)),
          timer_(socket_.get_executor()),
          reader_(setup_.session, setup_.is_client, *this),
          writer_(setup_.is_client),
          flush_writer_(setup_.is_client) {
        error_code ignored;
        socket_.non_blocking(true, ignored);
    }

    void start() {
        const std::weak_ptr<WebSocket> self = weak_from_this();
        session_ = std::make_shared<Session>(
            setup_.session, setup_.peer,
            Session::Orders{on_thread<>(setup_.core, self, [](WebSocket& socket) { socket.write(); }),
                            on_thread<std::uint16_t, std::string>(
                                setup_.core, self,
                                [](WebSocket& socket, std::uint16_t code, const std::string& text) {
                                    socket.close_after_writing(code, text);
                                }),
                            on_thread<>(setup_.core, self, [](WebSocket& socket) { socket.resume(); })});
        events_ = std::exchange(setup_.on_open, {})(session_);
        output_.assign(setup_.first.begin(), setup_.first.end());
        if (!output_.empty()) send();
        watch();
        std::string read = std::move(setup_.read);
        reader_.feed({reinterpret_cast<std::uint8_t*>(read.data()), read.size()});
        if (held_.empty()) await_input();
    }

    void abandon() override {
        events_ = {};
        setup_.on_ended = {};
        session_->end();
        timer_.cancel();
        if (!is_writing_ && !is_final_) say_goodbye();
        close_socket();
    }

    void cut() override { give_up(); }

    [[nodiscard]] bool is_closing() const override { return has_ended_ || close_with_ != close_code::none; }

private:
    // ---- in

    void await_input() {
        socket_.async_wait(Tcp::socket::wait_read, [self = shared_from_this()](error_code error) {
            if (error) self->end_reading(error);
            else self->read();
        });
    }

    // All connections of a thread share the memory.
    void read() {
        static thread_local std::vector<std::uint8_t> room(read_size);
        error_code error;
        const auto size = socket_.read_some(asio::buffer(room), error);
        if (error && error != asio::error::would_block) return end_reading(error);
        has_heard_ = has_heard_ || size != 0;
        if (!is_final_) reader_.feed(ByteSpan(room).first(size));
        if (held_.empty()) await_input();
    }
    void resume() {
        std::size_t taken = 0;
        while (taken < held_.size() && is_taken(held_[taken].bytes, held_[taken].kind)) ++taken;
        held_.erase(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(taken));
        if (taken == 0 || !held_.empty()) return;
        if (held_end_) std::exchange(held_end_, {})();
        await_input();
    }
    [[nodiscard]] bool is_taken(ByteView message, Kind kind) {
        return has_ended_ || !events_.on_message || events_.on_message(message, kind);
    }

    void end_reading(error_code error) {
        if (!has_ended_) {
            const bool was_lost = close_with_ == close_code::none;
            end({was_lost ? Ended::lost : Ended::by_us, 0, text_of(error)});
        }
        timer_.cancel();
        close_socket();
    }

    void take_message(ByteView message, Kind kind) override {
        if (has_ended_) return;
        session_->counts().messages_in.add();
        session_->counts().bytes_in.add(message.size());
        if (!held_.empty() || !is_taken(message, kind)) held_.push_back({{message.begin(), message.end()}, kind});
    }
    // Only the newest ping is answered (RFC 6455, section 5.5.3).
    void take_ping(ByteView payload) override {
        pong_.assign(payload.begin(), payload.end());
        owes_pong_ = true;
        write();
    }
    void take_close(std::uint16_t code, std::string_view reason) override {
        after_held([this, code, text = printable(reason)] {
            const auto why = close_with_ == close_code::none ? Ended::by_peer : Ended::by_us;
            end({why, code, text});
            finish(code == 0 ? close_code::normal : code, "");
        });
    }
    void take_fault(Ended why, std::uint16_t code) override {
        after_held([this, why, code] {
            const auto text = fault_text(why, code, setup_.session.accepts);
            end({why, 0, text});
            finish(code, text);
        });
    }
    // The messages before the end of the session are delivered first.
    void after_held(std::function<void()> end_session) {
        if (held_.empty()) end_session();
        else held_end_ = std::move(end_session);
    }

    // ---- out

    void write() {
        if (is_writing_ || is_final_) return;
        output_.clear();
        taken_bytes_ = session_->take_begun(output_);
        if (std::exchange(owes_pong_, false)) writer_.append(output_, Opcode::pong, pong_);
        if (std::exchange(owes_ping_, false)) writer_.append(output_, Opcode::ping, {});
        if (!has_ended_ && !has_closed_) taken_bytes_ += session_->take(output_, write_size, writer_, mono_now());
        if (output_.empty() && close_with_ != close_code::none && !has_closed_) append_close();
        if (!output_.empty()) send();
        else if (has_ended_ && has_closed_) drain();
        else if (!has_ended_ && !has_closed_) session_->lend(socket_.native_handle(), flush_writer_);
    }
    void send() {
        is_writing_ = true;
        asio::async_write(socket_, asio::buffer(output_), [self = shared_from_this()](error_code error, std::size_t) {
            self->is_writing_ = false;
            if (error) return;  // it also ends the reader, which reports it
            const auto sent = std::exchange(self->taken_bytes_, 0);
            if (sent != 0 && !self->has_ended_ && self->events_.on_sent) self->events_.on_sent(sent);
            self->write();
        });
    }
    void append_close() {
        has_closed_ = true;
        taken_bytes_ += session_->take_begun(output_);
        std::vector<std::uint8_t> payload{static_cast<std::uint8_t>(close_with_ >> 8),
                                          static_cast<std::uint8_t>(close_with_ & 0xff)};
        const auto text = std::string_view(close_text_).substr(0, 123);
        payload.insert(payload.end(), text.begin(), text.end());
        writer_.append(output_, Opcode::close, payload);
        wait_for_end(setup_.patience);
    }

    void close_after_writing(std::uint16_t code, const std::string& text) {
        if (close_with_ != close_code::none || has_ended_) return;
        close_with_ = code;
        close_text_ = text;
        wait_for_end(setup_.patience);  // a peer that reads nothing never gets what waits
        write();
    }
    // The last frame, unless it was sent.
    void finish(std::uint16_t code, const std::string& text) {
        if (close_with_ == close_code::none) {
            close_with_ = code;
            close_text_ = text;
        }
        wait_for_end(setup_.patience);  // a peer that reads nothing never gets the last frame
        write();
    }
    // Sends nothing more, and waits until the peer closes the connection.
    void drain() {
        is_final_ = true;
        error_code ignored;
        socket_.shutdown(Tcp::socket::shutdown_send, ignored);
        wait_for_end(linger_time);
    }
    void wait_for_end(std::chrono::steady_clock::duration time) {
        timer_.expires_after(time);
        timer_.async_wait([self = shared_from_this()](error_code error) {
            if (!error && self->is_due()) self->give_up();
        });
    }
    // A new deadline does not cancel a wait whose handler is already queued.
    [[nodiscard]] bool is_due() const { return timer_.expiry() <= std::chrono::steady_clock::now(); }
    void give_up() {
        end({Ended::by_us, 0, "the far side did not close in time"});
        timer_.cancel();
        close_socket();
    }

    void say_goodbye() {
        if (has_closed_) return;
        output_.clear();
        close_with_ = close_code::going_away;
        append_close();
        timer_.cancel();
        error_code ignored;
        socket_.write_some(asio::buffer(output_), ignored);
    }

    // ---- silence

    void watch() {
        timer_.expires_after(setup_.session.silence);
        timer_.async_wait([self = shared_from_this()](error_code error) {
            if (!error && !self->is_closing()) self->look();
        });
    }
    void look() {
        if (!held_.empty()) return watch();  // nobody reads the answer to a ping
        const bool has_heard = std::exchange(has_heard_, false);
        if (!has_heard && std::exchange(is_pinged_, true)) {
            end({Ended::silent, 0, "no answer to a ping"});
            return close_socket();
        }
        if (has_heard) is_pinged_ = false;
        owes_ping_ = !has_heard;
        watch();
        write();
    }

    // ---- end

    void end(const Closed& closed) {
        if (std::exchange(has_ended_, true)) return;
        session_->end();
        if (setup_.on_ended) std::exchange(setup_.on_ended, {})(closed.why);
        if (events_.on_closed) events_.on_closed(closed);
    }
    void close_socket() {
        session_->withdraw();
        error_code ignored;
        socket_.close(ignored);
    }

    WebSocketSetup setup_;
    Tcp::socket socket_;
    asio::steady_timer timer_;  // looks for silence; once the session closes, ends the wait for the peer
    FrameReader reader_;
    FrameWriter writer_, flush_writer_;
    std::vector<std::uint8_t> output_, pong_;
    std::size_t taken_bytes_ = 0;  // of blocks, in `output_`
    struct Message {
        std::vector<std::uint8_t> bytes;
        Kind kind;
    };
    std::vector<Message> held_;       // that on_message refused, and those after it: at most what one read held
    std::function<void()> held_end_;  // ends the session once those are delivered
    bool is_writing_ = false, owes_pong_ = false, owes_ping_ = false;
    bool has_heard_ = false, is_pinged_ = false;
    std::uint16_t close_with_ = close_code::none;  // none: do not close
    std::string close_text_;
    bool has_closed_ = false;  // our close frame is in `output_` or was sent
    bool has_ended_ = false;   // and was reported
    bool is_final_ = false;    // nothing is sent any more
    std::shared_ptr<Session> session_;
    SessionEvents events_;
};

}  // namespace

std::shared_ptr<OpenSession> open_web_socket(Tcp::socket socket, WebSocketSetup setup) {
    const auto made = std::make_shared<WebSocket>(std::move(socket), std::move(setup));
    made->start();
    return made;
}

std::string accept_key(std::string_view key) {
    namespace detail = boost::beast::websocket::detail;
    detail::sec_ws_accept_type answer;
    detail::make_sec_ws_accept(answer, {key.data(), key.size()});
    return {answer.data(), answer.size()};
}

}  // namespace mavloom::http
