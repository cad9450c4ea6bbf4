// SPDX-License-Identifier: MIT
#include "simserve/scenario/vehicle_fault.hpp"

#include <gmock/gmock.h>

#include "simserve/scenario/time_line.hpp"

namespace mavloom::simserve {
namespace {

using testing::HasSubstr;

TEST(VehicleFault, HasAPartAKindAndNumbers) {
    const auto jump = parse_vehicle_fault(" gps  jump -100 2.5 ");
    ASSERT_TRUE(jump) << jump.error().text;
    EXPECT_EQ(jump->part, sim::FaultPart::gps);
    EXPECT_EQ(jump->kind, sim::FaultKind::jump);
    EXPECT_EQ(jump->count, 2u);
    EXPECT_EQ(jump->numbers, (std::array{-100.0, 2.5}));
    EXPECT_EQ(parse_vehicle_fault("motor off")->count, 0u);
    EXPECT_EQ(parse_vehicle_fault("all ok")->part, sim::FaultPart::all);
}

TEST(VehicleFault, ErrorsStateWhatThereIs) {
    const std::pair<std::string_view, std::string_view> wrong[]{
        {"", "write PART FAULT, as in gps off"},
        {"gps", "write PART FAULT, as in gps off"},
        {"gsp off", "did you mean 'gps'?"},
        {"gps fast", "gps takes ok, off, stuck, wrong, jump NORTH EAST, drift NORTH EAST, not 'fast'"},
        {"gps jump 5", "write gps jump NORTH EAST"},
        {"gps off 1", "write gps off"},
        {"gps jump 5 north", "'north' is not a number from -100000 to 100000"},
        {"motor off 1.5", "not a whole number"},
        {"motor off 17", "not a number from 1 to 16"},
        {"battery charge nan", "not a number from 0 to 100"},
    };
    for (const auto& [text, why] : wrong) {
        const auto fault = parse_vehicle_fault(text);
        ASSERT_FALSE(fault) << text;
        EXPECT_THAT(fault.error().text, HasSubstr(why));
    }
}

TEST(VehicleFault, IsAnOrderOfTheTimeLine) {
    EXPECT_EQ(*request_of_order("fail gps drift 1 0", SystemId{2}),
              R"({"cmd":"fail","fault":"gps drift 1 0","system":2})");
    EXPECT_FALSE(request_of_order("fail gps", {}));
}

}  // namespace
}  // namespace mavloom::simserve
