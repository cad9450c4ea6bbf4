// SPDX-License-Identifier: MIT
#include "sim/store/log_service.hpp"

#include <algorithm>
#include <array>

#include "mavloom/msg/log_data.hpp"
#include "mavloom/msg/log_entry.hpp"
#include "mavloom/msg/log_erase.hpp"
#include "mavloom/msg/log_request_data.hpp"
#include "mavloom/msg/log_request_end.hpp"
#include "mavloom/msg/log_request_list.hpp"
#include "mavloom/msg/logging_ack.hpp"
#include "mavloom/msg/remote_log_block_status.hpp"
#include "sim/service/shares.hpp"

namespace mavloom::sim {

namespace {

using namespace msg;

constexpr std::array log_ids{LogRequestList::id, LogRequestData::id, LogRequestEnd::id,
                             LogErase::id,       LoggingAck::id,     RemoteLogBlockStatus::id};
constexpr unsigned messages_at_once = 100;

}  // namespace

LogService::LogService(const VehicleOptions& options, const Firmware& firmware, const Parameters& parameters,
                       const Flight& flight, Radio& radio, const FlightTime& booted)
    : firmware_(firmware),
      radio_(radio),
      booted_(booted),
      max_clients_(options.limits.clients),
      logs_(options, firmware, parameters, flight, radio),
      streams_(firmware.is_px4(), options.system, options.limits.clients, radio) {
    logs_.recorder().reboot(booted_);
}

std::span<const MessageId> LogService::handled() const noexcept { return log_ids; }

void LogService::receive(const Client& from, MessageId id, ByteView payload, Moment now) {
    if (id == LogRequestList::id) return on_list(from, payload);
    if (id == LogRequestData::id) return on_data(from, payload);
    if (id == LogRequestEnd::id) return stop(from);
    if (id == LoggingAck::id) return streams_.on_logging_ack(from, payload);
    if (id == RemoteLogBlockStatus::id) {
        if (!firmware_.is_px4()) streams_.on_block_status(from, payload, now);
        return;
    }
    logs_.erase();
    downloads_.clear();
}

Result LogService::stop_stream(const Client& to) {
    streams_.stop(to);
    return Result::accepted;
}

// Without logs, one entry reports that there are none.
void LogService::on_list(const Client& from, ByteView payload) {
    const auto request = LogRequestList::decode(payload);
    const auto index_of = [&](std::uint16_t id) { return std::max(0, id - logs_.first_id()); };
    const auto first = static_cast<std::uint32_t>(index_of(request.start));
    const std::uint32_t end = std::min<std::uint32_t>(logs_.count(),
                                                      static_cast<std::uint32_t>(index_of(request.end)) + 1);
    if (first < end && begin({.client = from, .is_list = true, .next = first, .end = end})) return;
    radio_.send(from.link, LogEntry{.num_logs = logs_.count(), .last_log_num = logs_.count()});
}

// A request beyond the end, or for a log that does not exist, is answered with no bytes.
void LogService::on_data(const Client& from, ByteView payload) {
    const auto request = LogRequestData::decode(payload);
    stop(from);
    const int index = request.id_ - logs_.first_id();
    if (index < 0 || index >= logs_.count()) return send_nothing(from, request.id_, request.ofs);
    const auto log = static_cast<std::uint16_t>(index);
    const std::uint64_t end = std::min<std::uint64_t>(logs_.size(log), std::uint64_t{request.ofs} + request.count);
    if (request.ofs >= end || !begin({.client = from,
                                      .id = request.id_,
                                      .log = logs_.serial(log),
                                      .next = request.ofs,
                                      .end = static_cast<std::uint32_t>(end)}))
        send_nothing(from, request.id_, request.ofs);
}

bool LogService::begin(const Download& download) {
    stop(download.client);
    if (!make_room(downloads_, download.client.link, max_clients_)) return false;
    downloads_.push_back(download);
    if (!advance(downloads_.back())) downloads_.pop_back();
    return true;
}

bool LogService::advance(Download& download) {
    for (unsigned i = 0; i < messages_at_once && radio_.has_room(download.client.link); ++i)
        if (!send_next(download)) return false;
    return true;
}

void LogService::stop(const Client& client) {
    std::erase_if(downloads_, [&](const Download& download) { return download.client == client; });
}

void LogService::send_entry(const Client& to, std::uint32_t index) {
    const auto log = static_cast<std::uint16_t>(index);
    const WallTime began = logs_.began_at(log);
    radio_.send(to.link, LogEntry{.id_ = static_cast<std::uint16_t>(log + logs_.first_id()),
                                  .num_logs = logs_.count(),
                                  .last_log_num = logs_.count(),
                                  .time_utc = static_cast<std::uint32_t>(unix_us(began) / 1'000'000),
                                  .size = logs_.size(log)});
}

void LogService::send_nothing(const Client& to, std::uint16_t id, std::uint32_t offset) {
    radio_.send(to.link, LogData{.id_ = id, .ofs = offset});
}

// When a flight begins, the oldest logs may go, and the list becomes shorter.
bool LogService::send_next_entry(Download& download) {
    download.end = std::min<std::uint32_t>(download.end, logs_.count());
    if (download.next >= download.end) return false;
    send_entry(download.client, download.next++);
    return download.next < download.end;
}

bool LogService::send_next(Download& download) {
    if (download.is_list) return send_next_entry(download);
    const auto log = logs_.index_of(download.log);
    if (!log) return false;
    LogData message{.id_ = download.id, .ofs = download.next};
    message.count = static_cast<std::uint8_t>(std::min<std::size_t>(message.data.size(), download.end - download.next));
    (void)logs_.read(*log, download.next, ByteSpan(message.data).first(message.count));
    radio_.send(download.client.link, message);
    download.next += message.count;
    return download.next < download.end;
}

void LogService::pump(Moment now) {
    std::erase_if(downloads_, [&](Download& download) { return !advance(download); });
    streams_.pump(now);
}

void LogService::reboot() {
    downloads_.clear();
    streams_.reboot();
    logs_.recorder().reboot(booted_);
}

void LogService::forget(LinkId link) {
    std::erase_if(downloads_, [&](const Download& download) { return download.client.link == link; });
    streams_.forget(link);
}

}  // namespace mavloom::sim
