// SPDX-License-Identifier: MIT
// The schemes of endpoints, a row for each. Everything that treats schemes differently reads these rows: the grammar,
// the checks, the hints, the commands and the configuration. A transport for a scheme is registered in
// `link/transport.hpp`.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace mavloom::endpoint {

enum class Scheme : std::uint8_t { udpin, udpout, udpbcast, udpmcast, tcpin, tcpout, wsin, wsout, serial, shm, tlog };

// The part after SCHEME://: HOST:PORT, HOST:PORT[/PATH], the path of a device, the name of a ring, or the path of a
// recording.
enum class Form : std::uint8_t { address, address_and_path, device, ring, recording };

enum class Carrier : std::uint8_t { udp, tcp, other };

// Listens: peers or clients contact it. Calls: it contacts the far side, which is fixed. Reads: it is opened here, and
// there is no far side.
enum class Side : std::uint8_t { listens, calls, reads };

// Whom a datagram reaches.
enum class Cast : std::uint8_t { one, broadcast, group };

// Kinds of options. A scheme takes the options of some kinds; `options.cpp` has the kind of each option.
using OptionKinds = std::uint16_t;
namespace takes {
inline constexpr OptionKinds any = 1 << 0;        // name=
inline constexpr OptionKinds link = 1 << 1;       // queues, filters, rates, groups, keys
inline constexpr OptionKinds address = 1 << 2;    // idle=
inline constexpr OptionKinds datagrams = 1 << 3;  // mtu=, rcvbuf=, iface=, ttl=
inline constexpr OptionKinds peers = 1 << 4;      // max_peers=, trusted=
inline constexpr OptionKinds low_latency = 1 << 5;
inline constexpr OptionKinds bind = 1 << 6;
inline constexpr OptionKinds reuse = 1 << 7;
inline constexpr OptionKinds fixed = 1 << 8;
inline constexpr OptionKinds device = 1 << 9;      // baud=, flow=
inline constexpr OptionKinds ring = 1 << 10;       // from=, lossless=, foreign=
inline constexpr OptionKinds recording = 1 << 11;  // speed=, rotate_bytes=, rotate_every=
inline constexpr OptionKinds origin = 1 << 12;     // origin=
inline constexpr OptionKinds fault = 1 << 13;      // fault=, in_fault=, out_fault=, fault_seed=

inline constexpr OptionKinds stream = any | link | address | low_latency | fault;
inline constexpr OptionKinds datagram = stream | datagrams;
}  // namespace takes

struct SchemeRow {
    Scheme scheme;
    std::string_view name;
    Form form;
    Carrier carrier;
    Side side;
    Cast cast;
    OptionKinds options;
    // The scheme of a program at the far side.
    std::string_view counterpart;
    // Asks why nothing was heard: a format text over {address} and {port} of the far side, {local_port}, and {baud}.
    std::string_view if_silent;
    std::string_view help;
    bool is_stream = false;  // what is sent in one piece may arrive in several
};

inline constexpr std::array<SchemeRow, 11> scheme_rows{{
    {.scheme = Scheme::udpin,
     .name = "udpin",
     .form = Form::address,
     .carrier = Carrier::udp,
     .side = Side::listens,
     .cast = Cast::one,
     .options = takes::datagram | takes::peers | takes::reuse,
     .counterpart = "udpout",
     .if_silent = "does the far side send to port {local_port} and to an address of this machine, and does the "
                  "firewall let it in?",
     .help = "binds a port; each peer that sends MAVLink is a link"},
    {.scheme = Scheme::udpout,
     .name = "udpout",
     .form = Form::address,
     .carrier = Carrier::udp,
     .side = Side::calls,
     .cast = Cast::one,
     .options = takes::datagram | takes::bind,
     .counterpart = "udpin",
     .if_silent = "does the far side listen on {address}, and does it answer every sender? PX4 answers only the first "
                  "one: restart it after this program",
     .help = "sends to one address"},
    {.scheme = Scheme::udpbcast,
     .name = "udpbcast",
     .form = Form::address,
     .carrier = Carrier::udp,
     .side = Side::calls,
     .cast = Cast::broadcast,
     .options = takes::datagram | takes::peers | takes::bind | takes::fixed,
     .counterpart = "udpin",
     .if_silent = "does a program on that network listen on port {port}, and does the firewall let answers through?",
     .help = "broadcasts until somebody answers"},
    {.scheme = Scheme::udpmcast,
     .name = "udpmcast",
     .form = Form::address,
     .carrier = Carrier::udp,
     .side = Side::calls,
     .cast = Cast::group,
     .options = takes::datagram | takes::peers,
     .counterpart = "udpmcast",
     .if_silent = "is a program in the group {address}, on the network that iface= or the routing table selects?",
     .help = "sends to a multicast group, and receives what others send there"},
    {.scheme = Scheme::tcpin,
     .name = "tcpin",
     .form = Form::address,
     .carrier = Carrier::tcp,
     .side = Side::listens,
     .cast = Cast::one,
     .options = takes::stream | takes::peers,
     .counterpart = "tcpout",
     .if_silent = "a client is connected: does it send MAVLink?",
     .help = "accepts clients; each is a link",
     .is_stream = true},
    {.scheme = Scheme::tcpout,
     .name = "tcpout",
     .form = Form::address,
     .carrier = Carrier::tcp,
     .side = Side::calls,
     .cast = Cast::one,
     .options = takes::stream | takes::bind,
     .counterpart = "tcpin",
     .if_silent = "{address} accepted the connection: does it send MAVLink?",
     .help = "connects to one address, again and again",
     .is_stream = true},
    {.scheme = Scheme::wsin,
     .name = "wsin",
     .form = Form::address_and_path,
     .carrier = Carrier::tcp,
     .side = Side::listens,
     .cast = Cast::one,
     .options = takes::stream | takes::peers | takes::origin,
     .counterpart = "wsout",
     .if_silent = "a WebSocket client is connected: does it send MAVLink, in binary messages?",
     .help = "accepts WebSocket clients; each is a link"},
    {.scheme = Scheme::wsout,
     .name = "wsout",
     .form = Form::address_and_path,
     .carrier = Carrier::tcp,
     .side = Side::calls,
     .cast = Cast::one,
     .options = takes::stream | takes::bind,
     .counterpart = "wsin",
     .if_silent = "{address} accepted the WebSocket: does it send MAVLink, in binary messages?",
     .help = "connects to one WebSocket server, again and again"},
    {.scheme = Scheme::serial,
     .name = "serial",
     .form = Form::device,
     .carrier = Carrier::other,
     .side = Side::calls,
     .cast = Cast::one,
     .options = takes::any | takes::link | takes::low_latency | takes::device | takes::fault,
     .counterpart = "serial",
     .if_silent = "is it the right port, is the baud rate right ({baud}), are the wires crossed (TX to RX), and does "
                  "the far side send MAVLink on that port?",
     .help = "opens a serial device",
     .is_stream = true},
    {.scheme = Scheme::shm,
     .name = "shm",
     .form = Form::ring,
     .carrier = Carrier::other,
     .side = Side::reads,
     .cast = Cast::one,
     .options = takes::any | takes::link | takes::ring,
     .counterpart = "shm",
     .if_silent = {},
     .help = "a ring in shared memory"},
    {.scheme = Scheme::tlog,
     .name = "tlog",
     .form = Form::recording,
     .carrier = Carrier::other,
     .side = Side::reads,
     .cast = Cast::one,
     .options = takes::any | takes::recording,
     .counterpart = "tlog",
     .if_silent = {},
     .help = "a recording"},
}};

[[nodiscard]] constexpr const SchemeRow& row_of(Scheme scheme) noexcept {
    return scheme_rows[static_cast<std::size_t>(scheme)];
}

[[nodiscard]] constexpr bool has_address(const SchemeRow& row) noexcept {
    return row.form == Form::address || row.form == Form::address_and_path;
}

[[nodiscard]] constexpr std::string_view scheme_name(Scheme scheme) noexcept { return row_of(scheme).name; }

// Null if there is no such scheme.
[[nodiscard]] constexpr const SchemeRow* find_scheme(std::string_view name) noexcept {
    for (const SchemeRow& row : scheme_rows)
        if (row.name == name) return &row;
    return nullptr;
}

// True if endpoints of this scheme have a fixed far side and contact it first. False if peers or clients contact them.
[[nodiscard]] constexpr bool sends_first(Scheme scheme) noexcept { return row_of(scheme).side == Side::calls; }

static_assert(
    [] {
        for (std::size_t i = 0; i < scheme_rows.size(); ++i)
            if (scheme_rows[i].scheme != static_cast<Scheme>(i)) return false;
        return true;
    }(),
    "rows have the order of the enumerators");

}  // namespace mavloom::endpoint
