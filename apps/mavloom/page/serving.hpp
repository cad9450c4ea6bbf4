// SPDX-License-Identifier: MIT
// Passes frames from a receiver to an audience, such as the server of `mavloom web`, on the calling thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "command.hpp"
#include "mavloom/dialect/filter.hpp"
#include "mavloom/endpoint/endpoint.hpp"
#include "mavloom/feed/receiver.hpp"
#include "mavloom/web/server.hpp"

namespace mavloom::app {

// Its functions are those of web::Server.
class Audience {
public:
    virtual ~Audience() = default;
    virtual void take(const observe::Heard& heard) = 0;
    virtual void flush() = 0;  // after each batch
    virtual void note_counts(observe::OwnCounts counts) = 0;
    virtual void note_end(LinkId link) = 0;
    [[nodiscard]] virtual std::uint64_t left_out() const = 0;
};

class ServerAudience : public Audience {
public:
    explicit ServerAudience(web::Server& server) : server_(server) {}
    void take(const observe::Heard& heard) override { server_.take(heard); }
    void flush() override { server_.flush(); }
    void note_counts(observe::OwnCounts counts) override { server_.note_counts(std::move(counts)); }
    void note_end(LinkId link) override { server_.note_end(link); }
    [[nodiscard]] std::uint64_t left_out() const override { return server_.left_out(); }

private:
    web::Server& server_;
};

class Serving {
public:
    // Of the receiver. Frames that arrive within this time are passed together: each time wakes its thread, this one
    // and that of the audience.
    static constexpr std::chrono::milliseconds rest{20};

    struct Options {
        dialect::Filter filter{};
        std::uint64_t count = 0;  // ends after so many frames; 0: no limit
        std::function<void(const wire::FrameView&, WallTime)> on_frame{};
        std::function<void(const wire::FrameView&)> on_arrival{};  // of those that the filter leaves out, too
    };
    Serving(const Common& common, Options options, feed::Receiver& receiver, Audience& audience)
        : common_(common), options_(std::move(options)), receiver_(receiver), audience_(audience) {}

    // Serves until the receiver stops or all its sources end. The receiver must have been started.
    void run();
    // Passes the receiver's counts of this moment. Any thread; call it about twice a second.
    void note_counts();
    // False after `count` frames.
    [[nodiscard]] bool is_going() const noexcept { return going_; }

private:
    static constexpr int frames_at_once = 256;

    void pass_some(MonoTime now);

    const Common& common_;
    Options options_;
    feed::Receiver& receiver_;
    Audience& audience_;
    std::uint64_t frames_ = 0;
    bool going_ = true, has_said_ = false;
};

// Errors name `option`, which has the place; `access` has all but the addresses.
[[nodiscard]] SetupResult<std::unique_ptr<web::Server>> open_server(const dialect::Dialect& dialect,
                                                                    const endpoint::HostPort& place,
                                                                    std::string_view option, web::Options access = {});

// Where a browser on this machine finds the server.
// `has_token`: clients need one, so the place has room for it.
[[nodiscard]] std::string place_of(const net::Address& address, bool has_token = false);

}  // namespace mavloom::app
