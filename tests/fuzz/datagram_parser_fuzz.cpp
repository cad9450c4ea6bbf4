// SPDX-License-Identifier: MIT
// Any datagram: views stay inside it, every byte is counted once; signing and sequence tracking take whatever is found.
#include <cstdint>
#include <cstdlib>

#include "mavloom/wire/datagram_parser.hpp"
#include "mavloom/wire/sequence.hpp"
#include "mavloom/wire/signing.hpp"
#include "support/golden_frames.hpp"

using namespace mavloom;

static void require(bool condition) {
    if (!condition) std::abort();
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const wire::MessageTable table{test::golden_messages};
    wire::DatagramParser parser{table};
    wire::SequenceTracker tracker;
    wire::Verifier verifier{wire::SigningKey{{}}};

    parser.parse({data, size}, [&](const wire::ParseEvent& event) {
        if (event.kind == wire::ParseEvent::Kind::junk) return;
        const auto frame = event.frame;
        require(frame.bytes().data() >= data && frame.bytes().data() + frame.size() <= data + size);
        require(frame.header_length() + frame.payload_length() + wire::checksum_length + frame.signature().size() ==
                frame.size());
        tracker.update(frame);
        require(verifier.verify(frame, {}) != wire::Verifier::Verdict::good || frame.is_signed());
    });

    const auto& c = parser.counters();
    require(c.frame_bytes.value() + c.flagged_bytes.value() + c.junk_bytes.value() == size);
    return 0;
}
