// SPDX-License-Identifier: MIT
// What tests/system/test_pymavlink_peer.py talks to: one JSON request a line on stdin, one JSON answer a line on
// stdout.
//   {"frame":HEX, "key":HEX?, "now":TICKS?}
//       -> {"line":{the JSON form}, "text":…, "copied":HEX, "rebuilt":HEX, "verdict":…}
//   {"name":…, "fields":{…}, "version":1|2, "seq":…, "sys":…, "comp":…, "key":HEX?, "link_id":…, "now":TICKS}
//       -> {"frame":HEX}
//   {"cdr":HEX of a frame}
//       -> {"cdr":HEX}
//   {"ros2msg":NAME}
//       -> {"type":…, "text":…}
// `copied` is the frame made again from its payload as a whole, `rebuilt` the one made field by field from the decoded
// values. Field values in requests are as in the JSON form, and {"hex":…} for text of any bytes. A refusal is
// {"error":…}.
#include <fmt/format.h>

#include <iostream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "mavloom/message/builder.hpp"
#include "mavloom/message/cdr.hpp"
#include "mavloom/message/format.hpp"
#include "mavloom/message/view.hpp"
#include "mavloom/wire/datagram_parser.hpp"
#include "mavloom/wire/frame_writer.hpp"
#include "mavloom/wire/signing.hpp"
#include "support/bytes.hpp"

namespace {

using namespace mavloom;
using dialect::Field;
using nlohmann::json;
using test::Bytes;

std::string to_hex(ByteView bytes) {
    std::string digits;
    for (const auto byte : bytes) digits += fmt::format("{:02x}", byte);
    return digits;
}

void require(const SetupResult<void>& result) {
    if (!result) throw std::runtime_error(result.error().text);
}

// ---- values in requests

std::string text_from(const json& value) {
    if (!value.is_object()) return value.get<std::string>();
    const auto bytes = test::hex(value.at("hex").get<std::string>());
    return {bytes.begin(), bytes.end()};
}

void set_element(message::MessageBuilder& builder, const Field& field, const json& value, std::size_t index) {
    if (value.is_string()) {
        const auto& text = value.get_ref<const std::string&>();
        const double special = text == "NaN" ? std::numeric_limits<double>::quiet_NaN()
                                             : (text == "-Infinity" ? -1 : 1) * std::numeric_limits<double>::infinity();
        require(builder.set_number(field, special, index));
    } else if (value.is_number_float()) {
        require(builder.set_number(field, value.get<double>(), index));
    } else if (value.is_number_unsigned()) {
        require(builder.set_unsigned(field, value.get<std::uint64_t>(), index));
    } else {
        require(builder.set_integer(field, value.get<std::int64_t>(), index));
    }
}

void set_field(message::MessageBuilder& builder, const Field& field, const json& value) {
    if (field.type == dialect::FieldType::char8) return require(builder.set_text(field, text_from(value)));
    if (!field.is_array()) return set_element(builder, field, value, 0);
    if (value.size() != field.count()) throw std::runtime_error(std::string(field.name) + ": wrong number of elements");
    for (std::size_t i = 0; i < field.count(); ++i) set_element(builder, field, value[i], i);
}

// ---- frames

wire::SigningKey key_from(const json& request) {
    const auto bytes = test::hex(request.at("key").get<std::string>());
    std::array<std::uint8_t, wire::SigningKey::length> key{};
    if (bytes.size() != key.size()) throw std::runtime_error("a key has 32 bytes");
    std::copy(bytes.begin(), bytes.end(), key.begin());
    return wire::SigningKey(key);
}

std::string written(const wire::FrameHeader& header, const message::MessageBuilder& builder, wire::Signing signing) {
    wire::FrameBuffer buffer{};
    return to_hex(wire::write_frame(buffer, header, builder.definition().wire, builder.payload(), signing).bytes());
}

// The same frame once more: link id and time of its signature included.
std::string written_like(const wire::FrameView& frame, const message::MessageBuilder& builder, const json& request) {
    const wire::FrameHeader header{frame.version(), frame.sequence(), frame.source(), frame.compat_flags()};
    if (!frame.is_signed()) return written(header, builder, {});
    const auto signature = frame.signature();
    std::uint64_t ticks = 0;
    for (int i = 6; i >= 1; --i) ticks = ticks << 8 | signature[static_cast<std::size_t>(i)];
    wire::Signer signer(key_from(request), signature[0]);
    return written(header, builder, {&signer, wire::SigningTime{ticks}});
}

// All fields copied by their typed values instead of as bytes.
message::MessageBuilder rebuilt(const message::MessageView& view) {
    message::MessageBuilder builder(view.definition());
    for (const auto& field : view.definition().fields) {
        if (field.is_text()) {
            require(builder.set_text(field, view.text(field)));
            continue;
        }
        for (std::size_t i = 0; i < field.count(); ++i) {
            switch (field.type) {
                using enum dialect::FieldType;
                case f32: builder.put(field, view.get<float>(field, i), i); break;
                case f64: builder.put(field, view.get<double>(field, i), i); break;
                case char8: builder.put(field, view.get<char>(field, i), i); break;
                case i8:
                case i16:
                case i32:
                case i64: require(builder.set_integer(field, view.integer(field, i), i)); break;
                default: require(builder.set_unsigned(field, view.unsigned_integer(field, i), i)); break;
            }
        }
    }
    return builder;
}

std::string_view verdict_of(const wire::FrameView& frame, const json& request) {
    using Verdict = wire::Verifier::Verdict;
    if (!request.contains("key")) return "unchecked";
    wire::Verifier verifier(key_from(request));
    switch (verifier.verify(frame, {request.at("now").get<std::uint64_t>()})) {
        case Verdict::good: return "good";
        case Verdict::unsigned_frame: return "unsigned";
        case Verdict::bad_signature: return "bad";
        default: return "refused";
    }
}

// ---- requests

json decode(const json& request) {
    const auto& dialect = dialect::default_dialect();
    static const message::JsonFormatter formatter(dialect);
    const auto bytes = test::hex(request.at("frame").get<std::string>());
    json answer;
    wire::DatagramParser parser(dialect.wire_table());
    parser.parse(bytes, [&](const wire::ParseEvent& event) {
        if (event.kind != wire::ParseEvent::Kind::frame || answer.contains("line")) {
            answer["error"] = "not one good frame";
            return;
        }
        const auto* message = dialect.find(event.frame.id());
        const message::Received received{wall_from_us(1), "peer", event.frame, message};
        message::TextBuffer line, text;
        formatter.append(line, received);
        message::append_text(text, received, dialect);
        answer["line"] = fmt::to_string(line);
        answer["text"] = fmt::to_string(text);
        if (message == nullptr) return;
        const message::MessageView view(*message, event.frame.payload());
        answer["copied"] = written_like(event.frame, message::MessageBuilder(*message, view.payload()), request);
        answer["rebuilt"] = written_like(event.frame, rebuilt(view), request);
        answer["verdict"] = verdict_of(event.frame, request);
    });
    if (answer.is_null()) answer["error"] = "no frame";
    return answer;
}

json encode(const json& request) {
    const auto found = dialect::default_dialect().message(request.at("name").get<std::string>());
    if (!found) throw std::runtime_error(found.error().text);
    message::MessageBuilder builder(**found);
    for (const auto& [name, value] : request.at("fields").items()) {
        const auto* field = (*found)->find(name);
        if (field == nullptr) throw std::runtime_error("no field " + name);
        set_field(builder, *field, value);
    }
    const wire::FrameHeader header{
        request.at("version") == 1 ? wire::Version::v1 : wire::Version::v2,
        request.at("seq").get<std::uint8_t>(),
        {SystemId{request.at("sys").get<std::uint8_t>()}, ComponentId{request.at("comp").get<std::uint8_t>()}}};
    if (!request.contains("key")) return {{"frame", written(header, builder, {})}};
    wire::Signer signer(key_from(request), request.at("link_id").get<std::uint8_t>());
    return {{"frame", written(header, builder, {&signer, {request.at("now").get<std::uint64_t>()}})}};
}

json to_cdr(const json& request) {
    const auto bytes = test::hex(request.at("cdr").get<std::string>());
    const auto frame = wire::FrameView::unchecked(bytes);
    const message::CdrEncoder encoder(*dialect::default_dialect().find(frame.id()));
    Bytes out(encoder.max_size());
    out.resize(encoder.encode(frame.payload(), out));
    return {{"cdr", to_hex(out)}};
}

json schema(const json& request) {
    const auto& definition = *dialect::default_dialect().find(request.at("ros2msg").get<std::string>());
    return {{"type", message::ros2_type(definition)}, {"text", message::ros2msg(definition)}};
}

json answer_to(const std::string& line) {
    try {
        const auto request = json::parse(line);
        if (request.contains("cdr")) return to_cdr(request);
        if (request.contains("ros2msg")) return schema(request);
        return request.contains("frame") ? decode(request) : encode(request);
    } catch (const std::exception& error) {
        return {{"error", error.what()}};
    }
}

}  // namespace

int main() {
    std::ios::sync_with_stdio(false);
    for (std::string line; std::getline(std::cin, line);)
        std::cout << answer_to(line).dump(-1, ' ', false, json::error_handler_t::replace) << '\n';
    return std::cout.flush() ? 0 : 1;
}
