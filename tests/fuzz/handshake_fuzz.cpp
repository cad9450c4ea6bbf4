// SPDX-License-Identifier: MIT
// Any bytes as a request to a server, or as the answer to a client that opens a WebSocket: no crash, an end, and no
// WebSocket without a whole handshake. The first byte chooses. In an answer, %ACCEPT% stands for the accept key.
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <future>
#include <string>
#include <string_view>

#include "http/web_socket/web_socket.hpp"
#include "mavloom/base/text.hpp"
#include "mavloom/http/client.hpp"
#include "mavloom/http/server.hpp"
#include "mavloom/net/tcp.hpp"

namespace {

using namespace mavloom::http;
using mavloom::net::Address;
using mavloom::net::TcpListener;
using mavloom::net::TcpStream;

constexpr std::chrono::seconds patience{5};

void demand(bool holds) {
    if (!holds) std::abort();
}

void send_all(const TcpStream& to, std::string_view text) {
    for (ssize_t sent = 0; !text.empty() && sent >= 0;) {
        pollfd writable{to.fd(), POLLOUT, 0};
        demand(::poll(&writable, 1, 5000) == 1);
        sent = ::send(to.fd(), text.data(), text.size(), MSG_NOSIGNAL);
        if (sent > 0) text.remove_prefix(static_cast<std::size_t>(sent));
    }
}

// Up to the end of what the far side sends, or to `end`.
std::string read_until(const TcpStream& from, std::string_view end) {
    std::string text;
    while (end.empty() || !text.ends_with(end)) {
        std::array<char, 4096> room{};
        pollfd readable{from.fd(), POLLIN, 0};
        demand(::poll(&readable, 1, 5000) == 1);
        const auto size = ::recv(from.fd(), room.data(), end.empty() ? room.size() : 1, 0);
        if (size <= 0) break;
        text.append(room.data(), static_cast<std::size_t>(size));
    }
    return text;
}

std::string lower(std::string_view text) {
    std::string all(text);
    for (char& c : all)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return all;
}

struct Served {
    std::atomic<int> opened = 0;
    Thread thread = *Thread::start();
    Server server = *Server::listen(
        thread, {.addresses = {*Address::parse("127.0.0.1", 0)},
                 .routes = {{"/text", [](const Request&, const Respond& respond) { respond({}); }}},
                 .web_sockets = {{.path = "/", .subprotocols = {"one"}, .on_open = [this](const auto&) {
                                      ++opened;
                                      return SessionEvents{};
                                  }}}});
};

void request(std::string_view text) {
    static Served served;
    const int before = served.opened;
    TcpStream client = *TcpStream::start_connect(served.server.addresses().front());
    demand(client.wait_connected(patience) && client.finish_connect());
    send_all(client, text);
    ::shutdown(client.fd(), SHUT_WR);
    const auto answer = read_until(client, {});
    demand(answer.empty() || answer.starts_with("HTTP/1.1 "));
    const auto all = lower(text);
    const bool may_open = all.find("get /") != std::string::npos &&
                          all.find("\nsec-websocket-key:") != std::string::npos &&
                          all.find("websocket") != std::string::npos && all.find("13") != std::string::npos;
    demand(may_open || (served.opened == before && answer.find("\r\nSec-WebSocket-Accept:") == std::string::npos));
}

void answer(std::string text) {
    static const auto local = *Address::parse("127.0.0.1", 0);
    static auto listener = *TcpListener::open(local, false);
    static auto thread = *Thread::start();
    std::promise<bool> opened;
    const auto client = Client::connect(thread,
                                        {.addresses = {listener.local()}, .host = "localhost", .patience = patience},
                                        {.on_open =
                                             [&](const auto&) {
                                                 opened.set_value(true);
                                                 return SessionEvents{};
                                             },
                                         .on_failed = [&](const auto&) { opened.set_value(false); }});
    pollfd waits{listener.fd(), POLLIN, 0};
    demand(::poll(&waits, 1, 5000) == 1);
    TcpStream server = std::move(*listener.accept());
    const auto asked = read_until(server, "\r\n\r\n");
    constexpr std::string_view name = "Sec-WebSocket-Key: ", accept = "%ACCEPT%";
    const auto at = asked.find(name) + name.size();
    const auto key = accept_key(asked.substr(at, asked.find('\r', at) - at));
    const auto place = text.find(accept);
    if (place != std::string::npos) text.replace(place, accept.size(), key);
    send_all(server, text);
    ::shutdown(server.fd(), SHUT_WR);
    auto result = opened.get_future();
    demand(result.wait_for(patience * 2) == std::future_status::ready);
    demand(!result.get() || (place != std::string::npos && lower(text).starts_with("http/1.1 101")));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
    if (data[0] == 'c') answer(std::string(text));
    else request(text);
    return 0;
}
