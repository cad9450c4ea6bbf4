// SPDX-License-Identifier: MIT
// Any payload of any message, printed in all forms: JSON that a strict parser reads and that holds every field, one
// line of text without control characters, CSV with as many columns as its header. Input: two bytes choose the message,
// one the length of the link's name, then that name, then the payload.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "mavloom/message/builder.hpp"
#include "mavloom/message/format.hpp"
#include "mavloom/wire/frame_writer.hpp"

namespace {

using namespace mavloom;

void require(bool holds) {
    if (!holds) std::abort();
}

std::string printed(auto append) {
    message::TextBuffer out;
    append(out);
    return fmt::to_string(out);
}

// Commas outside of quotes.
std::size_t columns_of(std::string_view row) {
    bool quoted = false;
    std::size_t columns = 1;
    for (const char c : row) {
        if (c == '"') quoted = !quoted;
        if (c == ',' && !quoted) ++columns;
    }
    require(!quoted);
    return columns;
}

void check_json(const message::Received& received) {
    static const message::JsonFormatter formatter(dialect::default_dialect());
    const auto line = printed([&](auto& out) { message::append_json(out, received); });
    require(line == printed([&](auto& out) { formatter.append(out, received); }));
    require(std::count(line.begin(), line.end(), '\n') == 1 && line.back() == '\n');
    const auto object = nlohmann::json::parse(line, nullptr, false);
    require(object.is_object() && object.at("id") == received.frame.id().value);
    if (received.message == nullptr) {
        require(object.at("name").is_null() &&
                object.at("payload_hex").get_ref<const std::string&>().size() == 2 * received.frame.payload().size());
    } else {
        require(object.at("fields").size() == received.message->fields.size());
    }
}

void check_text(const message::Received& received) {
    const auto line = printed([&](auto& out) { message::append_text(out, received, dialect::default_dialect()); });
    require(!line.empty() && line.back() == '\n');
    const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
    require(std::none_of(line.begin(), line.end() - 1, is_control));
    require(line.find("\xc2\x9b") == std::string::npos);  // the control sequence introducer of C1
}

void check_csv(const message::Received& received) {
    if (received.message == nullptr) return;
    const auto header = printed([&](auto& out) { message::append_csv_header(out, *received.message); });
    const auto row = printed([&](auto& out) { message::append_csv_row(out, received); });
    require(columns_of(row) == columns_of(header));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 3) return 0;
    const auto messages = dialect::default_dialect().messages();
    const auto chosen = static_cast<std::size_t>(data[0] | data[1] << 8);
    const auto& definition = messages[chosen % messages.size()];
    ByteView rest{data + 3, size - 3};
    const auto name_length = std::min<std::size_t>(data[2], rest.size());
    const std::string link(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(name_length));
    rest = rest.subspan(name_length);

    const message::MessageBuilder builder(definition, rest.first(std::min(rest.size(), wire::max_payload_length)));
    wire::FrameBuffer buffer{};
    const auto frame = wire::write_frame(buffer, {wire::Version::v2, 1, {SystemId{1}, ComponentId{1}}}, definition.wire,
                                         builder.payload());
    for (const auto* known : {&definition, static_cast<const dialect::Message*>(nullptr)}) {
        const message::Received received{wall_from_us(1), link, frame, known};
        check_json(received);
        check_text(received);
        check_csv(received);
    }
    return 0;
}
