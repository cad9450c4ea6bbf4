// SPDX-License-Identifier: MIT
#include <array>

#include "flight/wire_units.hpp"
#include "sim/recorder/format.hpp"

namespace mavloom::sim {

namespace dataflash {

namespace {

using Bytes = std::vector<std::uint8_t>;

// A message is two bytes of synchronisation and its type, then the fields. `fields` has a letter for the type of each
// column, `units` and `scales` one for each column's unit and for the factor that leads to it.
struct Message {
    std::uint8_t type, size;  // size of the fields
    std::string_view name, fields, columns, units, scales;
};
constexpr std::uint8_t message_head = 3;
constexpr Message fmt_message{128, 86, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns", "-b---", "-----"};
constexpr Message unit_message{129, 8 + 1 + 64, "UNIT", "QbZ", "TimeUS,Id,Label", "s--", "F--"};
constexpr Message fmtu_message{130, 8 + 1 + 16 + 16, "FMTU", "QBNN", "TimeUS,FmtType,UnitIds,MultIds", "s---", "F---"};
constexpr Message mult_message{131, 8 + 1 + 8, "MULT", "Qbd", "TimeUS,Id,Mult", "s--", "F--"};
constexpr Message parm_message{132, 8 + 16 + 4 + 4, "PARM", "QNff", "TimeUS,Name,Value,Default", "s---", "F---"};
constexpr Message msg_message{133, 8 + 64, "MSG", "QZ", "TimeUS,Message", "s-", "F-"};
constexpr Message mode_message{134, 8 + 3, "MODE", "QMBB", "TimeUS,Mode,ModeNum,Rsn", "s---", "F---"};
constexpr Message att_message{135, 8 + 3 * 4, "ATT", "Qfff", "TimeUS,Roll,Pitch,Yaw", "sddh", "F000"};
constexpr Message gps_message{136,
                              8 + 1 + 1 + 4 + 2 + 1 + 2 + 4 + 4 + 4 + 4 * 4 + 1,
                              "GPS",
                              "QBBIHBcLLeffffB",
                              "TimeUS,I,Status,GMS,GWk,NSats,HDop,Lat,Lng,Alt,Spd,GCrs,VZ,Yaw,U",
                              "s#-s-S-DUmnhnh-",
                              "F--C-0BGGB000--"};
constexpr Message pos_message{
    137, 8 + 4 + 4 + 3 * 4, "POS", "QLLfff", "TimeUS,Lat,Lng,Alt,RelHomeAlt,RelOriginAlt", "sDUmmm", "FGG000"};
constexpr Message bat_message{138,      8 + 1 + 3 * 4 + 1, "BAT", "QBfffB", "TimeUS,Inst,Volt,Curr,CurrTot,RemPct",
                              "s#vAa%", "F-00C0"};
constexpr std::array all_messages{fmt_message,  unit_message, fmtu_message, mult_message, parm_message, msg_message,
                                  mode_message, att_message,  gps_message,  pos_message,  bat_message};

constexpr std::array attitude_messages{fmt_message, unit_message, fmtu_message, mult_message, msg_message, att_message};

constexpr std::uint32_t length_of(const Message& message) noexcept {
    return message_head + std::uint32_t{message.size};
}
constexpr std::uint32_t sample_size = length_of(att_message) + length_of(gps_message) + length_of(pos_message) +
                                      length_of(bat_message);
static_assert(sample_size <= LogFormat::largest_record);

struct Unit {
    char id;
    std::string_view label;
};
constexpr Unit unit_table[] = {
    {'-', ""},   {'?', "UNKNOWN"}, {'A', "A"},   {'D', "deglatitude"}, {'S', "satellites"}, {'U', "deglongitude"},
    {'a', "Ah"}, {'b', "B"},       {'d', "deg"}, {'h', "degheading"},  {'m', "m"},          {'n', "m/s"},
    {'s', "s"},  {'v', "V"},       {'%', "%"},   {'#', "instance"}};
struct Scale {
    char id;
    double factor;
};
constexpr Scale scale_table[] = {{'-', 0}, {'?', 1}, {'0', 1}, {'B', 1e-2}, {'C', 1e-3}, {'F', 1e-6}, {'G', 1e-7}};

void begin(ByteWriter& out, const Message& message) noexcept {
    out.put(std::uint8_t{0xa3});
    out.put(std::uint8_t{0x95});
    out.put(message.type);
}

// Appends a message whose fields `fill` writes.
template <class Fill>
void append(Bytes& to, const Message& message, const Fill& fill) {
    const std::size_t at = to.size();
    to.resize(at + length_of(message));
    ByteWriter out(ByteSpan(to).subspan(at));
    begin(out, message);
    fill(out);
}

void append_definitions(Bytes& to, std::span<const Message> messages, std::uint64_t time) {
    for (const Message& message : messages)
        append(to, fmt_message, [&](ByteWriter& out) {
            out.put(message.type);
            out.put(static_cast<std::uint8_t>(length_of(message)));
            out.put_text(message.name, 4);
            out.put_text(message.fields, 16);
            out.put_text(message.columns, 64);
        });
    for (const Unit& unit : unit_table)
        append(to, unit_message, [&](ByteWriter& out) {
            out.put(time);
            out.put(static_cast<std::int8_t>(unit.id));
            out.put_text(unit.label, 64);
        });
    for (const Scale& scale : scale_table)
        append(to, mult_message, [&](ByteWriter& out) {
            out.put(time);
            out.put(static_cast<std::int8_t>(scale.id));
            out.put(scale.factor);
        });
    for (const Message& message : messages)
        append(to, fmtu_message, [&](ByteWriter& out) {
            out.put(time);
            out.put(message.type);
            out.put_text(message.units, 16);
            out.put_text(message.scales, 16);
        });
}

void append_parameters(Bytes& to, std::uint64_t time, std::span<const ParamInfo> infos,
                       std::span<const ChangedParameter> changed) {
    Parameters values(infos);
    for (const ChangedParameter& parameter : changed) values.set_bits(parameter.index, parameter.bits);
    for (ParamIndex i = 0; i < values.size(); ++i)
        append(to, parm_message, [&](ByteWriter& out) {
            out.put(time);
            out.put_text(infos[i].name, 16);
            out.put(as_float(values.value(i)));
            out.put(as_float(infos[i].initial));
        });
}

void append_text(Bytes& to, std::uint64_t time, std::string_view text) {
    append(to, msg_message, [&](ByteWriter& out) {
        out.put(time);
        out.put_text(text, 64);
    });
}

// GPS time: weeks since 1980-01-06, and milliseconds of the week. It is ahead of UTC by the leap seconds since then.
struct GpsTime {
    std::uint16_t week = 0;
    std::uint32_t ms = 0;
};
GpsTime gps_time(WallTime utc) noexcept {
    if (utc == WallTime{}) return {};
    constexpr std::chrono::seconds epoch{315'964'800}, leap{18};
    constexpr std::chrono::weeks week{1};
    const auto time = utc.time_since_epoch() - epoch + leap;
    return {static_cast<std::uint16_t>(time / week),
            static_cast<std::uint32_t>(time % week / std::chrono::milliseconds{1})};
}

void put_attitude(ByteWriter& out, std::uint64_t time, const Quaternion& attitude) noexcept {
    const Euler angles = to_euler(attitude);
    begin(out, att_message);
    out.put(time);
    for (const double angle : {angles.roll, angles.pitch, wrap_2pi(angles.yaw)}) out.put(as_float(to_degrees(angle)));
}

void write_gps(ByteWriter& out, const LogHead& head, const LogRecord& record, const Sample& sample) noexcept {
    const GpsTime time = gps_time(utc_of(head, record));
    constexpr std::uint16_t good_hdop = 70;  // 1/100
    begin(out, gps_message);
    out.put(time_us(record));
    out.put(std::uint8_t{0});
    out.put(sample.fix_type);
    out.put(time.ms);
    out.put(time.week);
    out.put(sample.satellites);
    out.put(good_hdop);
    out.put(sample.gps_position[0]);
    out.put(sample.gps_position[1]);
    out.put(sample.gps_position[2] / 10);
    out.put(as_float(sample.gps_speed / 1e2));
    out.put(as_float(sample.gps_course / 1e2));
    out.put(as_float(sample.velocity[2] / 1e2));
    out.put(0.0f);  // no yaw from GPS
    out.put(std::uint8_t{1});
}

void write_position(ByteWriter& out, const LogHead& head, const LogRecord& record, const Sample& sample) noexcept {
    const double altitude = sample.position[2] / 1e3;
    begin(out, pos_message);
    out.put(time_us(record));
    out.put(sample.position[0]);
    out.put(sample.position[1]);
    out.put(as_float(altitude));
    out.put(as_float(altitude - head.home_altitude / 1e3));
    out.put(as_float(altitude - head.origin[2]));
}

void write_battery(ByteWriter& out, const LogRecord& record, const Sample& sample) noexcept {
    begin(out, bat_message);
    out.put(time_us(record));
    out.put(std::uint8_t{0});
    out.put(as_float(sample.millivolts / 1e3));
    out.put(as_float(sample.centiamperes / 1e2));
    out.put(static_cast<float>(sample.used_mah));
    out.put(static_cast<std::uint8_t>(std::lround(sample.remaining / 1e2)));
}

void write_mode(ByteWriter& out, const Firmware& firmware, const LogRecord& record, std::uint8_t mode) noexcept {
    constexpr std::uint8_t by_ground_station = 2;
    const auto number = static_cast<std::uint8_t>(firmware.modes()[mode].custom_mode);
    begin(out, mode_message);
    out.put(time_us(record));
    out.put(number);
    out.put(number);
    out.put(by_ground_station);
}

class DataFlash final : public LogFormat {
public:
    // Readers find out the kind of vehicle by the text with the firmware's name.
    Bytes header(const LogSource& source, const LogHead& head) const override {
        const std::uint64_t time = std::uint64_t{head.began_ms} * 1000;
        Bytes bytes;
        append_definitions(bytes, all_messages, time);
        append_parameters(bytes, time, source.firmware.parameters(), head.changed);
        append_text(bytes, time, source.firmware.texts().banner);
        return bytes;
    }
    Bytes attitude_header() const override {
        Bytes bytes;
        append_definitions(bytes, attitude_messages, 0);
        append_text(bytes, 0, "Simulated by Mavloom");
        return bytes;
    }
    std::uint32_t attitude_size() const noexcept override { return length_of(att_message); }
    void write_attitude(std::uint64_t time, const Quaternion& attitude, ByteSpan out) const noexcept override {
        ByteWriter writer(out);
        put_attitude(writer, time, attitude);
    }
    std::uint32_t size(const LogRecord& record) const noexcept override {
        if (std::holds_alternative<Sample>(record.content)) return sample_size;
        return length_of(std::holds_alternative<LoggedText>(record.content) ? msg_message : mode_message);
    }
    void write(const LogSource& source, const LogHead& head, const LogRecord& record,
               ByteSpan out) const noexcept override {
        ByteWriter writer(out);
        if (const auto* const sample = std::get_if<Sample>(&record.content)) {
            put_attitude(writer, time_us(record), attitude_of(*sample));
            write_gps(writer, head, record, *sample);
            write_position(writer, head, record, *sample);
            write_battery(writer, record, *sample);
        } else if (const auto* const text = std::get_if<LoggedText>(&record.content)) {
            begin(writer, msg_message);
            writer.put(time_us(record));
            writer.put_text(text->text(), 64);
        } else if (const auto* const change = std::get_if<ModeChange>(&record.content)) {
            write_mode(writer, source.firmware, record, change->mode);
        }
    }
};

}  // namespace

}  // namespace dataflash

const LogFormat& dataflash_format() noexcept {
    static const dataflash::DataFlash format;
    return format;
}

const LogFormat& LogFormat::of(bool is_px4) noexcept { return is_px4 ? ulog_format() : dataflash_format(); }

}  // namespace mavloom::sim
