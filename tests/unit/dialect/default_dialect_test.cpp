// SPDX-License-Identifier: MIT
// Facts of the default dialect, as upstream's XML states them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mavloom/dialect/dialect.hpp"

namespace mavloom::dialect {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// Message ids that a PX4 (main of August 2026) and QGroundControl sent in six recordings, by tools that know no
// dialect.
TEST(DefaultDialect, KnowsEveryIdThatPx4AndQGroundControlSent) {
    constexpr std::uint32_t ids[] = {
        0,   1,   2,   4,   8,   11,  20,  21,  22,  23,  24,  29,  30,  31,  32,  33,  36,  41,  42,  43,    44,   45,
        46,  47,  49,  51,  73,  74,  75,  76,  77,  83,  85,  87,  105, 110, 111, 117, 118, 122, 132, 141,   147,  148,
        230, 241, 242, 244, 245, 253, 290, 291, 300, 331, 345, 380, 397, 410, 411, 435, 436, 441, 514, 12901, 12904};
    for (const auto id : ids) EXPECT_NE(default_dialect().find(MessageId{id}), nullptr) << id;
}

TEST(DefaultDialect, FindsMessagesByIdAndName) {
    const auto& dialect = default_dialect();
    EXPECT_EQ(dialect.name(), "all");
    EXPECT_EQ(dialect.messages().size(), 393u);
    EXPECT_EQ(dialect.find(MessageId{30}), dialect.find("ATTITUDE"));
    EXPECT_EQ(dialect.find("ATTITUDE")->origin, "common.xml");
    EXPECT_EQ(dialect.find("HEARTBEAT")->origin, "minimal.xml");
    EXPECT_EQ(dialect.find("MISSION_CHECKSUM")->id(), MessageId{53});
    EXPECT_EQ(dialect.find("attitude"), nullptr);
    EXPECT_EQ(dialect.find(MessageId{0xffffff}), nullptr);
    EXPECT_EQ(dialect.wire_table().find(MessageId{30})->crc_extra, 39);
}

TEST(DefaultDialect, KeepsUnitsInvalidsMultipliersAndInstances) {
    const auto& dialect = default_dialect();
    EXPECT_EQ(dialect.field("ATTITUDE.rollspeed")->field->units, "rad/s");
    EXPECT_EQ(dialect.field("GPS_RAW_INT.eph")->field->invalid, "UINT16_MAX");
    EXPECT_DOUBLE_EQ(dialect.field("GPS_RAW_INT.eph")->field->multiplier, 0.01);
    EXPECT_DOUBLE_EQ(dialect.field("GPS_STATUS.satellite_azimuth")->field->multiplier, 360.0 / 255.0);
    EXPECT_TRUE(dialect.field("BATTERY_STATUS.id")->field->instance);
    EXPECT_TRUE(dialect.field("BATTERY_STATUS.mode")->field->extension);
    EXPECT_TRUE(dialect.field("HEARTBEAT.base_mode")->field->bitmask);
    EXPECT_FALSE(dialect.field("HEARTBEAT.type")->field->bitmask);
}

TEST(DefaultDialect, CountsTargetOfManualControlAsTargetSystem) {
    EXPECT_EQ(default_dialect().find("MANUAL_CONTROL")->wire.target_system_offset, 10);
    EXPECT_EQ(default_dialect().find("MANUAL_CONTROL")->wire.target_component_offset, wire::MessageInfo::no_target);
}

// Offsets worked out by hand from the definitions' wire order.
TEST(DefaultDialect, KnowsWhereASendersClockLies) {
    const auto boot_time = [](std::string_view name) { return default_dialect().find(name)->wire.boot_time_offset; };

    EXPECT_EQ(boot_time("SYSTEM_TIME"), 8);
    EXPECT_EQ(boot_time("ATTITUDE"), 0);
    EXPECT_EQ(boot_time("CAMERA_IMAGE_CAPTURED"), 8);  // behind time_utc
    for (const auto* none : {"HEARTBEAT", "GPS_RAW_INT", "SET_POSITION_TARGET_LOCAL_NED"})
        EXPECT_EQ(boot_time(none), wire::MessageInfo::no_boot_time) << none;
}

TEST(DefaultDialect, LabelsCommandParameters) {
    const auto* command = default_dialect().find_enum("MAV_CMD")->find("MAV_CMD_NAV_WAYPOINT");
    ASSERT_NE(command, nullptr);
    EXPECT_EQ(command->value, 16u);
    ASSERT_EQ(command->params.size(), 7u);
    EXPECT_EQ(command->params[0].index, 1);
    EXPECT_EQ(command->params[0].label, "Hold");
    EXPECT_EQ(command->params[0].units, "s");
    EXPECT_EQ(command->params[0].minimum, 0.0);
    EXPECT_EQ(command->params[6].label, "Altitude");
}

TEST(DefaultDialect, KnowsWhatIsDeprecated) {
    const auto& dialect = default_dialect();
    EXPECT_EQ(dialect.find("RADIO")->deprecated.since, "2013-06");
    EXPECT_EQ(dialect.find("RADIO")->deprecated.replaced_by, "RADIO_STATUS");
    EXPECT_EQ(dialect.find_enum("MAV_MODE")->deprecated.replaced_by, "MAV_MODE_FLAG");
    EXPECT_EQ(dialect.find("ATTITUDE")->deprecated.since, "");
}

TEST(DefaultDialect, MergesEnumsOverFiles) {
    const auto* commands = default_dialect().find_enum("MAV_CMD");
    EXPECT_NE(commands->find("MAV_CMD_NAV_TAKEOFF"), nullptr);                // common.xml
    EXPECT_NE(commands->find("MAV_CMD_DO_SET_RESUME_REPEAT_DIST"), nullptr);  // ardupilotmega.xml
    EXPECT_EQ(commands->find(std::uint64_t{22})->name, "MAV_CMD_NAV_TAKEOFF");
    EXPECT_EQ(commands->find(std::uint64_t{65536}), nullptr);
}

TEST(Dialect, SuggestsTheNearestName) {
    const auto& dialect = default_dialect();
    const auto message = dialect.message("ATITUDE");
    ASSERT_FALSE(message);
    EXPECT_EQ(message.error().code, SetupCode::usage);
    EXPECT_THAT(message.error().text, AllOf(HasSubstr("'ATITUDE'"), HasSubstr("'ATTITUDE'")));
    EXPECT_THAT(dialect.field("ATTITUDE.rol").error().text,
                AllOf(HasSubstr("ATTITUDE"), HasSubstr("'rol'"), HasSubstr("'roll'")));
    EXPECT_THAT(dialect.field("ATITUDE.roll").error().text, HasSubstr("'ATTITUDE'"));
    EXPECT_THAT(dialect.field("ATTITUDE").error().text, HasSubstr("expected MESSAGE.field"));
}

TEST(Dialect, ResolvesAFieldOnce) {
    const auto handle = default_dialect().field("ATTITUDE.yaw");
    ASSERT_TRUE(handle);
    EXPECT_EQ(handle->message->name, "ATTITUDE");
    EXPECT_EQ(handle->field->offset, 12);
    EXPECT_EQ(handle->field->type, FieldType::f32);
}

}  // namespace
}  // namespace mavloom::dialect
