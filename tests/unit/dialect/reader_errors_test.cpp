// SPDX-License-Identifier: MIT
// What a malformed file gets: file, line, what is wrong and what was expected. One test per kind of fault.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <string>

#include "xml_folder.hpp"

namespace mavloom::dialect::test {
namespace {

// The error of a file whose second line is `line` within <messages>, or <enums>.
std::string message_error(std::string_view line) {
    const XmlFolder folder;
    folder.write("a.xml", messages(line));
    return folder.error();
}
std::string enum_error(std::string_view line) {
    const XmlFolder folder;
    folder.write("a.xml", enums(line));
    return folder.error();
}
std::string field_error(std::string_view field) {
    return message_error(R"(<message id="1" name="M">)" + std::string(field) + "</message>");
}

std::string repeated(std::string_view text, std::size_t times) {
    std::string out;
    for (std::size_t i = 0; i < times; ++i) out += text;
    return out;
}

TEST(ReaderErrors, MissingTopFileIsNotFound) {
    const XmlFolder folder;
    EXPECT_EQ(folder.load().error().code, SetupCode::not_found);
    EXPECT_EQ(folder.error(), "a.xml: no such file");
}

TEST(ReaderErrors, MissingIncludeNamesTheIncludingLine) {
    const XmlFolder folder;
    folder.write("a.xml", "<mavlink>\n\n  <include>sub/none.xml</include>\n</mavlink>");
    EXPECT_EQ(folder.load().error().code, SetupCode::bad_input);
    EXPECT_EQ(
        folder.error(),
        "a.xml:3: cannot include sub/none.xml: no such file; expected a file beside the including one, or the name "
        "of a public one, such as common.xml");
}

TEST(ReaderErrors, AClashWithAPublicFileNamesBothPlaces) {
    const XmlFolder folder;
    folder.write("a.xml",
                 "<mavlink><include>common.xml</include><messages>\n<message id=\"30\" name=\"MINE\">"
                 "<field type=\"uint8_t\" name=\"a\"/></message></messages></mavlink>");
    EXPECT_THAT(folder.error(), testing::HasSubstr("id 30 of message ATTITUDE belongs to MINE at a.xml:2"));
    EXPECT_THAT(folder.error(), testing::StartsWith("common.xml:"));
}

TEST(ReaderErrors, APublicFileIsNoTopFile) {
    const XmlFolder folder;
    EXPECT_EQ(folder.error("common.xml"), "common.xml: no such file");
}

TEST(ReaderErrors, MalformedXmlNamesTheLine) {
    const XmlFolder folder;
    folder.write("a.xml", "<mavlink>\n<messages>\n</mavlink>");
    EXPECT_EQ(folder.load().error().code, SetupCode::bad_input);
    EXPECT_EQ(folder.error(), "a.xml:3: Start-end tags mismatch; expected well-formed XML");
}

TEST(ReaderErrors, MalformedIncludeNamesItsOwnLine) {
    const XmlFolder folder;
    folder.write("a.xml", "<mavlink><include>b.xml</include></mavlink>");
    folder.write("b.xml", "<mavlink>\n<messages");
    EXPECT_EQ(folder.error(), "b.xml:2: Error parsing start element tag; expected well-formed XML");
}

TEST(ReaderErrors, EmptyFile) {
    const XmlFolder folder;
    folder.write("a.xml", "");
    EXPECT_EQ(folder.error(), "a.xml:1: No document element found; expected well-formed XML");
}

TEST(ReaderErrors, AnotherKindOfXml) {
    const XmlFolder folder;
    folder.write("a.xml", "<?xml version=\"1.0\"?>\n<svg/>");
    EXPECT_EQ(folder.error(), "a.xml:2: the outermost element is <svg>; expected <mavlink>");
}

TEST(ReaderErrors, FolderInPlaceOfAFile) {
    const XmlFolder folder;
    std::filesystem::create_directory(folder.path() / "a.xml");
    EXPECT_EQ(folder.error(), "a.xml: not a regular file");
}

TEST(ReaderErrors, PipeIsNotReadForEver) {
    const XmlFolder folder;
    ASSERT_EQ(mkfifo((folder.path() / "a.xml").c_str(), 0600), 0);
    EXPECT_EQ(folder.error(), "a.xml: not a regular file");
}

TEST(ReaderErrors, EmptyInclude) {
    const XmlFolder folder;
    folder.write("a.xml", "<mavlink>\n<include> </include></mavlink>");
    EXPECT_EQ(folder.error(), "a.xml:2: empty <include>; expected the name of an XML file");
}

TEST(ReaderErrors, UnknownElement) {
    EXPECT_EQ(field_error(R"(<field type="float" name="x"/><extention/>)"),
              "a.xml:2: unknown element <extention> in <message>, did you mean 'extensions'?; expected one of "
              "description, deprecated, "
              "superseded, wip, field, extensions");
    EXPECT_EQ(message_error("<enum/>"), "a.xml:2: unknown element <enum> in <messages>; expected one of message");
}

TEST(ReaderErrors, MessageWithoutName) {
    EXPECT_EQ(message_error(R"(<message id="1"/>)"), "a.xml:2: <message> without name; expected name=\"…\"");
}

TEST(ReaderErrors, NameThatIsNoWord) {
    EXPECT_EQ(message_error(R"(<message id="1" name="../x"/>)"),
              "a.xml:2: name \"../x\" of a <message>; expected letters, digits and underscores, at most 100");
    EXPECT_EQ(message_error(R"(<message id="1" name="&#27;[2J"/>)"),
              "a.xml:2: name \"(unprintable)\" of a <message>; expected letters, digits and underscores, at most 100");
}

TEST(ReaderErrors, MessageIdOutOfRange) {
    EXPECT_EQ(message_error(R"(<message id="16777216" name="M"/>)"),
              "a.xml:2: id \"16777216\" of message M; expected 0 to 16777215");
    EXPECT_EQ(message_error(R"(<message id="-1" name="M"/>)"),
              "a.xml:2: id \"-1\" of message M; expected 0 to 16777215");
    EXPECT_EQ(message_error(R"(<message name="M"/>)"), "a.xml:2: id \"\" of message M; expected 0 to 16777215");
}

TEST(ReaderErrors, MessageWithoutFields) {
    EXPECT_EQ(message_error(R"(<message id="1" name="M"/>)"), "a.xml:2: message M has no field; expected at least one");
}

TEST(ReaderErrors, UnknownType) {
    const std::string expected =
        "; expected char, int8_t to int64_t, uint8_t to uint64_t, float or double, an array as type[n]";
    for (const std::string type : {"uint8", "string", "float[0]", "float[-1]", "float[", "float[x]", "float[3]x", ""})
        EXPECT_EQ(field_error("\n<field type=\"" + type + "\" name=\"x\"/>"),
                  "a.xml:3: type \"" + type + "\" of field 'x'" + expected);
}

TEST(ReaderErrors, ArrayThatNoPayloadHolds) {
    EXPECT_EQ(field_error(R"(<field type="char[256]" name="x"/>)"),
              "a.xml:2: field 'x' has 256 elements; expected at most 255");
    EXPECT_EQ(field_error(R"(<field type="char[99999999999999999999]" name="x"/>)").substr(0, 14), "a.xml:2: type ");
}

TEST(ReaderErrors, PayloadTooLong) {
    EXPECT_EQ(field_error(R"(<field type="double[31]" name="x"/><extensions/><field type="double" name="y"/>)"),
              "a.xml:2: message M has a payload of 256 bytes; expected at most 255");
}

TEST(ReaderErrors, TooManyFields) {
    std::string fields;
    for (int i = 0; i < 65; ++i) fields += "<field type=\"uint8_t\" name=\"f" + std::to_string(i) + "\"/>";
    EXPECT_EQ(field_error(fields), "a.xml:2: message M has 65 fields; expected at most 64");
}

TEST(ReaderErrors, FieldTwice) {
    EXPECT_EQ(field_error("<field type=\"float\" name=\"x\"/>\n<field type=\"int8_t\" name=\"x\"/>"),
              "a.xml:3: message M has a field 'x' already, at line 2");
}

TEST(ReaderErrors, ExtensionsTwice) {
    EXPECT_EQ(field_error("<field type=\"float\" name=\"x\"/><extensions/>\n<extensions/>"),
              "a.xml:3: a second <extensions/> in message M");
}

TEST(ReaderErrors, FieldOfAnUnknownEnum) {
    const XmlFolder folder;
    folder.write("a.xml", R"(<mavlink><enums><enum name="MAV_TYPE"/></enums><messages>
        <message id="1" name="M"><field type="uint8_t" name="x" enum="MAV_TYP"/></message></messages></mavlink>)");
    EXPECT_EQ(folder.error(),
              "a.xml:2: field 'x' names the enum 'MAV_TYP', which no file defines, did you mean 'MAV_TYPE'?; expected "
              "an enum");
}

TEST(ReaderErrors, FlagThatIsNeitherTrueNorFalse) {
    EXPECT_EQ(field_error(R"(<field type="uint8_t" name="x" instance="yes"/>)"),
              "a.xml:2: instance=\"yes\"; expected true or false");
    EXPECT_EQ(enum_error(R"(<enum name="E" bitmask="TRUE"/>)"), "a.xml:2: bitmask=\"TRUE\"; expected true or false");
}

TEST(ReaderErrors, NumberThatIsNone) {
    EXPECT_EQ(field_error(R"(<field type="uint8_t" name="x" multiplier="1/0"/>)"),
              "a.xml:2: multiplier=\"1/0\"; expected a number");
    EXPECT_EQ(enum_error(R"(<enum name="E"><entry name="A" value="1"><param index="1" minValue="low"/></entry></enum>)"),
              "a.xml:2: minValue=\"low\"; expected a number");
}

TEST(ReaderErrors, ControlCharactersInTexts) {
    const std::string expected =
        "a.xml:2: units of a <field> holds control characters or is not UTF-8; expected plain text";
    EXPECT_EQ(field_error("<field type=\"uint8_t\" name=\"x\" units=\"&#7;\"/>"), expected);
    EXPECT_EQ(field_error("<field type=\"uint8_t\" name=\"x\" units=\"\xff\"/>"), expected);
    EXPECT_EQ(field_error("<field type=\"uint8_t\" name=\"x\" units=\"\xc0\xaf\"/>"), expected);
    EXPECT_EQ(field_error("<field type=\"uint8_t\" name=\"x\" units=\"\xc2\x9b\"/>"), expected);
    EXPECT_EQ(field_error("<field type=\"uint8_t\" name=\"x\" units=\"\xc2\xb0"
                          "C\"/>"),
              "");
}

TEST(ReaderErrors, EntryValueThatIsNoNumber) {
    const std::string expected = " of A; expected a number from 0 to 2**64-1: decimal, 0x…, 0b… or 2**n";
    for (const std::string value : {"-1", "1.5", "2**64", "2**", "0x", "18446744073709551616", "ONE", "1<<3", ""})
        EXPECT_EQ(enum_error("<enum name=\"E\"><entry name=\"A\" value=\"" + value + "\"/></enum>"),
                  "a.xml:2: value \"" + value + "\"" + expected);
}

TEST(ReaderErrors, NoValueIsLeftBehindTheHighest) {
    EXPECT_EQ(
        enum_error("<enum name=\"E\"><entry name=\"Z\" value=\"18446744073709551615\"/>\n<entry name=\"A\"/></enum>")
            .substr(0, 22),
        "a.xml:3: value \"\" of A");
}

TEST(ReaderErrors, CommandParameterIndex) {
    for (const std::string index : {"0", "8", "", "x"})
        EXPECT_EQ(
            enum_error("<enum name=\"E\"><entry name=\"A\" value=\"1\"><param index=\"" + index + "\"/></entry></enum>"),
            "a.xml:2: index \"" + index + "\" of a <param>; expected 1 to 7");
    EXPECT_EQ(
        enum_error(
            "<enum name=\"E\"><entry name=\"A\" value=\"1\"><param index=\"1\"/><param index=\"1\"/></entry></enum>"),
        "a.xml:2: a second <param> with index 1 in A");
}

TEST(ReaderErrors, DeprecationWithoutADate) {
    EXPECT_EQ(enum_error(R"(<enum name="E"><deprecated replaced_by="F"/></enum>)"),
              "a.xml:2: <deprecated> without a date; expected since=\"YYYY-MM\"");
}

TEST(ReaderErrors, EntryNamesAndValuesThatConflictNameBothPlaces) {
    const XmlFolder folder;
    folder.write("a.xml",
                 "<mavlink><include>b.xml</include><enums><enum name=\"E\">\n<entry value=\"1\" "
                 "name=\"A\"/></enum></enums></mavlink>");
    folder.write("b.xml",
                 "<mavlink><enums><enum name=\"E\">\n\n<entry value=\"2\" name=\"A\"/></enum></enums></mavlink>");
    EXPECT_EQ(folder.error(),
              "b.xml:3: A = 2 in enum E conflicts with A = 1 at a.xml:2; expected one name for each value");
    folder.write("b.xml",
                 "<mavlink><enums><enum name=\"E\">\n\n<entry value=\"1\" name=\"B\"/></enum></enums></mavlink>");
    EXPECT_EQ(folder.error(),
              "b.xml:3: B = 1 in enum E conflicts with A = 1 at a.xml:2; expected one name for each value");
}

TEST(ReaderErrors, EntryWithOtherParametersNamesBothPlaces) {
    EXPECT_EQ(
        enum_error("<enum name=\"E\"><entry value=\"1\" name=\"A\"><param index=\"1\" label=\"X\"/></entry></enum>\n"
                   "<enum name=\"E\"><entry value=\"1\" name=\"A\"><param index=\"1\" label=\"Y\"/></entry></enum>"),
        "a.xml:3: A has other parameters at a.xml:2; expected the same");
}

TEST(ReaderErrors, OneIdForTwoMessagesNamesBothPlaces) {
    const XmlFolder folder;
    folder.write("a.xml",
                 "<mavlink><include>b.xml</include><messages>\n<message id=\"5\" name=\"M\"><field type=\"float\" "
                 "name=\"x\"/></message></messages></mavlink>");
    folder.write("b.xml",
                 "<mavlink><messages>\n\n<message id=\"5\" name=\"N\"><field type=\"float\" "
                 "name=\"x\"/></message></messages></mavlink>");
    EXPECT_EQ(folder.error(), "b.xml:3: id 5 of message N belongs to M at a.xml:2; expected a free id");
}

TEST(ReaderErrors, OneNameWithTwoIdsNamesBothPlaces) {
    EXPECT_EQ(message_error("<message id=\"5\" name=\"M\"><field type=\"float\" name=\"x\"/></message>\n"
                            "<message id=\"6\" name=\"M\"><field type=\"float\" name=\"x\"/></message>"),
              "a.xml:3: message M has id 6 here and id 5 at a.xml:2; expected one id");
}

TEST(ReaderErrors, OneMessageWithOtherContentNamesBothPlaces) {
    EXPECT_EQ(message_error("<message id=\"5\" name=\"M\"><field type=\"float\" name=\"x\"/></message>\n"
                            "<message id=\"5\" name=\"M\"><field type=\"int8_t\" name=\"x\"/></message>"),
              "a.xml:3: message M (id 5) has other content at a.xml:2; expected one definition");
}

TEST(ReaderErrors, FileTooLong) {
    const XmlFolder folder;
    folder.write("a.xml", "<mavlink>" + std::string(9u << 20, ' ') + "</mavlink>");
    EXPECT_EQ(folder.error(), "a.xml: too long; expected at most 8 MiB of definitions");
}

TEST(ReaderErrors, TooManyIncludes) {
    const XmlFolder folder;
    for (int i = 0; i <= 200; ++i)
        folder.write("f" + std::to_string(i) + ".xml",
                     "<mavlink><include>f" + std::to_string(i + 1) + ".xml</include></mavlink>");
    EXPECT_EQ(folder.error("f0.xml"), "f200.xml: too much is included; expected at most 200 files and 32 MiB together");
}

// "Billion laughs": an entity that would expand to gigabytes. Entities beyond XML's own five are not expanded at all.
TEST(ReaderErrors, EntityBombIsOnlyText) {
    const XmlFolder folder;
    std::string bomb = "<?xml version=\"1.0\"?>\n<!DOCTYPE mavlink [\n<!ENTITY l0 \"lol\">\n";
    for (int i = 1; i < 20; ++i) {
        const auto inner = "&l" + std::to_string(i - 1) + ";";
        bomb += "<!ENTITY l" + std::to_string(i) + " \"" + repeated(inner, 10) + "\">\n";
    }
    bomb +=
        "]>\n<mavlink><messages><message id=\"1\" name=\"M\"><field type=\"float\" name=\"x\" "
        "units=\"&l19;\"/></message></messages></mavlink>";
    folder.write("a.xml", bomb);
    const auto loaded = folder.load();
    ASSERT_TRUE(loaded) << loaded.error().text;
    EXPECT_EQ(loaded->find("M")->fields[0].units, "&l19;");
}

TEST(ReaderErrors, ExternalEntityIsNotRead) {
    const XmlFolder folder;
    folder.write("a.xml",
                 "<!DOCTYPE m [<!ENTITY x SYSTEM \"file:///etc/passwd\">]>\n" +
                     messages(R"(<message id="1" name="M"><field type="float" name="x" units="&x;"/></message>)"));
    EXPECT_EQ(folder.load()->find("M")->fields[0].units, "&x;");
}

TEST(ReaderErrors, DeepNestingNeedsNoStack) {
    const XmlFolder folder;
    constexpr std::size_t depth = 400'000;
    folder.write("a.xml", "<mavlink>" + repeated("<enums>", depth) + repeated("</enums>", depth) + "</mavlink>");
    EXPECT_EQ(folder.error(),
              "a.xml:1: unknown element <enums> in <enums>, did you mean 'enum'?; expected one of enum");
    folder.write("a.xml", repeated("<mavlink>", depth));
    EXPECT_EQ(folder.error().substr(0, 8), "a.xml:1:");
}

}  // namespace
}  // namespace mavloom::dialect::test
