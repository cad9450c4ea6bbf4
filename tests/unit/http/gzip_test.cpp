// SPDX-License-Identifier: MIT
#include "mavloom/http/gzip.hpp"

#include <gtest/gtest.h>

#include <cstddef>

namespace mavloom::http {
namespace {

using namespace std::string_literals;

// Of `printf mavloom | gzip -9 -n | xxd -p`.
const std::string mavloom_gz =
    "\x1f\x8b\x08\x00\x00\x00\x00\x00\x02\x03\xcb\x4d\x2c\xcb\xc9\xcf\xcf\x05\x00\xe0\x95\x2a\x21\x07\x00\x00\x00"s;
constexpr std::size_t header_size = 10, trailer_size = 8;

TEST(Gunzip, DecompressesWhatGzipWrote) { EXPECT_EQ(gunzip(mavloom_gz), "mavloom"); }

TEST(Gunzip, DecompressesNoContent) {
    // printf '' | gzip -9 -n | xxd -p
    EXPECT_EQ(gunzip("\x1f\x8b\x08\x00\x00\x00\x00\x00\x02\x03\x03\x00\x00\x00\x00\x00\x00\x00\x00\x00"s), "");
}

TEST(Gunzip, DecompressesTheSmallestFormOfAlikeBytes) {
    // head -c 100000 /dev/zero | gzip -9 -n | xxd -p
    const std::string start =
        "\x1f\x8b\x08\x00\x00\x00\x00\x00\x02\x03\xed\xc1\x31\x01\x00\x00\x00\xc2\xa0\xf5\x4f"
        "\x6d\x0d\x0f\xa0"s;
    const std::string end = "\x80\x57\x03\x7d\x95\x11\xd4\xa0\x86\x01\x00"s;
    EXPECT_TRUE(gunzip(start + std::string(96, '\0') + end) == std::string(100'000, '\0'));
}

TEST(Gunzip, RefusesBytesThatAreCut) {
    for (std::size_t size = 0; size < mavloom_gz.size(); ++size)
        EXPECT_FALSE(gunzip(mavloom_gz.substr(0, size))) << size;
}

// Python's module gzip refuses the same, but for the bits behind the last block.
TEST(Gunzip, RefusesDamage) {
    const std::size_t unused = mavloom_gz.size() - trailer_size - 1;
    for (std::size_t at = header_size; at < mavloom_gz.size(); ++at) {
        for (int bit = 0; bit < 8 && at != unused; ++bit) {
            auto damaged = mavloom_gz;
            damaged[at] = static_cast<char>(damaged[at] ^ (1 << bit));
            EXPECT_FALSE(gunzip(damaged)) << "bit " << bit << " of byte " << at;
        }
    }
}

TEST(Gunzip, RefusesOtherForms) {
    EXPECT_FALSE(gunzip("mavloom is no gzip"));
    // As without -n: the flag FNAME, and a name.
    auto named = mavloom_gz;
    named[3] = 8;
    named.insert(header_size, "name.txt\0"s);
    EXPECT_FALSE(gunzip(named));
    EXPECT_FALSE(gunzip(mavloom_gz + "more"));
}

TEST(Gunzip, AllocatesNoMoreThanTheBytesMayHold) {
    auto boasting = mavloom_gz;
    boasting.replace(boasting.size() - 4, 4, "\xff\xff\xff\xff");
    EXPECT_FALSE(gunzip(boasting));
}

}  // namespace
}  // namespace mavloom::http
