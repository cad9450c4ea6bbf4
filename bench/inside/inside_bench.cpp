// SPDX-License-Identifier: MIT
// bench inside: measures what a frame costs in the router between the system calls.
// The steps are those of the router: parse, watch the sequence, count, route, queue, gather. The frames come from a
// recorded flight, with one vehicle on one link and one ground station on another. There are no sockets, and none of
// the look-ups with which Links finds a link, its counters and a message's class. Before the measurement, every frame
// must come out unchanged. Prints nanoseconds of CPU time per frame, from the fastest turn, because other load on the
// machine can only make a turn slower.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <vector>

#include "../cpu_time.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/net/block_queue.hpp"
#include "mavloom/observe/traffic_table.hpp"
#include "mavloom/route/engine.hpp"
#include "mavloom/wire/datagram_parser.hpp"
#include "mavloom/wire/sequence.hpp"
#include "mavloom/wire/stream_parser.hpp"

namespace {

using namespace mavloom;

constexpr LinkId vehicle{1}, station{2};
constexpr std::size_t mtu_bytes = 1280, datagrams_per_turn = 4;
constexpr std::uint8_t telemetry = 2;

struct Datagrams {
    std::vector<std::uint8_t> bytes;
    std::vector<ByteView> each;
    std::size_t frames = 0;
};

// Returns true if the frame may have a target. Its target is not in this network, so it is left out; all other frames
// are broadcast.
bool may_have_target(const wire::ParseEvent& event) noexcept {
    return event.info == nullptr || event.info->target_system_offset < event.frame.payload().size();
}

Datagrams load(const char* path, const wire::MessageTable& table, std::size_t per_datagram) {
    std::ifstream in(path, std::ios::binary);
    const std::vector<std::uint8_t> file{std::istreambuf_iterator<char>(in), {}};
    Datagrams result;
    std::vector<std::size_t> ends;
    wire::StreamParser parser(table);
    parser.feed(file, MonoTime{}, [&](const wire::ParseEvent& event) {
        if (event.kind != wire::ParseEvent::Kind::frame || may_have_target(event)) return;
        result.bytes.insert(result.bytes.end(), event.frame.bytes().begin(), event.frame.bytes().end());
        if (++result.frames % per_datagram == 0) ends.push_back(result.bytes.size());
    });
    result.frames = ends.size() * per_datagram;
    result.bytes.resize(ends.empty() ? 0 : ends.back());
    for (std::size_t from = 0; const std::size_t end : ends) {
        result.each.push_back(ByteView(result.bytes).subspan(from, end - from));
        from = end;
    }
    return result;
}

enum class Until { parse, sequence, count, route, queue };
constexpr std::array step_names{"parse", "watch the sequence", "count by message", "route", "queue and gather"};

// The steps of Links and Router for a frame.
class Way {
public:
    Way() : parser_(table_), engine_(table_, {}) {
        engine_.add_link(vehicle, {});
        engine_.add_link(station, {});
    }

    template <Until until, class Out>
    void pass(const Datagrams& datagrams, MonoTime begin, Out&& out) {
        MonoTime now = begin;
        for (std::size_t i = 0; i < datagrams.each.size(); ++i) {
            parser_.parse(datagrams.each[i], [&](const wire::ParseEvent& event) { on_event<until>(event, now); });
            if ((i + 1) % datagrams_per_turn != 0) continue;
            flush(out);
            now += std::chrono::microseconds{100};
        }
        flush(out);
    }
    [[nodiscard]] std::size_t frames() const noexcept { return frames_; }

private:
    template <Until until>
    void on_event(const wire::ParseEvent& event, MonoTime now) {
        if (event.kind != wire::ParseEvent::Kind::frame) return;
        ++frames_;
        if constexpr (until >= Until::sequence) tracker_.update(event.frame, event.info);
        const std::uint64_t mark = until >= Until::route ? engine_.mark_of(event.frame) : 0;
        if constexpr (until >= Until::count) traffic_.add(vehicle, event.frame, WallTime{now.time_since_epoch()});
        if constexpr (until >= Until::route)
            for (const LinkId link : engine_.route(event.frame, mark, event.info, vehicle, now).links)
                if (until >= Until::queue && link == station) queue_.push(event.frame.bytes(), telemetry, 0, now);
    }

    template <class Out>
    void flush(Out&& out) {
        std::array<iovec, 64> room;
        auto position = queue_.front();
        while (true) {
            const auto gathered = queue_.gather(position, mtu_bytes, room);
            if (gathered.blocks == 0) break;
            for (std::size_t i = 0; i < gathered.pieces; ++i)
                out(ByteView{static_cast<const std::uint8_t*>(room[i].iov_base), room[i].iov_len});
            queue_.pop(position);
            position = queue_.front();
        }
    }

    const wire::MessageTable& table_ = dialect::default_dialect().wire_table();
    wire::DatagramParser parser_;
    wire::SequenceTracker tracker_;
    observe::TrafficTable traffic_;
    route::Engine engine_;
    net::BlockQueue queue_{net::BlockQueue::Limits{.max_bytes = 1 << 20}};
    std::size_t frames_ = 0;
};

bool passes_unchanged(const Datagrams& datagrams) {
    std::vector<std::uint8_t> out;
    Way way;
    way.pass<Until::queue>(datagrams, MonoTime{std::chrono::hours{1}},
                           [&](ByteView bytes) { out.insert(out.end(), bytes.begin(), bytes.end()); });
    return way.frames() == datagrams.frames && out == datagrams.bytes;
}

// Runs the flight once, up to a step. Each turn has later times than the one before, so that no frame counts as an echo
// or a copy.
template <Until until>
void take(const Datagrams& datagrams, Way& way, int turn, double& fastest) {
    const MonoTime begin{std::chrono::hours{1 + turn}};
    const double from = bench::cpu_seconds();
    way.pass<until>(datagrams, begin, [](ByteView) {});
    fastest = std::min(fastest, 1e9 * (bench::cpu_seconds() - from) / static_cast<double>(datagrams.frames));
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) {
        fmt::print(stderr, "usage: inside_bench FILE.tlog [FRAMES_PER_DATAGRAM] [TURNS]\n");
        return 2;
    }
    const std::size_t per_datagram = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 8;
    const int turns = argc > 3 ? std::atoi(argv[3]) : 101;
    if (per_datagram == 0 || turns < 1) return 2;
    const auto datagrams = load(argv[1], dialect::default_dialect().wire_table(), per_datagram);
    if (datagrams.frames == 0) {
        fmt::print(stderr, "inside_bench: {} has no such frames\n", argv[1]);
        return 1;
    }
    if (!passes_unchanged(datagrams)) {
        fmt::print(stderr, "inside_bench: the frames that came out differ from those that went in\n");
        return 4;
    }
    std::array<double, step_names.size()> ns;
    ns.fill(1e9);
    std::array<Way, step_names.size()> ways;
    for (int turn = 0; turn < turns; ++turn) {
        take<Until::parse>(datagrams, ways[0], turn, ns[0]);
        take<Until::sequence>(datagrams, ways[1], turn, ns[1]);
        take<Until::count>(datagrams, ways[2], turn, ns[2]);
        take<Until::route>(datagrams, ways[3], turn, ns[3]);
        take<Until::queue>(datagrams, ways[4], turn, ns[4]);
    }
    fmt::print("inside the router: {} frames, {} a datagram, {} turns, all came out unchanged\n", datagrams.frames,
               per_datagram, turns);
    for (std::size_t i = 0; i < ns.size(); ++i)
        fmt::print("  {:<20} {:7.1f} ns a frame, {:6.1f} with all above\n", step_names[i],
                   ns[i] - (i == 0 ? 0 : ns[i - 1]), ns[i]);
}
