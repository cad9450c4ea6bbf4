// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "mavloom/msg/attitude.hpp"
#include "mavloom/msg/param_error.hpp"
#include "mavloom/msg/param_request_list.hpp"
#include "mavloom/msg/param_request_read.hpp"
#include "mavloom/msg/param_set.hpp"
#include "mavloom/msg/param_value.hpp"
#include "mavloom/msg/vfr_hud.hpp"
#include "unit/sim/rig.hpp"

namespace mavloom::sim {
namespace {

using namespace std::chrono_literals;
using test::Peer;
using test::Rig;

constexpr std::uint8_t uint32_type = 5, int32_type = 6, real32_type = 9;
constexpr Peer other_client{LinkId{1}, {SystemId{245}, ComponentId{190}}};

std::array<char, 16> id_of(std::string_view name) {
    std::array<char, 16> id{};
    std::ranges::copy(name, id.begin());
    return id;
}
template <class Message>
std::string name_in(const Message& message) {
    return {message.param_id.data(), strnlen(message.param_id.data(), message.param_id.size())};
}
float float_of(std::int32_t value) { return std::bit_cast<float>(value); }
std::int32_t int_of(float value) { return std::bit_cast<std::int32_t>(value); }

msg::ParamSet set_of(std::string_view name, float value, std::uint8_t type) {
    return {
        .target_system = 1, .target_component = 1, .param_id = id_of(name), .param_value = value, .param_type = type};
}
msg::ParamRequestRead read_of(std::string_view name) {
    return {.target_system = 1, .target_component = 1, .param_id = id_of(name), .param_index = -1};
}
constexpr msg::ParamRequestList list_request{.target_system = 1, .target_component = 0};
constexpr VehicleOptions ardupilot{.autopilot = Autopilot::ardupilot};

TEST(ParameterService, ListsTheHashAndThenEveryValueOnce) {
    Rig rig;

    rig.send(list_request);
    rig.run(2.0);

    const auto values = rig.all<msg::ParamValue>();
    ASSERT_GT(values.size(), 150u);
    EXPECT_EQ(name_in(values[0]), "_HASH_CHECK");
    EXPECT_EQ(values[0].param_type, uint32_type);
    EXPECT_EQ(values[0].param_index, 0xffff);
    for (std::size_t i = 1; i < values.size(); ++i) {
        EXPECT_EQ(values[i].param_index, i - 1);
        EXPECT_EQ(values[i].param_count, values.size() - 1);
        EXPECT_TRUE(i == 1 || name_in(values[i - 1]) < name_in(values[i])) << i;
    }
}

TEST(ParameterService, SendsAtLeastAThousandValuesASecond) {
    Rig rig;

    rig.send(list_request);
    rig.run(100ms);

    EXPECT_GE(rig.all<msg::ParamValue>().size(), 100u);
}

// At 57,600 baud a link takes 5,760 bytes a second. The queue may not grow beyond a few frames.
TEST(ParameterService, WaitsWhileTheLinkHasNoRoom) {
    Rig rig;
    rig.sink.full = {1};
    rig.send(list_request);
    rig.run(1.0);
    EXPECT_TRUE(rig.all<msg::ParamValue>().empty());

    rig.sink.full = {};
    rig.run(2.0);

    const auto values = rig.all<msg::ParamValue>();
    ASSERT_FALSE(values.empty());
    EXPECT_EQ(values.size(), values.back().param_count + 1u);
}

TEST(ParameterService, StartsOverOnASecondRequestWithoutTheHash) {
    Rig rig;
    rig.send(list_request);
    rig.run(15ms);
    rig.forget();

    rig.send(list_request);
    rig.run(2.0);

    const auto values = rig.all<msg::ParamValue>();
    ASSERT_FALSE(values.empty());
    EXPECT_EQ(values[0].param_index, 0);
    EXPECT_EQ(values.size(), values[0].param_count);
}

TEST(ParameterService, GivesEachClientAListOfItsOwn) {
    Rig rig;
    rig.vehicle.open(LinkId{2}, {}, rig.now());
    rig.send(list_request);
    rig.run(20ms);
    rig.send(list_request, {.link = LinkId{2}});
    rig.run(2.0);

    for (const LinkId link : {LinkId{1}, LinkId{2}}) {
        std::set<std::uint16_t> indices;
        for (const auto& value : rig.all<msg::ParamValue>(link)) EXPECT_TRUE(indices.insert(value.param_index).second);
        EXPECT_EQ(indices.size(), rig.last<msg::ParamValue>(link)->param_count + 1u);
    }
}

TEST(ParameterService, EndsTheListOfAClientThatHasAllValues) {
    Rig rig;
    rig.send(list_request);
    rig.send(list_request, other_client);
    rig.run(1ms);
    const auto hash = rig.all<msg::ParamValue>().front();
    rig.forget();

    rig.send(set_of("_HASH_CHECK", hash.param_value, uint32_type), other_client);
    rig.send(set_of("_HASH_CHECK", hash.param_value, uint32_type));
    rig.run(1.0);

    EXPECT_TRUE(rig.all<msg::ParamValue>().empty());
    const auto errors = rig.all<msg::ParamError>();
    ASSERT_EQ(errors.size(), 2u);
    EXPECT_EQ(errors[0].error, 5) << "read only";
    EXPECT_EQ(errors[0].target_system, 245);
    EXPECT_EQ(errors[1].target_system, 255);
}

// The checksum over the values of the list, by an independent computation.
TEST(ParameterService, HashIsTheChecksumOfTheList) {
    Rig rig;
    rig.send(list_request);
    rig.run(2.0);
    const std::set<std::string> changing{"COM_FLIGHT_UUID", "EKF2_MAG_DECL", "LND_FLIGHT_T_HI", "LND_FLIGHT_T_LO",
                                         "SENS_DPRES_OFF"};
    std::uint32_t crc = 0;
    const auto add = [&crc](unsigned char byte) {
        crc ^= byte;
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc % 2 == 1 ? 0xedb88320u : 0);
    };
    const auto values = rig.all<msg::ParamValue>();
    for (std::size_t i = 1; i < values.size(); ++i) {
        const std::string name = name_in(values[i]);
        const bool is_calibration = name.starts_with("CAL_") && (name.ends_with("OFF") || name.ends_with("SCALE") ||
                                                                 name.ends_with("COMP") || name.ends_with("DIAG"));
        const bool is_mode = name.starts_with("COM_MODE") && name.ends_with("_HASH");
        if (changing.contains(name) || is_calibration || is_mode) continue;
        for (const char c : name) add(static_cast<unsigned char>(c));
        for (int shift = 0; shift < 32; shift += 8)
            add(static_cast<unsigned char>(std::bit_cast<std::uint32_t>(values[i].param_value) >> shift));
    }

    EXPECT_EQ(std::bit_cast<std::uint32_t>(values[0].param_value), crc);
}

TEST(ParameterService, ReadsByNameAndByIndex) {
    Rig rig;
    rig.send(read_of("MIS_TAKEOFF_ALT"));
    const auto value = rig.last<msg::ParamValue>();
    ASSERT_TRUE(value);
    EXPECT_EQ(value->param_value, 2.5f);
    EXPECT_EQ(value->param_type, real32_type);

    rig.send(msg::ParamRequestRead{.target_system = 1,
                                   .param_id = id_of("BAT1_N_CELLS"),
                                   .param_index = static_cast<std::int16_t>(value->param_index)});

    EXPECT_EQ(name_in(*rig.last<msg::ParamValue>()), "MIS_TAKEOFF_ALT") << "the index wins";
}

TEST(ParameterService, TransportsIntegersOfPx4ByteByByte) {
    Rig rig;
    rig.send(read_of("BAT1_N_CELLS"));

    const auto value = rig.last<msg::ParamValue>();
    ASSERT_TRUE(value);
    EXPECT_EQ(int_of(value->param_value), 4);
    EXPECT_EQ(value->param_type, int32_type);
}

TEST(ParameterService, HandlesNamesOfSixteenCharacters) {
    Rig rig;
    rig.send(read_of("COM_FLTMODE_BOOT"));

    ASSERT_TRUE(rig.last<msg::ParamValue>());
    EXPECT_EQ(name_in(*rig.last<msg::ParamValue>()), "COM_FLTMODE_BOOT");
}

TEST(ParameterService, RefusesUnknownNamesAndIndices) {
    Rig rig;
    rig.send(read_of("NO_SUCH_PARAM"));
    ASSERT_TRUE(rig.last<msg::ParamError>());
    EXPECT_EQ(rig.last<msg::ParamError>()->error, 1);
    EXPECT_EQ(name_in(*rig.last<msg::ParamError>()), "NO_SUCH_PARAM");
    EXPECT_EQ(rig.last<msg::ParamError>()->param_index, -1);

    for (const int index : {-2, 5000, 32767, -32768}) {
        rig.send(msg::ParamRequestRead{
            .target_system = 1, .param_id = id_of("BAT1_N_CELLS"), .param_index = static_cast<std::int16_t>(index)});
        EXPECT_EQ(rig.last<msg::ParamError>()->param_index, index);
    }
    rig.send(set_of("", 1, real32_type));
    rig.send(set_of("NO_SUCH_PARAM", 1, real32_type));
    EXPECT_EQ(rig.all<msg::ParamError>().size(), 7u);
    EXPECT_TRUE(rig.all<msg::ParamValue>().empty());
}

TEST(ParameterService, StoresAValueAndReportsItOnAllLinks) {
    Rig rig;
    rig.vehicle.open(LinkId{2}, {}, rig.now());

    rig.send(set_of("NAV_DLL_ACT", float_of(2), int32_type));
    rig.send(set_of("MIS_TAKEOFF_ALT", 10, real32_type));

    for (const LinkId link : {LinkId{1}, LinkId{2}}) {
        const auto values = rig.all<msg::ParamValue>(link);
        ASSERT_EQ(values.size(), 2u);
        EXPECT_EQ(int_of(values[0].param_value), 2);
        EXPECT_EQ(values[1].param_value, 10);
    }
    rig.forget();
    rig.send(read_of("NAV_DLL_ACT"));
    EXPECT_EQ(int_of(rig.last<msg::ParamValue>()->param_value), 2);
}

// The client sees PARAM_ERROR first. A client that does not know it sees by PARAM_VALUE that nothing changed.
TEST(ParameterService, RefusesAnotherTypeAndRepeatsTheOldValue) {
    Rig rig;
    rig.vehicle.open(LinkId{2}, {}, rig.now());
    rig.send(set_of("BAT1_N_CELLS", 6, real32_type));
    rig.send(set_of("MIS_TAKEOFF_ALT", float_of(6), int32_type));
    rig.send(set_of("BAT1_N_CELLS", 6, uint32_type));

    const auto errors = rig.all<msg::ParamError>();
    const auto values = rig.all<msg::ParamValue>();
    ASSERT_EQ(errors.size(), 3u);
    ASSERT_EQ(values.size(), 3u);
    EXPECT_EQ(errors[0].error, 7);
    EXPECT_EQ(errors[1].error, 7);
    EXPECT_EQ(errors[2].error, 6);
    EXPECT_EQ(int_of(values[0].param_value), 4);
    EXPECT_EQ(values[1].param_value, 2.5f);
    EXPECT_TRUE(rig.all<msg::ParamValue>(LinkId{2}).empty());
    const auto first = std::ranges::find_if(rig.sink.frames, [](const test::Sent& sent) {
        return sent.frame().id() == msg::ParamError::id || sent.frame().id() == msg::ParamValue::id;
    });
    EXPECT_EQ(first->frame().id(), msg::ParamError::id);
}

// PX4 stores values beyond the range in its metadata, and NaN.
TEST(ParameterService, StoresAnyValueOfTheRightType) {
    Rig rig;
    for (const float value : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1e9f}) {
        rig.send(set_of("BAT_LOW_THR", value, real32_type));
        EXPECT_EQ(int_of(rig.last<msg::ParamValue>()->param_value), int_of(value));
    }
    rig.run(1.0);
}

TEST(ParameterService, HandlesTruncatedRequests) {
    Rig rig;
    msg::ParamSet request{.target_system = 1, .target_component = 0};
    rig.send(request);
    rig.send(msg::ParamRequestRead{.target_system = 1});

    EXPECT_EQ(rig.all<msg::ParamError>().size(), 1u);
    EXPECT_EQ(rig.all<msg::ParamValue>().size(), 1u) << "index 0";
}

TEST(ParameterService, DropsTheListOfAClosedLink) {
    Rig rig;
    rig.vehicle.open(LinkId{2}, {}, rig.now());
    rig.send(list_request, {.link = LinkId{2}});
    rig.vehicle.close(LinkId{2});
    rig.forget();
    rig.run(1.0);

    EXPECT_TRUE(rig.all<msg::ParamValue>(LinkId{2}).empty());
}

TEST(ParameterService, LimitsTheNumberOfClients) {
    Rig rig;
    rig.sink.full = {1};
    for (int i = 0; i < 100; ++i)
        rig.send(list_request, {.id = {SystemId{static_cast<std::uint8_t>(100 + i)}, ComponentId{1}}});

    EXPECT_EQ(rig.all<msg::ParamError>().size(), 100u - VehicleOptions{}.limits.clients);
}

// The far side of link 1 takes nothing, so none of its lists ends.
TEST(ParameterService, AClientWithManyIdsKeepsNoOtherLinkOut) {
    Rig rig;
    rig.vehicle.open(LinkId{2}, {}, rig.now());
    rig.sink.full = {1};
    for (int i = 0; i < 100; ++i)
        rig.send(list_request, {.id = {SystemId{static_cast<std::uint8_t>(100 + i)}, ComponentId{1}}});

    rig.send(list_request, {.link = LinkId{2}});
    rig.run(10.0);

    EXPECT_TRUE(rig.all<msg::ParamError>(LinkId{2}).empty());
    const auto values = rig.all<msg::ParamValue>(LinkId{2});
    ASSERT_FALSE(values.empty());
    EXPECT_EQ(values.size(), values.back().param_count + 1u) << "and the checksum";
}

TEST(ParameterService, CastsValuesOfArduPilot) {
    Rig rig(ardupilot);
    rig.send(read_of("RTL_ALT"));
    EXPECT_EQ(rig.last<msg::ParamValue>()->param_value, 1500);
    EXPECT_EQ(rig.last<msg::ParamValue>()->param_type, int32_type);
    rig.send(read_of("FRAME_CLASS"));
    EXPECT_EQ(rig.last<msg::ParamValue>()->param_value, 1);
    EXPECT_EQ(rig.last<msg::ParamValue>()->param_type, 2);

    // pymavlink's param_set_send() sends REAL32 by default, for integers as well.
    rig.send(set_of("RTL_ALT", 2000, real32_type));
    EXPECT_EQ(rig.last<msg::ParamValue>()->param_value, 2000);
    rig.send(set_of("RTL_ALT", std::nanf(""), real32_type));
    EXPECT_EQ(rig.last<msg::ParamError>()->error, 2);
    EXPECT_EQ(rig.last<msg::ParamValue>()->param_value, 2000);
}

TEST(ParameterService, ArduPilotKnowsNoHash) {
    Rig rig(ardupilot);
    rig.send(read_of("_HASH_CHECK"));
    EXPECT_EQ(rig.last<msg::ParamError>()->error, 1);
    rig.send(list_request);
    rig.run(2.0);

    const auto values = rig.all<msg::ParamValue>();
    ASSERT_FALSE(values.empty());
    EXPECT_EQ(values[0].param_index, 0);
    EXPECT_EQ(values.size(), values[0].param_count);
}

TEST(ParameterService, RatesOfArduPilotsGroupsActOnAllLinks) {
    Rig rig(ardupilot, {.profile = Profile::ardupilot});
    rig.send(set_of("SR0_EXTRA1", 10, real32_type));
    rig.vehicle.open(LinkId{2}, {.profile = Profile::ardupilot}, rig.now());
    rig.forget();
    rig.run(5.0);

    for (const LinkId link : {LinkId{1}, LinkId{2}}) {
        EXPECT_NEAR(static_cast<double>(rig.all<msg::Attitude>(link).size()), 50, 1);
        EXPECT_NEAR(static_cast<double>(rig.all<msg::VfrHud>(link).size()), 20, 1) << "another group";
    }
    rig.send(set_of("SR0_EXTRA1", 0, real32_type));
    rig.forget();
    rig.run(2.0);
    EXPECT_TRUE(rig.all<msg::Attitude>().empty());
}

TEST(ParameterService, CountsFlights) {
    Rig rig(VehicleOptions{.ready_after = 0ms});
    rig.run(1.0);
    ASSERT_TRUE(rig.vehicle.arm(false).has_value());
    ASSERT_TRUE(rig.vehicle.disarm(false).has_value());
    rig.run(1.0);
    rig.forget();
    rig.send(read_of("COM_FLIGHT_UUID"));

    EXPECT_EQ(int_of(rig.last<msg::ParamValue>()->param_value), 1);
}

TEST(ParameterService, SystemIdIsTheVehiclesOwn) {
    Rig rig(VehicleOptions{.system = SystemId{7}});
    rig.send(msg::ParamRequestRead{.target_system = 7, .param_id = id_of("MAV_SYS_ID"), .param_index = -1});

    ASSERT_TRUE(rig.last<msg::ParamValue>());
    EXPECT_EQ(int_of(rig.last<msg::ParamValue>()->param_value), 7);
}

}  // namespace
}  // namespace mavloom::sim
