// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "unit/message/sample_messages.hpp"

namespace mavloom::message {
namespace {

using namespace mavloom::testing;  // NOLINT: the sample definitions

std::string header_of(const Message& message) {
    TextBuffer out;
    append_csv_header(out, message);
    return fmt::to_string(out);
}

std::string row_of(const Received& received) {
    TextBuffer out;
    append_csv_row(out, received);
    return fmt::to_string(out);
}

TEST(Csv, GivesEachElementAColumnAndTextOne) {
    EXPECT_EQ(header_of(statustext), "time_us,link,sys,comp,seq,severity,text,id,chunk_seq\n");
    EXPECT_EQ(
        header_of(sample),
        "time_us,link,sys,comp,seq,u64,i64,f64,lat,i16s[0],i16s[1],i16s[2],azimuth,eph,i8,c,small[0],small[1],small[2],"
        "blob[0],blob[1],blob[2],blob[3],blob[4],blob[5],blob[6],blob[7],blob[8],blob[9],covariance[0],covariance[1]"
        "\n");
}

TEST(Csv, PrintsRawValues) {
    const SampleFrame frame(attitude, bytes_of(std::uint32_t{5}, 0.01f, nan_f, inf_f, -inf_f, 0.0f, -2.0f));
    EXPECT_EQ(row_of(frame.received()), "1700000000123456,\"px4\",1,191,7,5,0.01,NaN,Infinity,-Infinity,0.0,-2.0\n");
}

TEST(Csv, QuotesTextAndDropsControls) {
    const SampleFrame frame(statustext, statustext_payload(6, "say \"hi\",\n\x1b[m"));
    EXPECT_EQ(row_of(frame.received("a,\"b\"")),
              "1700000000123456,\"a,\"\"b\"\"\",1,191,7,6,\"say \"\"hi\"\",\n\xef\xbf\xbd[m\",0,0\n");
}

TEST(Csv, HasAsManyColumnsAsTheHeader) {
    const SampleFrame frame(sample, std::vector<std::uint8_t>(61, 0x41));
    const auto commas = [](const std::string& s) { return std::count(s.begin(), s.end(), ','); };
    EXPECT_EQ(commas(row_of(frame.received())), commas(header_of(sample)));
}

TEST(Csv, PrintsIntegersInFull) {
    const SampleFrame frame(
        sample, bytes_of(std::numeric_limits<std::uint64_t>::max(), std::numeric_limits<std::int64_t>::min()));
    EXPECT_NE(row_of(frame.received()).find(",18446744073709551615,-9223372036854775808,0.0,"), std::string::npos);
}

}  // namespace
}  // namespace mavloom::message
