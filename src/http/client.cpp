// SPDX-License-Identifier: MIT
#include "mavloom/http/client.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/asio/read_until.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/detail/base64.hpp>
#include <boost/beast/core/string.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/rfc7230.hpp>
#include <utility>

#include "http/web_socket/frames.hpp"
#include "http/web_socket/web_socket.hpp"
#include "mavloom/base/shown.hpp"
#include "mavloom/net/tcp.hpp"

namespace mavloom::http {

namespace beast = boost::beast;
namespace http_beast = boost::beast::http;

namespace {

constexpr std::size_t longest_answer = 8192, longest_reason = 120;

std::string new_key() {
    std::array<std::uint8_t, 16> random{};
    fill_randomly(random);
    std::string key(beast::detail::base64::encoded_size(random.size()), '\0');
    beast::detail::base64::encode(key.data(), random.data(), random.size());
    return key;
}

std::string request_for(const ClientOptions& options, const std::string& key) {
    return fmt::format(
        "GET {} HTTP/1.1\r\nHost: {}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: {}\r\n"
        "Sec-WebSocket-Version: 13\r\n{}\r\n",
        options.path, options.host, key,
        options.subprotocol.empty() ? "" : fmt::format("Sec-WebSocket-Protocol: {}\r\n", options.subprotocol));
}

using Answer = http_beast::response<http_beast::empty_body>;

bool has_token(const Answer& answer, http_beast::field name, beast::string_view token) {
    const auto [begin, end] = answer.equal_range(name);
    return std::any_of(begin, end, [&](const auto& one) { return http_beast::token_list(one.value()).exists(token); });
}

// RFC 6455, section 4.1: what an answer to our request must have. Returns what is wrong with it, or nothing.
std::string fault_of(const Answer& answer, const std::string& key) {
    using http_beast::field;
    if (answer.result_int() != 101) return fmt::format("the server answered with HTTP status {}", answer.result_int());
    if (!beast::iequals(answer[field::upgrade], "websocket") || !has_token(answer, field::connection, "upgrade"))
        return "the server changes to another protocol";
    if (answer[field::sec_websocket_accept] != accept_key(key)) return "the answer belongs to another request";
    if (answer.count(field::sec_websocket_extensions) != 0) return "the server chose an extension that was not offered";
    return {};
}

// Returns the subprotocol that the server chose, or why its answer opens no WebSocket.
Result<std::string, std::string> check_answer(std::string_view header, const std::string& key,
                                              const std::string& subprotocol) {
    http_beast::response_parser<http_beast::empty_body> parser;
    parser.skip(true);
    error_code error;
    parser.put(asio::buffer(header), error);
    if (error || !parser.is_header_done()) return tl::unexpected(std::string("the answer is not HTTP"));
    const auto& answer = parser.get();
    if (auto fault = fault_of(answer, key); !fault.empty()) return tl::unexpected(std::move(fault));
    const auto header_value = answer[http_beast::field::sec_websocket_protocol];
    std::string chosen(header_value.data(), header_value.size());
    if (!chosen.empty() && chosen != subprotocol)
        return tl::unexpected(fmt::format("the server chose the subprotocol {}", in_quotes(chosen)));
    return chosen;
}

}  // namespace

// Owned by its handlers while it connects.
struct ClientState : std::enable_shared_from_this<ClientState> {
    ClientState(const std::shared_ptr<Core>& the_core, ClientOptions the_options, ClientEvents the_events)
        : core(the_core),
          options(std::move(the_options)),
          events(std::move(the_events)),
          socket(the_core->context()),
          deadline(the_core->context()) {}

    void try_next() {
        if (next == options.addresses.size()) return fail();
        socket = Tcp::socket(socket.get_executor());
        limit(options.patience);
        if (const auto error = bind()) return try_another(error);
        socket.async_connect(endpoint_of(options.addresses[next]), [self = shared_from_this()](error_code error) {
            if (error || self->is_late) self->try_another(error);
            else self->shake_hands();
        });
    }
    [[nodiscard]] error_code bind() {
        error_code error;
        if (!options.bind) return error;
        const auto local = endpoint_of(*options.bind);
        socket.open(local.protocol(), error);
        if (!error) socket.set_option(Tcp::socket::reuse_address(true), error);
        if (!error) socket.bind(local, error);
        return error;
    }
    void try_another(error_code error) {
        if (is_shut) return;
        const auto why = is_late ? "no answer in time" : error.message();
        problem = fmt::format("cannot connect to {}: {}", options.addresses[next].text(), why);
        ++next;
        try_next();
    }
    void fail(SetupCode code = SetupCode::unreachable) {
        if (problem.empty()) problem = "there is no address to connect to";
        if (events.on_failed) events.on_failed({code, 0, problem});
    }
    void shake_hands() {
        if (is_shut) return;
        net::set_stream_options(socket.native_handle(), max_unsent_bytes);
        limit(options.patience);
        request = request_for(options, key);
        asio::async_write(socket, asio::buffer(request), [self = shared_from_this()](error_code error, std::size_t) {
            if (error) self->fail_handshake(error.message());
            else self->read_answer();
        });
    }
    void read_answer() {
        asio::async_read_until(socket, asio::dynamic_buffer(answer, longest_answer), "\r\n\r\n",
                               [self = shared_from_this()](error_code error, std::size_t size) {
                                   if (error == asio::error::not_found) self->fail_handshake("the answer is too long");
                                   else if (error) self->fail_handshake(text_of(error));
                                   else self->take_answer(size);
                               });
    }
    void take_answer(std::size_t header_size) {
        if (is_shut) return;
        deadline.cancel();
        auto checked = check_answer(std::string_view(answer).substr(0, header_size), key, options.subprotocol);
        if (!checked) return fail_handshake(with_reason(checked.error(), std::string_view(answer).substr(header_size)));
        web_socket = open_web_socket(std::move(socket), {.core = core,
                                                         .is_client = true,
                                                         .session = options.session,
                                                         .patience = options.patience,
                                                         .peer = {options.addresses[next], "", *checked},
                                                         .read = answer.substr(header_size),
                                                         .on_open = events.on_open,
                                                         .on_ended = [](Ended) {}});
    }
    void fail_handshake(std::string_view why) {
        if (is_shut) return;
        deadline.cancel();
        if (is_late) why = "no answer in time";
        if (!answer.empty() && !answer.starts_with("HTTP/")) why = "the answer is not HTTP";
        problem = fmt::format("no WebSocket at {}: {}", options.addresses[next].text(), why);
        close();
        fail(SetupCode::bad_input);
    }
    // A server explains a refusal in the body of its answer, if it came with the header.
    [[nodiscard]] std::string with_reason(std::string fault, std::string_view body) const {
        const auto line = body.substr(0, std::min(body.find('\n'), longest_reason));
        return line.empty() || line.front() == '<' ? fault : fmt::format("{}: {}", fault, printable(line));
    }
    void limit(std::chrono::steady_clock::duration time) {
        is_late = false;
        deadline.expires_after(time);
        deadline.async_wait([self = shared_from_this()](error_code error) {
            // A new deadline does not cancel a wait whose handler is already queued.
            if (error || self->deadline.expiry() > std::chrono::steady_clock::now()) return;
            self->is_late = true;
            self->close();
        });
    }
    void close() {
        error_code ignored;
        socket.close(ignored);
    }
    void shut() {
        is_shut = true;
        events = {};
        deadline.cancel();
        close();
        if (const auto open = web_socket.lock()) open->abandon();
    }

    std::weak_ptr<Core> core;
    ClientOptions options;
    ClientEvents events;
    Tcp::socket socket;
    asio::steady_timer deadline;
    std::weak_ptr<OpenSession> web_socket;
    std::size_t next = 0;  // of the addresses
    bool is_shut = false;
    bool is_late = false;  // the deadline closed the socket
    const std::string key = new_key();
    std::string request, answer;
    std::string problem;  // of the last address
};

Client Client::connect(const Thread& thread, ClientOptions options, ClientEvents events) {
    const auto& core = thread.core();
    auto state = std::make_shared<ClientState>(core, std::move(options), std::move(events));
    asio::post(core->context(), [state] {
        if (!state->is_shut) state->try_next();
    });
    return {core, std::move(state)};
}

Client::Client(std::shared_ptr<Core> core, std::shared_ptr<ClientState> state) noexcept
    : core_(std::move(core)), state_(std::move(state)) {}
Client::Client(Client&&) noexcept = default;
Client::~Client() {
    if (state_) core_->run_and_wait([this] { state_->shut(); });
}

}  // namespace mavloom::http
