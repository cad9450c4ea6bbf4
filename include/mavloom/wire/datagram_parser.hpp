// SPDX-License-Identifier: MIT
// Finds the MAVLink frames in one datagram at a time. A frame never continues in the next datagram.
// Use one parser per peer, because it learns the CRC_EXTRA of message ids that have no definition.
// One owner thread; allocates nothing after construction.
#pragma once

#include "mavloom/wire/detail/scanner.hpp"

namespace mavloom::wire {

class DatagramParser {
public:
    // `table` must outlive the parser.
    explicit DatagramParser(const MessageTable& table) : scanner_(table) {}

    // Calls sink(const ParseEvent&) for everything in the datagram, in order. The views point into `datagram`.
    template <class Sink>
    void parse(ByteView datagram, Sink&& sink) {
        scanner_.scan(datagram, detail::End::closed, sink);
        scanner_.end_junk(sink);
    }

    [[nodiscard]] const ParseCounters& counters() const noexcept { return scanner_.counters(); }

private:
    detail::Scanner scanner_;
};

}  // namespace mavloom::wire
