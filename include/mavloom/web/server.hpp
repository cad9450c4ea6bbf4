// SPDX-License-Identifier: MIT
// The server of `mavloom web`: live telemetry for viewers (Foxglove, Lichtblick, PlotJuggler) by the Foxglove WebSocket
// protocol, and for `curl` as JSON. docs/guide/web.md describes what clients see.
//
// It has a thread of its own for the network. One other thread calls `take` and `flush`. Clients only read. One that
// reads slowly loses the oldest telemetry first, and disturbs nobody else.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "mavloom/base/result.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/message/format.hpp"
#include "mavloom/net/address.hpp"
#include "mavloom/observe/alarm.hpp"
#include "mavloom/observe/heard.hpp"
#include "mavloom/observe/hop.hpp"
#include "mavloom/observe/own_counts.hpp"

namespace mavloom::web {

struct Options {
    std::vector<net::Address> addresses{};  // with port 0, the kernel chooses one
    std::vector<std::string> hosts{};       // further names of this machine, for the Host header
    std::string hosts_option{};             // of the program, that adds to them; empty: it has none
    std::vector<std::string> origins{};     // pages that may connect, as in "https://app.example.com"; "*": all
    std::string token{};                    // of read_token; each client must send it. Empty: all may read
};

// The routes that a router has learned.
struct RoutesOf {
    std::string router;
    std::string error{};                // why they are not known; empty: they are
    std::vector<std::string> routes{};  // each a JSON object, as the router's control socket reports it
};

class Server {
public:
    // Each message of each source, and each instance of it, is a channel. Frames of further ones are only counted.
    static constexpr std::size_t max_channels = 20'000;

    // `dialect` must outlive the server. `in_use` names the process that holds the port.
    [[nodiscard]] static SetupResult<std::unique_ptr<Server>> listen(const dialect::Dialect& dialect,
                                                                     const Options& options);
    ~Server();

    // Queues the frame for all clients that subscribe to its channel.
    void take(const observe::Heard& heard);
    // Sends what `take` queued. Call it after each batch.
    void flush();
    // The counts of the receiver of the frames. Reports show them from the next `set_hops` on. Any thread may call it.
    void note_counts(observe::OwnCounts counts);
    // The programs on the way of the frames, in the order in which frames pass them, with their counts of this moment.
    // The server adds itself as the last one. Call it about twice a second.
    void set_hops(std::vector<observe::Hop> hops);
    // The link, a recording, has ended, so its senders are not silent.
    void note_end(LinkId link);
    // Whether clients wait for `set_routes`, which answers /api/v1/routes. Any thread may call both.
    [[nodiscard]] bool wants_routes() const;
    void set_routes(const std::vector<RoutesOf>& routers);
    [[nodiscard]] std::vector<observe::Alarm> alarms() const;
    // Frames that have no channel, because there are max_channels of them.
    [[nodiscard]] std::uint64_t left_out() const;

    [[nodiscard]] const std::vector<net::Address>& addresses() const noexcept;

private:
    class Impl;
    explicit Server(std::unique_ptr<Impl> impl) noexcept;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mavloom::web
