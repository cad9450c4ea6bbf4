// SPDX-License-Identifier: MIT
#include "sim/payload/traffic.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "flight/physics/math.hpp"
#include "mavloom/msg/adsb_vehicle.hpp"
#include "mavloom/msg/enums/adsb_altitude_type.hpp"
#include "mavloom/msg/enums/adsb_emitter_type.hpp"
#include "mavloom/msg/enums/adsb_flags.hpp"

namespace mavloom::sim {

namespace {

constexpr std::uint16_t valid_flags = msg::ADSB_FLAGS_VALID_COORDS | msg::ADSB_FLAGS_VALID_ALTITUDE |
                                      msg::ADSB_FLAGS_VALID_HEADING | msg::ADSB_FLAGS_VALID_VELOCITY |
                                      msg::ADSB_FLAGS_VALID_CALLSIGN | msg::ADSB_FLAGS_VALID_SQUAWK |
                                      msg::ADSB_FLAGS_VERTICAL_VELOCITY_VALID;

std::array<char, 9> make_callsign(Random& random) {
    std::array<char, 9> text{};
    for (std::size_t i = 0; i < 3; ++i) text[i] = static_cast<char>('A' + random.bits() % 26);
    for (std::size_t i = 3; i < 6; ++i) text[i] = static_cast<char>('0' + random.bits() % 10);
    return text;
}

// A place on a racetrack around the origin whose straights point north, clockwise from the south end of the west side.
struct OnTrack {
    double north, east, course;
};
OnTrack on_track(double straight, double radius, double along) {
    const double half = pi * radius;
    if (along < straight) return {along - straight / 2, -radius, 0};
    along -= straight;
    if (along < half) {
        const double turned = along / radius;
        return {straight / 2 + radius * flight::math::sin(turned), -radius * flight::math::cos(turned), turned};
    }
    along -= half;
    if (along < straight) return {straight / 2 - along, radius, pi};
    const double turned = (along - straight) / radius;
    return {-straight / 2 - radius * flight::math::sin(turned), radius * flight::math::cos(turned), pi + turned};
}

}  // namespace

Aircraft::Motion Aircraft::at(double seconds) const {
    const double lap = 2 * straight + 2 * pi * radius;
    const double travelled = start + speed * seconds;
    const OnTrack place = on_track(straight, radius, travelled - lap * std::floor(travelled / lap));
    const double course = place.course + direction, phase = 2 * pi * seconds / swing_time;
    const double sine = flight::math::sin(direction), cosine = flight::math::cos(direction);
    return {.position = center + Vector3{place.north * cosine - place.east * sine,
                                         place.north * sine + place.east * cosine, -swing * flight::math::sin(phase)},
            .velocity = {speed * flight::math::cos(course), speed * flight::math::sin(course),
                         -swing * flight::math::cos(phase) * 2 * pi / swing_time}};
}

// One in three is an airliner on a long track; the others are light aircraft that circle low.
Aircraft make_aircraft(Random& random) {
    const bool is_airliner = random.bits() % 3 == 0;
    Aircraft made{.icao = static_cast<std::uint32_t>(0x400000 + random.bits() % 0x400000)};
    made.callsign = make_callsign(random);
    for (int digit = 0; digit < 4; ++digit)  // octal digits, read as a decimal number
        made.squawk = static_cast<std::uint16_t>(made.squawk * 10 + random.bits() % 8);
    made.emitter = is_airliner ? msg::ADSB_EMITTER_TYPE_LARGE : msg::ADSB_EMITTER_TYPE_LIGHT;
    made.direction = random.uniform(0, 2 * pi);
    made.speed = is_airliner ? random.uniform(120, 230) : random.uniform(35, 65);
    made.radius = is_airliner ? random.uniform(4000, 7000) : random.uniform(700, 1800);
    made.straight = is_airliner ? random.uniform(15000, 30000) : random.uniform(0, 3000);
    const double height = is_airliner ? random.uniform(2500, 9000) : random.uniform(250, 900);
    made.center = {random.uniform(-2500, 2500), random.uniform(-2500, 2500), -height};
    made.start = random.uniform(0, 1e5);
    made.swing = is_airliner ? 0 : random.uniform(10, 60);
    return made;
}

Traffic::Traffic(const VehicleOptions& options, Radio& radio, const Streams& streams, FlightTime now)
    : options_(options), radio_(radio), streams_(streams) {
    constexpr std::uint64_t own_sequence = 0x74726166666963;  // apart from the noise of the vehicle
    Random random(options_.seed ^ own_sequence);
    for (std::size_t i = 0; i < std::min(options_.traffic, max_aircraft); ++i)
        aircraft_.push_back(make_aircraft(random));
    if (!aircraft_.empty()) next_ = now + period / 2;
}

// Each aircraft transmits once a second; they take turns, so that their messages do not burst. Nor do they after a
// stall: what was not received then is lost, as over the air.
void Traffic::pump(Moment now) {
    caught_up_ = std::exchange(last_pump_, now.real) == now.real ? caught_up_ + 1 : 0;
    const std::uint64_t turn = turns_++;
    if (caught_up_ < aircraft_.size())
        transmit(aircraft_[turn % aircraft_.size()], turn / aircraft_.size(), now.flight);
    next_ += period / static_cast<std::int64_t>(aircraft_.size());
}

void Traffic::transmit(const Aircraft& aircraft, std::uint64_t round, FlightTime now) {
    const Aircraft::Motion motion = aircraft.at(std::chrono::duration<double>(now).count());
    const Home& home = options_.home;
    const GeoPoint place = LocalFrame({home.latitude_deg, home.longitude_deg, home.altitude_m}).to_geo(motion.position);
    const double speed = motion.velocity.head<2>().norm();
    const double heading = wrap_2pi(flight::math::atan2(motion.velocity.y(), motion.velocity.x()));
    const msg::AdsbVehicle message{
        .ICAO_address = aircraft.icao,
        .lat = to_degrees_e7(place.latitude),
        .lon = to_degrees_e7(place.longitude),
        .altitude_type = msg::ADSB_ALTITUDE_TYPE_GEOMETRIC,
        .altitude = static_cast<std::int32_t>(std::lround(place.altitude * 1000)),
        .heading = static_cast<std::uint16_t>(std::min(35999L, std::lround(to_degrees(heading) * 100))),
        .hor_velocity = static_cast<std::uint16_t>(std::lround(speed * 100)),
        .ver_velocity = static_cast<std::int16_t>(std::lround(-motion.velocity.z() * 100)),
        .callsign = aircraft.callsign,
        .emitter_type = aircraft.emitter,
        .tslc = 0,
        .flags = valid_flags,
        .squawk = aircraft.squawk};
    for (const LinkId link : radio_.links()) {
        const auto interval = streams_.interval(link, msg::AdsbVehicle::id);
        if (interval && interval->count() <= 0) continue;
        const auto every = interval ? static_cast<std::uint64_t>(std::max<std::int64_t>(1, *interval / period)) : 1;
        if (round % every == 0) radio_.send(link, message);
    }
}

}  // namespace mavloom::sim
