// SPDX-License-Identifier: MIT
// States what is wrong with links, where, why, and what to do: pure functions from what was heard to findings.
//
// `Evidence` is a snapshot; nothing here reads a clock, a socket or a file. docs/guide/doctor.md lists the findings.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/durations.hpp"
#include "mavloom/base/ids.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/observe/alarm.hpp"
#include "mavloom/observe/asked_rates.hpp"
#include "mavloom/observe/frame_log.hpp"
#include "mavloom/observe/hop.hpp"
#include "mavloom/observe/inspector.hpp"
#include "mavloom/observe/loss.hpp"
#include "mavloom/observe/radio_reports.hpp"
#include "mavloom/observe/sender_streams.hpp"

namespace mavloom::observe {

struct Finding {
    enum class Severity : std::uint8_t { error, warning };

    std::string_view id;  // stable: "radio-loss"
    Severity severity = Severity::warning;
    std::string where{};   // "1/1 by udpin://0.0.0.0:14550#192.168.1.7:14550"
    std::string what{};    // one sentence, or two
    std::string why{};     // may be empty
    std::string remedy{};  // what to do
    // Those that it is about, for programs.
    std::string source{}, link{};
    std::optional<Source> sender{};
    std::optional<MessageId> message{};
};

// "error", "warning"
[[nodiscard]] std::string_view name_of(Finding::Severity severity) noexcept;

// One of the sources that were listened to.
struct Listened {
    enum class Kind : std::uint8_t { listens, calls, serial, ring, recording };

    std::string name;
    Kind kind = Kind::listens;
    bool is_asked = true;    // by the user; else it was tried because something may be there
    bool is_up = true;       // a recording is; a ring is if it is there
    Nanoseconds duration{};  // that was listened for, or of the recording
    std::string refusal{};   // why it could not be opened
    bool is_taken = false;   // it could not be opened because another program has the port or device
    std::string failure{};   // why it is not connected
    std::string silence{};   // what to check if nothing was heard
    std::uint32_t baud = 0;  // of a serial port, if known
    std::uint64_t rcvbuf_asked = 0, rcvbuf_granted = 0;  // bytes; 0: it has none
    std::vector<NamedCount> counts{};

    [[nodiscard]] std::uint64_t count(std::string_view counter) const noexcept;
};

// A link, with the source that it belongs to.
struct HeardLink {
    LinkId id{};
    std::string name;
    std::size_t source = 0;  // its place in Evidence::sources
};

// The frames of one message of one sender on one link; of several instances, those that came most often.
struct Stream {
    LinkId link{};
    Source source{};
    MessageId id{};
    std::string_view name{};  // empty: it has no definition
    std::uint64_t count = 0, bytes = 0;
    double hz = 0;
};

struct BadChecksum {
    LinkId link{};
    MessageId id{};
    std::uint64_t count = 0;
};

struct Evidence {
    const dialect::Dialect* dialect = nullptr;
    bool is_recorded = false;
    Nanoseconds duration{};  // of the longest source
    std::vector<Listened> sources{};
    std::vector<HeardLink> links{};
    std::vector<SenderLoss> losses{};  // of each sender on each link
    std::vector<Stream> streams{};
    std::vector<Vehicle> vehicles{};
    std::vector<Alarm> alarms{};
    std::vector<RadioReport> radios{};
    std::vector<BadChecksum> bad_checksums{};
    std::vector<std::vector<SenderStream>> senders{};  // for each source, as the next
    std::vector<std::vector<AskedRate>> asked{};
    // Between a source and the next one; for one source nothing.
    std::vector<std::vector<Passage>> passages{};
    std::vector<Hop> hops_before{}, hops_after{};  // at the begin and at the end
    // When programs had time to notice that ports are open now; empty if it was not listened for so long.
    std::vector<Hop> hops_settled{};
    std::uint64_t buffer_full = 0;  // frames that this program was too slow for

    // Null, empty, or 0 if there is none.
    [[nodiscard]] const HeardLink* link(LinkId id) const noexcept;
    [[nodiscard]] const Listened* source_of(LinkId link) const noexcept;
    [[nodiscard]] std::string_view name_of(LinkId link) const noexcept;
    [[nodiscard]] double seconds() const noexcept { return mavloom::seconds(duration); }
};

// The streams of the table, for Evidence.
[[nodiscard]] std::vector<Stream> streams_of(const LatestTable& latest);

// Errors first.
[[nodiscard]] std::vector<Finding> diagnose(const Evidence& evidence);

}  // namespace mavloom::observe
