// SPDX-License-Identifier: MIT
// The loop of `mavloom relay`. Frames from the sources pass through the editing stage to the destinations. Answers from
// the destinations go back to the sources. docs/guide/relay.md describes what a user sees.
//
// Recordings wait until every destination has a peer; live sources do not wait. If a queue is full, the relay stops
// reading recordings and lossless rings, so that its queues drop nothing. If the writer of a lossless ring then has no
// room, it acts by its own policy: it waits, drops new records or overwrites unread ones.
//
// One owner thread, which also drives the links. All objects that are passed to the constructor must outlive the relay.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "mavloom/edit/stage.hpp"
#include "mavloom/feed/destinations.hpp"
#include "mavloom/feed/sources.hpp"
#include "mavloom/feed/totals.hpp"
#include "mavloom/link/silence_watch.hpp"

namespace mavloom::feed {

// A relay reports here while it runs. It calls these functions on its own thread.
class RelayHandler {
public:
    virtual ~RelayHandler() = default;
    // Called before each turn; true ends the relay. To end a turn that waits, call Sources::wake.
    virtual bool should_stop() { return false; }
    // `on_waiting`: a recording waits because a destination has no peer yet. `on_started`: that wait is over.
    virtual void on_waiting() {}
    virtual void on_started() {}
    virtual void on_link_up(std::string_view /*name*/) {}
    virtual void on_link_down(std::string_view /*name*/, std::string_view /*why*/) {}
    // LinkHandler::on_notice.
    virtual void on_notice(std::string_view /*text*/) {}
};

struct RelayOutcome {
    Totals totals;                        // of the sources
    std::uint64_t unheard_answers = 0;    // answers for which there was no source
    bool is_incomplete = false;           // all sources were recordings, and a destination lost frames
    bool reached_no_destination = false;  // there were frames, or waiting recordings, and no destination took any frame
    std::optional<SetupError> write_error, read_error;  // of the first file or recording that failed
};

class Relay : private link::LinkHandler {
public:
    // `on`: the stage signs. Only then does the relay read the clock for each frame.
    enum class Signing : bool { off, on };

    Relay(Sources& sources, Destinations& destinations, edit::Stage& stage, RelayHandler& handler,
          Signing signing = Signing::off)
        : sources_(sources), destinations_(destinations), stage_(stage), handler_(handler), signing_(signing) {}

    // Relays until `end`, until `should_stop` returns true, until all recordings have ended, or until a file fails.
    // Then it delivers the frames that had already arrived, sends those that are queued (for at most 5 s) and closes
    // the files. Call it once.
    [[nodiscard]] RelayOutcome run(MonoTime end);

private:
    static constexpr std::size_t frames_a_turn = 1024;  // from recordings and rings
    static constexpr std::chrono::seconds longest_flush{5}, longest_turn{1};
    static constexpr std::chrono::milliseconds room_poll_interval{1};  // how often a full queue is checked for room
    static constexpr std::chrono::seconds maintain_interval{1};

    void on_frame(const link::RxFrame& rx) override;
    void on_link_up(LinkId link, link::EndpointId endpoint, std::string_view name) override {
        silence_.on_link_up(link, endpoint, mono_now());
        handler_.on_link_up(name);
    }
    void on_link_down(LinkId link, link::EndpointId, std::string_view why) override {
        silence_.on_link_down(link, sources_.links().counters(link));
        handler_.on_link_down(sources_.links().link_name(link), why);
    }
    void on_notice(link::EndpointId, std::string_view text) override { handler_.on_notice(text); }

    void turn(MonoTime end);
    void watch_sources(MonoTime now);
    void maintain(MonoTime now);
    void wait_for_peers();
    [[nodiscard]] std::size_t room() const;
    [[nodiscard]] RelayOutcome finish();

    Sources& sources_;
    Destinations& destinations_;
    edit::Stage& stage_;
    RelayHandler& handler_;
    Signing signing_;
    link::SilenceWatch silence_;  // of the sources
    MonoTime maintain_due_{};
    std::uint64_t unheard_answers_ = 0;
    bool has_started_ = false;  // every destination had a peer
    bool has_waited_ = false;
};

}  // namespace mavloom::feed
