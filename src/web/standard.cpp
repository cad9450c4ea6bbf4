// SPDX-License-Identifier: MIT
#include "web/standard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "mavloom/base/source_text.hpp"

namespace mavloom::web {

namespace {

struct Type {
    std::string_view name, fields;
};
constexpr Type time_type{"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"};
constexpr Type header_type{"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"};
constexpr Type quaternion_type{"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"};
constexpr std::string_view x_y_z = "float64 x\nfloat64 y\nfloat64 z\n";

// The fields of the type itself, then those of the types in it.
std::string schema(std::string_view fields, std::initializer_list<Type> types) {
    std::string text(fields);
    for (const auto& type : types) text += fmt::format("{:=<80}\nMSG: {}\n{}", "", type.name, type.fields);
    return text;
}

std::string nav_sat_fix_schema() {
    return schema(
        "std_msgs/Header header\nsensor_msgs/NavSatStatus status\n"
        "float64 latitude\nfloat64 longitude\nfloat64 altitude\n"
        "float64[9] position_covariance\nuint8 position_covariance_type\n",
        {{"sensor_msgs/NavSatStatus", "int8 status\nuint16 service\n"}, header_type, time_type});
}

std::string pose_schema() {
    return schema("std_msgs/Header header\ngeometry_msgs/Pose pose\n",
                  {{"geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"},
                   {"geometry_msgs/Point", x_y_z},
                   quaternion_type,
                   header_type,
                   time_type});
}

std::string transforms_schema() {
    return schema(
        "geometry_msgs/TransformStamped[] transforms\n",
        {{"geometry_msgs/TransformStamped",
          "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n"},
         {"geometry_msgs/Transform", "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"},
         {"geometry_msgs/Vector3", x_y_z},
         quaternion_type,
         header_type,
         time_type});
}

std::string log_schema() {
    return schema(
        "byte DEBUG=10\nbyte INFO=20\nbyte WARN=30\nbyte ERROR=40\nbyte FATAL=50\n"
        "builtin_interfaces/Time stamp\nuint8 level\nstring name\nstring msg\nstring file\nstring function\n"
        "uint32 line\n",
        {time_type});
}

// Appends CDR, little-endian. Numbers are aligned to their size, from the end of the encapsulation header on.
class Writer {
public:
    explicit Writer(std::vector<std::uint8_t>& out) : out_(out) {
        out_.insert(out_.end(), {0, 1, 0, 0});
        start_ = out_.size();
    }
    template <class T>
    void number(T value) {
        while ((out_.size() - start_) % sizeof(T) != 0) out_.push_back(0);
        out_.resize(out_.size() + sizeof(T));
        store_le(out_.data() + out_.size() - sizeof(T), value);
    }
    // Viewers refuse text that is not UTF-8. STATUSTEXT is ASCII by its definition.
    void text(std::string_view text) {
        number(static_cast<std::uint32_t>(text.size() + 1));
        for (const char c : text)
            out_.push_back(static_cast<unsigned char>(c) < 0x80 ? static_cast<std::uint8_t>(c) : '?');
        out_.push_back(0);
    }
    void time(WallTime time) {
        const auto ns = time.time_since_epoch().count();
        number(static_cast<std::int32_t>(ns / 1'000'000'000));
        number(static_cast<std::uint32_t>(ns % 1'000'000'000));
    }

private:
    std::vector<std::uint8_t>& out_;
    std::size_t start_;
};

double value_of(const message::MessageView& view, std::string_view name) {
    const auto* const field = view.definition().find(name);
    return field == nullptr ? 0.0 : view.number(*field);
}

// The axes that a vehicle's LOCAL_POSITION_NED refers to.
std::string local_frame_of(Source source) { return source_text(source) + "/local"; }

// The altitude is above mean sea level: the message has none above the ellipsoid. 0/0 stands for an unknown position.
void encode_position(const StandardInput& in, std::vector<std::uint8_t>& out) {
    Writer writer(out);
    writer.time(in.time);
    writer.text(source_text(in.source));
    const bool is_known = value_of(in.view, "lat") != 0 || value_of(in.view, "lon") != 0;
    writer.number(static_cast<std::int8_t>(is_known ? 0 : -1));
    writer.number(std::uint16_t{1});  // GPS
    writer.number(value_of(in.view, "lat") * 1e-7);
    writer.number(value_of(in.view, "lon") * 1e-7);
    writer.number(value_of(in.view, "alt") * 1e-3);
    for (int i = 0; i < 9; ++i) writer.number(0.0);
    writer.number(std::uint8_t{0});  // the covariance is not known
}

// MAVLink: x north, y east, z down. ROS: x east, y north, z up. 0 as long as the vehicle has sent no position.
void put_place(Writer& writer, const message::MessageView* position) {
    const auto value = [&](std::string_view name) { return position == nullptr ? 0.0 : value_of(*position, name); };
    writer.number(value("y"));
    writer.number(value("x"));
    writer.number(-value("z"));
}

// MAVLink's angles turn a body with z down into north, east, down; ROS's turn a body with z up into east, north, up. So
// roll stays, pitch changes its sign, and yaw is counted from east, to the other side.
void put_orientation(Writer& writer, const message::MessageView& attitude) {
    const double roll = value_of(attitude, "roll") / 2, pitch = -value_of(attitude, "pitch") / 2,
                 yaw = std::numbers::pi / 4 - value_of(attitude, "yaw") / 2;
    const double sr = std::sin(roll), cr = std::cos(roll), sp = std::sin(pitch), cp = std::cos(pitch),
                 sy = std::sin(yaw), cy = std::cos(yaw);
    writer.number(sr * cp * cy - cr * sp * sy);
    writer.number(cr * sp * cy + sr * cp * sy);
    writer.number(cr * cp * sy - sr * sp * cy);
    writer.number(cr * cp * cy + sr * sp * sy);
}

void encode_pose(const StandardInput& in, std::vector<std::uint8_t>& out) {
    Writer writer(out);
    writer.time(in.time);
    writer.text(local_frame_of(in.source));
    put_place(writer, in.other);
    put_orientation(writer, in.view);
}

void encode_transform(const StandardInput& in, std::vector<std::uint8_t>& out) {
    Writer writer(out);
    writer.number(std::uint32_t{1});
    writer.time(in.time);
    writer.text(local_frame_of(in.source));
    writer.text(source_text(in.source));
    put_place(writer, in.other);
    put_orientation(writer, in.view);
}

// From MAV_SEVERITY, 0 (emergency) to 7 (debug).
std::uint8_t level_of(double severity) {
    constexpr std::array<std::uint8_t, 8> levels{50, 50, 50, 40, 30, 20, 20, 10};
    return levels[static_cast<std::size_t>(std::clamp(severity, 0.0, 7.0))];
}

void encode_log(const StandardInput& in, std::vector<std::uint8_t>& out) {
    Writer writer(out);
    writer.time(in.time);
    writer.number(level_of(value_of(in.view, "severity")));
    writer.text(source_text(in.source));
    const auto* const text = in.view.definition().find("text");
    const auto words = text == nullptr ? std::string_view() : in.view.text(*text);
    writer.text(words.substr(0, words.find('\0')));
    writer.text("");
    writer.text("");
    writer.number(std::uint32_t{0});
}

constexpr MessageId attitude{30}, local_position_ned{32}, global_position_int{33}, statustext{253};

constexpr std::array standard_topics{
    Standard{global_position_int, {}, "position", "sensor_msgs/msg/NavSatFix", nav_sat_fix_schema, encode_position},
    Standard{attitude, local_position_ned, "pose", "geometry_msgs/msg/PoseStamped", pose_schema, encode_pose},
    Standard{attitude, local_position_ned, "tf", "tf2_msgs/msg/TFMessage", transforms_schema, encode_transform},
    Standard{statustext, {}, "log", "rcl_interfaces/msg/Log", log_schema, encode_log},
};

}  // namespace

std::span<const Standard> standards() noexcept { return standard_topics; }

}  // namespace mavloom::web
