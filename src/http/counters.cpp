// SPDX-License-Identifier: MIT
#include "mavloom/http/counters.hpp"

namespace mavloom::http {

namespace {

struct Described {
    Count count;
    std::string_view name, help;
};

constexpr std::array<Described, Counters::size> described{
    {{Count::connections, "connections", "TCP connections that were accepted"},
     {Count::turned_away, "turned_away", "connections, WebSockets and streams beyond the limit, which got status 503"},
     {Count::displaced, "displaced", "idle connections that were closed to make room for a newcomer"},
     {Count::timed_out, "timed_out", "clients that sent no whole request, or did not read an answer, in time"},
     {Count::requests, "requests", "whole requests, also those that were refused"},
     {Count::bad_request, "bad_request", "clients that did not send HTTP"},
     {Count::header_size, "header_size", "requests with a header that was too long, which got status 431"},
     {Count::body_size, "body_size", "requests with a body, which got status 413"},
     {Count::wrong_host, "wrong_host", "requests with a Host header that is not this machine, which got status 403"},
     {Count::wrong_origin, "wrong_origin", "requests that a web page of another origin caused, which got status 403"},
     {Count::wrong_token, "wrong_token", "requests without the token of this server, which got status 401"},
     {Count::wrong_path, "wrong_path", "requests for a path that does not exist, which got status 404"},
     {Count::wrong_method, "wrong_method", "requests other than GET and HEAD, which got status 405"},
     {Count::wrong_query, "wrong_query",
      "requests for a stream with options that it does not have, which got status 400"},
     {Count::streams, "streams", "streams that were begun"},
     {Count::bad_handshake, "bad_handshake", "WebSockets that were refused because of their handshake"},
     {Count::web_sockets, "web_sockets", "WebSockets that were opened"},
     {Count::ws_silent, "ws_silent", "WebSockets that ended because the client did not answer a ping"},
     {Count::ws_protocol, "ws_protocol", "WebSockets that ended because the client broke the protocol"},
     {Count::ws_size, "ws_size", "WebSockets that ended because a message was too long"},
     {Count::ws_fragments, "ws_fragments", "WebSockets that ended because a message came in too many fragments"},
     {Count::ws_kind, "ws_kind",
      "WebSockets that ended because a message was binary, where only text is accepted, or the reverse"},
     {Count::ws_lost, "ws_lost", "WebSockets that ended because the connection broke"}}};

// A row that is missing has the count 0.
consteval bool are_in_order() {
    for (std::size_t i = 0; i < described.size(); ++i)
        if (described[i].count != static_cast<Count>(i) || described[i].help.empty()) return false;
    return true;
}
static_assert(are_in_order(), "each count needs a row, in the order of the counts");

}  // namespace

std::string_view Counters::name(Count what) noexcept { return described[static_cast<std::size_t>(what)].name; }
std::string_view Counters::help(Count what) noexcept { return described[static_cast<std::size_t>(what)].help; }

}  // namespace mavloom::http
