// SPDX-License-Identifier: MIT
// The views as grids of text. Expected rates and counts are those of the frames that each test sends.
#include "mavloom/view/draw.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "mavloom/msg/attitude.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/statustext.hpp"
#include "unit/observe/fixture.hpp"

namespace mavloom::view {
namespace {

using namespace observe::testing;
using ::testing::HasSubstr;
using ::testing::Not;

struct DrawTest : InspectorTest {
    DrawTest() {
        for (int i = 0; i < 101; ++i) hear(msg::Attitude{.roll = 0.01F * static_cast<float>(i)}, i * 100ms);
        for (int i = 0; i < 11; ++i)
            hear(msg::Heartbeat{.type = 2, .autopilot = 12, .base_mode = 0x81, .custom_mode = 50593792}, i * 1s);
    }

    [[nodiscard]] std::shared_ptr<Snapshot> taken(Nanoseconds at = 10s, Rates rates = Rates::average) const {
        return std::make_shared<Snapshot>(
            take_snapshot(dialect::default_dialect(), inspector, {wall(at), mono(at)},
                          {{.link = LinkId{1}, .source = vehicle, .received = 112, .lost = 8}}, rates));
    }
    std::string drawn(Size size, Glyphs glyphs = Glyphs::ascii) { return draw(*taken(), state, size, glyphs).text(); }
    Effect type(std::u32string_view characters) {
        auto effect = Effect::none;
        for (const char32_t c : characters) effect = press({.character = c});
        return effect;
    }
    Effect press(const Key& key) { return view::press(state, taken(), key, {80, 24}); }

    State state{};
};

TEST_F(DrawTest, TheMessagesOfAVehicle) {
    EXPECT_EQ(drawn({80, 12}),
              " mavloom top                                                   11.0 Hz  218 B/s\n"
              " no alarm\n"
              " 1 Messages  2 Vehicles  3 Links  4 Routes  5 Alarms\n"
              " MESSAGEv                                  HZ     AGE  GAP MAX   JITTER   SHARE\n"
              " 1/1 quadrotor link                                               8 lost, 6.7 %\n"
              "   ATTITUDE                              10.0   0.0 s   100 ms     0 us  90.6 %\n"
              "   HEARTBEAT                              1.0   0.0 s   1.00 s     0 us   9.4 %\n"
              "\n\n\n\n"
              " ? help  / search  s sort  enter open  f freeze  space pause  q quit\n");
}

TEST_F(DrawTest, ASearchLeavesWhatMatches) {
    type(U"/atti");
    EXPECT_THAT(drawn({80, 24}), HasSubstr("ATTITUDE"));
    EXPECT_THAT(drawn({80, 24}), Not(HasSubstr("HEARTBEAT")));
}

TEST_F(DrawTest, OnlyWhatASearchShowsIsOpened) {
    press({.code = Key::Code::end});
    type(U"/atti");
    press({.code = Key::Code::enter});
    press({.code = Key::Code::enter});
    EXPECT_THAT(drawn({80, 24}), HasSubstr("ATTITUDE #30 of 1/1"));
    EXPECT_THAT(drawn({40, 10}), HasSubstr("ATTITUDE #30 of 1/1            10.0 Hz"));
}

TEST_F(DrawTest, HelpAndHintsNeedNoUtf8AndNoWideTerminal) {
    type(U"?");
    EXPECT_THAT(drawn({40, 10}), HasSubstr(" ^ v PgUp    select a message; j and k,\n PgDn Home   too\n"));
    EXPECT_THAT(drawn({80, 24}), HasSubstr(" Enter, Esc              open the message, and go back\n"));
}

TEST_F(DrawTest, HelpScrollsWhereItDoesNotFit) {
    type(U"?");
    EXPECT_THAT(drawn({40, 10}), Not(HasSubstr("quit")));
    press({.code = Key::Code::end});
    EXPECT_THAT(drawn({40, 10}), HasSubstr(" q           quit\n"
                                           "\n"
                                           " + green     the message is new\n"
                                           " ! grey      the message does not come\n"
                                           "             any more\n"));
    press({.code = Key::Code::up});
    EXPECT_THAT(drawn({40, 10}), Not(HasSubstr("any more")));
    type(U"q");
    EXPECT_THAT(drawn({40, 10}), HasSubstr("ATTITUDE"));
}

TEST_F(DrawTest, AMessageOpensToItsFields) {
    press({.code = Key::Code::down});
    press({.code = Key::Code::enter});
    EXPECT_THAT(drawn({80, 24}), HasSubstr("1.0 rad\n"));  // roll of the last frame
    EXPECT_THAT(drawn({80, 24}), HasSubstr("rollspeed"));
    press({.code = Key::Code::escape});
    EXPECT_THAT(drawn({80, 24}), Not(HasSubstr("rollspeed")));
}

// 20 frames in the middle of the 20 dots of the plots, so 3 s apart. In a character, the left dots are 1, 2, 4 and 0x40
// from the top, the right ones 8, 0x10, 0x20 and 0x80 (Unicode, "Braille Patterns").
struct FieldPlotTest : DrawTest {
    FieldPlotTest() {
        for (int i = 0; i < 20; ++i) {
            const auto* const row = hear(msg::Attitude{.roll = static_cast<float>(i)}, 21'500ms + i * 3s);
            history.watch(key_of(*row));
            history.take(*row);
        }
        press({.code = Key::Code::down});
        press({.code = Key::Code::enter});
    }
    std::string plotted(Size size, Glyphs glyphs) {
        auto shown = taken(80s);
        shown->history = history;
        return draw(*shown, state, size, glyphs).text();
    }
    History history;
};

TEST_F(FieldPlotTest, EachNumberOfAMessageHasASmallPlot) {
    EXPECT_THAT(plotted({62, 12}, Glyphs::unicode),
                HasSubstr("\n"
                          " time_boot_ms           0 ms                       ⠒⠒⠒⠒⠒⠒⠒⠒⠒⠒\n"
                          " roll                   19.0 rad                   ⣀⣀⡤⠤⠤⠖⠒⠒⠋⠉\n"
                          " pitch                  0.0 rad                    ⠒⠒⠒⠒⠒⠒⠒⠒⠒⠒\n"
                          " yaw                    0.0 rad                    ⠒⠒⠒⠒⠒⠒⠒⠒⠒⠒\n"
                          " rollspeed              0.0 rad/s                  ⠒⠒⠒⠒⠒⠒⠒⠒⠒⠒\n"
                          " pitchspeed             0.0 rad/s                  ⠒⠒⠒⠒⠒⠒⠒⠒⠒⠒\n"
                          " yawspeed               0.0 rad/s                  ⠒⠒⠒⠒⠒⠒⠒⠒⠒⠒\n"));
}

TEST_F(FieldPlotTest, WithoutUtf8PlotsAreAscii) {
    EXPECT_THAT(plotted({62, 12}, Glyphs::ascii),
                HasSubstr(" time_boot_ms           0 ms                       ----------\n"
                          " roll                   19.0 rad                   ___...--''\n"));
}

TEST_F(FieldPlotTest, AValueCoversTheOldPartOfItsPlot) {
    hear(msg::Attitude{.roll = 1.0F / 3}, 80s);
    EXPECT_THAT(plotted({40, 10}, Glyphs::ascii), HasSubstr(" roll           0.33333334 rad   __..''\n"));
    EXPECT_THAT(plotted({32, 10}, Glyphs::ascii), HasSubstr(" roll       0.33333334 rad ..''\n"));
}

TEST_F(FieldPlotTest, ThePlotsOfAnotherMessageAreNotShown) {
    press({.code = Key::Code::escape});
    press({.code = Key::Code::down});
    press({.code = Key::Code::enter});
    EXPECT_THAT(plotted({80, 24}, Glyphs::ascii), HasSubstr("no number to plot so far"));
}

TEST_F(FieldPlotTest, FewPointsOfALongHistoryAreTheSameOnesLater) {
    const auto* const roll = dialect::default_dialect().find(msg::Attitude::id)->find("roll");
    const auto chosen = history.points({roll}, wall(80s), 7);
    ASSERT_EQ(chosen.size(), 5U) << "of 20 frames, each fourth one";
    history.take(*hear(msg::Attitude{}, 82s));  // removes the first one, which is too old
    const auto later = history.points({roll}, wall(82s), 7);
    ASSERT_EQ(later.size(), 5U);
    for (std::size_t i = 1; i < chosen.size(); ++i) EXPECT_EQ(later[i - 1].time, chosen[i].time);
}

TEST_F(DrawTest, AVehicleIsShownInTheWordsOfMavlink) {
    type(U"2");
    EXPECT_THAT(drawn({120, 24}), HasSubstr("quadrotor"));
    EXPECT_THAT(drawn({120, 24}), HasSubstr("Hold"));
}

TEST_F(DrawTest, TextFromOutsideControlsNoTerminal) {
    msg::Statustext text{.severity = 2};
    constexpr std::string_view words =
        "\x1b[2J\x07"
        "boom\xff\xe2\x80\xae";
    std::ranges::copy(words, text.text.begin());
    hear(text, 10s);
    type(U"5");
    const auto all = drawn({120, 24}, Glyphs::unicode);
    EXPECT_THAT(all, HasSubstr("boom"));
    for (const char c : all) EXPECT_TRUE(c == '\n' || static_cast<unsigned char>(c) >= ' ') << int{c};
    EXPECT_THAT(all, Not(HasSubstr("\xe2\x80\xae"))) << "the direction of writing";
}

TEST_F(DrawTest, AColumnIsHiddenAndShownAgain) {
    type(U"c3");
    EXPECT_THAT(drawn({80, 24}), HasSubstr(" 1 HZ 3 AGE"));
    press({.code = Key::Code::escape});
    EXPECT_THAT(drawn({80, 24}), Not(HasSubstr(" AGE")));
    type(U"c3");
    press({.code = Key::Code::escape});
    EXPECT_THAT(drawn({80, 24}), HasSubstr(" AGE"));
}

TEST_F(DrawTest, ARateIsAskedForAndItsAnswerIsShown) {
    press({.code = Key::Code::down});
    EXPECT_EQ(type(U"i2x5"), Effect::none);
    EXPECT_THAT(drawn({80, 24}), HasSubstr("rate: 25_ Hz ATTITUDE from 1/1"));
    EXPECT_EQ(press({.code = Key::Code::enter}), Effect::ask_rate);
    ASSERT_TRUE(state.asked);
    EXPECT_EQ(state.asked->key.id, msg::Attitude::id);
    EXPECT_EQ(state.asked->interval_us(), 40'000);
    EXPECT_THAT(drawn({80, 24}), HasSubstr("ATTITUDE from 1/1: asked, no answer so far"));
    state.asked->answer.is_untaken = true;
    EXPECT_THAT(drawn({80, 24}), HasSubstr("ATTITUDE from 1/1: not asked"));
    state.asked->answer.result = 3;
    EXPECT_THAT(drawn({80, 24}), HasSubstr("ATTITUDE from 1/1: unsupported"));
}

TEST_F(DrawTest, NoRateIsAskedForWithoutAGoodNumber) {
    press({.code = Key::Code::down});
    for (const auto* const typed : {U"i", U"i1.2.3", U"i99999"}) {
        type(typed);
        EXPECT_EQ(press({.code = Key::Code::enter}), Effect::none);
        EXPECT_EQ(drawn({80, 24}).find("is no rate") == std::string::npos, typed[1] == 0)
            << "nothing typed is no error";
        press({.code = Key::Code::escape});
    }
    EXPECT_FALSE(state.asked);
}

TEST_F(DrawTest, TheRoutesOfARouter) {
    auto shown = taken();
    shown->routes = {{.router = "router", .source = vehicle, .link = "udpin://:14550", .age = 250ms, .frames = 7},
                     {.router = "other", .error = "it does not answer"}};
    type(U"4");
    const auto all = draw(*shown, state, {80, 24}, Glyphs::ascii).text();
    EXPECT_THAT(all, HasSubstr(" 1/1      router          udpin://:14550"));
    EXPECT_THAT(all, HasSubstr("          other           it does not answer"));
    EXPECT_THAT(draw(*shown, state, {40, 10}, Glyphs::ascii).text(),
                HasSubstr(" SENDER   REACHED BY                AGE\n"
                          " 1/1      udpin://:14550          0.2 s\n"
                          " other: it does not answer\n"));
}

TEST_F(DrawTest, WhereARecordingStandsNeverCoversItsName) {
    auto shown = taken();
    shown->title = "/home/pilot/flight.tlog";
    shown->playing = Playing{.begin = wall(0s), .end = wall(100s), .speed = 8};
    const auto title = [&](int width) {
        const auto all = draw(*shown, state, {width, 10}, Glyphs::ascii).text();
        return all.substr(0, all.find('\n'));
    };
    EXPECT_EQ(title(80), " mavloom top  /home/pilot/flight.tlog        00:10 / 01:40 x8  11.0 Hz  218 B/s");
    EXPECT_EQ(title(40), " mavloom top  /home/p  00:10 / 01:40 x8");
    EXPECT_EQ(title(20), " m 00:10 / 01:40 x8");
}

TEST_F(DrawTest, RatesEndWhenASenderFallsSilent) {
    hear(msg::Attitude{}, 12s, station);
    EXPECT_THAT(draw(*taken(14900ms, Rates::recent), state, {40, 10}, Glyphs::ascii).text(),
                HasSubstr("   ATTITUDE                        10.0\n   HEARTBEAT                        1.0\n"));
    const auto silent = draw(*taken(15s, Rates::recent), state, {40, 10}, Glyphs::ascii).text();
    EXPECT_THAT(silent,
                HasSubstr("!  ATTITUDE                           -\n!  HEARTBEAT                          -\n"));
    EXPECT_THAT(silent, HasSubstr("0.00 Hz"));
    EXPECT_THAT(silent, HasSubstr("+  ATTITUDE ")) << "the station's is not silent";
    type(U"2");
    EXPECT_THAT(draw(*taken(15s, Rates::recent), state, {40, 10}, Glyphs::ascii).text(), HasSubstr("\n!1/1 "));
}

TEST_F(DrawTest, ALinkShowsHowFullItsQueueIs) {
    auto shown = taken();
    const observe::HopLink slow{
        .name = "udpout://192.168.1.20:14550", .frames_in = 1, .queued_bytes = 800'000, .queue_limit_bytes = 1 << 20};
    const observe::HopLink idle{.name = "tablet", .queue_limit_bytes = 1 << 20};
    shown->hops = {{.name = "router", .kind = observe::Hop::Kind::router, .links = {slow, idle}}};
    type(U"3");
    EXPECT_EQ(draw(*shown, state, {80, 9}, Glyphs::ascii).text(),
              " mavloom top                                                   11.0 Hz  218 B/s\n"
              " no alarm\n"
              " 1 Messages  2 Vehicles  3 Links  4 Routes  5 Alarms\n"
              " LINK                                    HZ IN  HZ OUT       IN      OUT  QUEUE\n"
              " router router                               -       -        0        0\n"
              "   udpout://192.168.1.20:14550               -       -        1        0   77 %\n"
              "   tablet                                    -       -        0        0    0 %\n"
              "\n"
              " tab next view  space pause  ? help  q quit\n");
}

TEST_F(DrawTest, AProgramsHintIsReadInFortyColumns) {
    auto shown = taken();
    const observe::HopLink tablet{.name = "tablet", .losses = {{"queue_age", 7, ""}, {"queue_bytes", 3, ""}}};
    const std::string hint = "px4 has no ring: to see all, start it with --ring px4";
    shown->hops = {{.name = "px4", .losses = {{"gaps", 1, ""}}, .links = {tablet}, .hint = hint}};
    type(U"3");
    EXPECT_THAT(draw(*shown, state, {40, 20}, Glyphs::ascii).text(),
                HasSubstr("   px4 has no ring: to see all, start it\n   with --ring px4\n   1 gaps\n   tablet"));
    const auto text = whole_text(*shown, 40, Glyphs::ascii);
    EXPECT_THAT(text, HasSubstr("start it\n   with --ring px4\n   1 gaps\n"));
    EXPECT_THAT(text, HasSubstr("     7 queue_age\n     3 queue_bytes\n"));
}

TEST_F(DrawTest, ALinkToAClosedPortStatesWhyItSendsNothing) {
    auto shown = taken();
    shown->hops = {{.name = "router", .links = {{.name = "tablet", .refused = 12}}}};
    type(U"3");
    EXPECT_THAT(draw(*shown, state, {80, 9}, Glyphs::ascii).text(),
                HasSubstr("\n     12 refused: no program listened at its port, or its host was gone\n"));
}

TEST_F(DrawTest, ATerminalOfFiveColumnsShowsTheFirstDigitsOfTheRate) {
    auto shown = taken();
    shown->hz = 184.4;
    EXPECT_EQ(draw(*shown, state, {5, 5}, Glyphs::ascii).text().substr(0, 6), "184.4\n");
}

TEST_F(DrawTest, InARecordingSpaceHasOneMeaning) {
    auto shown = taken();
    shown->playing = Playing{.is_halted = true};
    EXPECT_THAT(draw(*shown, state, {80, 24}, Glyphs::ascii).text(), HasSubstr("  space play  "));
    type(U"?");
    const auto help = draw(*shown, state, {80, 30}, Glyphs::ascii).text();
    EXPECT_THAT(help, HasSubstr(" space                   halt the recording"));
    EXPECT_THAT(help, Not(HasSubstr("the picture stands still")));
}

void forget_frames(Snapshot& shown) {
    shown.frames = 0;
    shown.rows.clear();
}

TEST_F(DrawTest, WhileNothingIsHeardHintsAreShown) {
    auto shown = taken();
    shown->hints = {"reading udpin://0.0.0.0:14550", "a vehicle may be at /dev/ttyACM0: to read it, name the source"};
    EXPECT_THAT(draw(*shown, state, {40, 10}, Glyphs::ascii).text(), Not(HasSubstr("a vehicle may be at")));
    forget_frames(*shown);
    EXPECT_THAT(draw(*shown, state, {40, 10}, Glyphs::ascii).text(), HasSubstr(" nothing to show\n"
                                                                               " reading udpin://0.0.0.0:14550\n"
                                                                               " a vehicle may be at /dev/ttyACM0: to\n"
                                                                               "   read it, name the source\n"));
}

TEST_F(DrawTest, WhileNothingIsHeardOfANamedSourceItsLastReportIsShown) {
    auto shown = taken();
    shown->notices = {"serial:///dev/ttyACM0: up", "serial:///dev/ttyACM0: cannot open it; trying again"};
    EXPECT_THAT(draw(*shown, state, {40, 10}, Glyphs::ascii).text(), Not(HasSubstr("cannot open")));
    forget_frames(*shown);
    EXPECT_THAT(draw(*shown, state, {40, 10}, Glyphs::ascii).text(),
                HasSubstr(" nothing to show\n"
                          " serial:///dev/ttyACM0: cannot open it;\n"
                          "   trying again\n"
                          " serial:///dev/ttyACM0: up\n"));
}

TEST_F(DrawTest, AnAlarmIsReadInFortyColumns) {
    auto shown = taken();
    shown->alarms = {{.kind = observe::Alarm::Kind::silent,
                      .severity = observe::Alarm::Severity::error,
                      .source = vehicle,
                      .text = "nothing is heard of it",
                      .since = wall(4s)}};
    type(U"5");
    EXPECT_THAT(draw(*shown, state, {40, 10}, Glyphs::ascii).text(), HasSubstr(" FROM     ALARM\n"
                                                                               " 1/1      nothing is heard of it\n"));
    EXPECT_THAT(draw(*shown, state, {80, 24}, Glyphs::ascii).text(),
                HasSubstr(" BEGAN    LASTED   SEVERITY  FROM     ALARM\n"
                          " 6.00 s   now      error     1/1      nothing is heard of it\n"));
}

TEST_F(DrawTest, AnAlarmOfAProgramHasNoSender) {
    auto shown = taken();
    shown->alarms = {{.kind = observe::Alarm::Kind::loss,
                      .severity = observe::Alarm::Severity::warning,
                      .text = "router lost 3: queue_age",
                      .since = wall(4s)}};
    EXPECT_THAT(draw(*shown, state, {80, 24}, Glyphs::ascii).text(), HasSubstr("\n ! router lost 3: queue_age\n"));
}

TEST_F(DrawTest, VehiclesWithoutRoomAreCounted) {
    hear(msg::Heartbeat{.type = 2, .autopilot = 12, .base_mode = 0x81, .custom_mode = 50593792}, 10s, station);
    EXPECT_THAT(drawn({80, 24}), HasSubstr(" 1/1 quadrotor Hold armed    255/190 quadrotor Hold armed\n"));
    EXPECT_THAT(drawn({60, 24}), HasSubstr(" 1/1 quadrotor Hold armed                           +1 more\n"));
}

TEST_F(DrawTest, QuitIsTheEffectOfQ) { EXPECT_EQ(type(U"q"), Effect::quit); }

// Under the sanitizers.
TEST_F(DrawTest, NoSizeAndNoKeysLeaveTheGrid) {
    const auto seed = std::random_device{}();
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
    constexpr std::u32string_view keys = U"/12345sSrfci0d. ?jkaq";
    for (int i = 0; i < 2000; ++i) {
        const Size size{1 + below(130), 1 + below(50)};
        const auto code = static_cast<Key::Code>(below(static_cast<int>(Key::Code::scroll_down) + 1));
        (void)view::press(
            state, taken(),
            {code, keys[static_cast<std::size_t>(below(static_cast<int>(keys.size())))], below(130), below(50)}, size);
        const auto grid = draw(*taken(), state, size, below(2) == 0 ? Glyphs::ascii : Glyphs::unicode);
        ASSERT_EQ(grid.size(), size);
    }
}

}  // namespace
}  // namespace mavloom::view
