// SPDX-License-Identifier: MIT
// Measures how many records per second go from one writer to several readers, in threads or in processes, over any
// transport. A transport returns its two sides from `writer()` and `reader(number)`, which are called in the thread or
// process that uses the side:
//     Writer: void write(const Shared&, ByteView record);  void flush(const Shared&);
//     Reader: void poll(each);     calls each(ByteView) for the records that have arrived, in order and without a gap
// Readers compare every record with what was written: its first and last word, or all bytes.
#pragma once

#include <sched.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <thread>
#include <vector>

#include "records.hpp"

namespace mavloom::bench {

inline constexpr unsigned max_readers = 3;

struct Plan {
    unsigned readers = 1;
    bool processes = false;
    std::uint64_t records = 10'000'000;
    std::uint64_t before = 1'000'000;  // warm-up records, which are not timed
};

// The state that both sides share, apart from the measured transport.
struct Shared {
    struct alignas(128) Reader {
        std::atomic<std::uint64_t> taken{0};
        std::atomic<bool> ready{false};
    };
    std::array<Reader, max_readers> readers;
    unsigned count = 0;

    [[nodiscard]] std::uint64_t slowest() const noexcept {
        std::uint64_t least = readers[0].taken.load(std::memory_order_acquire);
        for (unsigned i = 1; i < count; ++i) least = std::min(least, readers[i].taken.load(std::memory_order_acquire));
        return least;
    }
    void wait_for(std::uint64_t records) const noexcept {
        while (slowest() < records) ::sched_yield();
    }
    void wait_until_ready() const noexcept {
        for (unsigned i = 0; i < count; ++i)
            while (!readers[i].ready.load(std::memory_order_acquire)) ::usleep(100);
    }
};

inline Shared& make_shared_page(unsigned readers) {
    void* const page = ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (page == MAP_FAILED) std::abort();
    auto& shared = *new (page) Shared;
    shared.count = readers;
    return shared;
}

// Updates `taken` only now and then. Otherwise the benchmark would measure the shared cache line that holds it.
template <class Transport, class Records>
void read_all(Transport& transport, const Records& records, unsigned number, Shared::Reader& self, const Plan& plan) {
    auto reader = transport.reader(number);
    self.ready.store(true, std::memory_order_release);
    std::uint64_t next = 0, told = 0;
    const std::uint64_t all = plan.before + plan.records;
    while (next < all) {
        reader.poll([&](ByteView bytes) {
            if (!records.matches(next, bytes)) {
                std::fprintf(stderr, "record %llu of reader %u is not what was written\n",
                             static_cast<unsigned long long>(next), number);
                std::_Exit(1);
            }
            ++next;
        });
        if (next - told < 64 && next != plan.before && next != all) continue;
        self.taken.store(next, std::memory_order_release);
        told = next;
    }
}

template <class Transport, class Records>
double write_all(Transport& transport, const Records& records, const Shared& shared, const Plan& plan) {
    auto writer = transport.writer();
    shared.wait_until_ready();
    std::uint64_t next = 0;
    const auto write_up_to = [&](std::uint64_t end) {
        for (; next < end; ++next) writer.write(shared, records[next]);
        writer.flush(shared);
        shared.wait_for(end);
    };
    write_up_to(plan.before);
    const auto start = std::chrono::steady_clock::now();
    write_up_to(plan.before + plan.records);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Runs `run` in a child process, which then exits. wait_for_processes() ends the program if a child failed.
template <class Run>
void start_process(Run&& run) {
    if (::fork() != 0) return;
    run();
    std::_Exit(0);
}

inline void wait_for_processes() {
    for (int status = 0; ::wait(&status) > 0;)
        if (status != 0) std::exit(1);
}

// Runs the measurement and prints records and seconds.
template <class Transport, class Records>
void measure(Transport& transport, const Records& records, const Plan& plan) {
    Shared& shared = make_shared_page(plan.readers);
    std::vector<std::jthread> threads;
    for (unsigned i = 0; i < plan.readers; ++i) {
        const auto read = [&, i] { read_all(transport, records, i, shared.readers[i], plan); };
        if (plan.processes) start_process(read);
        else threads.emplace_back(read);
    }
    const double seconds = write_all(transport, records, shared, plan);
    threads.clear();
    wait_for_processes();
    std::printf("%llu %.6f\n", static_cast<unsigned long long>(plan.records), seconds);
}

}  // namespace mavloom::bench
