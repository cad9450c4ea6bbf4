// SPDX-License-Identifier: MIT
// Differential: the same bytes whole and in chunks (whose sizes come from the bytes) must give the same frames and
// count every byte once.
#include <cstdint>
#include <cstdlib>

#include "mavloom/wire/stream_parser.hpp"
#include "support/golden_frames.hpp"
#include "support/parse_log.hpp"

using namespace mavloom;

static void require(bool condition) {
    if (!condition) std::abort();
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const wire::MessageTable table{test::golden_messages};
    const ByteView bytes{data, size};
    wire::StreamParser whole{table}, chunked{table};
    test::ParseLog expected, actual;

    whole.feed(bytes, MonoTime{}, expected);
    whole.finish(expected);
    for (std::size_t at = 0; at < size;) {
        const std::size_t chunk = std::min<std::size_t>(size - at, 1u + data[at] % 97u * 3u);  // short and long ones
        chunked.feed(bytes.subspan(at, chunk), MonoTime{}, actual);
        at += chunk;
    }
    chunked.finish(actual);

    require(actual.events == expected.events && actual.frames == expected.frames);
    const auto& c = chunked.counters();
    require(c.frame_bytes.value() + c.flagged_bytes.value() + c.junk_bytes.value() == size);
    return 0;
}
