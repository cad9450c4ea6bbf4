// SPDX-License-Identifier: MIT
// The JSON form is a contract: docs/guide/listen.md. Expected lines are written by hand from it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "unit/message/sample_messages.hpp"

namespace mavloom::message {
namespace {

using namespace mavloom::testing;  // NOLINT: the sample definitions

TEST(Json, PrintsTheObjectOfTheContract) {
    const SampleFrame frame(attitude, bytes_of(std::uint32_t{5}, 0.01f, -0.02f, 1.5f, 0.0f, -0.0f, 1e-7f));

    EXPECT_EQ(json_of(frame.received()),
              R"({"time_us":1700000000123456,"link":"px4","sys":1,"comp":191,"seq":7,"id":30,"name":"ATTITUDE","v":2,)"
              R"("signed":false,"fields":{"time_boot_ms":5,"roll":0.01,"pitch":-0.02,"yaw":1.5,"rollspeed":0.0,)"
              R"("pitchspeed":-0.0,"yawspeed":1e-07}})"
              "\n");
}

TEST(Json, PrintsFieldsInTheOrderOfTheDefinition) {
    const auto payload = bytes_of(std::uint32_t{9}, std::uint8_t{2}, std::uint8_t{12}, std::uint8_t{0x81},
                                  std::uint8_t{4}, std::uint8_t{3});

    EXPECT_EQ(json_fields_of(heartbeat, payload),
              R"("type":2,"autopilot":12,"base_mode":129,"custom_mode":9,"system_status":4,"mavlink_version":3)");
}

TEST(Json, StatesVersionAndSignature) {
    const SampleFrame v1(heartbeat, std::vector<std::uint8_t>(9), wire::Version::v1);
    EXPECT_NE(json_of(v1.received()).find(R"("name":"HEARTBEAT","v":1,"signed":false,"fields":{)"), std::string::npos);

    std::vector<std::uint8_t> bytes{0xfd, 1, 1, 0, 9, 1, 1, 0, 0, 0, 0x2a, 0, 0};
    bytes.resize(bytes.size() + wire::signature_length);
    const Received received{wall_from_us(0), "l", wire::FrameView::unchecked(bytes), &heartbeat};
    EXPECT_NE(json_of(received).find(R"("v":2,"signed":true,"fields":{"type":0)"), std::string::npos);
}

TEST(Json, PrintsUnknownIdsAsHex) {
    const std::vector<std::uint8_t> bytes{0xfd, 3, 0, 0, 9, 1, 2, 0x70, 0x11, 0x01, 0x0a, 0x00, 0xff, 0, 0};
    const Received received{wall_from_us(7), "udp", wire::FrameView::unchecked(bytes), nullptr};

    EXPECT_EQ(
        json_of(received),
        R"({"time_us":7,"link":"udp","sys":1,"comp":2,"seq":9,"id":70000,"name":null,"v":2,"signed":false,"payload_hex":"0a00ff"})"
        "\n");
}

TEST(Json, PrintsSpecialFloatsAsStrings) {
    const auto payload = bytes_of(std::uint32_t{0}, nan_f, inf_f, -inf_f, -nan_f, std::numeric_limits<float>::max(),
                                  std::numeric_limits<float>::denorm_min());

    EXPECT_EQ(
        json_fields_of(attitude, payload),
        R"("time_boot_ms":0,"roll":"NaN","pitch":"Infinity","yaw":"-Infinity","rollspeed":"NaN","pitchspeed":3.4028235e+38,"yawspeed":1e-45)");
}

TEST(Json, PrintsIntegersBeyondDoublesAsStrings) {
    const auto first_two = [](std::uint64_t u, std::int64_t i) {
        const auto text = json_fields_of(sample, bytes_of(u, i));
        return text.substr(0, text.find(",\"f64\""));
    };
    EXPECT_EQ(first_two(9007199254740992u, -9007199254740992), R"("u64":9007199254740992,"i64":-9007199254740992)");
    EXPECT_EQ(first_two(9007199254740993u, -9007199254740993), R"("u64":"9007199254740993","i64":"-9007199254740993")");
    EXPECT_EQ(first_two(std::numeric_limits<std::uint64_t>::max(), std::numeric_limits<std::int64_t>::min()),
              R"("u64":"18446744073709551615","i64":"-9223372036854775808")");
}

TEST(Json, PrintsArraysAndExtensionsThatWereCutOff) {
    EXPECT_EQ(json_fields_of(sample, {}),
              R"("u64":0,"i64":0,"f64":0.0,"lat":0,"i16s":[0,0,0],"azimuth":0,"eph":0,"i8":0,"c":"","small":[0,0,0],)"
              R"("blob":[0,0,0,0,0,0,0,0,0,0],"covariance":[0.0,0.0])");
}

TEST(Json, PrintsACharacterAsAStringOfOne) {
    std::vector<std::uint8_t> payload(40);
    payload[39] = 'x';
    EXPECT_NE(json_fields_of(sample, payload).find(R"("c":"x")"), std::string::npos);
    payload[39] = 0xe9;  // half a character in UTF-8
    EXPECT_NE(json_fields_of(sample, payload).find("\"c\":\"\xef\xbf\xbd\""), std::string::npos);
}

TEST(Json, EscapesText) {
    const auto text_field = [](std::string_view text) {
        const auto fields = json_fields_of(statustext, statustext_payload(6, text));
        const auto start = fields.find("\"text\":") + 7;
        return fields.substr(start, fields.find(",\"id\"") - start);
    };
    EXPECT_EQ(text_field("a \"b\" \\ c"), R"("a \"b\" \\ c")");
    EXPECT_EQ(text_field("\b\t\n\f\r\x01\x1b[31m\x7f"), R"("\b\t\n\f\r\u0001\u001b[31m\u007f")");
    EXPECT_EQ(text_field(std::string_view("a\0b", 3)), R"("a\u0000b")");
    EXPECT_EQ(text_field("Höhe"), "\"Höhe\"");
    EXPECT_EQ(text_field("\xc2\x9b\xe2\x80\xae"), R"("\u009b\u202e")");
    EXPECT_EQ(text_field("bad \xff\xfe end"), "\"bad \xef\xbf\xbd\xef\xbf\xbd end\"");
    EXPECT_EQ(text_field("exactly8exactly8"), "\"exactly8exactly8\"");
    EXPECT_EQ(text_field("1234567\n12345678"), "\"1234567\\n12345678\"");
}

TEST(Json, EscapesTheLinksName) {
    const SampleFrame frame(heartbeat, {});
    EXPECT_NE(json_of(frame.received("a\"b\n")).find(R"("link":"a\"b\n",)"), std::string::npos);
}

TEST(Json, EveryByteGivesValidJson) {
    std::vector<std::uint8_t> payload(54);
    for (unsigned byte = 0; byte < 256; ++byte) {
        std::fill(payload.begin(), payload.end(), static_cast<std::uint8_t>(byte));
        const SampleFrame frame(statustext, payload);
        const auto parsed = nlohmann::json::parse(json_of(frame.received()), nullptr, false);
        ASSERT_FALSE(parsed.is_discarded()) << byte;
        EXPECT_EQ(parsed["fields"]["severity"], byte);
    }
}

TEST(Json, EveryCharacterAtEveryPlaceReadsBack) {
    for (int character = 1; character < 0x80; ++character) {
        for (std::size_t place = 0; place < 19; ++place) {
            std::string text = "nineteen characters";
            text[place] = static_cast<char>(character);
            const SampleFrame frame(statustext, statustext_payload(6, text));
            const auto line = json_of(frame.received());
            ASSERT_EQ(nlohmann::json::parse(line)["fields"]["text"], text) << line;
            ASSERT_EQ(line.find('\x7f'), std::string::npos);
        }
    }
}

// The formatter with keys made ahead prints what append_json prints; here over all kinds of message, and one of another
// dialect.
TEST(JsonFormatter, PrintsTheSameObject) {
    const JsonFormatter sut(sample_dialect());
    std::vector<Message> definitions(std::begin(messages), std::end(messages));
    definitions.push_back(heartbeat);  // a copy: not a record of the dialect
    for (const auto& definition : definitions) {
        for (const int byte : {0x00, 0x41, 0x7f, 0xff}) {
            const SampleFrame frame(
                definition, std::vector<std::uint8_t>(definition.wire.max_length, static_cast<std::uint8_t>(byte)));
            TextBuffer out;
            sut.append(out, frame.received("a \"link\""));
            EXPECT_EQ(fmt::to_string(out), json_of(frame.received("a \"link\""))) << definition.name;
        }
    }
}

TEST(JsonFormatter, PrintsUnknownIdsLongNamesAndNoFields) {
    static constexpr std::string_view long_name = "a_field_with_a_name_of_more_than_thirty_characters";
    const Field fields[] = {
        heartbeat_fields[0],
        {.name = long_name, .type = FieldType::u8, .array_length = 0, .offset = 5, .units = {}, .invalid = {}}};
    const Message definitions[] = {
        {.name = "LONG", .wire = {MessageId{1}, 1, 9, 9}, .fields = fields, .origin = {}, .deprecated = {}},
        {.name = "EMPTY", .wire = {MessageId{2}, 1, 0, 0}, .fields = {}, .origin = {}, .deprecated = {}}};
    const dialect::Dialect dialect("long", definitions, enums);
    const JsonFormatter sut(dialect);
    const SampleFrame frame(definitions[0], std::vector<std::uint8_t>(9, 3));

    const SampleFrame no_fields(definitions[1], {});
    TextBuffer known, empty, unknown;
    sut.append(known, frame.received());
    sut.append(empty, no_fields.received());
    auto received = frame.received();
    received.message = nullptr;
    sut.append(unknown, received);

    EXPECT_NE(fmt::to_string(known).find(fmt::format(R"("fields":{{"type":3,"{}":3}}}})", long_name)),
              std::string::npos);
    EXPECT_TRUE(fmt::to_string(empty).ends_with("\"fields\":{}}\n"));
    EXPECT_EQ(fmt::to_string(unknown), json_of(received));
}

TEST(Json, AppendsBehindWhatTheBufferHolds) {
    TextBuffer out;
    out.append(std::string_view("before "));
    append_json_fields(out, attitude, {});
    EXPECT_TRUE(fmt::to_string(out).starts_with(R"(before "time_boot_ms":0,)"));
}

}  // namespace
}  // namespace mavloom::message
