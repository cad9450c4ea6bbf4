// SPDX-License-Identifier: MIT
// Finds the frames of one datagram: any number of them, and never one that begins in one datagram and ends in another. One parser per peer
// (it remembers the learned CRC_EXTRA of ids without definition). One owner thread; allocates nothing after construction.
#pragma once

#include "mavloom/wire/detail/scanner.hpp"

namespace mavloom::wire {

class DatagramParser {
public:
    // `table` must outlive the parser.
    explicit DatagramParser(const MessageTable& table) : scanner_(table) {}

    // Calls sink(const ParseEvent&) for all that the datagram holds, in order; the views point into `datagram`.
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
