// SPDX-License-Identifier: MIT
// What the XML reader understands. Expected layouts are worked out by hand from the MAVLink guide's rules.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "xml_folder.hpp"

namespace mavloom::dialect::test {
namespace {

const Message& only_message(const SetupResult<Dialect>& loaded) { return loaded.value().messages()[0]; }

TEST(Reader, OrdersFieldsByTypeSizeAndKeepsExtensionsLast) {
    const XmlFolder folder;
    folder.write("a.xml", messages(R"(<message id="7" name="M"><description>no <b>fact</b></description>
        <field type="uint8_t" name="a"/><field type="uint16_t[3]" name="b">words</field><field type="double" name="c"/>
        <field type="int16_t" name="d"/><extensions/><field type="uint8_t" name="e"/><field type="uint64_t" name="f"/></message>)"));
    const auto loaded = folder.load();
    ASSERT_TRUE(loaded) << loaded.error().text;
    const auto& m = only_message(loaded);
    EXPECT_EQ(m.find("c")->offset, 0);
    EXPECT_EQ(m.find("b")->offset, 8);
    EXPECT_EQ(m.find("d")->offset, 14);
    EXPECT_EQ(m.find("a")->offset, 16);
    EXPECT_EQ(m.find("e")->offset, 17);
    EXPECT_EQ(m.find("f")->offset, 18);
    EXPECT_EQ(m.wire.min_length, 17);
    EXPECT_EQ(m.wire.max_length, 26);
    EXPECT_EQ(m.fields[0].name, "a");
    EXPECT_EQ(m.origin, "a.xml");
    EXPECT_EQ(loaded->name(), "a");
}

TEST(Reader, TakesIncludedPublicFilesThatAreNotThereFromTheBinary) {
    const XmlFolder folder;
    folder.write("a.xml",
                 "<mavlink><include>common.xml</include><enums><enum name=\"MAV_CMD\">"
                 "<entry value=\"42999\" name=\"MAV_CMD_MINE\"/></enum></enums></mavlink>");
    const auto loaded = folder.load();
    ASSERT_TRUE(loaded) << loaded.error().text;
    EXPECT_EQ(loaded->find("ATTITUDE")->origin, "common.xml");
    EXPECT_EQ(loaded->find("HEARTBEAT")->origin, "minimal.xml") << "which common.xml includes through standard.xml";
    EXPECT_EQ(loaded->find("AHRS"), nullptr) << "of ardupilotmega.xml";
    EXPECT_NE(loaded->find_enum("MAV_CMD")->find("MAV_CMD_MINE"), nullptr);
    EXPECT_EQ(loaded->find("ATTITUDE")->wire, default_dialect().find("ATTITUDE")->wire);
}

TEST(Reader, PrefersFilesBesideTheIncludingOneToPublicOnes) {
    const XmlFolder folder;
    folder.write("a.xml", "<mavlink><include>cubepilot.xml</include></mavlink>");  // which includes common.xml
    folder.write("common.xml",
                 messages(R"(<message id="50000" name="MINE"><field type="uint8_t" name="a"/></message>)"));
    const auto loaded = folder.load();
    ASSERT_TRUE(loaded) << loaded.error().text;
    EXPECT_NE(loaded->find("HERELINK_TELEM"), nullptr);
    EXPECT_NE(loaded->find("MINE"), nullptr);
    EXPECT_EQ(loaded->find("ATTITUDE"), nullptr);
}

TEST(Reader, KnowsAllTypes) {
    const XmlFolder folder;
    folder.write("a.xml",
                 messages(R"(<message id="7" name="M"><field type="char" name="a"/><field type="char[5]" name="b"/>
        <field type="int8_t" name="c"/><field type="uint8_t_mavlink_version" name="d"/><field type="int16_t" name="e"/>
        <field type="uint16_t" name="f"/><field type="int32_t" name="g"/><field type="uint32_t" name="h"/><field type="int64_t" name="i"/>
        <field type="uint64_t" name="j"/><field type="float[4]" name="k"/><field type="double" name="l"/></message>)"));
    const auto loaded = folder.load();
    ASSERT_TRUE(loaded) << loaded.error().text;
    const auto fields = only_message(loaded).fields;
    const FieldType expected[] = {FieldType::char8, FieldType::char8, FieldType::i8,  FieldType::u8,
                                  FieldType::i16,   FieldType::u16,   FieldType::i32, FieldType::u32,
                                  FieldType::i64,   FieldType::u64,   FieldType::f32, FieldType::f64};
    for (std::size_t i = 0; i < std::size(expected); ++i) EXPECT_EQ(fields[i].type, expected[i]) << fields[i].name;
    EXPECT_TRUE(fields[1].is_text());
    EXPECT_FALSE(fields[0].is_text());
    EXPECT_EQ(fields[10].array_length, 4);
}

TEST(Reader, FindsTargetsOnlyInPlainBytes) {
    const XmlFolder folder;
    folder.write(
        "a.xml",
        messages(R"(<message id="7" name="M"><field type="uint16_t" name="x"/><field type="uint8_t" name="target_system"/>
        <field type="uint8_t" name="target_component"/></message>
        <message id="8" name="N"><field type="uint16_t" name="target_system"/><field type="uint8_t[2]" name="target_component"/></message>
        <message id="9" name="O"><field type="uint8_t" name="target"/></message>)"));
    const auto loaded = folder.load();
    ASSERT_TRUE(loaded) << loaded.error().text;
    EXPECT_EQ(loaded->find("M")->wire.target_system_offset, 2);
    EXPECT_EQ(loaded->find("M")->wire.target_component_offset, 3);
    for (const auto* name : {"N", "O"}) {
        EXPECT_EQ(loaded->find(name)->wire.target_system_offset, wire::MessageInfo::no_target) << name;
        EXPECT_EQ(loaded->find(name)->wire.target_component_offset, wire::MessageInfo::no_target) << name;
    }
}

TEST(Reader, ReadsEveryFormOfAnEntryValue) {
    const XmlFolder folder;
    folder.write(
        "a.xml",
        enums(R"(<enum name="E" bitmask="true"><entry value="0x10" name="HEX"/><entry value="2**40" name="POWER"/>
        <entry value="0b101" name="BINARY"/><entry value="18446744073709551615" name="LAST"/><entry value="2**63" name="TOP"/>
        <entry name="AFTER_ZERO" value="1"/></enum>)"));
    const auto loaded = folder.load();
    ASSERT_TRUE(loaded) << loaded.error().text;
    const auto* e = loaded->find_enum("E");
    EXPECT_TRUE(e->bitmask);
    EXPECT_EQ(e->find("HEX")->value, 16u);
    EXPECT_EQ(e->find("POWER")->value, 1099511627776u);
    EXPECT_EQ(e->find("BINARY")->value, 5u);
    EXPECT_EQ(e->find("TOP")->value, 9223372036854775808u);
    EXPECT_EQ(e->find(UINT64_MAX)->name, "LAST");
    EXPECT_EQ(e->entries.front().name, "AFTER_ZERO");
}

// mavgen: the first is 1, each next one higher than the highest so far.
TEST(Reader, GivesEntriesWithoutValueTheNextOne) {
    const XmlFolder folder;
    folder.write(
        "a.xml",
        enums(
            R"(<enum name="E"><entry name="A"/><entry value="7" name="B"/><entry value="3" name="C"/><entry name="D"/></enum>)"));
    const auto loaded = folder.load();
    ASSERT_TRUE(loaded) << loaded.error().text;
    EXPECT_EQ(loaded->find_enum("E")->find("A")->value, 1u);
    EXPECT_EQ(loaded->find_enum("E")->find("D")->value, 8u);
}

// pymavlink's mavgen on the same two files gives A=1, X=2, B=3.
TEST(Reader, MovesEntriesWithoutValueOutOfTheWay) {
    const XmlFolder folder;
    folder.write(
        "a.xml",
        R"(<mavlink><include>b.xml</include><enums><enum name="E"><entry value="1" name="A"/><entry name="B"/></enum></enums></mavlink>)");
    folder.write("b.xml", enums(R"(<enum name="E"><entry value="2" name="X"/></enum>)"));
    const auto loaded = folder.load();
    ASSERT_TRUE(loaded) << loaded.error().text;
    EXPECT_EQ(loaded->find_enum("E")->find("B")->value, 3u);
}

TEST(Reader, MergesEnumsOfAllFilesAndIgnoresEqualRepeats) {
    const XmlFolder folder;
    folder.write("a.xml", R"(<mavlink><include>b.xml</include><enums><enum name="E"><entry value="2" name="TWO"/>
        <entry value="1" name="ONE"/></enum></enums></mavlink>)");
    folder.write(
        "b.xml",
        enums(R"(<enum name="E" bitmask="true"><deprecated since="2020-01" replaced_by="F"/><entry value="1" name="ONE">
        <param index="2" label="L"/></entry><entry value="4" name="FOUR"/></enum>)"));
    const auto loaded = folder.load();
    ASSERT_TRUE(loaded) << loaded.error().text;
    const auto* e = loaded->find_enum("E");
    ASSERT_EQ(e->entries.size(), 3u);
    EXPECT_EQ(e->entries[0].params[0].label, "L");
    EXPECT_TRUE(e->bitmask);
    EXPECT_EQ(e->deprecated.replaced_by, "F");
}

TEST(Reader, ReadsFieldFactsAndMarksBitmasksOfTheirEnums) {
    const XmlFolder folder;
    folder.write("a.xml",
                 R"(<mavlink><enums><enum name="E" bitmask="true"><entry value="1" name="ONE"/></enum></enums><messages>
        <message id="1" name="M"><superseded since="2024-03" replaced_by="N">words</superseded><wip/>
        <field type="uint8_t" name="a" enum="E"/><field type="uint8_t" name="b" display="bitmask" units="m/s" invalid="UINT8_MAX"/>
        <field type="uint8_t" name="c" multiplier="360/255" instance="true" print_format="0x%02x"/></message></messages></mavlink>)");
    const auto loaded = folder.load();
    ASSERT_TRUE(loaded) << loaded.error().text;
    const auto& m = only_message(loaded);
    EXPECT_EQ(m.deprecated.since, "2024-03");
    EXPECT_EQ(m.find("a")->enumeration, loaded->find_enum("E"));
    EXPECT_TRUE(m.find("a")->bitmask);
    EXPECT_TRUE(m.find("b")->bitmask);
    EXPECT_EQ(m.find("b")->units, "m/s");
    EXPECT_EQ(m.find("b")->invalid, "UINT8_MAX");
    EXPECT_FALSE(m.find("c")->bitmask);
    EXPECT_DOUBLE_EQ(m.find("c")->multiplier, 1.411764705882353);
    EXPECT_TRUE(m.find("c")->instance);
}

TEST(Reader, ReadsCommandParametersByIndex) {
    const XmlFolder folder;
    folder.write(
        "a.xml",
        enums(R"(<enum name="MAV_CMD"><entry value="5" name="C" hasLocation="true"><description>words</description>
        <param index="7" reserved="true" default="NaN"/><param index="1" label="Speed" units="m/s" minValue="-1" maxValue="1E3" increment="0.5"
        enum="SPEED_TYPE">words</param></entry></enum>)"));
    const auto loaded = folder.load();
    ASSERT_TRUE(loaded) << loaded.error().text;
    const auto params = loaded->find_enum("MAV_CMD")->find("C")->params;
    ASSERT_EQ(params.size(), 2u);
    EXPECT_EQ(params[0].index, 1);
    EXPECT_EQ(params[0].label, "Speed");
    EXPECT_EQ(params[0].minimum, -1.0);
    EXPECT_EQ(params[0].maximum, 1000.0);
    EXPECT_EQ(params[0].increment, 0.5);
    EXPECT_EQ(params[0].enum_name, "SPEED_TYPE");
    EXPECT_TRUE(params[1].reserved);
    EXPECT_EQ(params[1].default_value, "NaN");
    EXPECT_FALSE(params[1].maximum.has_value());
}

TEST(Reader, ReadsCircularAndDiamondIncludesOnce) {
    const XmlFolder folder;
    const auto file = [&](std::string_view name, std::string_view includes, int id) {
        folder.write(name, "<mavlink>" + std::string(includes) + "<messages><message id=\"" + std::to_string(id) +
                               "\" name=\"M" + std::to_string(id) +
                               "\"><field type=\"float\" name=\"x\"/></message></messages></mavlink>");
    };
    file("a.xml", "<include>b.xml</include><include>sub/c.xml</include>", 1);
    file("b.xml", "<include>d.xml</include><include>a.xml</include>", 2);
    file("sub/c.xml", "<include> ../d.xml\n</include><include>../sub/c.xml</include>", 3);
    file("d.xml", "<include>sub/../b.xml</include>", 4);
    const auto loaded = folder.load();
    ASSERT_TRUE(loaded) << loaded.error().text;
    EXPECT_EQ(loaded->messages().size(), 4u);
    EXPECT_EQ(loaded->find("M3")->origin, "c.xml");
}

TEST(Reader, AcceptsTheSameMessageTwice) {
    const XmlFolder folder;
    const std::string m = R"(<message id="1" name="M"><field type="float" name="x" units="m"/></message>)";
    folder.write("a.xml", messages(m + "\n" + m));
    EXPECT_EQ(folder.error(), "");
    EXPECT_EQ(folder.load()->messages().size(), 1u);
}

TEST(Reader, AcceptsAByteOrderMarkAndCarriageReturns) {
    const XmlFolder folder;
    folder.write(
        "a.xml",
        "\xef\xbb\xbf<?xml version=\"1.0\"?>\r\n<mavlink>\r\n<include> b.xml \r\n</include>\r\n</mavlink>\r\n");
    folder.write("b.xml", messages(R"(<message id="1" name="M"><field type="float" name="x"/></message>)"));
    EXPECT_EQ(folder.error(), "");
}

TEST(Dialect, OutlivesCopiesAndMoves) {
    const XmlFolder folder;
    folder.write("a.xml", messages(R"(<message id="1" name="M"><field type="float" name="x"/></message>)"));
    auto first = std::make_unique<Dialect>(folder.load().value());
    const Dialect copy = *first;
    const Dialect moved = std::move(*first);
    first.reset();
    EXPECT_EQ(copy.find("M"), moved.find("M"));
    EXPECT_EQ(copy.find("M")->fields[0].name, "x");
    EXPECT_EQ(copy.wire_table().find(MessageId{1})->max_length, 4);
}

// `--dialect FILE`: definitions of the file replace, the rest stays.
TEST(Dialect, WithAnotherReplacesByIdNameAndEntryValue) {
    const XmlFolder folder;
    folder.write(
        "a.xml",
        R"(<mavlink><enums><enum name="E"><entry value="1" name="OLD"/><entry value="2" name="MOVED"/><entry value="3" name="KEPT"/></enum>
        </enums><messages><message id="1" name="M"><field type="uint8_t" name="x" enum="E"/></message>
        <message id="2" name="N"><field type="float" name="x"/></message><message id="3" name="P"><field type="uint8_t" name="e" enum="E"/></message>
        </messages></mavlink>)");
    folder.write(
        "b.xml",
        R"(<mavlink><enums><enum name="E" bitmask="true"><entry value="1" name="NEW"/><entry value="9" name="MOVED"/></enum></enums>
        <messages><message id="1" name="Q"><field type="float" name="y"/></message>
        <message id="9" name="N"><field type="double" name="z"/></message></messages></mavlink>)");
    const auto merged = *folder.load("a.xml")->with(*folder.load("b.xml"));  // both sources are gone
    EXPECT_EQ(merged.name(), "a+b");
    ASSERT_EQ(merged.messages().size(), 3u);
    EXPECT_EQ(merged.find("M"), nullptr);
    EXPECT_EQ(merged.find(MessageId{1})->name, "Q");
    EXPECT_EQ(merged.find(MessageId{2}), nullptr);
    EXPECT_EQ(merged.find("N")->id(), MessageId{9});
    const auto* e = merged.find_enum("E");
    ASSERT_EQ(e->entries.size(), 3u);
    EXPECT_EQ(e->find(std::uint64_t{1})->name, "NEW");
    EXPECT_EQ(e->find("MOVED")->value, 9u);
    EXPECT_EQ(e->find(std::uint64_t{3})->name, "KEPT");
    EXPECT_EQ(merged.find("P")->fields[0].enumeration, e);
    EXPECT_TRUE(merged.find("P")->fields[0].bitmask);
    EXPECT_EQ(merged.wire_table().find(MessageId{9})->max_length, 8);
}

TEST(Dialect, WithAnotherKeepsTheBuiltInRest) {
    const XmlFolder folder;
    folder.write("mine.xml", messages(R"(<message id="60999" name="MINE"><field type="float" name="x"/></message>)"));
    const auto merged = *default_dialect().with(*folder.load("mine.xml"));
    EXPECT_EQ(merged.messages().size(), default_dialect().messages().size() + 1);
    EXPECT_NE(merged.find("MINE"), nullptr);
    EXPECT_NE(merged.find("ATTITUDE"), nullptr);
    EXPECT_EQ(merged.find("HEARTBEAT")->find("type")->enumeration, merged.find_enum("MAV_TYPE"));
}

// Each file may have 20,000 messages; four of them passed what the wire table can count.
TEST(Dialect, WithMoreMessagesThanTheTableCountsIsAnError) {
    const XmlFolder folder;
    constexpr unsigned each = 20'000;
    auto merged = SetupResult<Dialect>(default_dialect());
    for (unsigned file = 0; file < 4 && merged; ++file) {
        std::string text;
        for (unsigned i = file * each; i < (file + 1) * each; ++i)
            text += fmt::format(R"(<message id="{0}" name="M{0}"><field type="float" name="x"/></message>)",
                                100'000 + i);
        folder.write("many.xml", messages(text));
        merged = merged->with(*folder.load("many.xml"));
    }
    ASSERT_FALSE(merged.has_value());
    EXPECT_EQ(merged.error().code, SetupCode::bad_input);
    EXPECT_THAT(merged.error().text, testing::HasSubstr("expected at most 60000"));
}

}  // namespace
}  // namespace mavloom::dialect::test
