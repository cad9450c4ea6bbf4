// SPDX-License-Identifier: MIT
#include "sim/store/log_stream.hpp"

#include <algorithm>

#include "mavloom/msg/enums/mav_remote_log_data_block_commands.hpp"
#include "mavloom/msg/enums/mav_remote_log_data_block_statuses.hpp"
#include "mavloom/msg/logging_ack.hpp"
#include "mavloom/msg/logging_data.hpp"
#include "mavloom/msg/logging_data_acked.hpp"
#include "mavloom/msg/remote_log_block_status.hpp"
#include "mavloom/msg/remote_log_data_block.hpp"
#include "sim/service/shares.hpp"

namespace mavloom::sim {

namespace {

using namespace msg;

constexpr std::uint32_t piece = 249, block = 200;  // data bytes of LOGGING_DATA and of REMOTE_LOG_DATA_BLOCK
constexpr std::uint8_t no_message_begins = 255;
constexpr Nanoseconds repeat_after = std::chrono::milliseconds{100};
constexpr unsigned max_tries = 50;
constexpr std::size_t max_in_flight = 16;  // blocks without acknowledgement
constexpr Nanoseconds give_up_after = std::chrono::seconds{10};

}  // namespace

Result LogStreams::start(const Client& to, Moment now) {
    stop(to);
    if (!make_room(streams_, to.link, max_streams_)) return Result::temporarily_rejected;
    streams_.push_back({.client = to, .began = now.flight, .heard = now.real});
    return Result::accepted;
}

void LogStreams::stop(const Client& to) {
    std::erase_if(streams_, [&](const Stream& stream) { return stream.client == to; });
}

void LogStreams::forget(LinkId link) {
    std::erase_if(streams_, [&](const Stream& stream) { return stream.client.link == link; });
}

LogStreams::Stream* LogStreams::find(const Client& client) noexcept {
    const auto at = std::ranges::find(streams_, client, &Stream::client);
    return at == streams_.end() ? nullptr : &*at;
}

std::uint64_t LogStreams::written(const Stream& stream, Moment now) const noexcept {
    const auto records = static_cast<std::uint64_t>((now.flight - stream.began) / LogImage::record_interval);
    return image_.header_size() + records * image_.record_size();
}

void LogStreams::pump(Moment now) {
    std::erase_if(streams_,
                  [&](Stream& stream) { return !(is_px4_ ? pump_messages(stream, now) : pump_blocks(stream, now)); });
}

// --- PX4

void LogStreams::on_logging_ack(const Client& from, ByteView payload) {
    Stream* const stream = find(from);
    if (stream == nullptr || !stream->waits || LoggingAck::decode(payload).sequence != stream->sequence) return;
    stream->waits = false;
    stream->tries = 0;
    stream->offset += piece_length(*stream);
    ++stream->sequence;
}

// The header ends a piece, so that no record waits for an acknowledgement.
std::uint32_t LogStreams::piece_length(const Stream& stream) const noexcept {
    return is_in_header(stream) ? std::min(piece, image_.header_size() - stream.offset) : piece;
}

bool LogStreams::pump_messages(Stream& stream, Moment now) {
    if (is_in_header(stream)) {
        if (stream.waits && now.real - stream.sent < repeat_after) return true;
        if (stream.tries++ == max_tries) return false;
        stream.waits = true;
        stream.sent = now.real;
        send_message<LoggingDataAcked>(stream);
        return true;
    }
    while (stream.offset + std::uint64_t{piece} <= written(stream, now) && radio_.has_room(stream.client.link)) {
        send_message<LoggingData>(stream);
        stream.offset += piece;
        ++stream.sequence;
        if (stream.offset > image_.size() - 2 * piece) return false;
    }
    return true;
}

template <class Message>
void LogStreams::send_message(Stream& stream) {
    Message message{.target_system = stream.client.id.system.value,
                    .target_component = stream.client.id.component.value,
                    .sequence = stream.sequence,
                    .length = static_cast<std::uint8_t>(piece_length(stream))};
    const std::uint32_t record = image_.record_size();
    if (!is_in_header(stream)) {
        const std::uint32_t inside = (stream.offset - image_.header_size()) % record;
        const std::uint32_t begins = inside == 0 ? 0 : record - inside;
        message.first_message_offset = begins < piece ? static_cast<std::uint8_t>(begins) : no_message_begins;
    } else if (stream.offset != 0) {
        message.first_message_offset = no_message_begins;
    }
    (void)image_.read(stream.offset, ByteSpan(message.data).first(message.length));
    radio_.send(stream.client.link, message);
}

// --- ArduPilot

void LogStreams::on_block_status(const Client& from, ByteView payload, Moment now) {
    const auto status = RemoteLogBlockStatus::decode(payload);
    if (status.seqno == MAV_REMOTE_LOG_DATA_BLOCK_STOP) return stop(from);
    if (status.seqno == MAV_REMOTE_LOG_DATA_BLOCK_START) return void(start(from, now));
    Stream* const stream = find(from);
    if (stream == nullptr) return;
    stream->heard = now.real;
    const auto at = std::ranges::find(stream->blocks, status.seqno, &Block::seq);
    if (at == stream->blocks.end()) return;
    if (status.status == MAV_REMOTE_LOG_DATA_BLOCK_ACK) {
        stream->blocks.erase(at);
    } else {
        at->sent = now.real;
        send_block(*stream, at->seq);
    }
}

bool LogStreams::pump_blocks(Stream& stream, Moment now) {
    if (now.real - stream.heard >= give_up_after) return false;
    for (Block& sent : stream.blocks) {
        if (now.real - sent.sent < repeat_after || !radio_.has_room(stream.client.link)) continue;
        sent.sent = now.real;
        send_block(stream, sent.seq);
    }
    while (stream.blocks.size() < max_in_flight &&
           (stream.next_block + std::uint64_t{1}) * block <= written(stream, now)) {
        if (!radio_.has_room(stream.client.link)) break;
        stream.blocks.push_back({stream.next_block, now.real});
        send_block(stream, stream.next_block++);
    }
    return stream.next_block < image_.size() / block - 1;
}

void LogStreams::send_block(const Stream& stream, std::uint32_t seq) {
    RemoteLogDataBlock message{.target_system = stream.client.id.system.value,
                               .target_component = stream.client.id.component.value,
                               .seqno = seq};
    (void)image_.read(seq * block, message.data);
    radio_.send(stream.client.link, message);
}

}  // namespace mavloom::sim
