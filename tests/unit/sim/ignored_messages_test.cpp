// SPDX-License-Identifier: MIT
// Messages that a vehicle takes without an answer and without an effect: corrections, measurements and traffic of other
// systems, and bytes that mean nothing.
#include <gmock/gmock.h>

#include "mavloom/msg/adsb_vehicle.hpp"
#include "mavloom/msg/att_pos_mocap.hpp"
#include "mavloom/msg/battery_status.hpp"
#include "mavloom/msg/distance_sensor.hpp"
#include "mavloom/msg/gps_inject_data.hpp"
#include "mavloom/msg/gps_rtcm_data.hpp"
#include "mavloom/msg/landing_target.hpp"
#include "mavloom/msg/obstacle_distance.hpp"
#include "mavloom/msg/odometry.hpp"
#include "mavloom/msg/play_tune.hpp"
#include "mavloom/msg/play_tune_v2.hpp"
#include "mavloom/msg/statustext.hpp"
#include "mavloom/msg/system_time.hpp"
#include "mavloom/msg/tunnel.hpp"
#include "mavloom/msg/vicon_position_estimate.hpp"
#include "mavloom/msg/vision_position_estimate.hpp"
#include "mavloom/msg/vision_speed_estimate.hpp"
#include "unit/sim/rig.hpp"

namespace mavloom::sim::ignored_tests {
namespace {

using test::Rig;

class IgnoredMessages : public testing::TestWithParam<Autopilot> {
protected:
    static VehicleOptions options() {
        VehicleOptions options;
        options.autopilot = GetParam();
        return options;
    }
    template <class Message>
    void receive() {
        const wire::MessageInfo& info = *dialect::default_dialect().wire_table().find(Message::id);
        for (const std::uint8_t fill : std::initializer_list<std::uint8_t>{0, 1, 0x7f, 0xff}) {
            std::vector<std::uint8_t> payload(info.max_length, fill);
            for (const auto offset : {info.target_system_offset, info.target_component_offset})
                if (offset != wire::MessageInfo::no_target) payload[offset] = 1;
            receive(info, payload);
        }
    }
    void receive(const wire::MessageInfo& info, ByteView payload) {
        wire::FrameBuffer buffer;
        const auto frame = wire::write_frame(buffer, {.source = {SystemId{255}, ComponentId{190}}}, info, payload);
        disturbed.vehicle.receive(LinkId{1}, frame, &info, disturbed.now());
    }
    // The vehicle that got the messages sends the same bytes as one that did not.
    void expect_no_effect() {
        disturbed.run(3.0);
        quiet.run(3.0);
        ASSERT_EQ(disturbed.sink.frames.size(), quiet.sink.frames.size());
        for (std::size_t i = 0; i < quiet.sink.frames.size(); ++i)
            ASSERT_EQ(disturbed.sink.frames[i].bytes, quiet.sink.frames[i].bytes) << i;
    }
    Rig disturbed{options()}, quiet{options()};
};

TEST_P(IgnoredMessages, ChangeNothing) {
    disturbed.run(3.0);
    quiet.run(3.0);

    receive<msg::GpsRtcmData>();
    receive<msg::GpsInjectData>();
    receive<msg::VisionPositionEstimate>();
    receive<msg::VisionSpeedEstimate>();
    receive<msg::ViconPositionEstimate>();
    receive<msg::AttPosMocap>();
    receive<msg::Odometry>();
    receive<msg::DistanceSensor>();
    receive<msg::ObstacleDistance>();
    receive<msg::LandingTarget>();
    receive<msg::PlayTune>();
    receive<msg::PlayTuneV2>();
    receive<msg::Tunnel>();
    receive<msg::Statustext>();
    receive<msg::SystemTime>();
    receive<msg::BatteryStatus>();
    receive<msg::AdsbVehicle>();

    expect_no_effect();
}

TEST_P(IgnoredMessages, AnUnknownIdChangesNothing) {
    disturbed.run(3.0);
    quiet.run(3.0);
    const std::array<std::uint8_t, 14> bytes{wire::stx_v2, 2, 0, 0, 7, 255, 190, 0xfe, 0xff, 0xff, 1, 1, 0, 0};

    disturbed.vehicle.receive(LinkId{1}, wire::FrameView::unchecked(bytes), nullptr, disturbed.now());

    expect_no_effect();
}

INSTANTIATE_TEST_SUITE_P(Firmwares, IgnoredMessages, testing::Values(Autopilot::px4, Autopilot::ardupilot),
                         [](const auto& test) { return std::string(autopilot_names[static_cast<int>(test.param)]); });

}  // namespace
}  // namespace mavloom::sim::ignored_tests
