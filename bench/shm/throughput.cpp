// SPDX-License-Identifier: MIT
// shm_throughput ring|ring32|bare|udp READERS threads|processes RECORDS [FLIGHT.tlog [verify]]
// Measures how many records per second go from one writer to READERS lossless readers. Records have 64 bytes, or are
// the frames of FLIGHT.tlog. ring32 is a ring of 32 MiB. Prints the records and the seconds they took.
#include <algorithm>
#include <string_view>

#include "bare_transport.hpp"
#include "mavloom/base/clock.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/record/tlog_reader.hpp"
#include "ring_transport.hpp"
#include "throughput.hpp"
#include "udp_transport.hpp"

using namespace mavloom;
using namespace mavloom::bench;

static std::vector<std::vector<std::uint8_t>> frames_of(const char* flight) {
    auto reader = or_exit(record::TlogReader::open(flight, dialect::default_dialect().wire_table()));
    std::vector<std::vector<std::uint8_t>> frames;
    while (const auto entry = reader.next())
        frames.emplace_back(entry->frame.bytes().begin(), entry->frame.bytes().end());
    return frames;
}

template <class Records>
static int run(std::string_view transport, const Records& records, const Plan& plan) {
    if (transport == "ring" || transport == "ring32") {
        RingTransport ring("throughput", {.capacity = transport == "ring" ? shm::default_capacity : 32 << 20});
        measure(ring, records, plan);
    } else if (transport == "bare" && plan.readers == 1) {
        BareTransport bare;
        measure(bare, records, plan);
    } else if (transport == "udp") {
        UdpTransport udp(plan.readers);
        measure(udp, records, plan);
    } else return 2;
    return 0;
}

int main(int argc, char** argv) {
    if (argc < 5) return 2;
    const std::uint64_t count = std::strtoull(argv[4], nullptr, 10);
    const Plan plan{.readers = static_cast<unsigned>(std::atoi(argv[2])),
                    .processes = std::string_view(argv[3]) == "processes",
                    .records = count,
                    .before = std::min<std::uint64_t>(1'000'000, count)};
    if (plan.readers < 1 || plan.readers > max_readers) return 2;
    if (argc == 5) return run(argv[1], NumberedRecords(), plan);
    const auto frames = frames_of(argv[5]);
    return run(argv[1], RecordedFrames({frames.begin(), frames.end()}, argc > 6), plan);
}
