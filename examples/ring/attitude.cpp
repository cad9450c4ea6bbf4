// SPDX-License-Identifier: MIT
// ring_attitude NAME prints each ATTITUDE message in a ring, one per line. It continues when another writer takes over,
// and ends when no record arrives for two seconds.
#include <chrono>
#include <cstdio>
#include <mavloom/dialect/dialect.hpp>
#include <mavloom/msg/attitude.hpp>
#include <mavloom/shm/ring_follower.hpp>
#include <mavloom/wire/datagram_parser.hpp>

using namespace mavloom;

static void show(const wire::ParseEvent& event) {
    if (event.kind != wire::ParseEvent::Kind::frame || event.frame.id() != msg::Attitude::id) return;
    const auto attitude = msg::Attitude::decode(event.frame.payload());
    std::printf("%u %u %u %.6f %.6f %.6f\n", event.frame.system().value, event.frame.component().value,
                attitude.time_boot_ms, attitude.roll, attitude.pitch, attitude.yaw);
}

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("ring_attitude NAME\n", stderr);
        return 2;
    }
    std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);  // a pipe gets each line at once
    shm::RingFollower ring(argv[1], {.lossless = true, .from = shm::ReaderOptions::From::oldest});
    wire::DatagramParser parser(dialect::default_dialect().wire_table());
    const auto next_record = [&] { return ring.read(mono_now() + std::chrono::seconds(2)); };
    auto record = next_record();
    for (; record; record = next_record()) {
        parser.parse(record->data, show);
        // Reads the records that follow in place, without copying them.
        (void)ring.reader()->try_visit(256, [&](const shm::RingRecord& next) { parser.parse(next.data, show); });
    }
    if (const auto* error = ring.error()) std::fprintf(stderr, "%s\n", error->text.c_str());
    std::fprintf(stderr, "%llu records missed\n", static_cast<unsigned long long>(ring.missed()));
    const bool is_damaged = record.error() == shm::ReadError::damaged;
    if (is_damaged) std::fprintf(stderr, "ring %s is damaged\n", argv[1]);
    return ring.opened() == 0 || is_damaged ? 1 : 0;
}
