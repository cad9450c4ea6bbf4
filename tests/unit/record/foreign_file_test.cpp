// SPDX-License-Identifier: MIT
#include "record/foreign_file.hpp"

#include <gtest/gtest.h>

#include <string>

#include "mavloom/record/tlog_reader.hpp"
#include "support/bytes.hpp"
#include "support/golden_frames.hpp"
#include "support/golden_table.hpp"
#include "support/temp_dir.hpp"

namespace mavloom::record {
namespace {

using namespace std::string_literals;
using test::golden_table;

std::string name_of(const std::string& bytes) {
    const ByteView view(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    const auto format = foreign_format(view, golden_table());
    return format ? std::string(format->name) : std::string();
}

TEST(ForeignFile, KnowsOtherFormatsByTheirFirstBytes) {
    EXPECT_EQ(name_of("\xa3\x95\x80\x80\x59"s), "a DataFlash log of ArduPilot");
    EXPECT_EQ(name_of("FMT, 128, 89, FMT, BBnNZ"), "a DataFlash log of ArduPilot as text");
    EXPECT_EQ(name_of("ULog\x01\x12\x35\x01"s), "a ULog of PX4");
    EXPECT_EQ(name_of("\x1f\x8b\x08\x00\x00"s), "a gzip file");
    EXPECT_EQ(name_of("\xfd"
                      "7zXZ\x00\x00"s),
              "an xz file");
    EXPECT_EQ(name_of("\xd4\xc3\xb2\xa1\x02\x00"s), "a pcap capture");
    EXPECT_EQ(name_of("\x0a\x0d\x0d\x0a\x1c"s), "a pcapng capture");
    EXPECT_EQ(name_of("PK\x03\x04\x14"s), "a zip file");
    EXPECT_EQ(name_of("SQLite format 3\0\x10"s), "an SQLite database");
    EXPECT_EQ(name_of("\x89HDF\r\n\x1a\n\0"s), "an HDF5 file");
}

TEST(ForeignFile, KnowsText) {
    const std::string rows(4096, ',');
    EXPECT_EQ(name_of("{\"a\":\t1}\r\n" + rows), "JSON");
    EXPECT_EQ(name_of("time" + rows), "text");
    EXPECT_EQ(name_of("a,b\n1,2\n"), "text");
    for (const char other : {'\0', '\x1b', '\x7f', '\xfd', '\xfe'}) EXPECT_EQ(name_of(rows.substr(1) + other), "");
}

TEST(ForeignFile, KnowsFramesWithoutTimes) {
    const auto& frame = test::heartbeat_v2;
    std::string stream(frame.begin(), frame.end());
    EXPECT_EQ(name_of(stream), "a MAVLink stream without times");
    EXPECT_EQ(name_of(stream + stream), "a MAVLink stream without times");
    EXPECT_EQ(name_of(stream + "damage"), "");
}

TEST(ForeignFile, TakesDamageAndNothingForATlog) {
    EXPECT_EQ(name_of(""), "");
    EXPECT_EQ(name_of("\x00\x06\x0a\x24\x18\x1e\x40\x00\xfd"s), "");
    EXPECT_EQ(name_of("\xfd\xfe\xfd\xfe damage"), "");
    EXPECT_EQ(name_of("\x1f\x8b\x07"s), "");
}

TEST(ForeignFile, IsRefusedByNameWithTheToolToUse) {
    const test::TempDir folder;
    const auto path = folder / "flight.bin";
    test::write_file(path, test::hex("a395808059"));

    const auto reader = TlogReader::open(path, golden_table());

    ASSERT_FALSE(reader);
    EXPECT_EQ(reader.error().code, SetupCode::bad_input);
    EXPECT_EQ(reader.error().text, path.string() +
                                       " is a DataFlash log of ArduPilot, not a tlog: read it with pymavlink "
                                       "(mavlogdump.py FILE), or download the telemetry log of the flight");
}

}  // namespace
}  // namespace mavloom::record
