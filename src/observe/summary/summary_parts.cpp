// SPDX-License-Identifier: MIT
#include "observe/summary/summary_parts.hpp"

#include <array>

#include "mavloom/msg/param_value.hpp"

namespace mavloom::observe {

namespace {

struct Reading {
    SummaryParts& parts;
    SenderLog& sender;
    ByteView payload;
    const When& when;
};

void read_message(const Reading& in, const msg::Heartbeat& message) {
    in.parts.count_entry(in.sender.take(message, in.payload, in.when));
}
void read_message(const Reading& in, const msg::AutopilotVersion& message) { in.sender.take(message); }
void read_message(const Reading& in, const msg::GlobalPositionInt& message) {
    in.sender.take(message, in.when, in.parts.with_tracks);
}
void read_message(const Reading& in, const msg::GpsRawInt& message) {
    in.sender.take(message, in.when, in.parts.with_tracks);
}
void read_message(const Reading& in, const msg::SysStatus& message) { in.sender.take_battery(message); }
void read_message(const Reading& in, const msg::BatteryStatus& message) { in.sender.take_battery(message); }
void read_message(const Reading& in, const msg::ParamValue& message) {
    auto& parameters = in.parts.parameters;
    in.parts.count_entry(parameters.add(in.sender.source(), message, in.sender.is_bytewise(), in.when));
}
void read_message(const Reading& in, const msg::Statustext& message) {
    constexpr std::uint8_t warning = 4;  // MAV_SEVERITY
    if (message.severity > warning) return;
    auto& open = in.sender.open_text;
    if (!open.joiner.add(in.sender.source(), message)) {
        in.parts.count_entry(in.parts.texts.add(in.sender.source(), open));
        open.severity = message.severity;
        open.when = in.when;
    }
    open.text = open.joiner.text();
}

struct Reader {
    MessageId id;
    std::uint8_t crc_extra;
    void (*read)(const Reading&);
};

template <class... Messages>
constexpr std::array make_readers{Reader{Messages::id, Messages::crc_extra,
                                         [](const Reading& in) { read_message(in, Messages::decode(in.payload)); }}...};
constexpr auto& message_readers = make_readers<msg::Heartbeat, msg::AutopilotVersion, msg::GlobalPositionInt, msg::GpsRawInt,
                                               msg::SysStatus, msg::BatteryStatus, msg::ParamValue, msg::Statustext>;

std::uint8_t reader_of(const wire::MessageInfo& info) noexcept {
    const auto at = std::ranges::find_if(
        message_readers, [&](const Reader& one) { return one.id == info.id && one.crc_extra == info.crc_extra; });
    return at == message_readers.end() ? std::uint8_t{0} : static_cast<std::uint8_t>(at - message_readers.begin() + 1);
}

}  // namespace

SenderLog* SummaryParts::find_or_add(Source source) {
    auto& place = sender_at[std::size_t{source.system.value} << 8 | source.component.value];
    if (place == 0) [[unlikely]] {
        if (senders.size() == Summarizer::max_senders) return nullptr;
        senders.emplace_back(source, messages.size());
        place = static_cast<std::uint16_t>(senders.size());
    }
    return &senders[place - 1u];
}

std::vector<std::uint8_t> readers_of(std::span<const wire::MessageInfo> messages) {
    std::vector<std::uint8_t> readers;
    readers.reserve(messages.size());
    for (const auto& info : messages) readers.push_back(reader_of(info));
    return readers;
}

void read(std::uint8_t reader, SummaryParts& parts, SenderLog& sender, ByteView payload, const When& when) {
    message_readers[reader - 1u].read({parts, sender, payload, when});
}

}  // namespace mavloom::observe
