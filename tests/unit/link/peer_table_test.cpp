// SPDX-License-Identifier: MIT
#include "link/udp/peer_table.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <random>
#include <string>

namespace mavloom::link::detail {
namespace {

net::Address address_of(unsigned number) {
    // Both families, many of one host.
    const auto port = static_cast<std::uint16_t>(1000 + number % 97);
    const std::string host = number % 3 == 0 ? fmt::format("2001:db8::{:x}", number / 97)
                                             : fmt::format("10.0.{}.1", number / 97);
    return *net::Address::parse(host, port);
}

TEST(PeerTable, FindsWhatAMapFinds) {
    const char* given = std::getenv("MAVLOOM_SEED");
    const unsigned seed = given != nullptr ? static_cast<unsigned>(std::strtoul(given, nullptr, 10))
                                           : std::random_device{}();
    SCOPED_TRACE(fmt::format("MAVLOOM_SEED={}", seed));
    std::mt19937 random(seed);
    std::vector<int> peers(1000);
    PeerTable<int> table;
    std::map<unsigned, int*> expected;
    for (int step = 0; step < 30'000; ++step) {
        const auto number = static_cast<unsigned>(random() % 1000);
        if (!expected.contains(number) && expected.size() < 300) {
            table.add(address_of(number), peers[number]);
            expected[number] = &peers[number];
        } else if (random() % 2 == 0) {
            table.remove(address_of(number));
            expected.erase(number);
        }
        const auto asked = static_cast<unsigned>(random() % 1000);
        ASSERT_EQ(table.find(address_of(asked)), expected.contains(asked) ? expected[asked] : nullptr) << asked;
        ASSERT_EQ(table.size(), expected.size());
    }
}

TEST(PeerTable, ForgetsTheLastOneFoundWhenItGoes) {
    PeerTable<int> table;
    int peer = 0;
    table.add(address_of(1), peer);
    EXPECT_EQ(table.find(address_of(1)), &peer);
    table.remove(address_of(1));
    EXPECT_EQ(table.find(address_of(1)), nullptr);
}

}  // namespace
}  // namespace mavloom::link::detail
