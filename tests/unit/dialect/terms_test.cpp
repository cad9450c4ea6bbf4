// SPDX-License-Identifier: MIT
#include "mavloom/dialect/terms.hpp"

#include <gmock/gmock.h>

namespace mavloom::dialect {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string error_of(std::string_view rate) {
    const auto term = parse_rate_term(rate);
    return term ? "none" : term.error().text;
}

TEST(RateTerm, HasANameAnIdOrAStar) {
    for (const auto& [text, message, rate] : {std::tuple{"ATTITUDE:10", "ATTITUDE", 10.0},
                                              std::tuple{"30:0.5", "30", 0.5}, std::tuple{"*:50", "*", 50.0}}) {
        const auto term = parse_rate_term(text);
        ASSERT_TRUE(term.has_value()) << text;
        EXPECT_EQ(term->message, message);
        EXPECT_EQ(term->rate_hz, rate);
    }
}

TEST(RateTerm, RefusesWhatIsNone) {
    EXPECT_THAT(error_of("ATTITUDE"), HasSubstr("has no rate"));
    EXPECT_THAT(error_of(":1"), HasSubstr("not a message name"));
    EXPECT_THAT(error_of("A-B:1"), HasSubstr("not a message name"));
    EXPECT_THAT(error_of("16777216:1"), HasSubstr("0 to 16777215"));
    for (const auto* rate : {"A:", "A:0", "A:-1", "A:+1", "A:nan", "A:inf", "A:1x", "A:1e999"})
        EXPECT_THAT(error_of(rate), HasSubstr("not a number above 0")) << rate;
}

TEST(Terms, AreSeparatedByCommas) {
    std::vector<std::string> found;
    const auto keep = [&](std::string_view term) -> SetupResult<void> {
        found.emplace_back(term);
        return {};
    };
    ASSERT_TRUE(for_each_term("a,b,c", keep).has_value());
    EXPECT_THAT(found, ElementsAre("a", "b", "c"));
    for (const auto* empty : {"", "a,", ",a", "a,,b"}) EXPECT_FALSE(for_each_term(empty, keep).has_value()) << empty;
}

TEST(Terms, AreLookedUpByNameOrId) {
    const auto& dialect = default_dialect();

    EXPECT_EQ(find_message_id(dialect, "ATTITUDE")->value, 30u);
    EXPECT_EQ(find_message_id(dialect, "16777215")->value, 16777215u);
    EXPECT_THAT(find_message_id(dialect, "ATITUDE").error().text, HasSubstr("did you mean 'ATTITUDE'?"));
    EXPECT_EQ((*find_message(dialect, "30"))->name, "ATTITUDE");
    EXPECT_THAT(find_message(dialect, "16777215").error().text, HasSubstr("has no definition"));
}

}  // namespace
}  // namespace mavloom::dialect
