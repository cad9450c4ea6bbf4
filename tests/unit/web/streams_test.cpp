// SPDX-License-Identifier: MIT
#include "web/clients/streams.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace mavloom::web {
namespace {

using ::testing::HasSubstr;

std::string error_of(std::string_view query) {
    const auto terms = parse_stream_terms(dialect::default_dialect(), query);
    return terms ? "" : terms.error().text;
}

constexpr Source vehicle{SystemId{1}, ComponentId{1}}, camera{SystemId{1}, ComponentId{100}};

TEST(StreamTerms, NarrowWhatIsSent) {
    const auto terms = *parse_stream_terms(dialect::default_dialect(),
                                           "only=ATTITUDE,24&from=1/1&max_rate=ATTITUDE:10");
    EXPECT_TRUE(terms.filter.admits(MessageId{30}, vehicle));
    EXPECT_TRUE(terms.filter.admits(MessageId{24}, vehicle));
    EXPECT_FALSE(terms.filter.admits(MessageId{0}, vehicle));
    EXPECT_FALSE(terms.filter.admits(MessageId{30}, camera));
    EXPECT_EQ(*terms.max_rate.interval_of(MessageId{30}), std::chrono::milliseconds(100));
}

TEST(StreamTerms, WithoutAQueryAdmitEverything) {
    const auto terms = *parse_stream_terms(dialect::default_dialect(), "");
    EXPECT_TRUE(terms.filter.admits_all());
    EXPECT_TRUE(terms.max_rate.empty());
}

TEST(StreamTerms, ErrorsNameTheOption) {
    EXPECT_THAT(error_of("only=ATITUDE"), HasSubstr("only: "));
    EXPECT_THAT(error_of("only=ATITUDE"), HasSubstr("ATTITUDE"));
    EXPECT_THAT(error_of("from=1/x"), HasSubstr("from: '1/x' is not SYS or SYS/COMP"));
    EXPECT_THAT(error_of("max_rate=5"), HasSubstr("max_rate: "));
    EXPECT_THAT(error_of("rate=5"), HasSubstr("rate: there is no such option; a stream takes only, from and max_rate"));
    EXPECT_NE(error_of("only=%zz"), "");
}

}  // namespace
}  // namespace mavloom::web
