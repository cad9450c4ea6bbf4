// SPDX-License-Identifier: MIT
#include "http/access.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>

namespace mavloom::http {
namespace {

const net::Address loopback = *net::Address::parse("127.0.0.1", 80), lan = *net::Address::parse("192.0.2.1", 80);

bool has_host(const Access& access, std::string_view host, const net::Address& local = loopback) {
    return Allowed(access).has_host(host, local, mono_now());
}
bool has_origin(const Access& access, std::string_view origin, std::string_view host = "localhost:80") {
    return Allowed(access).has_origin(origin, host);
}

TEST(Access, HostIsThisMachine) {
    for (const auto* const host : {"", "127.0.0.1", "127.0.0.1:9090", "localhost:1", "LocalHost", "localhost.:9090",
                                   "[::1]", "[::1]:9090", "127.0.0.2"})
        EXPECT_TRUE(has_host({.own_names = false}, host)) << host;
    for (const auto* const host : {"evil.example", "localhost..", "localhost.evil.example", "[::1", "[::2]", ".", "[",
                                   "]", ":", "192.0.2.1", "127.0.0.1.evil.example:9090", "127.1", "0x7f000001"})
        EXPECT_FALSE(has_host({.own_names = false}, host)) << host;
    EXPECT_TRUE(has_host({.own_names = false}, "192.0.2.1:80", lan));
}

TEST(Access, HostIsOneOfTheNamesOfThisMachine) {
    std::array<char, 256> name{};
    ASSERT_EQ(::gethostname(name.data(), name.size() - 1), 0);
    const std::string own = name.data();
    EXPECT_TRUE(has_host({}, own + ":8088"));
    EXPECT_TRUE(has_host({}, own + ".local"));
    EXPECT_FALSE(has_host({}, own + ".evil.example"));
    EXPECT_TRUE(has_host({.hosts = {"gcs.example.com"}}, "GCS.example.com:8088"));
    EXPECT_FALSE(has_host({.hosts = {"gcs.example.com"}}, "example.com"));
    EXPECT_TRUE(has_host({.any_host = true}, "evil.example"));
}

TEST(Access, OriginIsAbsentListedOrOwn) {
    EXPECT_TRUE(has_origin({}, ""));
    EXPECT_TRUE(has_origin({}, "http://localhost:80"));
    EXPECT_TRUE(has_origin({}, "https://LOCALHOST:80"));
    for (const auto* const origin :
         {"null", "http://localhost", "http://localhost:81", "file://localhost:80", "localhost:80", "http://",
          "https://evil.example", "http://localhost:80.evil.example"})
        EXPECT_FALSE(has_origin({}, origin)) << origin;
    const Access listed{.origins = {"https://app.example.com"}};
    EXPECT_TRUE(has_origin(listed, "https://app.example.com"));
    EXPECT_FALSE(has_origin(listed, "http://app.example.com"));
    EXPECT_FALSE(has_origin(listed, "https://app.example.com.evil.example"));
    EXPECT_TRUE(has_origin({.origins = {"*"}}, "null"));
}

// A page at http://evil.example:80, whose name leads here, has its own origin and the same Host.
TEST(Access, NoOriginIsOwnIfAnyHostIsAllowed) {
    EXPECT_FALSE(has_origin({.any_host = true}, "http://evil.example:80", "evil.example:80"));
    EXPECT_FALSE(has_origin({}, "http://", ""));
}

TEST(Access, TargetIsSplit) {
    EXPECT_EQ(split_target("/metrics?x=1?y"), std::pair(std::string_view("/metrics"), std::string_view("x=1?y")));
    EXPECT_EQ(split_target("/"), std::pair(std::string_view("/"), std::string_view()));
    EXPECT_EQ(split_target("http://localhost/metrics").first, "");
    EXPECT_EQ(split_target("").first, "");
}

}  // namespace
}  // namespace mavloom::http
