// SPDX-License-Identifier: MIT
// The lower bound of `bench sim`: sends datagrams of given sizes at given instants, and does nothing else. It sleeps
// until each instant, then sends one datagram.
//
// Usage: bare_sender PORT SCHEDULE. The schedule has a line for each datagram: nanoseconds since the start, and bytes.
// The program begins when it has read it, and repeats it indefinitely, with the time of its last line as its length.
#include <arpa/inet.h>
#include <sys/socket.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <vector>

namespace {

struct Datagram {
    std::int64_t at_ns;
    std::size_t bytes;
};

std::vector<Datagram> read_schedule(const char* path) {
    std::vector<Datagram> schedule;
    std::FILE* const file = std::fopen(path, "r");
    if (file == nullptr) return schedule;
    long long at = 0;
    unsigned long bytes = 0;
    while (std::fscanf(file, "%lld %lu", &at, &bytes) == 2) schedule.push_back({at, bytes});
    std::fclose(file);
    return schedule;
}

void sleep_until(std::int64_t ns) {
    const timespec at{static_cast<std::time_t>(ns / 1'000'000'000), static_cast<long>(ns % 1'000'000'000)};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    const auto schedule = read_schedule(argv[2]);
    if (schedule.empty() || schedule.back().at_ns <= 0) return 3;
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(std::atoi(argv[1])));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    static std::array<char, 65536> bytes{};
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    for (std::int64_t start = std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;; start += schedule.back().at_ns) {
        for (const Datagram& datagram : schedule) {
            sleep_until(start + datagram.at_ns);
            ::sendto(fd, bytes.data(), datagram.bytes, 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
        }
    }
}
