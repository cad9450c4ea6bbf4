// SPDX-License-Identifier: MIT
// What the telemetry contains: at rest against recordings of a real PX4 (tests/data/README.md), in flight against the
// rules that tie its messages together.
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>

#include <GeographicLib/Geodesic.hpp>

#include "mavloom/message/view.hpp"
#include "mavloom/msg/actuator_output_status.hpp"
#include "mavloom/msg/altitude.hpp"
#include "mavloom/msg/attitude.hpp"
#include "mavloom/msg/attitude_quaternion.hpp"
#include "mavloom/msg/battery_status.hpp"
#include "mavloom/msg/command_ack.hpp"
#include "mavloom/msg/command_long.hpp"
#include "mavloom/msg/current_mode.hpp"
#include "mavloom/msg/enums/failure_type.hpp"
#include "mavloom/msg/enums/failure_unit.hpp"
#include "mavloom/msg/enums/mav_cmd.hpp"
#include "mavloom/msg/esc_status.hpp"
#include "mavloom/msg/estimator_status.hpp"
#include "mavloom/msg/extended_sys_state.hpp"
#include "mavloom/msg/global_position_int.hpp"
#include "mavloom/msg/gps_global_origin.hpp"
#include "mavloom/msg/gps_raw_int.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/highres_imu.hpp"
#include "mavloom/msg/hil_state_quaternion.hpp"
#include "mavloom/msg/home_position.hpp"
#include "mavloom/msg/local_position_ned.hpp"
#include "mavloom/msg/odometry.hpp"
#include "mavloom/msg/position_target_local_ned.hpp"
#include "mavloom/msg/scaled_imu.hpp"
#include "mavloom/msg/scaled_pressure.hpp"
#include "mavloom/msg/servo_output_raw.hpp"
#include "mavloom/msg/sys_status.hpp"
#include "mavloom/msg/system_time.hpp"
#include "mavloom/msg/vfr_hud.hpp"
#include "unit/sim/rig.hpp"

namespace mavloom::sim {
namespace {

using message::MessageView;
using test::Rig;
using test::Sent;

const dialect::Dialect& definitions() { return dialect::default_dialect(); }

struct Recorded {
    double seconds;  // since the start of the file
    std::vector<std::uint8_t> bytes;

    [[nodiscard]] wire::FrameView frame() const { return wire::FrameView::unchecked(bytes); }
};

// The frames of vehicle 1/1, all of them MAVLink 2 and unsigned.
std::vector<Recorded> recording(const char* name, double until) {
    std::ifstream file(std::string(MAVLOOM_TEST_DATA "/") + name, std::ios::binary);
    const std::vector<std::uint8_t> bytes(std::istreambuf_iterator<char>(file), {});
    std::vector<Recorded> frames;
    std::uint64_t start = 0;
    for (std::size_t at = 0; at + 20 <= bytes.size();) {
        std::uint64_t time = 0;
        for (int i = 0; i < 8; ++i) time = time << 8 | bytes[at + i];
        if (start == 0) start = time;
        const std::size_t length = bytes[at + 9] + std::size_t{12};
        const double seconds = static_cast<double>(time - start) * 1e-6;
        if (seconds > until) break;
        if (bytes[at + 13] == 1) frames.push_back({seconds, {&bytes[at + 8], &bytes[at + 8] + length}});
        at += 8 + length;
    }
    return frames;
}

MessageView view_of(const wire::FrameView& frame) { return {*definitions().find(frame.id()), frame.payload()}; }

// How far a field may lie from the recording; infinity: it may have any value. Fields that are not listed: integers are
// equal, floats are equal to 0.1 or both NaN.
constexpr double any = std::numeric_limits<double>::infinity();
const std::map<std::string_view, double> tolerances{
    {"SYS_STATUS.load", 130},
    {"SYS_STATUS.voltage_battery", 900},
    {"SYS_STATUS.current_battery", any},  // PX4's simulator does not measure it
    {"BATTERY_STATUS.voltages", any},     // PX4's simulator reports a sum in the field of the first cell
    {"BATTERY_STATUS.current_battery", any},
    {"BATTERY_STATUS.current_consumed", 20},
    {"BATTERY_STATUS.energy_consumed", any},
    {"BATTERY_STATUS.time_remaining", any},
    {"PING.seq", any},
    {"LINK_NODE_STATUS.tx_rate", 10'000},
    {"LINK_NODE_STATUS.rx_rate", any},
    {"LINK_NODE_STATUS.messages_sent", any},
    {"LINK_NODE_STATUS.messages_received", any},
    {"GPS_RAW_INT.lat", 20},
    {"GPS_RAW_INT.lon", 30},
    {"GPS_RAW_INT.alt", 300},
    {"GPS_RAW_INT.alt_ellipsoid", 300},
    {"GPS_RAW_INT.vel", 20},
    {"GPS_RAW_INT.cog", any},  // unknown at rest, where PX4 sends noise
    {"SCALED_PRESSURE.press_abs", 1},
    {"SCALED_PRESSURE.temperature", 400},
    {"GLOBAL_POSITION_INT.lat", 20},
    {"GLOBAL_POSITION_INT.lon", 30},
    {"GLOBAL_POSITION_INT.alt", 100},
    {"GLOBAL_POSITION_INT.relative_alt", 100},
    {"GLOBAL_POSITION_INT.vx", 15},
    {"GLOBAL_POSITION_INT.vy", 15},
    {"GLOBAL_POSITION_INT.vz", 10},
    {"GLOBAL_POSITION_INT.hdg", any},  // both sides of north
    {"VFR_HUD.heading", any},
    {"VFR_HUD.airspeed", any},  // NaN in PX4; here the ground speed
    {"HIGHRES_IMU.xacc", 0.5},
    {"HIGHRES_IMU.yacc", 0.5},
    {"HIGHRES_IMU.zacc", 0.5},
    {"HIGHRES_IMU.abs_pressure", 1},
    {"HIGHRES_IMU.pressure_alt", 1},
    {"HIGHRES_IMU.temperature", 4},
    {"HIGHRES_IMU.fields_updated", any},
    {"HOME_POSITION.latitude", 20},
    {"HOME_POSITION.longitude", 30},
    {"HOME_POSITION.altitude", 100},
    {"ALTITUDE.altitude_monotonic", 1},
    {"ESTIMATOR_STATUS.pos_horiz_accuracy", 0.3},
    {"VIBRATION.vibration_x", 0.2},
    {"VIBRATION.vibration_y", 0.2},
    {"VIBRATION.vibration_z", 0.2},
    {"ODOMETRY.reset_counter", any},
    {"OPEN_DRONE_ID_LOCATION.direction", any},
    {"OPEN_DRONE_ID_LOCATION.speed_horizontal", 20},
    {"OPEN_DRONE_ID_LOCATION.speed_vertical", 20},
    {"OPEN_DRONE_ID_LOCATION.latitude", 20},
    {"OPEN_DRONE_ID_LOCATION.longitude", 30},
    {"OPEN_DRONE_ID_LOCATION.altitude_barometric", 1},
    {"OPEN_DRONE_ID_LOCATION.altitude_geodetic", 1},
    {"OPEN_DRONE_ID_SYSTEM.operator_latitude", 20},
    {"OPEN_DRONE_ID_SYSTEM.operator_longitude", 30},
};

bool is_time(std::string_view field) {
    return field == "time_usec" || field == "time_boot_ms" || field == "time_unix_usec" || field == "ts1" ||
           field == "timestamp";
}

double tolerance_of(const dialect::Message& message, const dialect::Field& field) {
    const auto at = tolerances.find(std::string(message.name) + "." + std::string(field.name));
    if (at != tolerances.end()) return at->second;
    if (is_time(field.name) && message.id().value != 12901) return any;
    return field.type == dialect::FieldType::f32 ? 0.1 : 0;
}

void expect_alike(const MessageView& ours, const MessageView& px4) {
    for (const dialect::Field& field : px4.definition().fields) {
        const double tolerance = tolerance_of(px4.definition(), field);
        for (std::size_t i = 0; i < field.count() && tolerance != any; ++i) {
            const double a = ours.number(field, i), b = px4.number(field, i);
            const bool alike = std::isnan(b) ? std::isnan(a) : std::abs(a - b) <= tolerance;
            EXPECT_TRUE(alike) << px4.definition().name << "." << field.name << "[" << i << "]: " << a << ", PX4 " << b;
        }
    }
}

// The last message of each id that the vehicle sent.
std::map<std::uint32_t, const Sent*> newest(const Rig& rig) {
    std::map<std::uint32_t, const Sent*> by_id;
    for (const Sent& sent : rig.sink.frames) by_id[sent.frame().id().value] = &sent;
    return by_id;
}

// Not compared: GPS_GLOBAL_ORIGIN, which PX4 sent before the recording begins, and messages of services (STATUSTEXT,
// EVENT, CURRENT_EVENT_SEQUENCE).
const std::set<std::uint32_t> no_streams{49, 253, 410, 411};

void expect_like(const Rig& rig, const std::vector<Recorded>& recorded) {
    const auto ours = newest(rig);
    std::set<std::uint32_t> compared;
    for (const Recorded& px4 : recorded) {
        const std::uint32_t id = px4.frame().id().value;
        if (no_streams.contains(id) || !compared.insert(id).second) continue;
        const auto at = ours.find(id);
        ASSERT_NE(at, ours.end()) << view_of(px4.frame()).definition().name;
        expect_alike(view_of(at->second->frame()), view_of(px4.frame()));
    }
    for (const auto& [id, sent] : ours)
        EXPECT_TRUE(compared.contains(id) || no_streams.contains(id))
            << view_of(sent->frame()).definition().name << " is not sent by PX4";
}

TEST(TelemetryAtRest, FieldsAreThoseOfPx4ForAGroundStation) {
    const auto recorded = recording("px4_gcs_flight.tlog", 3.5);  // it is armed after 3.6 s
    ASSERT_GT(recorded.size(), 1000u);
    Rig rig({}, {.profile = Profile::px4_normal});
    rig.run(22.0);

    expect_like(rig, recorded);
}

// The recordings have a flight, and a session in which the client asks for everything.
TEST(TelemetryByDefault, HasOnlyMessagesThatPx4Sends) {
    std::set<std::uint32_t> known = no_streams;
    for (const char* const name : {"px4_gcs_flight.tlog", "px4_gcs_session.tlog", "px4_onboard_rest.tlog"})
        for (const Recorded& px4 : recording(name, 200)) known.insert(px4.frame().id().value);
    Rig rig({}, {.profile = Profile::normal});
    rig.run(4.0);
    ASSERT_TRUE(rig.vehicle.take_off(8));
    rig.run(15.0);

    const auto ours = newest(rig);
    EXPECT_GT(ours.size(), 20u);
    for (const auto& [id, sent] : ours) EXPECT_TRUE(known.contains(id)) << view_of(sent->frame()).definition().name;
}

TEST(TelemetryAtRest, FieldsAreThoseOfPx4ForACompanionComputer) {
    const auto recorded = recording("px4_onboard_rest.tlog", 60);
    ASSERT_EQ(recorded.size(), 70u);
    Rig rig({.utc_at_start = WallTime{std::chrono::seconds{1'795'222'850}}}, {.profile = Profile::px4_onboard});
    rig.run(5.0);
    auto frames = recorded;
    // PX4's simulator has no date for OPEN_DRONE_ID_LOCATION although it has one for SYSTEM_TIME.
    std::erase_if(frames, [](const Recorded& r) { return r.frame().id().value == 12901; });
    std::erase_if(rig.sink.frames, [](const Sent& s) { return s.frame().id().value == 12901; });

    expect_like(rig, frames);
}

// Messages a second in the recordings, which are longer than the files in tests/data: counts of 180 s on the link for
// ground stations and 60 s on that for companion computers. PX4's simulated clock ran at 0.982 and 0.9764 of the
// wall's.
struct Count {
    std::uint32_t id;
    int count;
};

void expect_counts(Profile profile, std::span<const Count> counts, double seconds) {
    Rig rig({.utc_at_start = WallTime{std::chrono::seconds{1'795'222'850}}}, {.profile = profile});
    rig.run(5.0);
    rig.forget();
    rig.run(seconds);
    std::map<std::uint32_t, int> ours;
    for (const Sent& sent : rig.sink.frames) ++ours[sent.frame().id().value];
    for (const auto& [id, count] : counts)
        EXPECT_NEAR(ours[id], count, std::max(2.0, 0.005 * count)) << definitions().find(MessageId{id})->name;
}

TEST(TelemetryAtRest, MessagesComeAtTheRatesOfPx4ForAGroundStation) {
    constexpr Count counts[] = {
        {32, 8838}, {83, 8838}, {85, 8838}, {30, 8837}, {31, 8837},   {33, 8837},   {36, 8837}, {24, 884},
        {74, 707},  {0, 177},   {1, 177},   {8, 177},   {29, 177},    {141, 177},   {245, 177}, {290, 177},
        {291, 177}, {441, 177}, {42, 177},  {132, 88},  {12901, 177}, {12904, 177}, {147, 88},  {230, 88},
        {242, 88},  {436, 88},  {514, 88},  {380, 88},  {4, 18},      {241, 18},
    };
    expect_counts(Profile::px4_normal, counts, 180 * 0.982);
}

TEST(TelemetryAtRest, MessagesComeAtTheRatesOfPx4ForACompanionComputer) {
    constexpr Count counts[] = {
        {30, 5859}, {31, 2929}, {33, 2929}, {105, 2929}, {32, 1757}, {331, 1757}, {36, 586},   {74, 586}, {83, 586},
        {85, 586},  {111, 586}, {132, 586}, {141, 586},  {290, 586}, {291, 586},  {24, 469},   {1, 293},  {245, 293},
        {0, 58},    {2, 58},    {4, 58},    {8, 58},     {29, 58},   {42, 58},    {230, 58},   {441, 58}, {514, 58},
        {147, 29},  {241, 29},  {242, 29},  {380, 29},   {436, 29},  {12901, 58}, {12904, 58},
    };
    expect_counts(Profile::px4_onboard, counts, 60 * 0.9764);
}

// All messages that describe one instant: requested one after the other, so that they show the same state.
struct Instant {
    explicit Instant(Rig& rig) {
        for (const std::uint32_t id : {230, 0,   1,   24,  26,  29,  30,  31,  32,  33,  36,  49, 74,
                                       85,  105, 115, 141, 147, 242, 245, 291, 331, 375, 436, 2})
            rig.send(msg::CommandLong{
                .target_system = 1, .command = msg::MAV_CMD_REQUEST_MESSAGE, .param1 = static_cast<float>(id)});
        for (const Sent& sent : rig.sink.frames) frames[sent.frame().id().value] = sent.bytes;
    }
    template <class Message>
    [[nodiscard]] Message get() const {
        return Message::decode(wire::FrameView::unchecked(frames.at(Message::id.value)).payload());
    }
    std::map<std::uint32_t, std::vector<std::uint8_t>> frames;
};

double degrees(double radians) { return radians * 180 / 3.14159265358979323846; }
// Of two angles in degrees.
double apart(double a, double b) { return std::abs(std::remainder(a - b, 360)); }

void expect_attitudes_agree(const Instant& now) {
    const auto euler = now.get<msg::Attitude>();
    const auto q = now.get<msg::AttitudeQuaternion>();
    const auto odometry = now.get<msg::Odometry>();
    const double w = q.q1, x = q.q2, y = q.q3, z = q.q4;
    EXPECT_NEAR(w * w + x * x + y * y + z * z, 1, 1e-6);
    EXPECT_GE(w, 0);
    EXPECT_NEAR(apart(degrees(std::atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))), degrees(euler.roll)), 0, 1e-3);
    EXPECT_NEAR(apart(degrees(std::asin(2 * (w * y - z * x))), degrees(euler.pitch)), 0, 1e-3);
    EXPECT_NEAR(apart(degrees(std::atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))), degrees(euler.yaw)), 0, 1e-3);
    EXPECT_EQ(odometry.q, (std::array{q.q1, q.q2, q.q3, q.q4}));
    EXPECT_EQ(q.yawspeed, euler.yawspeed);
    EXPECT_EQ(odometry.rollspeed, euler.rollspeed);
    const auto global = now.get<msg::GlobalPositionInt>();
    EXPECT_LT(global.hdg, 36'000);
    EXPECT_NEAR(apart(degrees(euler.yaw), global.hdg / 100.0), 0, 0.0051);
    EXPECT_NEAR(apart(global.hdg / 100.0, now.get<msg::VfrHud>().heading + 0.5), 0, 0.51);
}

// Latitude, longitude and local position by the geodesic from the origin, at the resolution of 1e-7 degrees.
void expect_positions_agree(const Instant& now) {
    const auto local = now.get<msg::LocalPositionNed>();
    const auto global = now.get<msg::GlobalPositionInt>();
    const auto origin = now.get<msg::GpsGlobalOrigin>();
    const auto odometry = now.get<msg::Odometry>();
    double distance = 0, azimuth = 0, back = 0;
    GeographicLib::Geodesic::WGS84().Inverse(origin.latitude * 1e-7, origin.longitude * 1e-7, global.lat * 1e-7,
                                             global.lon * 1e-7, distance, azimuth, back);
    EXPECT_NEAR(distance * std::cos(azimuth * 0.017453292519943295), local.x, 0.03);
    EXPECT_NEAR(distance * std::sin(azimuth * 0.017453292519943295), local.y, 0.03);
    EXPECT_NEAR((global.alt - origin.altitude) * 1e-3, -local.z, 0.0015);
    EXPECT_EQ(global.alt - global.relative_alt, now.get<msg::HomePosition>().altitude);
    EXPECT_EQ(odometry.x, local.x);
    EXPECT_EQ(odometry.z, local.z);
    EXPECT_EQ(odometry.vy, local.vy);
    const auto altitude = now.get<msg::Altitude>();
    EXPECT_NEAR(altitude.altitude_amsl, global.alt * 1e-3, 0.001);
    EXPECT_NEAR(altitude.altitude_relative, global.relative_alt * 1e-3, 0.002);
    EXPECT_NEAR(altitude.altitude_local, -local.z, 1e-5);
    EXPECT_GE(altitude.bottom_clearance, 0);
}

void expect_velocities_agree(const Instant& now) {
    const auto local = now.get<msg::LocalPositionNed>();
    const auto global = now.get<msg::GlobalPositionInt>();
    const auto hud = now.get<msg::VfrHud>();
    EXPECT_NEAR(global.vx, local.vx * 100, 0.51);
    EXPECT_NEAR(global.vy, local.vy * 100, 0.51);
    EXPECT_NEAR(global.vz, local.vz * 100, 0.51);
    EXPECT_EQ(hud.climb, -local.vz);
    EXPECT_NEAR(hud.groundspeed, std::hypot(local.vx, local.vy), 1e-5);
    EXPECT_NEAR(hud.alt, global.alt * 1e-3, 0.001);
}

void expect_receiver_is_near(const Instant& now) {
    const auto gps = now.get<msg::GpsRawInt>();
    const auto global = now.get<msg::GlobalPositionInt>();
    const auto local = now.get<msg::LocalPositionNed>();
    const double speed = std::hypot(local.vx, local.vy);
    EXPECT_EQ(gps.fix_type, 3);
    EXPECT_NEAR(gps.lat, global.lat, 30 + speed * 20) << "1e-7 degrees; the receiver measures eight times a second";
    EXPECT_NEAR(gps.alt, global.alt, 300 + std::abs(local.vz) * 150);
    EXPECT_NEAR(gps.vel / 100.0, speed, 0.8);
    if (speed > 2 && gps.cog != 0xffff) {
        EXPECT_NEAR(apart(gps.cog / 100.0, degrees(std::atan2(local.vy, local.vx))), 0, 20);
    }
}

void expect_battery_agrees(const Instant& now) {
    const auto status = now.get<msg::SysStatus>();
    const auto battery = now.get<msg::BatteryStatus>();
    int sum = 0;
    for (const std::uint16_t cell : battery.voltages) sum += cell == 0xffff ? 0 : cell;
    EXPECT_EQ(sum, status.voltage_battery);
    EXPECT_EQ(battery.current_battery, status.current_battery);
    EXPECT_EQ(battery.battery_remaining, status.battery_remaining);
}

void expect_states_agree(const Instant& now) {
    const auto heartbeat = now.get<msg::Heartbeat>();
    EXPECT_EQ(now.get<msg::CurrentMode>().custom_mode, heartbeat.custom_mode);
    const auto landed = now.get<msg::ExtendedSysState>().landed_state;
    const bool armed = (heartbeat.base_mode & 128) != 0;
    EXPECT_TRUE(armed || landed == 1) << "a vehicle in the air is armed";
    const auto servos = now.get<msg::ServoOutputRaw>();
    const auto outputs = now.get<msg::ActuatorOutputStatus>();
    const auto escs = now.get<msg::EscStatus>();
    EXPECT_EQ(outputs.active, 0xfu);
    if (!armed) {
        EXPECT_EQ(servos.servo1_raw, 900);
        EXPECT_EQ(escs.rpm[0], 0);
        EXPECT_EQ(now.get<msg::VfrHud>().throttle, 0);
    } else {
        EXPECT_NEAR(servos.servo1_raw, 1000 + 1000 * outputs.actuator[0], 0.51);
        EXPECT_NEAR(escs.rpm[0], 10'000 * std::sqrt(outputs.actuator[0]), 0.51);
    }
    EXPECT_EQ(servos.servo5_raw, 900);
    EXPECT_EQ(now.get<msg::SysStatus>().onboard_control_sensors_health, 0x1320c83fu) << "also in flight, as PX4";
    EXPECT_EQ(now.get<msg::EstimatorStatus>().flags, landed == 1 ? 0x3ff : 0x37f);
}

// Sensors: the accelerometer in two scales, and pressure that belongs to the altitude (standard atmosphere).
void expect_sensors_agree(const Instant& now) {
    const auto imu = now.get<msg::HighresImu>();
    const auto scaled = now.get<msg::ScaledImu>();
    EXPECT_NEAR(scaled.zacc, imu.zacc / 9.80665 * 1000, 0.51);
    EXPECT_NEAR(scaled.xgyro, imu.xgyro * 1000, 0.51);
    EXPECT_NEAR(scaled.zmag, imu.zmag * 1000, 0.51);
    const double altitude = now.get<msg::GlobalPositionInt>().alt * 1e-3;
    const double pressure = 1013.25 * std::pow(1 - 0.0065 * altitude / 288.15, 5.255);
    EXPECT_NEAR(now.get<msg::ScaledPressure>().press_abs, pressure, 0.15);
    const auto truth = now.get<msg::HilStateQuaternion>();
    EXPECT_NEAR(truth.alt, now.get<msg::GlobalPositionInt>().alt, 200);
    EXPECT_NEAR(truth.zacc, scaled.zacc, 60) << "mG; noise of 0.1 m/s^2 stands in one of them";
}

void expect_times_agree(const Instant& now) {
    const std::uint32_t ms = now.get<msg::Attitude>().time_boot_ms;
    EXPECT_EQ(now.get<msg::GlobalPositionInt>().time_boot_ms, ms);
    EXPECT_EQ(now.get<msg::PositionTargetLocalNed>().time_boot_ms, ms);
    EXPECT_EQ(now.get<msg::GpsRawInt>().time_usec / 1000, ms);
    EXPECT_EQ(now.get<msg::HighresImu>().time_usec / 1000, ms);
    EXPECT_EQ(now.get<msg::ServoOutputRaw>().time_usec / 1000, ms);
    const auto system = now.get<msg::SystemTime>();
    EXPECT_EQ(system.time_boot_ms, ms);
    EXPECT_EQ(system.time_unix_usec, 1'795'222'850'000'000u + std::uint64_t{ms} * 1000);
}

void expect_coherent(const Instant& now) {
    expect_attitudes_agree(now);
    expect_positions_agree(now);
    expect_velocities_agree(now);
    expect_receiver_is_near(now);
    expect_battery_agrees(now);
    expect_states_agree(now);
    expect_sensors_agree(now);
    expect_times_agree(now);
}

// Other vehicles: what depends on neither rotors nor firmware.
using Vehicles = testing::TestWithParam<std::tuple<Kind, Autopilot>>;
struct TelemetryOfEveryVehicle : Vehicles {};
INSTANTIATE_TEST_SUITE_P(Telemetry, TelemetryOfEveryVehicle,
                         testing::Combine(testing::Values(Kind::quad, Kind::plane, Kind::rover),
                                          testing::Values(Autopilot::px4, Autopilot::ardupilot)));

TEST_P(TelemetryOfEveryVehicle, MessagesOfAnInstantAgree) {
    const auto [kind, autopilot] = GetParam();
    Rig rig({.kind = kind,
             .autopilot = autopilot,
             .wind = {.speed_m_s = 3, .direction_deg = 70, .gust_m_s = 0.5},
             .utc_at_start = WallTime{std::chrono::seconds{1'795'222'850}}});
    rig.run(5.0);
    if (kind != Kind::rover) {
        (void)rig.vehicle.set_mode("GUIDED");  // ArduPilot's copters and planes take off in it
        (void)rig.vehicle.arm(true);
        (void)rig.vehicle.take_off(20);
    }
    for (int i = 0; i < 200 && !HasFailure(); ++i) {
        rig.forget();
        const Instant now(rig);
        expect_attitudes_agree(now);
        expect_velocities_agree(now);
        expect_receiver_is_near(now);
        expect_battery_agrees(now);
        EXPECT_EQ(now.get<msg::CurrentMode>().custom_mode, now.get<msg::Heartbeat>().custom_mode);
        rig.run(0.2);
    }
    EXPECT_EQ(rig.vehicle.status().landed == LandedState::in_air, kind != Kind::rover);
}

// The generator that came before this simulator sent everything from the start, in four classes.
TEST(TelemetryOfRandomMotion, TheOriginalClassesComeCompleteAndAgree) {
    Rig rig({.motion = Motion::random, .utc_at_start = WallTime{std::chrono::seconds{1'795'222'850}}},
            {.profile = Profile::original});
    rig.run(10.0);
    rig.forget();
    rig.run(20.0);
    std::map<std::uint32_t, int> counts;
    for (const Sent& sent : rig.sink.frames) ++counts[sent.frame().id().value];
    for (const std::uint32_t id : {0, 1, 2, 36, 42, 65, 147, 231, 242, 245, 436}) EXPECT_NEAR(counts[id], 20, 1) << id;
    for (const std::uint32_t id : {24, 29, 33, 62, 74, 87, 141, 230, 241}) EXPECT_NEAR(counts[id], 100, 1) << id;
    for (const std::uint32_t id : {30, 32, 85}) EXPECT_NEAR(counts[id], 200, 1) << id;
    for (const std::uint32_t id : {31, 83, 140}) EXPECT_NEAR(counts[id], 400, 1) << id;
    for (int i = 0; i < 100 && !HasFailure(); ++i) {
        rig.forget();
        expect_coherent(Instant(rig));
        rig.run(0.2);
    }
}

struct TelemetryInFlight : testing::Test {
    void command(std::uint16_t id, float p1, float p2 = 0, float p4 = 0, float x = 0, float y = 0, float z = 0) {
        rig.send(msg::CommandLong{.target_system = 1,
                                  .target_component = 1,
                                  .command = id,
                                  .param1 = p1,
                                  .param2 = p2,
                                  .param4 = p4,
                                  .param5 = x,
                                  .param6 = y,
                                  .param7 = z});
        const auto ack = rig.last<msg::CommandAck>();
        ASSERT_TRUE(ack);
        ASSERT_EQ(ack->result, 0) << "command " << id;
    }
    // Looks at the telemetry ten times a second.
    void watch(double seconds) {
        for (double t = 0; t < seconds && !HasFailure(); t += 0.1) {
            rig.forget();
            const Instant now(rig);
            expect_coherent(now);
            armed_seen |= (now.get<msg::Heartbeat>().base_mode & 128) != 0;
            landed_seen.insert(now.get<msg::ExtendedSysState>().landed_state);
            highest = std::max(highest, now.get<msg::GlobalPositionInt>().relative_alt);
            fastest = std::max<double>(fastest, now.get<msg::VfrHud>().groundspeed);
            rig.run(0.1);
        }
    }

    Rig rig{{.utc_at_start = WallTime{std::chrono::seconds{1'795'222'850}}}, {.profile = Profile::lite}};
    bool armed_seen = false;
    std::set<int> landed_seen;
    int highest = 0;
    double fastest = 0;
};

TEST_F(TelemetryInFlight, AllMessagesOfAnInstantAgree) {
    rig.run(4.0);
    watch(2);
    ASSERT_TRUE(rig.vehicle.take_off(15));
    watch(20);
    command(msg::MAV_CMD_DO_REPOSITION, -1, 1, 1.5f, 47.39802f, 8.54600f, 509);
    watch(20);
    ASSERT_TRUE(rig.vehicle.set_mode("Return"));
    watch(80);

    EXPECT_TRUE(armed_seen);
    EXPECT_THAT(landed_seen, testing::UnorderedElementsAre(1, 2, 3, 4));
    EXPECT_GT(highest, 14'000);
    EXPECT_GT(fastest, 3);
    EXPECT_FALSE(rig.vehicle.status().armed) << "it has landed";
}

// MAV_TYPE_HEXAROTOR is 13, MAV_TYPE_OCTOROTOR 14, MAV_TYPE_DODECAROTOR 29, MAV_TYPE_QUADROTOR 2.
TEST(TelemetryOfBodies, NamesTheKindOfMulticopter) {
    for (const auto& [frame, type] :
         {std::pair{Frame::hexa_x, 13}, {Frame::octo_plus, 14}, {Frame::dodeca_cox, 29}, {Frame::quad_plus, 2}}) {
        VehicleOptions options;
        set_frame(options.body.copter, frame, 0.3);
        Rig rig(options);
        rig.run(1.0);
        EXPECT_EQ(rig.last<msg::Heartbeat>()->type, type);
    }
}

TEST_F(TelemetryInFlight, AFailedReceiverShowsInAllItsMessagesUntilItWorksAgain) {
    rig.run(4.0);
    ASSERT_TRUE(rig.vehicle.take_off(10));
    rig.run(15.0);
    const auto fail = [&](float type) { command(msg::MAV_CMD_INJECT_FAILURE, msg::FAILURE_UNIT_SENSOR_GPS, type); };
    fail(msg::FAILURE_TYPE_OFF);
    rig.run(0.5);
    rig.forget();
    {
        const Instant now(rig);
        EXPECT_LT(now.get<msg::GpsRawInt>().fix_type, 2);
        EXPECT_EQ(now.get<msg::GpsRawInt>().eph, 0xffff);
        EXPECT_EQ(now.get<msg::SysStatus>().onboard_control_sensors_health & 32u, 0u);
        const unsigned flags = now.get<msg::EstimatorStatus>().flags;
        EXPECT_EQ(flags & (16u | 512u), 0u) << "no absolute position";
        EXPECT_NE(flags & 128u, 0u) << "a constant one";
    }
    fail(msg::FAILURE_TYPE_OK);
    rig.run(0.5);
    rig.forget();
    const Instant now(rig);
    EXPECT_EQ(now.get<msg::GpsRawInt>().fix_type, 3);
    EXPECT_NE(now.get<msg::SysStatus>().onboard_control_sensors_health & 32u, 0u);
}

// LOCAL_POSITION_NED at every step of the vehicle: the position is the sum of the velocity times the step.
TEST_F(TelemetryInFlight, PositionIsTheIntegralOfVelocityAndAttitudeOfRates) {
    rig.run(4.0);
    for (const std::uint32_t id : {30, 32}) command(msg::MAV_CMD_SET_MESSAGE_INTERVAL, static_cast<float>(id), 4'000);
    ASSERT_TRUE(rig.vehicle.take_off(10));
    rig.run(14.0);
    command(msg::MAV_CMD_DO_REPOSITION, -1, 1, 2.5f, 47.39802f, 8.54600f, 509);
    rig.run(1.0);
    rig.forget();
    rig.run(12.0);

    const auto local = rig.all<msg::LocalPositionNed>();
    const auto attitude = rig.all<msg::Attitude>();
    ASSERT_GT(local.size(), 2'900u);
    ASSERT_GT(attitude.size(), 2'900u);
    double farthest = 0, turned = 0, integral = 0;
    for (std::size_t i = 1; i < local.size(); ++i) {
        ASSERT_EQ(local[i].time_boot_ms - local[i - 1].time_boot_ms, 4u);
        ASSERT_NEAR(local[i].x - local[i - 1].x, local[i].vx * 0.004f, 2e-5);
        ASSERT_NEAR(local[i].y - local[i - 1].y, local[i].vy * 0.004f, 2e-5);
        ASSERT_NEAR(local[i].z - local[i - 1].z, local[i].vz * 0.004f, 2e-5);
        farthest = std::max<double>(farthest, std::hypot(local[i].x - local[0].x, local[i].y - local[0].y));
    }
    for (std::size_t i = 1; i < attitude.size(); ++i) {
        const auto& [ms, roll, pitch, yaw, rollspeed, pitchspeed, yawspeed] = attitude[i];
        turned += std::remainder(yaw - attitude[i - 1].yaw, 2 * 3.14159265358979);
        integral += (std::sin(roll) * pitchspeed + std::cos(roll) * yawspeed) / std::cos(pitch) * 0.004;
    }
    EXPECT_GT(farthest, 20);
    EXPECT_GT(std::abs(turned), 1);
    EXPECT_NEAR(turned, integral, 0.02);
}

// Charge: the integral of the current is what BATTERY_STATUS has as consumed.
TEST_F(TelemetryInFlight, TheCurrentEmptiesTheBattery) {
    rig.run(4.0);
    command(msg::MAV_CMD_SET_MESSAGE_INTERVAL, 147, 20'000);
    ASSERT_TRUE(rig.vehicle.take_off(10));
    rig.run(10.0);
    rig.forget();
    rig.run(60.0);

    const auto samples = rig.all<msg::BatteryStatus>();
    ASSERT_GT(samples.size(), 2'900u);
    double mah = 0;
    for (std::size_t i = 1; i < samples.size(); ++i) {
        mah += samples[i].current_battery * 0.01 * 1000 * 0.02 / 3600;
        ASSERT_LE(samples[i].battery_remaining, samples[i - 1].battery_remaining);
        ASSERT_GE(samples[i].current_consumed, samples[i - 1].current_consumed);
    }
    EXPECT_GT(mah, 100);
    EXPECT_NEAR(samples.back().current_consumed - samples.front().current_consumed, mah, 1.5);
}

}  // namespace
}  // namespace mavloom::sim
