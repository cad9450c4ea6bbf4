// SPDX-License-Identifier: MIT
// shm_latency line|ring|futex|pipe ROUNDS: measures how long 64 bytes take from one core to another, as half of a round
// trip between two threads that are pinned to two cores. `line` passes a single word in a cache line, the minimum.
// Prints the median and the 99.9th percentile in ns.
#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

#include "records.hpp"
#include "ring_transport.hpp"

using namespace mavloom;
using namespace mavloom::bench;

namespace {

void keep_on(unsigned core) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(core, &set);
    ::pthread_setaffinity_np(::pthread_self(), sizeof set, &set);
}

// One direction of a transport. `give` sends number `n` and `take` waits for it. Numbers start at 1.
class Line {
public:
    explicit Line(std::string_view) {}
    void open_for_reading() {}
    void give(std::uint64_t n) { word_.store(n, std::memory_order_release); }
    void take(std::uint64_t n) {
        while (word_.load(std::memory_order_acquire) != n) {}
    }

private:
    alignas(128) std::atomic<std::uint64_t> word_{0};
    char rest_of_line_[120]{};
};

void expect(std::uint64_t n, ByteView record) {
    if (NumberedRecords().matches(n, record)) return;
    std::fprintf(stderr, "record %llu is not what was written\n", static_cast<unsigned long long>(n));
    std::exit(1);
}

template <bool spin>
class Ring {
public:
    explicit Ring(std::string_view direction) : transport_(direction), writer_(transport_.writer()) {}
    void open_for_reading() { reader_.emplace(or_exit(transport_.open({.lossless = true, .spin = spin}))); }
    void give(std::uint64_t n) {
        writer_.write(0, records_[n]);
        if (!spin) writer_.flush(0);
    }
    void take(std::uint64_t n) {
        const auto record = reader_->read();
        if (!record) std::exit(1);
        expect(n, record->data);
    }

private:
    RingTransport transport_;
    RingTransport::Writer writer_;
    std::optional<shm::RingReader> reader_;
    NumberedRecords records_;
};

class Pipe {
public:
    explicit Pipe(std::string_view) {
        if (::pipe(ends_) != 0) std::exit(1);
    }
    void open_for_reading() {}
    void give(std::uint64_t n) {
        const ByteView record = records_[n];
        if (::write(ends_[1], record.data(), record.size()) != static_cast<ssize_t>(record.size())) std::exit(1);
    }
    void take(std::uint64_t n) {
        std::uint8_t record[NumberedRecords::bytes];
        if (::read(ends_[0], record, sizeof record) != sizeof record) std::exit(1);
        expect(n, record);
    }

private:
    int ends_[2]{};
    NumberedRecords records_;
};

template <class Way>
void measure(std::uint64_t rounds) {
    Way there("there"), back("back");
    there.open_for_reading();
    back.open_for_reading();
    const std::jthread echo([&] {
        keep_on(1);
        for (std::uint64_t n = 1; n <= rounds; ++n) {
            there.take(n);
            back.give(n);
        }
    });
    keep_on(0);
    std::vector<std::int64_t> halves(rounds);
    for (std::uint64_t n = 1; n <= rounds; ++n) {
        const auto start = std::chrono::steady_clock::now();
        there.give(n);
        back.take(n);
        halves[n - 1] = (std::chrono::steady_clock::now() - start).count() / 2;
    }
    halves.erase(halves.begin(), halves.begin() + static_cast<std::ptrdiff_t>(rounds / 10));
    std::ranges::sort(halves);
    std::printf("%lld %lld\n", static_cast<long long>(halves[halves.size() / 2]),
                static_cast<long long>(halves[halves.size() * 999 / 1000]));
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    const std::string_view way = argv[1];
    const std::uint64_t rounds = std::strtoull(argv[2], nullptr, 10);
    if (rounds < 10) return 2;
    if (way == "line") measure<Line>(rounds);
    else if (way == "ring") measure<Ring<true>>(rounds);
    else if (way == "futex") measure<Ring<false>>(rounds);
    else if (way == "pipe") measure<Pipe>(rounds);
    else return 2;
    return 0;
}
