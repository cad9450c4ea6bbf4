// SPDX-License-Identifier: MIT
#include "mavloom/config/config.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <tuple>

#include "mavloom/config/keys.hpp"
#include "mavloom/endpoint/grammar.hpp"
#include "mavloom/wire/signing.hpp"
#include "support/temp_dir.hpp"

namespace mavloom::config {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

Config parsed(std::string_view text, const Environment& environment = {}) {
    auto config = parse_config(text, "r.toml", environment);
    if (!config) {
        ADD_FAILURE() << config.error().text;
        return {};
    }
    return *config;
}

const Setting& setting(const Config& config, std::size_t section, std::string_view key) {
    const auto& settings = config.sections.at(section).settings;
    const auto found = std::find_if(settings.begin(), settings.end(), [&](const Setting& s) { return s.key == key; });
    if (found == settings.end()) throw std::out_of_range(std::string(key));
    return *found;
}

TEST(Config, AnEmptyFileGivesTheDefaults) {
    const auto config = parsed("");

    EXPECT_EQ(config.router.dedup_ms, 0u);
    EXPECT_EQ(config.router.unknown_component, UnknownComponent::system);
    EXPECT_EQ(config.router.unknown_target, UnknownTarget::drop);
    EXPECT_EQ(config.router.route_timeout, 60s);
    EXPECT_FALSE(config.router.heartbeat.has_value());
    EXPECT_EQ(config.ring.capacity_bytes, 8388608u);
    EXPECT_EQ(config.ring.full, WhenFull::evict);
    EXPECT_EQ(config.ring.mode, 0600);
    EXPECT_EQ(config.ring.inlet_mode, std::nullopt);
    EXPECT_EQ(config.log_level, LogLevel::info);
    EXPECT_EQ(config.service, ServiceConfig{});
    EXPECT_TRUE(config.endpoints.empty());
    EXPECT_EQ(config.sections.size(), 5u);
}

constexpr std::string_view whole_file = R"(
[router]
name = "bridge"
metrics = "127.0.0.1:9090"
metrics_detail = true
dedup_ms = 250
unknown_component = "drop"
unknown_target = "flood"
route_timeout = "2m"
heartbeat = "255/191"

[[endpoint]]
url = "udpin://0.0.0.0:14550?idle=2"
name = "ground"
max_rate = {ATTITUDE = 10, "*" = 50}
in_block = ["sys:7", 30]

[[endpoint]]
scheme = "tcpout"
host = "[::1]"
port = 5760
queue_age = 0.5
tap = true

[[endpoint]]
scheme = "serial"
path = "/dev/ttyACM0"
baud = 921600

[[endpoint]]
scheme = "shm"
ring = "main"

[ring]
name = "main"
capacity = "1M"
mode = "0640"
inlet_mode = "0660"
[record]
path = "flight.tlog"
rotate_bytes = 100000000
[log]
level = "debug"
)";

TEST(Config, TakesEveryKey) {
    const auto config = parsed(whole_file);

    EXPECT_EQ(config.router.dedup_ms, 250u);
    EXPECT_EQ(config.router.unknown_component, UnknownComponent::drop);
    EXPECT_EQ(config.router.unknown_target, UnknownTarget::flood);
    EXPECT_EQ(config.router.route_timeout, 120s);
    EXPECT_EQ(config.router.heartbeat, (std::pair<std::uint8_t, std::uint8_t>{255, 191}));
    ASSERT_EQ(config.endpoints.size(), 4u);
    EXPECT_EQ(config.endpoints[0].label(), "ground");
    EXPECT_EQ(config.endpoints[0].options.idle, 2s);
    EXPECT_EQ(config.endpoints[0].options.max_rate.size(), 2u);
    EXPECT_THAT(config.endpoints[0].options.in_block.messages, testing::ElementsAre("30"));
    EXPECT_THAT(config.endpoints[0].options.in_block.systems, testing::ElementsAre(7));
    EXPECT_EQ(config.endpoints[1].address, (endpoint::HostPort{"::1", 5760}));
    EXPECT_EQ(config.endpoints[1].options.queue_age, 500ms);
    EXPECT_TRUE(config.endpoints[1].options.tap);
    EXPECT_EQ(config.endpoints[2].options.baud, 921600u);
    EXPECT_EQ(config.endpoints[3].path, "main");
    EXPECT_EQ(config.ring.name, "main");
    EXPECT_EQ(config.ring.capacity_bytes, 1048576u);
    EXPECT_EQ(config.ring.mode, 0640);
    EXPECT_EQ(config.ring.inlet_mode, 0660);
    EXPECT_EQ(config.record.path, "flight.tlog");
    EXPECT_EQ(config.record.rotate_bytes, 100000000u);
    EXPECT_EQ(config.log_level, LogLevel::debug);
    EXPECT_EQ(config.service, (ServiceConfig{"bridge", endpoint::HostPort{"127.0.0.1", 9090}, true}));
}

TEST(Config, AUrlWhoseOptionEndsInTlogKeepsItsOptions) {
    const auto config = parse_config("[[endpoint]]\nurl = \"udpin://0.0.0.0:14550?name=x.tlog\"\n", "m.toml");
    ASSERT_TRUE(config.has_value()) << config.error().text;
    EXPECT_EQ(config->endpoints[0].options.name, "x.tlog");
    const auto& settings = config->sections.back().settings;
    EXPECT_EQ(std::count_if(settings.begin(), settings.end(),
                            [](const Setting& s) { return s.key == "name" && s.value == "x.tlog"; }),
              1);
}

TEST(Config, KnowsWhereEachValueCameFrom) {
    const auto config = parsed(whole_file, {{"MAVLOOM_ROUTER_DEDUP_MS", "7"}});

    EXPECT_EQ(config.router.dedup_ms, 7u);
    EXPECT_EQ(setting(config, 0, "dedup_ms").origin, Origin::environment);
    EXPECT_EQ(setting(config, 0, "dedup_ms").variable, "MAVLOOM_ROUTER_DEDUP_MS");
    EXPECT_EQ(setting(config, 0, "heartbeat").origin, Origin::file);
    EXPECT_EQ(setting(config, 0, "heartbeat").line, 10u);
    EXPECT_EQ(setting(config, 1, "full").origin, Origin::by_default);
    EXPECT_EQ(setting(config, 1, "full").value, "evict");
    EXPECT_EQ(setting(config, 5, "idle").line, 13u);  // in the url
    EXPECT_EQ(setting(config, 5, "max_rate").value, "*:50,ATTITUDE:10");
    EXPECT_EQ(setting(config, 5, "mtu").value, "1280");
    EXPECT_EQ(setting(config, 5, "mtu").origin, Origin::by_default);
    EXPECT_EQ(setting(config, 7, "baud").line, 28u);
}

struct Bad {
    std::string_view text;
    std::string_view expected;
};

class BadConfigs : public testing::TestWithParam<Bad> {};

TEST_P(BadConfigs, AreRefusedWithFileAndLine) {
    const auto config = parse_config(GetParam().text, "r.toml");

    ASSERT_FALSE(config.has_value());
    EXPECT_EQ(config.error().code, SetupCode::bad_input);
    EXPECT_THAT(config.error().text, HasSubstr(GetParam().expected));
}

INSTANTIATE_TEST_SUITE_P(
    Config, BadConfigs,
    testing::Values(
        Bad{"[router\n", "r.toml:1: "}, Bad{"a = 1\na = 2\n", "r.toml:2: "},
        Bad{"[ruoter]\n", "r.toml:1: there is no section 'ruoter', did you mean 'router'?"},
        Bad{"\n[weather]\n",
            "r.toml:2: there is no section 'weather'; there are router, ring, record, log, web, endpoint"},
        Bad{"router = 1\n", "r.toml:1: 'router' is a section; write [router]"},
        Bad{"[endpoint]\nurl = \"udpin://0.0.0.0:1\"\n", "r.toml:1: endpoints are written [[endpoint]]"},
        Bad{"[router]\ndedup = 1\n", "r.toml:2: [router] has no key 'dedup'"},
        Bad{"[router]\nroute_timeot = 1\n", "did you mean 'route_timeout'?"},
        Bad{"[router]\n\ndedup_ms = -1\n", "r.toml:3: dedup_ms: '-1' is not a whole number"},
        Bad{"[router]\nunknown_target = \"floot\"\n", "did you mean 'flood'?"},
        Bad{"[router]\nroute_timeout = 2024-01-01\n", "of the wrong type"},
        Bad{"[router]\nroute_timeout = \"0s\"\n", "r.toml:2: route_timeout: the timeout of routes must be above 0"},
        Bad{"[router]\nheartbeat = \"255\"\n", "neither off nor SYS/COMP"},
        Bad{"[[endpoint]]\nurl = \"udpin://0.0.0.0:1\"\nheartbeat = true\n",
            "r.toml:3: heartbeat=true needs the id that the router sends it with: --heartbeat SYS/COMP"},
        Bad{"[router]\nmetrics = 9090\n", "'9090' is not HOST:PORT, as in 127.0.0.1:9090"},
        Bad{"[router]\nname = \"a b\"\n", "not a router name"},
        Bad{"[[endpoint]]\nurl = \"udpout://127.0.0.1:1\"\nheartbeat = false\ntap = true\n",
            "r.toml:1: heartbeat= and tap=true exclude each other"},
        Bad{"[ring]\ncapacity = 3000000\n", "not a power of two"}, Bad{"[ring]\nmode = 600\n", "in quotes"},
        Bad{"[ring]\nmode = 0o640\n", "in quotes"}, Bad{"[ring]\nmode = \"640\"\n", "not a file mode"},
        Bad{"[ring]\nmode = \"0968\"\n", "three octal digits"},
        Bad{"[ring]\nfull = \"wait\"\n", "a router does not wait for readers: type evict"},
        Bad{"[ring]\nfull = \"evikt\"\n", "did you mean 'evict'?"}, Bad{"[ring]\nname = \"a b\"\n", "not a ring name"},
        Bad{"[record]\nrotate_every = \"10ms\"\n", "the minimum is 1s"},
        Bad{"[record]\nrotate_bytes = 1\n", "out of range (4096 to"},
        Bad{"\n[web]\nlisten = 8088\n", "r.toml:3: listen: '8088' is not HOST:PORT"},
        Bad{"[web]\ntoken = \"x\"\n", "r.toml:2: [web] has no key 'token'"},
        Bad{"[[endpoint]]\nname = \"x\"\n", "r.toml:1: an endpoint needs url"},
        Bad{"[[endpoint]]\nurk = \"udpin://0.0.0.0:1\"\n",
            "r.toml:2: [[endpoint]] has no key 'urk', did you mean 'url'?"},
        Bad{"[[endpoint]]\nurl = \"udp://:14540\"\n", "type udpin://0.0.0.0:14540"},
        Bad{"[[endpoint]]\nurl = \"udpin://0.0.0.0:14550\"\nport = 1\n", "r.toml:3: 'port' is given beside url"},
        Bad{"[[endpoint]]\nurl = \"udpin://0.0.0.0:14550?idle=1\"\nidle = 2\n",
            "r.toml:3: 'idle' is already set in the url"},
        Bad{"[[endpoint]]\nurl = \"udpin://0.0.0.0:14550\"\nqueue_byte = 2\n",
            "r.toml:3: there is no option 'queue_byte', did you mean 'queue_bytes'?"},
        Bad{"[[endpoint]]\nurl = \"udpin://0.0.0.0:14550\"\ndedup_ms = 5\n",
            "r.toml:3: there is no option 'dedup_ms'; 'dedup_ms' is a setting of the router: --dedup-ms, or dedup_ms "
            "in [router]"},
        Bad{"[[endpoint]]\nurl = \"udpin://0.0.0.0:14550\"\nbaud = 2\n", "does not take the option 'baud'"},
        Bad{"[[endpoint]]\nscheme = \"udpn\"\n", "did you mean 'udpin'?"},
        // A recording where a configuration is expected.
        Bad{std::string_view("\0\1flight", 8),
            "r.toml:1: this is not a text file; if it is a recording, mavloom listen"},
        // Habits from other programs.
        Bad{"\n[General]\nTcpServerPort=5760\n",
            "r.toml:2: this is a configuration of mavlink-router; to convert it, type mavloom check --convert r.toml"},
        Bad{"# x\n[UdpEndpoint alpha]\nMode = Server\n", "r.toml:2: this is a configuration of mavlink-router"},
        Bad{"[[endpoint]]\nurl = udpin://0.0.0.0:14550\n",
            "text is written in quotes: url = \"udpin://0.0.0.0:14550\""},
        Bad{"[ring]\nmode=rw # readable\n", "text is written in quotes: mode = \"rw\""},
        Bad{"[[endpoint]]\nscheme = \"serial\"\ndevice = \"/dev/ttyACM0\"\n",
            "r.toml:3: [[endpoint]] has no key 'device'; write path = \"/dev/ttyACM0\""},
        Bad{"[[endpoint]]\nscheme = \"udpin\"\naddress = \"0.0.0.0\"\n", "write host = \"0.0.0.0\""},
        Bad{"[[endpoint]]\nurl = \"udpin://0.0.0.0:1\"\ngroup_mode = \"best\"\n",
            "group_mode= has no effect without group=NAME"},
        // A missing or malformed host, port or path.
        Bad{"[[endpoint]]\nscheme = \"udpin\"\nport = 14550\n", "udpin needs host"},
        Bad{"[[endpoint]]\nscheme = \"udpin\"\nhost = \"\"\nport = 14550\n",
            "r.toml:3: host: the address to listen on is missing"},
        Bad{"[[endpoint]]\nscheme = \"udpin\"\nhost = \"[127.0.0.1]\"\nport = 14550\n", "brackets are for IPv6 only"},
        Bad{"[[endpoint]]\nscheme = \"udpin\"\nhost = \"::1\"\nport = 14550\n",
            "needs brackets; type udpin://[::1]:14550"},
        Bad{"[[endpoint]]\nscheme = \"udpin\"\nhost = \"127.0.0.1\"\n", "udpin needs port"},
        Bad{"[[endpoint]]\nscheme = \"udpin\"\nhost = \"127.0.0.1\"\nport = 0\n", "port 0"},
        Bad{"[[endpoint]]\nurl = \"udpin://127.0.0.1:0\"\n", "port 0"},
        Bad{"[[endpoint]]\nscheme = \"serial\"\n", "serial needs path"},
        Bad{"[[endpoint]]\nscheme = \"serial\"\npath = \"/dev/ttyS0\"\nbaud = 0\n", "r.toml:4: option 'baud'"},
        Bad{"[[endpoint]]\nscheme = \"shm\"\n", "shm needs ring"},
        Bad{"[[endpoint]]\nurl = \"udpin://0.0.0.0:1\"\n[[endpoint]]\nurl = \"udpin:0.0.0.0:1\"\n",
            "r.toml:3: two endpoints are named 'udpin://0.0.0.0:1'"}));

TEST(Config, AKeyThatIsGivenTwiceGetsNoHintAboutQuotes) {
    const auto twice = parse_config("[router]\ndedup_ms = 1\ndedup_ms = 2 # again\n", "r.toml", {});

    ASSERT_FALSE(twice.has_value());
    EXPECT_THAT(twice.error().text, HasSubstr("r.toml:3: "));
    EXPECT_THAT(twice.error().text, testing::Not(HasSubstr("quotes")));
}

TEST(Config, AVariableThatSetsNothingIsAnError) {
    const auto misspelt = parse_config("", "r.toml", {{"MAVLOOM_ROUTER_DEDUPMS", "1"}});
    const auto wrong = parse_config("", "r.toml", {{"MAVLOOM_LOG_LEVEL", "loud"}});

    ASSERT_FALSE(misspelt.has_value());
    EXPECT_THAT(misspelt.error().text, HasSubstr("did you mean 'MAVLOOM_ROUTER_DEDUP_MS'?"));
    ASSERT_FALSE(wrong.has_value());
    EXPECT_THAT(wrong.error().text,
                HasSubstr("environment: MAVLOOM_LOG_LEVEL: 'loud' is not one of debug, info, warning, error"));
}

TEST(Config, TheWebPageIsOffUnlessItHasAPlace) {
    const auto absent = parse_config("[web]\n", "r.toml", {});
    const auto given = parse_config(
        "[web]\norigin = [\"https://a.example\", \"https://b.example\"]\nhost = \"drone\"\n", "r.toml",
        {{"MAVLOOM_WEB_LISTEN", "0.0.0.0:8088"}});
    ASSERT_TRUE(absent.has_value() && given.has_value());

    EXPECT_EQ(absent->web, WebConfig{});
    EXPECT_EQ(given->web,
              (WebConfig{endpoint::HostPort{"0.0.0.0", 8088}, {"https://a.example", "https://b.example"}, {"drone"}}));
}

TEST(Config, AnOptionOverridesTheEnvironmentAndTheFile) {
    const std::array overrides{Override{"--dedup-ms", "router", "dedup_ms", "3"},
                               Override{"--metrics", "router", "metrics", "[::1]:9090"}};
    const auto config = parse_config("[router]\ndedup_ms = 1\nname = \"of-the-file\"\n", "r.toml",
                                     {{"MAVLOOM_ROUTER_DEDUP_MS", "2"}, {"MAVLOOM_ROUTER_METRICS", "127.0.0.1:1"}},
                                     overrides);
    ASSERT_TRUE(config.has_value()) << config.error().text;

    EXPECT_EQ(config->router.dedup_ms, 3u);
    EXPECT_EQ(config->service, (ServiceConfig{"of-the-file", endpoint::HostPort{"::1", 9090}, false}));
    EXPECT_EQ(setting(*config, 0, "dedup_ms").origin, Origin::option);
    EXPECT_EQ(setting(*config, 0, "dedup_ms").variable, "--dedup-ms");
}

TEST(Config, AnErrorOfAnOptionBeginsWithTheOption) {
    const auto error_of = [](const Override& given) {
        const auto config = parse_config("", "", {}, std::span(&given, 1));
        EXPECT_EQ(config ? SetupCode::system : config.error().code, SetupCode::usage);
        return config ? std::string("good") : config.error().text;
    };
    EXPECT_THAT(error_of({"--metrics", "router", "metrics", "9090"}), HasSubstr("--metrics: '9090' is not HOST:PORT"));
    EXPECT_THAT(error_of({"--request-streams", "router", "request_streams", "4"}),
                HasSubstr("--request-streams needs --heartbeat SYS/COMP"));
}

TEST(Config, EveryKeyOfTheRouterHasAnOption) {
    for (const ConfigKey& key : config_keys()) {
        if (key.section != "router" && key.section != "log") continue;
        std::string name = key.section == "log" ? "--log-" : "--";
        for (const char c : key.name) name += c == '_' ? '-' : c;
        EXPECT_EQ(key.option.name, name);
    }
}

TEST(Config, AVariableWithAMisspeltSectionIsAnError) {
    const auto misspelt = parse_config("", "r.toml", {{"MAVLOOM_ROUTR_DEDUP_MS", "1"}});

    ASSERT_FALSE(misspelt.has_value());
    EXPECT_EQ(misspelt.error().code, SetupCode::bad_input);
    EXPECT_THAT(misspelt.error().text, HasSubstr("did you mean 'MAVLOOM_ROUTER_DEDUP_MS'?"));
}

TEST(Config, AVariableThatIsNearToNoKeyIsNoted) {
    const auto config = parsed("", {{"MAVLOOM_SEED", "1"}, {"MAVLOOM_PROGRAM", "x"}});

    EXPECT_THAT(config.notes, testing::ElementsAre("environment: MAVLOOM_SEED sets nothing",
                                                   "environment: MAVLOOM_PROGRAM sets nothing"));
}

TEST(Config, TakesItsOwnVariablesFromTheEnvironment) {
    const char* const variables[] = {"PATH=/bin", "MAVLOOM_SEED=1", "MAVLOOM_LOG_LEVEL=info", "MAVLOOM", nullptr};

    EXPECT_EQ(environment_of(variables), (Environment{{"MAVLOOM_SEED", "1"}, {"MAVLOOM_LOG_LEVEL", "info"}}));
}

TEST(Config, MessagesAreLookedUpWithFileAndLine) {
    const auto& dialect = dialect::default_dialect();
    const auto check = [&](std::string_view text) {
        const auto checked = check_message_names(parsed(text), "r.toml", dialect);
        return checked ? std::string("good") : checked.error().text;
    };
    const std::string other =
        "[[endpoint]]\nurl = \"udpin://0.0.0.0:1\"\nin_allow = [\"ATTITUDE\", 77777, \"sys:1\"]\n";

    EXPECT_EQ(check(other), "good");
    EXPECT_EQ(check(other + "[[endpoint]]\nurl = \"udpin://0.0.0.0:2\"\nname = \"b\"\nout_block = \"ATITUDE\"\n"),
              "r.toml:7: out_block: unknown message 'ATITUDE', did you mean 'ATTITUDE'?");
    EXPECT_EQ(check(other + "[[endpoint]]\nurl = \"udpin://0.0.0.0:2?in_block=HEARTBEET\"\n"),
              "r.toml:5: in_block: unknown message 'HEARTBEET', did you mean 'HEARTBEAT'?");
    EXPECT_EQ(check("[[endpoint]]\nurl = \"udpin://0.0.0.0:2\"\nmax_rate = {\"*\" = 5, ATITUDE = 10}\n"),
              "r.toml:3: max_rate: unknown message 'ATITUDE', did you mean 'ATTITUDE'?");
}

TEST(Config, TwoRecordingsInOneFileAreAnErrorOfTheSecond) {
    const auto error_of = [](std::string_view text) {
        const auto config = parse_config(text, "r.toml");
        return config ? std::string("good") : config.error().text;
    };
    EXPECT_EQ(error_of("[record]\npath = \"a.tlog\"\n[[endpoint]]\nurl = \"tlog://./a.tlog?name=b\"\n"),
              "r.toml:4: another recording already writes to './a.tlog'");
    EXPECT_EQ(error_of("[[endpoint]]\nurl = \"tlog://a.tlog\"\n[[endpoint]]\nscheme = \"tlog\"\nname = \"b\"\npath = "
                       "\"a.tlog\"\n"),
              "r.toml:6: another recording already writes to 'a.tlog'");
}

TEST(Config, TwoEndpointsThatBindOnePortAreAnErrorOfTheSecond) {
    const auto with = [](std::string_view a, std::string_view b) {
        const auto config = parse_config(
            fmt::format("[[endpoint]]\nurl = \"{}\"\n[[endpoint]]\nname = \"b\"\nurl = \"{}\"\n", a, b), "r.toml");
        return config ? std::string("good") : config.error().text;
    };
    EXPECT_EQ(with("udpin://0.0.0.0:14550", "udpin://127.0.0.1:14550"),
              "r.toml:5: 'b' binds UDP port 14550, which 'udpin://0.0.0.0:14550' in line 2 already uses");
    EXPECT_EQ(with("udpout://127.0.0.1:1?bind=127.0.0.1:5000", "tcpin://127.0.0.1:5000"), "good");
    for (const auto& [a, b, meet] : {std::tuple{"tcpin://0.0.0.0:5760", "tcpin://[::]:5760", true},
                                     {"tcpin://0.0.0.0:5760", "tcpin://[::1]:5760", false},
                                     {"tcpin://127.0.0.1:5760", "tcpin://localhost:5760", true},
                                     {"tcpin://127.0.0.1:5760", "tcpin://127.0.0.2:5760", false},
                                     {"tcpin://127.0.0.1:5760", "udpin://127.0.0.1:5760", false},
                                     {"tcpin://companion:5760", "tcpin://companion:5760", true},
                                     {"tcpin://companion:5760", "tcpin://ground:5760", false},
                                     {"tcpin://companion:5760", "tcpin://0.0.0.0:5760", true},
                                     {"udpin://0.0.0.0:1?iface=eth0", "udpin://0.0.0.0:1?iface=eth1", false},
                                     {"udpin://0.0.0.0:1?iface=eth0", "udpin://0.0.0.0:1", true},
                                     {"udpin://0.0.0.0:1", "udpout://127.0.0.1:2?bind=0.0.0.0:1", true},
                                     {"udpin://0.0.0.0:1", "udpout://127.0.0.1:1", false},
                                     {"udpmcast://239.255.1.1:1", "udpmcast://239.255.1.1:1?iface=eth0", false},
                                     {"udpmcast://239.255.1.1:1", "udpin://0.0.0.0:1", true},
                                     {"udpmcast://239.255.1.1:1?iface=eth0", "udpin://0.0.0.0:1?iface=eth1", true}}) {
        const auto said = with(a, b);
        EXPECT_EQ(said != "good", meet) << a << " and " << b << ": " << said;
    }
}

TEST(Config, KeyFilesAreReadWithFileAndLine) {
    const test::TempDir dir;
    const auto key = dir / "good.key";
    ASSERT_TRUE(wire::SigningKey::random()->create_file(key));
    const auto check = [&](std::string_view options) {
        const auto checked = check_key_files(
            parsed(fmt::format("[[endpoint]]\nurl = \"udpin://0.0.0.0:1\"\n{}\n", options)), "r.toml");
        return checked ? std::string("good") : checked.error().text;
    };
    const auto quoted = [&](std::string_view name) { return fmt::format("\"{}\"", (dir / std::string(name)).string()); };

    EXPECT_EQ(check(fmt::format("sign = {0}\nverify = {0}", quoted("good.key"))), "good");
    EXPECT_THAT(check(fmt::format("sign = {}\nverify = {}", quoted("good.key"), quoted("none.key"))),
                testing::AllOf(testing::StartsWith("r.toml:4: verify: "), HasSubstr("none.key")));
}

TEST(Config, StatesWhyAFileCannotBeRead) {
    const test::TempDir dir;
    const std::vector<std::uint8_t> endless(5'000'000, '#');
    test::write_file(dir / "long.toml", endless);

    EXPECT_EQ(load_config(dir / "none.toml").error().code, SetupCode::not_found);
    EXPECT_THAT(load_config(dir.path()).error().text, HasSubstr("Is a directory"));
    EXPECT_EQ(load_config(dir / "long.toml").error().code, SetupCode::bad_input);
}

// The default that `check` shows is the default.
TEST(EndpointOptions, DefaultTextsGiveTheDefaultValues) {
    for (const auto* url : {"udpin://127.0.0.1:1", "udpbcast://192.168.1.255:1", "tcpin://127.0.0.1:1",
                            "serial:///dev/ttyS0", "shm://a", "tlog://a"}) {
        const auto plain = *endpoint::parse_endpoint(url);
        for (const auto name : endpoint::option_names_for(plain.scheme)) {
            const auto text = endpoint::default_option_text(plain.scheme, name);
            if (text.empty() || name == "queue_age" || name == "idle")
                continue;  // these depend on the traffic and on the peer
            auto set = plain;
            ASSERT_TRUE(endpoint::set_endpoint_option(set, name, text).has_value()) << name;
            const auto &a = set.options, &b = plain.options;
            EXPECT_TRUE(a.group_mode == b.group_mode && a.mtu_bytes == b.mtu_bytes && a.queue_bytes == b.queue_bytes &&
                        a.tap == b.tap && a.is_private == b.is_private && a.rcvbuf_bytes == b.rcvbuf_bytes &&
                        a.max_peers == b.max_peers && a.low_latency == b.low_latency && a.required == b.required &&
                        a.fixed == b.fixed && a.baud == b.baud && a.flow == b.flow && a.from_oldest == b.from_oldest &&
                        a.lossless == b.lossless)
                << name;
        }
    }
}

}  // namespace
}  // namespace mavloom::config
