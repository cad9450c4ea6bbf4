// SPDX-License-Identifier: MIT
#include "mavloom/dialect/rates.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <limits>

namespace mavloom::dialect {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

Rates rates_of(const std::vector<RateTerm>& terms) { return *Rates::compile(default_dialect(), terms); }

std::optional<Nanoseconds> interval(const Rates& rates, std::uint32_t id) {
    const auto* const found = rates.interval_of(MessageId{id});
    return found == nullptr ? std::nullopt : std::optional(*found);
}

TEST(Rates, AreIntervalsByMessage) {
    const auto sut = rates_of({{"ATTITUDE", 10}, {"0", 0.5}, {"*", 50}});

    EXPECT_EQ(interval(sut, 30), std::chrono::milliseconds{100});
    EXPECT_EQ(interval(sut, 0), std::chrono::seconds{2});
    EXPECT_EQ(interval(sut, 33), std::chrono::milliseconds{20});
    EXPECT_EQ(interval(sut, 12345678), std::chrono::milliseconds{20});  // no definition: telemetry
}

TEST(Rates, WithoutAStarLimitOnlyWhatTheyName) {
    const auto sut = rates_of({{"ATTITUDE", 10}});

    EXPECT_EQ(interval(sut, 33), std::nullopt);
    EXPECT_FALSE(sut.empty());
    EXPECT_TRUE(Rates().empty());
}

// One of each kind that docs/guide/queues.md exempts, and of those that it does not.
TEST(Rates, TheStarIsTelemetryThatCanBeThinned) {
    const auto sut = rates_of({{"*", 1}});

    for (const std::uint32_t id : {22u, 47u, 77u, 253u, 110u, 69u, 131u, 120u, 385u, 410u, 148u, 435u})
        EXPECT_EQ(interval(sut, id), std::nullopt) << id;
    for (const std::uint32_t id : {30u, 33u, 246u, 330u, 260u, 35u})
        EXPECT_EQ(interval(sut, id), std::chrono::seconds{1}) << id;
}

TEST(Rates, RefuseWhatIsNoRate) {
    const auto error_of = [](const std::vector<RateTerm>& terms) {
        const auto rates = Rates::compile(default_dialect(), terms);
        return rates ? std::string("accepted") : rates.error().text;
    };

    EXPECT_EQ(error_of({{"ATTITUDE", 0}}), "'ATTITUDE' needs a rate above 0, in Hz");
    EXPECT_EQ(error_of({{"*", std::numeric_limits<double>::infinity()}}), "'*' needs a rate above 0, in Hz");
    EXPECT_EQ(error_of({{"ATTITUDE", 1}, {"30", 2}}), "'30' has two rates");
    EXPECT_EQ(error_of({{"*", 1}, {"*", 2}}), "'*' has two rates");
    EXPECT_THAT(error_of({{"ATITUDE", 1}}), HasSubstr("ATTITUDE"));
}

TEST(RateWarnings, NameWhatBreaks) {
    const auto warnings_of = [](const std::vector<RateTerm>& terms) { return rate_warnings(default_dialect(), terms); };

    EXPECT_THAT(warnings_of({{"ATTITUDE", 1}, {"*", 1}, {"ADSB_VEHICLE", 1}, {"12345678", 1}}), IsEmpty());
    EXPECT_THAT(warnings_of({{"COMMAND_ACK", 1}, {"ATTITUDE", 1}, {"110", 0.5}}),
                ElementsAre(StartsWith("COMMAND_ACK:1 drops"), StartsWith("110:0.5 drops FILE_TRANSFER_PROTOCOL")));
    EXPECT_THAT(warnings_of({{"COMMAND_ACK", 1}}), ElementsAre(HasSubstr("commands and their answers may get lost")));
    EXPECT_THAT(warnings_of({{"PARAM_VALUE", 1}}), ElementsAre(HasSubstr("parameters may fail")));
    EXPECT_THAT(warnings_of({{"LOG_DATA", 1}}), ElementsAre(HasSubstr("one piece")));
}

}  // namespace
}  // namespace mavloom::dialect
