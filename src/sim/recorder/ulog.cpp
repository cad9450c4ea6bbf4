// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <array>

#include "flight/physics/geodesy.hpp"
#include "flight/wire_units.hpp"
#include "mavloom/msg/enums/mav_type.hpp"
#include "sim/metadata/event_catalog.hpp"
#include "sim/recorder/format.hpp"

namespace mavloom::sim {

namespace ulog {

namespace {

using Bytes = std::vector<std::uint8_t>;

// A message is a length, a type and a body. Topics have PX4's names and types, and those of its fields that the
// vehicle knows, in PX4's order. The number of a topic in the log is its index.
struct Topic {
    std::string_view name, fields;
    std::uint16_t size;  // of the fields
};
enum TopicIndex : std::uint16_t {
    attitude,
    angular_velocity,
    local,
    global,
    gps,
    battery,
    status,
    landed,
    topic_count
};
constexpr std::array<Topic, topic_count> topics{{
    {"vehicle_attitude", "uint64_t timestamp;uint64_t timestamp_sample;float[4] q;", 8 + 8 + 16},
    {"vehicle_angular_velocity", "uint64_t timestamp;uint64_t timestamp_sample;float[3] xyz;", 8 + 8 + 12},
    {"vehicle_local_position",
     "uint64_t timestamp;uint64_t timestamp_sample;uint64_t ref_timestamp;double ref_lat;double ref_lon;float x;float "
     "y;"
     "float z;float vx;float vy;float vz;float heading;float ref_alt;bool xy_valid;bool z_valid;bool v_xy_valid;"
     "bool v_z_valid;bool xy_global;bool z_global;",
     3 * 8 + 2 * 8 + 8 * 4 + 6},
    {"vehicle_global_position",
     "uint64_t timestamp;uint64_t timestamp_sample;double lat;double lon;float alt;float alt_ellipsoid;",
     2 * 8 + 2 * 8 + 2 * 4},
    {"vehicle_gps_position",
     "uint64_t timestamp;uint64_t time_utc_usec;double latitude_deg;double longitude_deg;double altitude_msl_m;"
     "double altitude_ellipsoid_m;float vel_m_s;float cog_rad;uint8_t fix_type;uint8_t satellites_used;",
     2 * 8 + 4 * 8 + 2 * 4 + 2},
    {"battery_status",
     "uint64_t timestamp;float voltage_v;float current_a;float discharged_mah;float remaining;bool connected;"
     "uint8_t cell_count;",
     8 + 4 * 4 + 2},
    {"vehicle_status",
     "uint64_t timestamp;uint64_t armed_time;uint8_t arming_state;uint8_t nav_state_user_intention;uint8_t nav_state;"
     "uint8_t vehicle_type;bool failsafe;uint8_t system_type;uint8_t system_id;uint8_t component_id;",
     2 * 8 + 8},
    {"vehicle_land_detected", "uint64_t timestamp;bool landed;", 8 + 1},
}};

constexpr std::uint32_t message_head = 3, data_head = message_head + 2;  // a data message begins with its topic

constexpr std::uint32_t sample_size = [] {
    std::uint32_t size = 0;
    for (const Topic& topic : topics) size += data_head + topic.size;
    return size;
}();
static_assert(sample_size <= LogFormat::largest_record);

void append_message(Bytes& to, char type, std::size_t size) {
    append_number(to, static_cast<std::uint16_t>(size));
    append(to, {&type, 1});
}

// A key is a type and a name: "float NAME".
void append_key(Bytes& to, char type, std::string_view key, std::size_t value_size) {
    append_message(to, type, 1 + key.size() + value_size);
    append_number(to, static_cast<std::uint8_t>(key.size()));
    append(to, key);
}

void append_text(Bytes& to, std::string_view name, std::string_view text) {
    append_key(to, 'I', fmt::format("char[{}] {}", text.size(), name), text.size());
    append(to, text);
}

constexpr std::size_t flag_bytes = 40;  // none is set

void append_beginning(Bytes& to, std::uint64_t time) {
    append(to, "ULog\x01\x12\x35\x01");
    append_number(to, time);
    append_message(to, 'B', flag_bytes);
    to.resize(to.size() + flag_bytes);
}

void append_format(Bytes& to, const Topic& topic) {
    append_message(to, 'F', topic.name.size() + 1 + topic.fields.size());
    append(to, fmt::format("{}:{}", topic.name, topic.fields));
}

// The log has the first instance of the topic.
void append_subscription(Bytes& to, std::uint16_t topic) {
    append_message(to, 'A', 1 + 2 + topics[topic].name.size());
    append_number(to, std::uint8_t{0});
    append_number(to, topic);
    append(to, topics[topic].name);
}

void append_parameters(Bytes& to, std::span<const ParamInfo> infos, std::span<const ChangedParameter> changed) {
    Parameters values(infos);
    for (const ChangedParameter& parameter : changed) values.set_bits(parameter.index, parameter.bits);
    for (ParamIndex i = 0; i < values.size(); ++i) {
        const bool is_real = infos[i].type == ParamType::real32;
        append_key(to, 'P', fmt::format("{} {}", is_real ? "float" : "int32_t", infos[i].name), sizeof(std::uint32_t));
        append_number(to, values.bits(i));
    }
}

// PX4's NAVIGATION_STATE of a mode.
std::uint8_t nav_state(const Firmware& firmware, std::uint8_t mode) noexcept {
    for (const NavigationGroup& group : navigation_groups())
        if (group.custom_mode == firmware.modes()[mode].custom_mode) return group.index;
    return 0;
}

// VEHICLE_TYPE of vehicle_status.
std::uint8_t vehicle_type(const Firmware& firmware) noexcept {
    constexpr std::uint8_t rotary_wing = 1, fixed_wing = 2, rover = 3;
    const std::uint8_t type = firmware.mav_type();
    return type == msg::MAV_TYPE_FIXED_WING ? fixed_wing : type == msg::MAV_TYPE_GROUND_ROVER ? rover : rotary_wing;
}

std::uint64_t microseconds(WallTime time) noexcept {
    return static_cast<std::uint64_t>(std::max<std::int64_t>(0, time.time_since_epoch() / std::chrono::microseconds{1}));
}

void begin(ByteWriter& out, TopicIndex topic, std::uint64_t time) noexcept {
    out.put(static_cast<std::uint16_t>(topics[topic].size + 2));
    out.put(static_cast<std::uint8_t>('D'));
    out.put(static_cast<std::uint16_t>(topic));
    out.put(time);
}

void put_attitude(ByteWriter& out, std::uint64_t time, const Quaternion& q) noexcept {
    begin(out, attitude, time);
    out.put(time);
    for (const double part : {q.w(), q.x(), q.y(), q.z()}) out.put(as_float(part));
}

// Writes the topics of one sample.
class Topics {
public:
    Topics(const LogSource& source, const LogHead& head, const LogRecord& record, ByteSpan out) noexcept
        : source_(source), head_(head), record_(record), sample_(std::get<Sample>(record.content)), out_(out) {}

    void write() noexcept {
        write_attitude();
        write_local_position();
        write_global_position();
        write_gps();
        write_battery();
        write_status();
    }

private:
    void begin(TopicIndex topic) noexcept { ulog::begin(out_, topic, time_us(record_)); }
    void write_attitude() noexcept {
        put_attitude(out_, time_us(record_), attitude_of(sample_));
        begin(angular_velocity);
        out_.put(time_us(record_));
        for (const std::int16_t rate : sample_.rates) out_.put(as_float(rate / 1e3));
    }
    void write_local_position() noexcept {
        begin(local);
        out_.put(time_us(record_));
        out_.put(std::uint64_t{head_.began_ms} * 1000);
        out_.put(head_.origin[0]);
        out_.put(head_.origin[1]);
        for (const float part : sample_.local) out_.put(part);
        for (const std::int16_t part : sample_.velocity) out_.put(as_float(part / 1e2));
        out_.put(as_float(to_euler(attitude_of(sample_)).yaw));
        out_.put(as_float(head_.origin[2]));
        constexpr int flags = 6;
        for (int i = 0; i < flags; ++i) out_.put(std::uint8_t{1});
    }
    void write_global_position() noexcept {
        begin(global);
        out_.put(time_us(record_));
        out_.put(from_degrees_e7(sample_.position[0]));
        out_.put(from_degrees_e7(sample_.position[1]));
        out_.put(as_float(sample_.position[2] / 1e3));
        out_.put(as_float(sample_.position[2] / 1e3));
    }
    void write_gps() noexcept {
        begin(gps);
        out_.put(microseconds(utc_of(head_, record_)));
        out_.put(from_degrees_e7(sample_.gps_position[0]));
        out_.put(from_degrees_e7(sample_.gps_position[1]));
        out_.put(sample_.gps_position[2] / 1e3);
        out_.put(sample_.gps_position[2] / 1e3);
        out_.put(as_float(sample_.gps_speed / 1e2));
        out_.put(as_float(wrap_pi(to_radians(sample_.gps_course / 1e2))));
        out_.put(sample_.fix_type);
        out_.put(sample_.satellites);
    }
    void write_battery() noexcept {
        begin(battery);
        out_.put(as_float(sample_.millivolts / 1e3));
        out_.put(as_float(sample_.centiamperes / 1e2));
        out_.put(static_cast<float>(sample_.used_mah));
        out_.put(as_float(sample_.remaining / 1e4));
        out_.put(std::uint8_t{1});
        out_.put(source_.battery_cells);
    }
    void write_status() noexcept {
        constexpr std::uint8_t disarmed = 1, armed = 2, autopilot = 1;
        begin(status);
        out_.put(sample_.is_armed ? std::uint64_t{head_.began_ms} * 1000 : std::uint64_t{0});
        out_.put(sample_.is_armed ? armed : disarmed);
        out_.put(nav_state(source_.firmware, sample_.wanted_mode));
        out_.put(nav_state(source_.firmware, sample_.mode));
        out_.put(vehicle_type(source_.firmware));
        out_.put(std::uint8_t{sample_.has_failsafe});
        out_.put(source_.firmware.mav_type());
        out_.put(head_.system.value);
        out_.put(autopilot);
        begin(landed);
        out_.put(std::uint8_t{sample_.is_landed});
    }

    const LogSource& source_;
    const LogHead& head_;
    const LogRecord& record_;
    const Sample& sample_;
    ByteWriter out_;
};

class ULog final : public LogFormat {
public:
    Bytes header(const LogSource& source, const LogHead& head) const override {
        Bytes bytes;
        append_beginning(bytes, std::uint64_t{head.began_ms} * 1000);
        for (const Topic& topic : topics) append_format(bytes, topic);
        append_text(bytes, "sys_name", "PX4");
        append_text(bytes, "ver_hw", "PX4_SITL");
        append_key(bytes, 'I', "uint32_t ver_sw_release", sizeof(std::uint32_t));
        append_number(bytes, source.firmware.version().flight);
        append_parameters(bytes, source.firmware.parameters(), head.changed);
        for (std::uint16_t i = 0; i < topic_count; ++i) append_subscription(bytes, i);
        return bytes;
    }
    Bytes attitude_header() const override {
        Bytes bytes;
        append_beginning(bytes, 0);
        append_format(bytes, topics[attitude]);
        append_text(bytes, "sys_name", "PX4");
        append_subscription(bytes, attitude);
        return bytes;
    }
    std::uint32_t attitude_size() const noexcept override { return data_head + topics[attitude].size; }
    void write_attitude(std::uint64_t time, const Quaternion& q, ByteSpan out) const noexcept override {
        ByteWriter writer(out);
        put_attitude(writer, time, q);
    }
    // The mode is in every sample, so a change of mode takes no bytes.
    std::uint32_t size(const LogRecord& record) const noexcept override {
        if (std::holds_alternative<Sample>(record.content)) return sample_size;
        if (const auto* const text = std::get_if<LoggedText>(&record.content))
            return message_head + 1 + 8 + text->length;
        return 0;
    }
    void write(const LogSource& source, const LogHead& head, const LogRecord& record,
               ByteSpan out) const noexcept override {
        if (std::holds_alternative<Sample>(record.content)) return Topics(source, head, record, out).write();
        const auto* const text = std::get_if<LoggedText>(&record.content);
        if (text == nullptr) return;
        ByteWriter writer(out);
        writer.put(static_cast<std::uint16_t>(1 + 8 + text->length));
        writer.put(static_cast<std::uint8_t>('L'));
        writer.put(static_cast<std::uint8_t>('0' + text->severity));
        writer.put(time_us(record));
        writer.put_text(text->text(), text->length);
    }
};

}  // namespace

}  // namespace ulog

const LogFormat& ulog_format() noexcept {
    static const ulog::ULog format;
    return format;
}

}  // namespace mavloom::sim
