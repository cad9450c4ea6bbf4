// SPDX-License-Identifier: MIT
#include "mavloom/endpoint/endpoint.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <climits>
#include <cmath>
#include <fstream>
#include <map>
#include <regex>
#include <string>

#include "mavloom/endpoint/checks.hpp"
#include "mavloom/endpoint/grammar.hpp"

namespace mavloom::endpoint {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;

Endpoint parsed(std::string_view text) {
    auto endpoint = parse_endpoint(text);
    if (!endpoint) {
        ADD_FAILURE() << text << " was refused: " << endpoint.error().text;
        return {};
    }
    return *endpoint;
}

struct GoodAddress {
    std::string_view text;
    Scheme scheme;
    std::string_view host;
    std::uint16_t port;
};

class GoodAddresses : public testing::TestWithParam<GoodAddress> {};

TEST_P(GoodAddresses, AreTaken) {
    const Endpoint endpoint = parsed(GetParam().text);

    EXPECT_EQ(endpoint.scheme, GetParam().scheme);
    EXPECT_EQ(endpoint.address.host, GetParam().host);
    EXPECT_EQ(endpoint.address.port, GetParam().port);
}

INSTANTIATE_TEST_SUITE_P(
    ParseEndpoint, GoodAddresses,
    testing::Values(GoodAddress{"udpin://127.0.0.1:14550", Scheme::udpin, "127.0.0.1", 14550},
                    GoodAddress{"udpin://[::1]:14550", Scheme::udpin, "::1", 14550},
                    GoodAddress{"udpin://0.0.0.0:14550", Scheme::udpin, "0.0.0.0", 14550},
                    GoodAddress{"udpin://[::]:14550", Scheme::udpin, "::", 14550},
                    GoodAddress{"udpin://localhost:0", Scheme::udpin, "localhost", 0},
                    GoodAddress{"tcpin://127.0.0.1:0", Scheme::tcpin, "127.0.0.1", 0},
                    GoodAddress{"udpout://gcs.example.org:65535", Scheme::udpout, "gcs.example.org", 65535},
                    GoodAddress{"udpout://gcs_1-a:1", Scheme::udpout, "gcs_1-a", 1},
                    GoodAddress{"udpout://[fe80::1%25eth0]:14550", Scheme::udpout, "fe80::1%eth0", 14550},
                    GoodAddress{"udpout://[fe80::1%eth0]:14550", Scheme::udpout, "fe80::1%eth0", 14550},
                    GoodAddress{"udpbcast://192.168.1.255:14550", Scheme::udpbcast, "192.168.1.255", 14550},
                    GoodAddress{"udpbcast://255.255.255.255:14550", Scheme::udpbcast, "255.255.255.255", 14550},
                    GoodAddress{"udpmcast://239.255.145.50:14550", Scheme::udpmcast, "239.255.145.50", 14550},
                    GoodAddress{"udpmcast://[ff02::1]:14550", Scheme::udpmcast, "ff02::1", 14550},
                    GoodAddress{"tcpin://0.0.0.0:5760", Scheme::tcpin, "0.0.0.0", 5760},
                    GoodAddress{"tcpout://10.0.0.1:5760", Scheme::tcpout, "10.0.0.1", 5760},
                    GoodAddress{"wsin://0.0.0.0:5761", Scheme::wsin, "0.0.0.0", 5761},
                    GoodAddress{"wsout://[::1]:80/mavlink?idle=5", Scheme::wsout, "::1", 80},
                    // pymavlink's spellings; its `tcp:` connects
                    GoodAddress{"udpin:0.0.0.0:14550", Scheme::udpin, "0.0.0.0", 14550},
                    GoodAddress{"udpout:127.0.0.1:14550", Scheme::udpout, "127.0.0.1", 14550},
                    GoodAddress{"tcp:127.0.0.1:5760", Scheme::tcpout, "127.0.0.1", 5760},
                    GoodAddress{"tcpin:0.0.0.0:5760", Scheme::tcpin, "0.0.0.0", 5760},
                    GoodAddress{"udpin:localhost:14550?name=gcs", Scheme::udpin, "localhost", 14550}));

struct GoodPath {
    std::string_view text;
    Scheme scheme;
    std::string_view path;
};

class GoodPaths : public testing::TestWithParam<GoodPath> {};

TEST_P(GoodPaths, AreTaken) {
    const Endpoint endpoint = parsed(GetParam().text);

    EXPECT_EQ(endpoint.scheme, GetParam().scheme);
    EXPECT_EQ(endpoint.path, GetParam().path);
}

INSTANTIATE_TEST_SUITE_P(
    ParseEndpoint, GoodPaths,
    testing::Values(
        GoodPath{"serial:///dev/ttyACM0", Scheme::serial, "/dev/ttyACM0"},
        GoodPath{"serial:///dev/serial/by-path/pci-0000:00:14.0-usb-0:1:1.0", Scheme::serial,
                 "/dev/serial/by-path/pci-0000:00:14.0-usb-0:1:1.0"},
        GoodPath{"/dev/ttyACM0,57600", Scheme::serial, "/dev/ttyACM0"},
        GoodPath{"/tmp/vehicle/tty,115200", Scheme::serial, "/tmp/vehicle/tty"},
        GoodPath{"/tmp/a,b.tlog", Scheme::tlog, "/tmp/a,b.tlog"}, GoodPath{"FOO.TLOG", Scheme::tlog, "FOO.TLOG"},
        GoodPath{"x.tlog.12", Scheme::tlog, "x.tlog.12"}, GoodPath{"/dev/ttyACM0", Scheme::serial, "/dev/ttyACM0"},
        GoodPath{"wsin://0.0.0.0:5761", Scheme::wsin, ""},
        GoodPath{"wsout://[::1]:80/a/b?idle=5", Scheme::wsout, "/a/b"}, GoodPath{"shm://main", Scheme::shm, "main"},
        GoodPath{"tlog://flight.tlog", Scheme::tlog, "flight.tlog"},
        GoodPath{"tlog:///var/log/flight.tlog", Scheme::tlog, "/var/log/flight.tlog"},
        GoodPath{"tlog://logs/no%20ending%3F", Scheme::tlog, "logs/no ending?"},
        GoodPath{"flight.tlog", Scheme::tlog, "flight.tlog"}, GoodPath{"./a/b.tlog", Scheme::tlog, "./a/b.tlog"},
        GoodPath{"/tmp/100%20.tlog", Scheme::tlog, "/tmp/100%20.tlog"},  // a bare path is as the shell gives it
        GoodPath{"/tmp/what?.tlog", Scheme::tlog, "/tmp/what?.tlog"},
        GoodPath{"flight.tlog?speed=10", Scheme::tlog, "flight.tlog"}));

struct Bad {
    std::string_view text;
    std::string_view expected;  // a part of the message: the cause, or the spelling to type
};

class BadEndpoints : public testing::TestWithParam<Bad> {};

TEST_P(BadEndpoints, AreRefusedWithTheSpellingToType) {
    const auto endpoint = parse_endpoint(GetParam().text);

    ASSERT_FALSE(endpoint.has_value()) << GetParam().text;
    EXPECT_EQ(endpoint.error().code, SetupCode::usage);
    EXPECT_THAT(endpoint.error().text, HasSubstr(GetParam().expected));
    EXPECT_THAT(endpoint.error().text, testing::StartsWith("endpoint '"));
}

INSTANTIATE_TEST_SUITE_P(
    Spelling, BadEndpoints,
    testing::Values(
        Bad{"", "it is empty"},
        // A missing or malformed host or port.
        Bad{"udpin://:14550", "udpin://127.0.0.1:14550 (this machine only) or udpin://0.0.0.0:14550"},
        Bad{"udpin://[127.0.0.1]:14550", "brackets are for IPv6 only; type udpin://127.0.0.1:14550"},
        Bad{"udpin://::1:14550", "needs brackets; type udpin://[::1]:14550"},
        Bad{"udpin://::1:5760", "needs brackets; type udpin://[::1]:5760"},
        Bad{"udpin://::1", "needs brackets and a port; type udpin://[::1]:14550"},
        Bad{"udpout://127.0.0.1:0", "port 0 is not a destination"},
        Bad{"udpin://127.0.0.1", "the port is missing; type udpin://127.0.0.1:14550"},
        Bad{"serial://", "the device is missing"},
        Bad{"serial:///dev/ttyACM0?baud=0", "'0' is not a whole number from 1 to"},
        Bad{"udpeavesdrop://127.0.0.1:1", "there is no scheme 'udpeavesdrop'"},
        // near misses
        Bad{"udp://:14540", "type udpin://0.0.0.0:14540 to listen, udpout://HOST:14540 to send"},
        Bad{"udp://127.0.0.1:14540", "type udpin://127.0.0.1:14540 to listen, udpout://127.0.0.1:14540 to send"},
        Bad{"udp:127.0.0.1:14540", "type udpin://127.0.0.1:14540 to listen"},
        Bad{"udp://14540", "type udpin://0.0.0.0:14540"}, Bad{"udp://gcs", "udpout://gcs:14550 to send"},
        Bad{"tcp://127.0.0.1:5760", "type tcpout://127.0.0.1:5760 to connect, tcpin://127.0.0.1:5760 to listen"},
        Bad{"tcp://0.0.0.0:5760", "tcpout://HOST:5760 to connect, tcpin://0.0.0.0:5760"},
        Bad{"127.0.0.1:14550", "type udpout://127.0.0.1:14550 to send, udpin://127.0.0.1:14550 to listen"},
        Bad{"localhost:14550", "udpout://localhost:14550"}, Bad{"0.0.0.0:14550", "type udpin://0.0.0.0:14550 to listen"},
        Bad{":14550", "type udpin://0.0.0.0:14550"}, Bad{"14550", "type udpin://0.0.0.0:14550"},
        Bad{"gcs", "shm://gcs"}, Bad{"logs/flight.dat", "type tlog://logs/flight.dat"},
        Bad{"udpserver://0.0.0.0:14550", "is written udpin://0.0.0.0:14550"},
        Bad{"udpclient:10.0.0.1:14550", "is written udpout://10.0.0.1:14550"},
        Bad{"udpinn://127.0.0.1:1", "did you mean 'udpin'?"}, Bad{"UDPIN://127.0.0.1:1", "did you mean 'udpin'?"},
        Bad{"http://localhost:80",
            "there are udpin, udpout, udpbcast, udpmcast, tcpin, tcpout, wsin, wsout, serial, shm, tlog"},
        Bad{"ws://10.0.0.1:5761/mavlink",
            "type wsout://10.0.0.1:5761/mavlink to connect, wsin://10.0.0.1:5761/mavlink to listen"},
        Bad{"wss://gcs.example.org:443", "needs TLS, which Mavloom leaves to a proxy"},
        Bad{"wsin://0.0.0.0:5761/a b", "has characters that a path here cannot have"},
        Bad{"wsin://0.0.0.0:5761?origin=app.example.com", "is not the origin of a web page"},
        Bad{"tcpin://0.0.0.0:5761?origin=*", "tcpin does not take the option 'origin' (it belongs to wsin)"},
        Bad{"udp:14550", "type udpin://0.0.0.0:14550 to listen, udpout://HOST:14550 to send"},
        Bad{"00000012.BIN", "ArduPilot's own log (DataFlash), not a recording of MAVLink; mavlogdump.py"},
        Bad{"logs/flight.ulg", "PX4's own log (ULog), not a recording of MAVLink; ulog_info"},
        Bad{"/tmp/ttyV0?baud=57600", "it has no scheme; type serial:///tmp/ttyV0?baud=57600"},
        Bad{"/tmp/ttyV0", "type serial:///tmp/ttyV0 if it is a device, tlog:///tmp/ttyV0 if it is a recording"},
        Bad{"udpbcast:192.168.1.255:14550", "type udpbcast://192.168.1.255:14550"},
        Bad{"serial:/dev/ttyACM0", "type serial:///dev/ttyACM0"},
        Bad{"serial:///dev/ttyACM0:57600", "type serial:///dev/ttyACM0?baud=57600"},
        Bad{"serial://dev/ttyACM0", "needs its full path"}, Bad{"serial://COM3", "needs its full path"},
        Bad{"/dev/ttyACM0,", "type /dev/ttyACM0,57600"}, Bad{"/dev/ttyACM0,fast", "'fast' is not a whole number"},
        Bad{"/dev/ttyACM0,57600?baud=9600", "twice"},
        Bad{"udpin://0.0.0.0:14550/", "'/' follows the port; type udpin://0.0.0.0:14550"},
        Bad{"udpin://0.0.0.0:14550/path", "'/path' follows the port"}));

INSTANTIATE_TEST_SUITE_P(
    Address, BadEndpoints,
    testing::Values(
        Bad{"udpin://", "the port is missing"},
        Bad{"udpin://127.0.0.1:", "the port is missing; type udpin://127.0.0.1:14550"},
        Bad{"udpin://14550", "type udpin://127.0.0.1:14550 (this machine only)"},
        Bad{"udpin://127.0.0.1:65536", "port '65536' is not a number from 1 to 65535"},
        Bad{"udpin://127.0.0.1:-1", "port '-1'"}, Bad{"udpin://127.0.0.1:14550x", "port '14550x'"},
        Bad{"udpin://127.0.0.1: 14550", "port ' 14550'"}, Bad{"udpin://127.0.0.256:1", "not an IPv4 address"},
        Bad{"udpin://127.1:1", "not an IPv4 address"}, Bad{"udpin://[::1:14550", "bracket"},
        Bad{"udpin://[::g]:14550", "not an IPv6 address"},
        Bad{"udpin://[localhost]:14550", "type udpin://localhost:14550"},
        Bad{"udpin://fe80::1%eth0:14550", "type udpin://[fe80::1%eth0"}, Bad{"udpin://a b:14550", "not a host name"},
        Bad{"udpin://user@host:14550", "not a host name"}, Bad{"udpin://-x:14550", "not a host name"},
        Bad{"udpin://255.255.255.255:14550", "type udpin://0.0.0.0:14550"},
        Bad{"udpin://239.255.145.50:14550", "type udpmcast://239.255.145.50:14550"},
        Bad{"udpout://0.0.0.0:14550",
            "an address to listen on, not a destination; type udpout://127.0.0.1:14550 for this machine, "
            "udpin://0.0.0.0:14550 "
            "to listen"},
        Bad{"udpout://[::]:14550", "udpin://[::]:14550"}, Bad{"tcpout://0.0.0.0:5760", "tcpin://0.0.0.0:5760"},
        Bad{"udpout://255.255.255.255:14550", "type udpbcast://255.255.255.255:14550"},
        Bad{"udpout://239.255.145.50:14550", "type udpmcast://"}, Bad{"tcpout://239.255.145.50:14550", "one machine"},
        Bad{"udpmcast://192.168.1.1:14550", "not a multicast group"}, Bad{"udpmcast://239.255.145.50:0", "port 0"},
        Bad{"udpbcast://[fe80::1]:14550", "type udpmcast://[ff02::1]:14550"},
        Bad{"udpbcast://0.0.0.0:14550", "not a destination"}, Bad{"shm://", "not a ring name"},
        Bad{"shm://a/b", "not a ring name"}, Bad{"shm://a%2fb", "not a ring name"},
        Bad{"tlog://", "the path is missing"}, Bad{"tlog://logs/", "is a folder"},
        Bad{"tlog://a%zz", "type %25 for a percent sign"}, Bad{"tlog://a%4", "type %25 for a percent sign"},
        Bad{"tlog://a%00b", "'%00'"}));

INSTANTIATE_TEST_SUITE_P(
    Options, BadEndpoints,
    testing::Values(
        Bad{"udpin://127.0.0.1:1?", "an option is missing"}, Bad{"udpin://127.0.0.1:1?name=a&", "an option is missing"},
        Bad{"udpin://127.0.0.1:1?=a", "an option is missing"},
        Bad{"udpin://127.0.0.1:1?tap", "option 'tap' has no value; type tap=VALUE"},
        Bad{"udpin://127.0.0.1:1?nmae=a", "did you mean 'name'?"},
        Bad{"udpin://127.0.0.1:1?queue_byte=1", "did you mean 'queue_bytes'?"},
        Bad{"udpin://127.0.0.1:1?xyzzy=1", "udpin takes name, group"},
        Bad{"udpin://127.0.0.1:1?dedup_ms=5",
            "'dedup_ms' is a setting of the router: --dedup-ms, or dedup_ms in [router]"},
        Bad{"udpin://127.0.0.1:1?dedup=5", "'dedup_ms' is a setting of the router"},
        Bad{"serial:///dev/ttyACM0?dedup_sm=5", "'dedup_ms' is a setting of the router"},
        Bad{"tcpin://127.0.0.1:1?unknown_component=drop", "'unknown_component' is a setting of the router"},
        Bad{"udpout://127.0.0.1:1?unknown_target=flood", "'unknown_target' is a setting of the router"},
        Bad{"tcpout://127.0.0.1:1?route_timeout=9", "'route_timeout' is a setting of the router"},
        Bad{"udpout://127.0.0.1:1?heartbeat=255/191",
            "type --heartbeat 255/191, or heartbeat = \"255/191\" in [router]"},
        Bad{"udpout://127.0.0.1:1?heartbeat=1", "neither true nor false"},
        Bad{"udpout://127.0.0.1:1?heartbeat=true&tap=true", "heartbeat= and tap=true exclude each other"},
        Bad{"tcpin://127.0.0.1:1?tap=true&heartbeat=false", "heartbeat= and tap=true exclude each other"},
        Bad{"serial:///dev/ttyACM0?request_streams=4", "'request_streams' is a setting of the router"},
        Bad{"udpout://127.0.0.1:1?metrics=127.0.0.1:9090", "--metrics, or metrics in [router]"},
        Bad{"serial:///dev/ttyACM0?baudrate=57600", "did you mean 'baud'?"},
        Bad{"udpin://127.0.0.1:1?baudrate=57600", "'baud' belongs to serial, not to udpin"},
        Bad{"udpin://127.0.0.1:1?group_mode=best", "group_mode= has no effect without group=NAME"},
        Bad{"udpin://127.0.0.1:1?sign_all=true", "sign_all= has no effect without sign=KEYFILE"},
        Bad{"udpin://127.0.0.1:1?un=drop", "udpin takes name, group"},
        Bad{"udpin://127.0.0.1:1?name=a&name=b", "option 'name' is given twice"},
        Bad{"udpin://127.0.0.1:1?baud=57600", "udpin does not take the option 'baud' (it belongs to serial)"},
        Bad{"serial:///dev/ttyACM0?mtu=0", "it belongs to udpin, udpout, udpbcast, udpmcast"},
        Bad{"tcpin://127.0.0.1:1?bind=0.0.0.0:1", "does not take the option 'bind'"},
        Bad{"tlog://a.tlog?tap=true", "does not take"}, Bad{"tlog://a.tlog?max_rate=*:1", "does not take"},
        Bad{"tlog://a.tlog?in_allow=ATTITUDE", "does not take"}, Bad{"a.tlog?out_block=sys:1", "does not take"},
        Bad{"udpin://127.0.0.1:1?name=", "option 'name'"}, Bad{"udpin://127.0.0.1:1?group=a%20b", "not a group name"},
        Bad{"udpin://127.0.0.1:1?mtu=279", "neither 0 (one frame a datagram) nor"},
        Bad{"udpin://127.0.0.1:1?mtu=65508", "nor from 280 to 65507"},
        Bad{"udpin://127.0.0.1:1?idle=0", "1000h, for never"}, Bad{"udpin://127.0.0.1:1?idle=-1", "not a duration"},
        Bad{"udpin://127.0.0.1:1?idle=2sec", "not a duration"}, Bad{"udpin://127.0.0.1:1?idle=inf", "not a duration"},
        Bad{"udpin://127.0.0.1:1?idle=nan", "not a duration"}, Bad{"udpin://127.0.0.1:1?idle=1e99", "ten years"},
        Bad{"udpin://127.0.0.1:1?queue_bytes=279", "out of range"},
        Bad{"udpin://127.0.0.1:1?queue_bytes=2000000000", "out of range (280 to 1073741824 bytes)"},
        Bad{"udpin://127.0.0.1:1?queue_bytes=1x", "not a size"},
        Bad{"udpin://127.0.0.1:1?queue_bytes=99999999999999999999", "not a size"},
        Bad{"udpin://127.0.0.1:1?queue_bytes=9999999999999G", "larger than any disk"},
        Bad{"udpin://127.0.0.1:1?max_rate=ATTITUDE", "has no rate"},
        Bad{"udpin://127.0.0.1:1?max_rate=ATTITUDE:0", "not a number above 0"},
        Bad{"udpin://127.0.0.1:1?max_rate=ATTITUDE:10,", "empty term"},
        Bad{"udpin://127.0.0.1:1?max_rate=A:1,A:2", "A has two rates"},
        Bad{"udpin://127.0.0.1:1?max_rate=*:nan", "not a number above 0"},
        Bad{"udpin://127.0.0.1:1?in_allow=sys:256", "not a whole number from 0 to 255"},
        Bad{"udpin://127.0.0.1:1?in_allow=system:1", "not a filter term"},
        Bad{"udpin://127.0.0.1:1?in_allow=ATT%20", "not a message name or id"},
        Bad{"udpin://127.0.0.1:1?in_allow=16777216", "from 0 to 16777215"},
        Bad{"udpin://127.0.0.1:1?out_block=,", "empty term"},
        Bad{"udpin://127.0.0.1:1?tap=yes", "neither true nor false"},
        Bad{"udpin://127.0.0.1:1?tap=1", "neither true nor false"},
        Bad{"udpin://127.0.0.1:1?group_mode=first", "not one of all, best, primary"},
        Bad{"udpin://127.0.0.1:1?max_peers=0", "from 1 to"}, Bad{"udpin://127.0.0.1:1?ttl=256", "from 0 to 255"},
        Bad{"udpin://127.0.0.1:1?iface=0123456789abcdef", "interface"},
        Bad{"udpout://127.0.0.1:1?bind=14550", "the host is missing"},
        Bad{"udpout://127.0.0.1:1?bind=::1:4", "brackets"},
        Bad{"serial:///dev/ttyS0?flow=xonxoff", "type none or rtscts"},
        Bad{"serial:///dev/ttyS0?flow=hard", "neither none nor rtscts"},
        Bad{"shm://main?from=newst", "neither oldest nor newest"},
        Bad{"tlog://a.tlog?speed=0", "neither max nor a number above 0"},
        Bad{"tlog://a.tlog?speed=inf", "neither max nor"}, Bad{"tlog://a.tlog?rotate_every=10ms", "too short"},
        Bad{"tlog://a.tlog?rotate_bytes=1", "out of range"}));

TEST(ParseEndpoint, KeepsDefaults) {
    const Endpoint endpoint = parsed("udpin://127.0.0.1:14550");

    EXPECT_EQ(endpoint.options.mtu_bytes, 1280u);
    EXPECT_EQ(endpoint.options.queue_bytes, 1048576u);
    EXPECT_EQ(endpoint.options.max_peers, 256u);
    EXPECT_EQ(endpoint.options.rcvbuf_bytes, 33554432u);
    EXPECT_FALSE(endpoint.options.idle.has_value());
    EXPECT_FALSE(endpoint.options.speed.has_value());
    EXPECT_TRUE(endpoint.options.in_allow.empty());
}

TEST(ParseEndpoint, TakesEveryOptionOfAnAddress) {
    const auto options =
        parsed(
            "udpin://127.0.0.1:14550?name=ground%20station&group=uplink&group_mode=best&mtu=0&idle=2&queue_bytes=64k"
            "&queue_age=500ms&max_rate=ATTITUDE:10,*:50&max_bytes=5000&in_allow=HEARTBEAT,30,sys:42&in_block=comp:100"
            "&out_allow=sys:1,sys:2&out_block=PING&tap=true&private=true&sign=%2Fkey&verify=key.hex&rcvbuf=1MiB"
            "&max_peers=8&iface=eth0&ttl=4&low_latency=true&required=true&reuse=true")
            .options;

    EXPECT_EQ(options.name, "ground station");
    EXPECT_EQ(options.group, "uplink");
    EXPECT_EQ(options.group_mode, GroupMode::best);
    EXPECT_EQ(options.mtu_bytes, 0u);
    EXPECT_EQ(options.idle, 2s);
    EXPECT_EQ(options.queue_bytes, 65536u);
    EXPECT_EQ(options.queue_age, 500ms);
    ASSERT_EQ(options.max_rate.size(), 2u);
    EXPECT_EQ(options.max_rate[0].message, "ATTITUDE");
    EXPECT_EQ(options.max_rate[0].rate_hz, 10);
    EXPECT_EQ(options.max_rate[1].message, "*");
    EXPECT_EQ(options.max_rate[1].rate_hz, 50);
    EXPECT_EQ(options.max_bytes_per_s, 5000u);
    EXPECT_THAT(options.in_allow.messages, ElementsAre("HEARTBEAT", "30"));
    EXPECT_THAT(options.in_allow.systems, ElementsAre(42));
    EXPECT_THAT(options.in_block.components, ElementsAre(100));
    EXPECT_THAT(options.out_allow.systems, ElementsAre(1, 2));
    EXPECT_THAT(options.out_block.messages, ElementsAre("PING"));
    EXPECT_TRUE(options.tap);
    EXPECT_TRUE(options.is_private);
    EXPECT_EQ(options.sign_key_file, "/key");
    EXPECT_EQ(options.verify_key_file, "key.hex");
    EXPECT_EQ(options.rcvbuf_bytes, 1048576u);
    EXPECT_EQ(options.max_peers, 8u);
    EXPECT_EQ(options.iface, "eth0");
    EXPECT_EQ(options.ttl, 4);
    EXPECT_TRUE(options.low_latency);
    EXPECT_TRUE(options.required);
    EXPECT_TRUE(options.reuse);
}

TEST(ParseEndpoint, TakesTheOptionsOfOtherSchemes) {
    EXPECT_EQ(parsed("/dev/ttyACM0,921600").options.baud, 921600u);
    EXPECT_EQ(parsed("serial:///dev/ttyACM0?baud=auto&flow=rtscts").options.baud, 0u);
    EXPECT_EQ(parsed("serial:///dev/ttyACM0?flow=rtscts").options.flow, "rtscts");
    EXPECT_TRUE(parsed("shm://main?from=oldest&lossless=true").options.from_oldest);
    EXPECT_TRUE(parsed("shm://main?from=oldest&lossless=true").options.lossless);
    EXPECT_FALSE(parsed("shm://main?from=newest").options.from_oldest);
    EXPECT_EQ(parsed("tlog://a.tlog?speed=10").options.speed, 10.0);
    EXPECT_TRUE(std::isinf(*parsed("a.tlog?speed=max").options.speed));
    EXPECT_EQ(parsed("tlog://a.tlog?rotate_bytes=100M&rotate_every=1h").options.rotate_bytes, 104857600u);
    EXPECT_EQ(parsed("tlog://a.tlog?rotate_bytes=100M&rotate_every=1h").options.rotate_every, 1h);
    EXPECT_TRUE(parsed("udpbcast://192.168.1.255:14550?fixed=true").options.fixed);
    EXPECT_EQ(parsed("udpout://127.0.0.1:1?bind=[::]:14551").options.bind, (HostPort{"::", 14551}));
    EXPECT_EQ(parsed("udpout://127.0.0.1:1?bind=0.0.0.0:0").options.bind, (HostPort{"0.0.0.0", 0}));
}

// A value that ends in .tlog made the whole text a path, and the options were lost.
TEST(ParseEndpoint, AnOptionThatEndsInTlogIsAnOption) {
    EXPECT_EQ(parsed("udpin://127.0.0.1:14550?name=x.tlog").options.name, "x.tlog");
    EXPECT_EQ(parsed("udpin:127.0.0.1:14550?name=x.tlog").options.name, "x.tlog");
    EXPECT_EQ(parsed("udpin:127.0.0.1:14550?name=x.tlog").scheme, Scheme::udpin);
    EXPECT_EQ(parsed("/dev/ttyACM0?name=x.tlog").scheme, Scheme::serial);
    EXPECT_EQ(parsed("flight.tlog?name=x.tlog").path, "flight.tlog");
    EXPECT_EQ(parsed("flight.tlog?name=x.tlog").options.name, "x.tlog");
}

TEST(CheckSourceOptions, RefusesWhatOnlyADestinationHas) {
    EXPECT_TRUE(check_source_options(parsed("a.tlog?speed=10&name=a")).has_value());
    EXPECT_TRUE(check_source_options(parsed("udpin://127.0.0.1:14550?tap=true")).has_value());
    EXPECT_EQ(check_source_options(parsed("a.tlog?rotate_every=1h")).error().text,
              "'tlog://a.tlog': 'rotate_every' applies to a recording that is written; this one is read");
    EXPECT_EQ(check_source_options(parsed("a.tlog?rotate_bytes=1M")).error().code, SetupCode::usage);
}

TEST(Endpoint, LabelIsTheNameElseTheUrlWithoutItsQuery) {
    EXPECT_EQ(parsed("udpin://127.0.0.1:14550?idle=2").label(), "udpin://127.0.0.1:14550");
    EXPECT_EQ(parsed("udpin:[::1]:14550").label(), "udpin://[::1]:14550");
    EXPECT_EQ(parsed("/dev/ttyACM0,57600").label(), "serial:///dev/ttyACM0");
    EXPECT_EQ(parsed("flight.tlog").label(), "tlog://flight.tlog");
    EXPECT_EQ(parsed("udpin://127.0.0.1:14550?name=gcs").label(), "gcs");
}

TEST(ParseEndpoint, ShowsNoControlCharactersAndCutsLongText) {
    const auto endpoint = parse_endpoint("udp\x1b[31m" + std::string(3000, 'x'));

    ASSERT_FALSE(endpoint.has_value());
    EXPECT_EQ(endpoint.error().text.find('\x1b'), std::string::npos);
    EXPECT_LT(endpoint.error().text.size(), 1000u);
}

TEST(ParseDuration, CountsSecondsUnlessAUnitFollows) {
    EXPECT_EQ(*parse_duration("2"), 2s);
    EXPECT_EQ(*parse_duration("0"), 0s);
    EXPECT_EQ(*parse_duration("0.25"), 250ms);
    EXPECT_EQ(*parse_duration("250ms"), 250ms);
    EXPECT_EQ(*parse_duration("2s"), 2s);
    EXPECT_EQ(*parse_duration("1.5m"), 90s);
    EXPECT_EQ(*parse_duration("1min"), 60s);
    EXPECT_EQ(*parse_duration("1h"), 3600s);
    EXPECT_EQ(*parse_duration("2d"), 48h);
    EXPECT_EQ(*parse_duration("7us"), 7us);
    EXPECT_EQ(*parse_duration("7ns"), 7ns);
    for (const auto* bad : {"", " 2", "2 s", "s", "+2", "-2", "2S", "0x10", "2s2", "1e400"})
        EXPECT_FALSE(parse_duration(bad)) << bad;
}

TEST(ParseSize, CountsBytes) {
    EXPECT_EQ(*parse_size("0"), 0u);
    EXPECT_EQ(*parse_size("5000"), 5000u);
    EXPECT_EQ(*parse_size("12B"), 12u);
    EXPECT_EQ(*parse_size("64k"), 65536u);
    EXPECT_EQ(*parse_size("64K"), 65536u);
    EXPECT_EQ(*parse_size("64kB"), 64000u);
    EXPECT_EQ(*parse_size("1M"), 1048576u);
    EXPECT_EQ(*parse_size("32m"), 33554432u);
    EXPECT_EQ(*parse_size("1g"), 1073741824u);
    EXPECT_EQ(*parse_size("64KiB"), 65536u);
    EXPECT_EQ(*parse_size("32MiB"), 33554432u);
    EXPECT_EQ(*parse_size("1GiB"), 1073741824u);
    EXPECT_EQ(*parse_size("1GB"), 1000000000u);
    EXPECT_EQ(*parse_size("32MB"), 32000000u);
    EXPECT_EQ(*parse_size("2G"), 2147483648u);
    for (const auto* bad :
         {"", "1.5M", "-1", "+1", "M", "1 M", " 1M", "1M\n", "1mb", "0x10", "1_000", "1T", "18446744073709551616"})
        EXPECT_FALSE(parse_size(bad)) << bad;
}

TEST(ParseMode, TakesThreeOctalDigits) {
    for (const auto* good : {"640", "0640", "0o640"}) EXPECT_EQ(*parse_mode(good), 0640) << good;
    EXPECT_EQ(*parse_mode("0600"), 0600);
    EXPECT_EQ(*parse_mode("777"), 0777);
    EXPECT_EQ(*parse_mode("0000"), 0);
    for (const auto* bad : {"", "9", "0", "60", "06400", "1600", "00o600", "0o6000", "0x600", "-600", "+600", " 600",
                            "600 ", "6_00", "608", "rw-r-----"})
        EXPECT_FALSE(parse_mode(bad)) << bad;
}

TEST(SetEndpointOption, TakesTheTextOfAFilesKey) {
    Endpoint endpoint = parsed("udpin://127.0.0.1:14550");

    EXPECT_TRUE(set_endpoint_option(endpoint, "idle", "1m").has_value());
    EXPECT_EQ(endpoint.options.idle, 60s);
    EXPECT_FALSE(set_endpoint_option(endpoint, "speed", "1").has_value());
}

// {option of a ring: its default}, from the table of docs/guide/endpoints.md.
std::map<std::string, std::string> ring_options_of_the_guide() {
    std::ifstream file(MAVLOOM_TEST_DATA "/../../docs/guide/endpoints.md");
    const std::regex row(R"(\| `(\w+)` \| ([^|]*) \| (?:`([^|]*)`)? ?\| .*)");
    std::map<std::string, std::string> options;
    for (std::string line; std::getline(file, line);) {
        std::smatch cells;
        if (!std::regex_match(line, cells, row)) continue;
        const std::string schemes = cells[2];
        if (schemes.starts_with("all") || schemes == "shm") options[cells[1]] = cells[3];
    }
    return options;
}

// `check` shows the options of all other schemes: tests/system/program/test_check.py.
TEST(EndpointOptionNames, OfARingAreThoseOfTheGuideWithTheirDefaults) {
    std::map<std::string, std::string> options;
    for (const auto name : option_names_for(Scheme::shm)) options.emplace(name, default_option_text(Scheme::shm, name));
    EXPECT_EQ(options, ring_options_of_the_guide());
}

TEST(EndpointOptionNames, HoldWhatTheDesignLists) {
    EXPECT_THAT(endpoint_option_names(), testing::SizeIs(43));
    EXPECT_THAT(endpoint_option_names(),
                testing::IsSupersetOf({"name", "mtu", "max_rate", "private", "rotate_every", "bind", "low_latency"}));
}

struct Pair {
    std::string_view a, b;
    bool is_loop;
};

class Loops : public testing::TestWithParam<Pair> {};

TEST_P(Loops, AreRefusedInEitherOrder) {
    const auto& [a, b, is_loop] = GetParam();
    EXPECT_EQ(!check_not_called(parsed(a), parsed(b)), is_loop) << a << " " << b;
    EXPECT_EQ(!check_not_called(parsed(b), parsed(a)), is_loop) << b << " " << a;
}

// A name of this machine may stand for any of its addresses: only a socket on all of them surely hears it.
TEST(OwnName, IsALoopOnlyWithAPortOnAllAddresses) {
    std::array<char, HOST_NAME_MAX + 1> name{};
    ASSERT_EQ(::gethostname(name.data(), name.size() - 1), 0);
    const auto call = parsed("udpout://" + std::string(name.data()) + ":14540");
    EXPECT_FALSE(check_not_called(parsed("udpin://0.0.0.0:14540"), call));
    EXPECT_TRUE(check_not_called(parsed("udpin://127.0.0.1:14540"), call));
}

INSTANTIATE_TEST_SUITE_P(Endpoints, Loops,
                         testing::Values(Pair{"udpin://0.0.0.0:14540", "udpout://127.0.0.1:14540", true},
                                         Pair{"udpin://127.0.0.1:14540", "udpout://localhost:14540", true},
                                         Pair{"tcpin://[::]:5760", "tcpout://[::1]:5760", true},
                                         Pair{"tcpin://[::]:5760", "tcpout://127.0.0.1:5760", true},
                                         Pair{"udpin://0.0.0.0:14540", "udpout://[::1]:14540", false},
                                         Pair{"udpin://127.0.0.1:14540", "udpout://127.0.0.2:14540", false},
                                         Pair{"udpin://0.0.0.0:14540", "udpout://127.0.0.1:14541", false},
                                         Pair{"udpin://0.0.0.0:14540", "udpout://192.0.2.1:14540", false},
                                         Pair{"udpin://0.0.0.0:5760", "tcpout://127.0.0.1:5760", false},
                                         Pair{"udpin://gcs.lan:14540", "udpout://gcs.lan:14540", true},
                                         Pair{"udpin://gcs.lan:14540", "udpout://192.0.2.1:14540", false},
                                         Pair{"udpin://0.0.0.0:14550", "udpbcast://127.255.255.255:14550", false}));

}  // namespace
}  // namespace mavloom::endpoint
