// SPDX-License-Identifier: MIT
// Any bytes as the messages of several clients to a simulated vehicle, with time passing between them. The vehicle
// neither crashes nor floods its links, its state stays sane, and its telemetry continues.
//
// An input begins with a byte of options (see `options_from`). Then come steps: a byte of which the low four bits
// choose the kind, and its arguments. A message is: index of its id, client, length, payload.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <utility>

#include "mavloom/dialect/dialect.hpp"
#include "mavloom/sim/vehicle.hpp"

namespace {

using namespace mavloom;

void expect(bool holds) {
    if (!holds) std::abort();
}

// Messages that vehicles handle, and some that they ignore. Append only: the corpus counts in this table.
constexpr std::uint16_t known_ids[] = {
    0,   2,   4,   11,  20,  21,  23,  37,  38,  39,  40,  41,  43,  44,  45,  47,  48,  51,  66,  69,    70,
    73,  75,  76,  80,  82,  84,  86,  109, 110, 111, 117, 119, 121, 122, 126, 139, 144, 185, 233, 246,   256,
    258, 268, 282, 284, 286, 287, 320, 321, 323, 331, 400, 412, 102, 138, 132, 149, 234, 300, 385, 11000, 50001};

struct Input {
    const std::uint8_t* at;
    const std::uint8_t* end;
    std::uint8_t byte() { return at == end ? std::uint8_t{0} : *at++; }
    std::uint16_t word() { return static_cast<std::uint16_t>(byte() | byte() << 8); }
};

// Counts, and checks the form of every frame.
class CountingSink final : public sim::Sink {
public:
    void send(LinkId link, const wire::FrameView& frame) override {
        expect(wire::frame_length(frame.bytes()) == frame.size());
        ++frames;
        if (link == LinkId{1} && frame.id() == MessageId{0} && frame.component() == ComponentId{1}) ++heartbeats;
    }
    [[nodiscard]] bool has_room(LinkId link) const override { return !full.at(link.value % full.size()); }

    std::uint64_t frames = 0, heartbeats = 0;
    std::array<bool, 4> full{};
};

sim::VehicleOptions options_from(std::uint8_t bits) {
    sim::VehicleOptions options;
    options.autopilot = (bits & 1) != 0 ? sim::Autopilot::ardupilot : sim::Autopilot::px4;
    options.kind = static_cast<sim::Kind>((bits >> 1) % 3);
    options.has_gimbal = (bits & 8) != 0;
    if ((bits & 16) != 0)
        options.limits = {.mission_items = 5,
                          .fence_items = 4,
                          .rally_items = 2,
                          .files = 3,
                          .file_bytes = 600,
                          .clients = 2,
                          .file_sessions = 1};
    options.motion = (bits & 32) != 0 ? sim::Motion::random : sim::Motion::flight;
    options.ready_after = (bits & 64) != 0 ? Nanoseconds{0} : std::chrono::milliseconds{500};
    if ((bits & 128) != 0) options.utc_at_start = WallTime{std::chrono::hours{24 * 365 * 50}};
    return options;
}

class Life {
public:
    explicit Life(std::uint8_t bits) : vehicle_(options_from(bits), sink_, {}) {
        vehicle_.open(LinkId{1}, {.profile = sim::Profile::lite}, now());
    }

    void step(Input& in) {
        const std::uint8_t kind = in.byte();
        switch (kind & 0xf) {
            case 0: return pass(std::chrono::milliseconds{in.byte()});
            case 1: return pass(std::chrono::milliseconds{20 * in.byte()});
            case 2: return open_link(2u + (kind >> 4 & 1u));
            case 3: return close_link(2u + (kind >> 4 & 1u));
            case 4: sink_.full[kind >> 4 & 3u] = in.byte() >= 64; break;
            case 5: return receive(MessageId{in.word()}, in);
            default: return receive(MessageId{known_ids[in.byte() % std::size(known_ids)]}, in);
        }
    }
    void check() const {
        const sim::VehicleStatus status = vehicle_.status();
        for (const double value :
             {status.altitude_m, status.relative_altitude_m, status.north_m_s, status.east_m_s, status.down_m_s,
              status.roll_deg, status.pitch_deg, status.heading_deg, status.battery_volts})
            expect(std::isfinite(value) && std::abs(value) < 1e7);
        expect(std::abs(status.latitude_deg) <= 90 && std::abs(status.longitude_deg) <= 180);
        expect(status.battery_percent >= 0 && status.battery_percent <= 100);
        // The fastest streams and transfers of three links, and one reply or a list of modes for each message.
        const auto seconds = static_cast<std::uint64_t>(flight_ / std::chrono::seconds{1});
        expect(sink_.frames < (seconds + 1) * 400'000 + messages_ * 2'000);
    }
    // A vehicle that is shut down is silent for good; one that reboots, for some seconds.
    void expect_telemetry() {
        if (vehicle_.next_due() == sim::FlightTime::max()) return;
        sink_.full = {};
        pass(std::chrono::seconds{4});
        if (vehicle_.next_due() == sim::FlightTime::max()) return;
        const std::uint64_t before = sink_.heartbeats;
        pass(std::chrono::seconds{3});
        expect(sink_.heartbeats >= before + 3);
    }
    [[nodiscard]] bool is_old() const { return flight_ > std::chrono::seconds{40}; }

private:
    [[nodiscard]] sim::Moment now() const { return {.flight = flight_, .real = MonoTime{flight_}}; }

    void pass(Nanoseconds time) {
        const sim::FlightTime end = flight_ + time;
        while (vehicle_.next_due() <= end) {
            flight_ = std::max(flight_, vehicle_.next_due());
            vehicle_.advance(now());
        }
        flight_ = end;
        vehicle_.advance(now());
    }

    void open_link(unsigned link) {
        if (std::exchange(is_open_[link], true)) return;
        vehicle_.open(LinkId{link}, {.profile = sim::Profile::lite}, now());
    }
    void close_link(unsigned link) {
        if (std::exchange(is_open_[link], false)) vehicle_.close(LinkId{link});
    }

    void receive(MessageId id, Input& in) {
        constexpr std::array<Source, 4> clients{{{SystemId{255}, ComponentId{190}},
                                                 {SystemId{245}, ComponentId{190}},
                                                 {SystemId{255}, ComponentId{230}},
                                                 {SystemId{1}, ComponentId{195}}}};
        const std::uint8_t from = in.byte(), length = in.byte();
        std::array<std::uint8_t, wire::max_frame_length> bytes{};
        bytes[0] = wire::stx_v2;
        const Source source = clients[from & 3u];
        bytes[5] = source.system.value;
        bytes[6] = source.component.value;
        store_le(bytes.data() + 7, static_cast<std::uint16_t>(id.value));
        std::uint8_t* const payload = bytes.data() + wire::header_length_v2;
        for (unsigned i = 0; i < length; ++i) payload[i] = in.byte();
        const wire::MessageInfo* const info = dialect::default_dialect().wire_table().find(id);
        bytes[1] = length;
        const bool keeps_target = (from & 0x80) != 0;
        if (info != nullptr && !keeps_target) bytes[1] = std::max(length, address(*info, payload));
        const unsigned link = 1u + (from >> 2) % 3;
        if (!is_open_[link]) return;
        ++messages_;
        const std::size_t size = wire::header_length_v2 + bytes[1] + wire::checksum_length;
        vehicle_.receive(LinkId{link}, wire::FrameView::unchecked({bytes.data(), size}), info, now());
    }

    // Writes the vehicle as the target. Returns the length that the payload has to have for it.
    static std::uint8_t address(const wire::MessageInfo& info, std::uint8_t* payload) {
        std::uint8_t least = 0;
        for (const std::uint8_t offset : {info.target_system_offset, info.target_component_offset}) {
            if (offset == wire::MessageInfo::no_target) continue;
            payload[offset] = 1;
            least = std::max(least, static_cast<std::uint8_t>(offset + 1));
        }
        return least;
    }

    CountingSink sink_;
    std::array<bool, 4> is_open_{false, true, false, false};
    sim::FlightTime flight_{};
    std::uint64_t messages_ = 0;
    sim::Vehicle vehicle_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Input in{data, data + size};
    Life life(in.byte());
    while (in.at != in.end && !life.is_old()) {
        life.step(in);
        life.check();
    }
    life.expect_telemetry();
    life.check();
    return 0;
}
