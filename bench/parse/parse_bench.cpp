// SPDX-License-Identifier: MIT
// bench parse: compares our stream parser with the C library's mavlink_parse_char, in turns, on the same bytes of a
// recorded flight. Before the measurement, both must find the same frames in the same order. Prints bytes per second of
// CPU time for each, and the ratio of each turn.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string_view>
#include <vector>

#include "../cpu_time.hpp"
#include "c_library.h"
#include "mavloom/base/bytes.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/wire/stream_parser.hpp"

namespace {

using namespace mavloom;
using bench::cpu_seconds;

// Returns the frames of a tlog without their times, as a serial line would have carried them.
std::vector<std::uint8_t> frames_of(const char* path, const wire::MessageTable& table) {
    std::ifstream in(path, std::ios::binary);
    const std::vector<std::uint8_t> file{std::istreambuf_iterator<char>(in), {}};
    std::vector<std::uint8_t> frames;
    wire::StreamParser parser(table);
    parser.feed(file, MonoTime{}, [&](const wire::ParseEvent& event) {
        if (event.kind != wire::ParseEvent::Kind::frame) return;
        frames.insert(frames.end(), event.frame.bytes().begin(), event.frame.bytes().end());
    });
    return frames;
}

peer_result our_parse(ByteView bytes, std::size_t chunk, const wire::MessageTable& table) {
    peer_result result{};
    wire::StreamParser parser(table);
    const auto sink = [&](const wire::ParseEvent& event) {
        if (event.kind != wire::ParseEvent::Kind::frame) {
            ++result.dropped;
            return;
        }
        ++result.frames;
        result.fingerprint = result.fingerprint * 31 + (event.frame.checksum() ^ event.frame.id().value);
    };
    for (std::size_t at = 0; at < bytes.size(); at += chunk)
        parser.feed(bytes.subspan(at, std::min(chunk, bytes.size() - at)), MonoTime{}, sink);
    parser.finish(sink);
    return result;
}

template <class F>
double bytes_per_second(std::size_t bytes, F&& parse) {
    const double begin = cpu_seconds();
    parse();
    return static_cast<double>(bytes) / (cpu_seconds() - begin);
}

double median(std::vector<double> values) {
    std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
    return values[values.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) {
        fmt::print(stderr, "usage: parse_bench FILE.tlog [CHUNK_BYTES] [TURNS]\n");
        return 2;
    }
    const auto& table = dialect::default_dialect().wire_table();
    const auto frames = frames_of(argv[1], table);
    const std::size_t chunk = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 4096;
    const int turns = argc > 3 ? std::atoi(argv[3]) : 21;

    const auto theirs = peer_parse(frames.data(), frames.size());
    const auto ours = our_parse(frames, chunk, table);
    if (theirs.frames != ours.frames || theirs.fingerprint != ours.fingerprint || ours.dropped != 0 || ours.frames == 0) {
        fmt::print(stderr, "parse_bench: the frames differ: we found {}, the C library {}\n", ours.frames,
                   theirs.frames);
        return 4;
    }

    std::vector<double> our_rate, their_rate, ratio;
    for (int turn = 0; turn < turns; ++turn) {
        peer_result found{}, found_by_peer{};
        our_rate.push_back(bytes_per_second(frames.size(), [&] { found = our_parse(frames, chunk, table); }));
        their_rate.push_back(
            bytes_per_second(frames.size(), [&] { found_by_peer = peer_parse(frames.data(), frames.size()); }));
        if (found.fingerprint != found_by_peer.fingerprint) return 4;
        ratio.push_back(our_rate.back() / their_rate.back());
    }
    const auto [low, high] = std::ranges::minmax(ratio);
    fmt::print("parse and validate {} frames, {} bytes, chunks of {} bytes, {} turns, same frames found\n", ours.frames,
               frames.size(), chunk, turns);
    fmt::print(
        "  mavloom             {:8.1f} MB/s\n  mavlink_parse_char  {:8.1f} MB/s\n  ratio               {:8.2f} (lowest "
        "{:.2f}, highest {:.2f})\n",
        median(our_rate) / 1e6, median(their_rate) / 1e6, median(ratio), low, high);
}
