// SPDX-License-Identifier: MIT
#include "flight/physics/math.hpp"
#include "flight/wire_units.hpp"
#include "mavloom/msg/enums/gps_fix_type.hpp"
#include "mavloom/msg/gnss_integrity.hpp"
#include "mavloom/msg/gps_raw_int.hpp"
#include "sim/telemetry/projections.hpp"

namespace mavloom::sim {

namespace {

constexpr std::uint16_t unknown = 0xffff;

std::uint16_t dilution(double value) noexcept { return value > 0 ? saturated<std::uint16_t>(value * 100) : unknown; }

void fill_fix(const View& view, const GpsFix& fix, msg::GpsRawInt& message) {
    constexpr double slowest_course = 0.3;  // m/s; below it the course is noise
    const GeoPoint position = view.flight.frame().to_geo(fix.position);
    const double speed = flight::math::hypot(fix.velocity.x(), fix.velocity.y());
    message.lat = to_degrees_e7(position.latitude);
    message.lon = to_degrees_e7(position.longitude);
    message.alt = message.alt_ellipsoid = to_mm(position.altitude);
    message.vel = saturated<std::uint16_t>(speed * 100);
    if (speed >= slowest_course)
        message.cog = to_centidegrees(wrap_2pi(flight::math::atan2(fix.velocity.y(), fix.velocity.x())));
    message.h_acc = saturated<std::uint32_t>(fix.horizontal_m * 1e3);
    message.v_acc = saturated<std::uint32_t>(fix.vertical_m * 1e3);
    message.vel_acc = saturated<std::uint32_t>(fix.speed_m_s * 1e3);
}

}  // namespace

// PX4's simulator reports the altitude above mean sea level in both altitude fields.
bool write_gps_raw_int(const View& view, ByteSpan payload) {
    const GpsFix& fix = view.flight.sensors().gps();
    msg::GpsRawInt message{.time_usec = boot_us(view),
                           .fix_type = fix.fix_type,
                           .eph = dilution(fix.hdop),
                           .epv = dilution(fix.vdop),
                           .vel = unknown,
                           .cog = unknown,
                           .satellites_visible = fix.satellites};
    if (fix.fix_type >= msg::GPS_FIX_TYPE_2D_FIX) fill_fix(view, fix, message);
    return put(message, payload);
}

// Nothing is known about the signals but that there are some: the values that PX4's simulator reports.
bool write_gnss_integrity(const View& /*view*/, ByteSpan payload) {
    constexpr std::uint8_t unknown_quality = 0xff;
    return put(msg::GnssIntegrity{.id_ = 4,
                                  .raim_hfom = unknown,
                                  .raim_vfom = unknown,
                                  .corrections_quality = unknown_quality,
                                  .system_status_summary = unknown_quality,
                                  .gnss_signal_quality = unknown_quality,
                                  .post_processing_quality = unknown_quality},
               payload);
}

}  // namespace mavloom::sim
