// SPDX-License-Identifier: MIT
#include "mavloom/config/convert.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "config/convert_ini.hpp"
#include "mavloom/config/config.hpp"

namespace mavloom::config {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

Conversion converted(std::string_view text) {
    auto conversion = convert_mavlink_router(text, "main.conf");
    if (!conversion) {
        ADD_FAILURE() << conversion.error().text;
        return {};
    }
    return *conversion;
}

// The configuration that comes out, and that its text is one.
Config config_of(std::string_view text) {
    const auto conversion = converted(text);
    auto config = parse_config(conversion.toml, "router.toml");
    if (!config) {
        ADD_FAILURE() << config.error().text << '\n' << conversion.toml;
        return {};
    }
    return *config;
}

std::string error_of(std::string_view text) {
    const auto conversion = convert_mavlink_router(text, "main.conf");
    if (conversion) {
        ADD_FAILURE() << "taken: " << text;
        return {};
    }
    EXPECT_EQ(conversion.error().code, SetupCode::bad_input);
    return conversion.error().text;
}

// "12 [General] Log", without the advice.
std::vector<std::string> places(const Conversion& conversion) {
    std::vector<std::string> all;
    for (const auto& note : conversion.notes)
        all.push_back(std::to_string(note.line) + " [" + note.section + "]" + (note.key.empty() ? "" : " ") + note.key);
    return all;
}

const endpoint::Endpoint& only_endpoint(const Config& config) {
    if (config.endpoints.size() != 1) throw std::out_of_range("not one endpoint");
    return config.endpoints.front();
}

constexpr std::string_view no_tcp = "[General]\nTcpServerPort = 0\n";
std::string without_tcp(std::string_view text) { return std::string(no_tcp) + std::string(text); }

TEST(ConvertMavlinkRouter, AnEmptyFileIsItsTcpServerOn5760) {
    const auto config = config_of("");

    EXPECT_EQ(only_endpoint(config).scheme, endpoint::Scheme::tcpin);
    EXPECT_EQ(only_endpoint(config).address, (endpoint::HostPort{"::", 5760}));
    EXPECT_EQ(config.router.unknown_component, UnknownComponent::drop);
}

TEST(ConvertMavlinkRouter, TwoServersOnOnePortAreAnErrorOfTheSecond) {
    constexpr std::string_view first = "[UdpEndpoint a]\nMode = Server\nAddress = 0.0.0.0\nPort = 14550\n";
    const auto with = [&](std::string_view address, int port) {
        return fmt::format("{}[UdpEndpoint b]\nMode = Server\nAddress = {}\nPort = {}\n", first, address, port);
    };
    EXPECT_EQ(
        error_of(with("127.0.0.1", 14550)),
        "main.conf:8: [UdpEndpoint b] listens on UDP port 14550, as [UdpEndpoint a] in line 4 does; choose another "
        "Port for one of them");
    EXPECT_THAT(config_of(with("127.0.0.1", 14551)).endpoints, SizeIs(3));
}

TEST(ConvertMavlinkRouter, ASectionThatContinuesAnotherIsNoted) {
    const auto conversion = converted(
        without_tcp("[UdpEndpoint a]\nMode = Server\nAddress = 0.0.0.0\nPort = 1\n[UdpEndpoint A]\nPort = 2\n"));
    EXPECT_THAT(places(conversion), ElementsAre("7 [UdpEndpoint a]"));
    EXPECT_THAT(conversion.notes.front().text, HasSubstr("continues the section of line 3"));
    EXPECT_THAT(conversion.toml, HasSubstr("udpin://0.0.0.0:2"));
}

TEST(ConvertMavlinkRouter, TcpServerPort0IsNoServer) { EXPECT_THAT(config_of(no_tcp).endpoints, IsEmpty()); }

// The documented sample's four examples.
TEST(ConvertMavlinkRouter, TheEndpointsOfTheSample) {
    const auto config = config_of(
        "[General]\n"
        "[UartEndpoint alpha]\nDevice = /dev/ttyS0\nBaud = 52000\n\n"
        "[UdpEndpoint bravo]\nMode = Server\nAddress = 0.0.0.0\nPort = 10000\n\n"
        "[UdpEndpoint charlie]\nMode = Normal\nAddress = 127.0.0.1\nPort = 11000\n\n"
        "[TcpEndpoint delta]\nAddress = 127.0.0.1\nPort = 25760\n");

    ASSERT_THAT(config.endpoints, SizeIs(5));
    const auto& [alpha, bravo, charlie, delta, server] = std::tie(
        config.endpoints[0], config.endpoints[1], config.endpoints[2], config.endpoints[3], config.endpoints[4]);
    EXPECT_EQ(alpha.scheme, endpoint::Scheme::serial);
    EXPECT_EQ(alpha.path, "/dev/ttyS0");
    EXPECT_EQ(alpha.options.baud, 52000u);
    EXPECT_EQ(alpha.options.name, "alpha");
    EXPECT_EQ(bravo.scheme, endpoint::Scheme::udpin);
    EXPECT_EQ(bravo.address, (endpoint::HostPort{"0.0.0.0", 10000}));
    EXPECT_EQ(charlie.scheme, endpoint::Scheme::udpout);
    EXPECT_EQ(charlie.address, (endpoint::HostPort{"127.0.0.1", 11000}));
    EXPECT_EQ(delta.scheme, endpoint::Scheme::tcpout);
    EXPECT_EQ(delta.address, (endpoint::HostPort{"127.0.0.1", 25760}));
    EXPECT_EQ(delta.options.name, "delta");
    EXPECT_EQ(server.scheme, endpoint::Scheme::tcpin);
}

TEST(ConvertMavlinkRouter, SectionsAndKeysIgnoreCase) {
    const auto config = config_of(
        "[GENERAL]\ntcpserverport=0\n[udpendpoint x]\nMODE=eavesdropping\naddress=[::]\npOrT=14550\n");

    EXPECT_EQ(only_endpoint(config).scheme, endpoint::Scheme::udpin);
    EXPECT_EQ(only_endpoint(config).address, (endpoint::HostPort{"::", 14550}));
}

TEST(ConvertMavlinkRouter, FiltersOfBothDirections) {
    const auto config = config_of(without_tcp(
        "[UdpEndpoint x]\nMode=Client\nAddress=10.0.0.2\nPort=1\n"
        "AllowMsgIdOut = 0,30, 33\nBlockMsgIdIn=150\nAllowSrcSysOut=1\nBlockSrcCompIn=100,101\nGroup=air\n"));
    const auto& o = only_endpoint(config).options;

    EXPECT_THAT(o.out_allow.messages, ElementsAre("0", "30", "33"));
    EXPECT_THAT(o.out_allow.systems, ElementsAre(1));
    EXPECT_THAT(o.in_block.messages, ElementsAre("150"));
    EXPECT_THAT(o.in_block.components, ElementsAre(100, 101));
    EXPECT_TRUE(o.out_block.empty());
    EXPECT_TRUE(o.in_allow.empty());
    EXPECT_EQ(o.group, "air");
}

TEST(ConvertMavlinkRouter, FilterIsTheOldNameOfAllowMsgIdOut) {
    const auto conversion = converted(
        without_tcp("[UdpEndpoint x]\nMode=Normal\nAddress=10.0.0.2\nPort=1\nFilter = 0,30\n"));

    EXPECT_THAT(conversion.toml, HasSubstr("out_allow = [\"0\", \"30\"]"));
    EXPECT_THAT(conversion.notes, IsEmpty());
}

TEST(ConvertMavlinkRouter, AUartHas115200BaudUnlessItSetsAnother) {
    EXPECT_EQ(only_endpoint(config_of(without_tcp("[UartEndpoint u]\nDevice=/dev/ttyS0\n"))).options.baud, 115200u);
    const auto flow = config_of(without_tcp("[UartEndpoint u]\nDevice=/dev/ttyS0\nFlowControl=1\n"));
    EXPECT_EQ(only_endpoint(flow).options.flow, "rtscts");
}

TEST(ConvertMavlinkRouter, AListOfBaudRatesIsAutoAndIsNamed) {
    const auto text = without_tcp("[UartEndpoint u]\nDevice=/dev/ttyS0\nBaud=57600,115200\n");

    EXPECT_EQ(only_endpoint(config_of(text)).options.baud, 0u);
    EXPECT_THAT(places(converted(text)), ElementsAre("5 [UartEndpoint u] Baud"));
}

TEST(ConvertMavlinkRouter, GeneralBecomesRouterLogAndRecord) {
    const auto config = config_of(
        "[General]\nTcpServerPort=5790\nDeduplicationPeriod=120\nDebugLogLevel=WARNING\nLog=/var/log/"
        "fs\nLogTelemetry=true\n");

    EXPECT_EQ(config.router.dedup_ms, 120u);
    EXPECT_EQ(config.log_level, LogLevel::warning);
    EXPECT_EQ(config.record.path, "/var/log/fs/telemetry.tlog");
    EXPECT_EQ(only_endpoint(config).address.port, 5790);
}

TEST(ConvertMavlinkRouter, NamesWhatItCannotCarryOver) {
    const auto conversion = converted(
        "[General]\n"
        "ReportStats = true\n"
        "MavlinkDialect = ardupilotmega\n"
        "Log = /var/log/fs\n"
        "LogMode = while-armed\n"
        "MinFreeSpace = 1000\n"
        "MaxLogFiles = 5\n"
        "SnifferSysid = 254\n"
        "DeduplicationPeriod = 90000\n"
        "DeduplicationPeriods = 1\n"
        "[TcpEndpoint t]\nAddress=10.0.0.1\nPort=5760\nRetryTimeout=0\n"
        "[UdpEndpoints y]\nMode=Normal\n"
        "[UdpEndpoint]\nMode=Normal\n");

    EXPECT_THAT(
        places(conversion),
        ElementsAre("2 [General] ReportStats", "3 [General] MavlinkDialect", "4 [General] Log", "5 [General] LogMode",
                    "6 [General] MinFreeSpace", "7 [General] MaxLogFiles", "8 [General] SnifferSysid",
                    "9 [General] DeduplicationPeriod", "10 [General] DeduplicationPeriods",
                    "14 [TcpEndpoint t] RetryTimeout", "15 [UdpEndpoints y]", "17 [UdpEndpoint]"));
    EXPECT_THAT(conversion.notes[8].text, HasSubstr("did you mean 'DeduplicationPeriod'"));
    EXPECT_THAT(conversion.notes[10].text, HasSubstr("did you mean 'UdpEndpoint'"));
}

TEST(ConvertMavlinkRouter, ValuesThatChangeNothingAreNotNamed) {
    EXPECT_THAT(
        converted("[General]\nReportStats=0\nMavlinkDialect=Auto\nLogMode=always\nMinFreeSpace=0\nSnifferSysid=0\n"
                  "LogTelemetry=false\n")
            .notes,
        IsEmpty());
}

TEST(ConvertMavlinkRouter, NormalModeToEverybodyIsBroadcastOrMulticast) {
    const auto scheme = [](std::string_view address) {
        const auto config = config_of(
            without_tcp("[UdpEndpoint x]\nMode=Normal\nAddress=" + std::string(address) + "\nPort=14550\n"));
        return only_endpoint(config).scheme;
    };

    EXPECT_EQ(scheme("192.168.1.255"), endpoint::Scheme::udpbcast);
    EXPECT_EQ(scheme("255.255.255.255"), endpoint::Scheme::udpbcast);
    EXPECT_EQ(scheme("239.255.145.50"), endpoint::Scheme::udpmcast);
    EXPECT_EQ(scheme("[ff02::1]"), endpoint::Scheme::udpmcast);
    EXPECT_EQ(scheme("[::1]"), endpoint::Scheme::udpout);
}

TEST(ConvertMavlinkRouter, NormalModeTo0000IsThisMachine) {
    const auto text = without_tcp("[UdpEndpoint x]\nMode=Normal\nAddress=0.0.0.0\nPort=14551\n");

    EXPECT_EQ(only_endpoint(config_of(text)).address, (endpoint::HostPort{"127.0.0.1", 14551}));
    EXPECT_THAT(places(converted(text)), ElementsAre("5 [UdpEndpoint x] Address"));
}

TEST(ConvertMavlinkRouter, NormalModeWithoutPortTakesTheNextFreeFrom14550) {
    const auto config = config_of(
        without_tcp("[UdpEndpoint a]\nMode=Normal\nAddress=10.0.0.1\n"
                    "[UdpEndpoint b]\nMode=Server\nAddress=0.0.0.0\nPort=14550\n"
                    "[UdpEndpoint c]\nMode=Normal\nAddress=10.0.0.1\n"));

    ASSERT_THAT(config.endpoints, SizeIs(3));
    EXPECT_EQ(config.endpoints[0].address.port, 14551);
    EXPECT_EQ(config.endpoints[2].address.port, 14552);
}

TEST(ConvertMavlinkRouter, TwoOfOneNameStayApart) {
    const auto config = config_of(without_tcp(
        "[UdpEndpoint x]\nMode=Server\nAddress=0.0.0.0\nPort=1\n[TcpEndpoint x]\nAddress=10.0.0.1\nPort=1\n"));

    ASSERT_THAT(config.endpoints, SizeIs(2));
    EXPECT_EQ(config.endpoints[1].options.name, "x-2");
}

TEST(ConvertMavlinkRouter, NamesWithQuotesAndBackslashesSurvive) {
    const auto config = config_of(without_tcp("[UartEndpoint a\"b\\c]\nDevice=/dev/tty\"S0\n"));

    EXPECT_EQ(only_endpoint(config).options.name, "a\"b\\c");
    EXPECT_EQ(only_endpoint(config).path, "/dev/tty\"S0");
}

TEST(ConvertMavlinkRouter, ErrorsNameFileAndLine) {
    EXPECT_THAT(error_of("Mode=Normal\n"), HasSubstr("main.conf:1: "));
    EXPECT_THAT(error_of("# x\n\n[General\n"), HasSubstr("main.conf:3: the bracket"));
    EXPECT_THAT(error_of("[General] more\n"), HasSubstr("main.conf:1: 'more' follows"));
    EXPECT_THAT(error_of("[ General]\n"), HasSubstr("main.conf:1: "));
    EXPECT_THAT(error_of("[General]\nTcpServerPort\n"), HasSubstr("main.conf:2: "));
    EXPECT_THAT(error_of("[General]\n=1\n"), HasSubstr("main.conf:2: there is no key"));
    EXPECT_THAT(error_of("[General]\nTcpServerPort=\n"), HasSubstr("main.conf:2: TcpServerPort has no value"));
    EXPECT_THAT(error_of("[General]\nTcpServerPort=x\n"), HasSubstr("main.conf:2: TcpServerPort: "));
    EXPECT_THAT(error_of("[General]\nTcpServerPort=65536\n"), HasSubstr("main.conf:2: TcpServerPort: "));
    EXPECT_THAT(error_of("[General]\nDebugLogLevel=loud\n"), HasSubstr("main.conf:2: DebugLogLevel: 'loud'"));
    EXPECT_THAT(error_of("[UartEndpoint u]\nBaud=1\n"), HasSubstr("main.conf:1: [UartEndpoint u] has no Device"));
    EXPECT_THAT(error_of("[UartEndpoint u]\nDevice=/dev/x\nBaud=0\n"), HasSubstr("main.conf:3: Baud: "));
    EXPECT_THAT(error_of("[UdpEndpoint u]\nMode=Normal\n"), HasSubstr("main.conf:1: [UdpEndpoint u] has no Address"));
    EXPECT_THAT(error_of("[UdpEndpoint u]\nAddress=1.2.3.4\n"), HasSubstr("has no Mode"));
    EXPECT_THAT(error_of("[UdpEndpoint u]\nMode=Server\nAddress=0.0.0.0\n"), HasSubstr("has no Port"));
    EXPECT_THAT(error_of("[UdpEndpoint u]\nMode=Both\nAddress=1.2.3.4\nPort=1\n"),
                HasSubstr("main.conf:2: Mode: 'Both'"));
    EXPECT_THAT(error_of("[UdpEndpoint u]\nMode=Normal\nAddress=1.2.3.4\nPort=0\n"), HasSubstr("main.conf:4: Port: "));
    EXPECT_THAT(error_of("[UdpEndpoint u]\nMode=Normal\nAddress=::1\nPort=1\n"), HasSubstr("main.conf:3: Address: "));
    EXPECT_THAT(error_of("[UdpEndpoint u]\nMode=Normal\nAddress=[127.0.0.1]\nPort=1\n"), HasSubstr("main.conf:3: "));
    EXPECT_THAT(error_of("[TcpEndpoint u]\nAddress=1.2.3.4\n"), HasSubstr("main.conf:1: [TcpEndpoint u] has no Port"));
    EXPECT_THAT(error_of("[TcpEndpoint u]\nAddress=1.2.3.4\nPort=1\nAllowSrcSysIn=1,256\n"),
                HasSubstr("main.conf:4: AllowSrcSysIn: "));
}

TEST(ConvertMavlinkRouter, BytesThatAreNoTextAreAnError) {
    EXPECT_THAT(error_of("[UartEndpoint u]\nDevice=/dev/\xFF\xFE\n"), HasSubstr("main.conf:"));
}

TEST(Ini, ASectionOpenedAgainContinuesAndTheLastValueStands) {
    const auto sections = detail::parse_ini("[a]\nx=1\n[b]\n[A]\nX = 2 ; no comment\n; comment\n#comment\ny=z=w", "f");

    ASSERT_TRUE(sections);
    ASSERT_THAT(*sections, SizeIs(2));
    ASSERT_THAT(sections->front().entries, SizeIs(2));
    EXPECT_EQ(sections->front().find("x")->value, "2 ; no comment");
    EXPECT_EQ(sections->front().find("x")->line, 5u);
    EXPECT_EQ(sections->front().find("y")->value, "z=w");
    EXPECT_EQ(sections->front().find("z"), nullptr);
}

TEST(ConvertMavlinkRouter, AFileThatIsNotThereIsAnError) {
    EXPECT_FALSE(convert_mavlink_router_file("/nowhere/main.conf"));
}

}  // namespace
}  // namespace mavloom::config
