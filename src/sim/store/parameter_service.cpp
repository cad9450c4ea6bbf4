// SPDX-License-Identifier: MIT
#include "sim/store/parameter_service.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "mavloom/msg/enums/mav_param_error.hpp"
#include "mavloom/msg/enums/mav_param_type.hpp"
#include "mavloom/msg/param_error.hpp"
#include "mavloom/msg/param_request_list.hpp"
#include "mavloom/msg/param_request_read.hpp"
#include "mavloom/msg/param_set.hpp"
#include "mavloom/msg/param_value.hpp"
#include "sim/service/shares.hpp"

namespace mavloom::sim {

namespace {

constexpr std::array parameter_messages{msg::ParamRequestList::id, msg::ParamRequestRead::id, msg::ParamSet::id};

// PX4's name for the checksum of all values. It has no index.
constexpr std::string_view hash_name = "_HASH_CHECK";
constexpr std::uint16_t no_index = 0xffff;

// Values that a list sends at a time. PX4 sends as many each 10 to 20 ms.
constexpr int values_per_pump = 20;

// A name ends at its first NUL, or has 16 characters.
std::string_view name_of(const std::array<char, 16>& id) noexcept {
    const auto end = std::ranges::find(id, '\0');
    return {id.data(), static_cast<std::size_t>(end - id.begin())};
}

std::array<char, 16> id_of(std::string_view name) noexcept {
    std::array<char, 16> id{};
    std::ranges::copy(name.substr(0, id.size()), id.begin());
    return id;
}

}  // namespace

std::span<const MessageId> ParameterService::handled() const noexcept { return parameter_messages; }

void ParameterService::receive(const Client& from, MessageId id, ByteView payload, Moment now) {
    if (id == msg::ParamRequestList::id) return on_list(from, now);
    if (id == msg::ParamRequestRead::id) return on_read(from, payload);
    on_set(from, payload);
}

// A second request starts over. PX4 leaves out the checksum then.
void ParameterService::on_list(const Client& from, Moment now) {
    const auto running = std::ranges::find(lists_, from, &List::client);
    if (running != lists_.end()) {
        running->has_hash_ahead = false;
        running->next = 0;
        return;
    }
    if (!make_room(lists_, from.link, max_clients_)) return refuse(from, {.error = msg::MAV_PARAM_ERROR_READ_FAIL});
    lists_.push_back({.client = from, .has_hash_ahead = firmware_.is_px4()});
    if (const auto banner = firmware_.texts().banner; !banner.empty())
        announcer_.say(Severity::info, banner, now.flight);
}

void ParameterService::on_read(const Client& from, ByteView payload) {
    const auto request = msg::ParamRequestRead::decode(payload);
    const std::string_view name = name_of(request.param_id);
    if (request.param_index >= 0 && request.param_index < parameters_.size())
        return send_value(from.link, static_cast<ParamIndex>(request.param_index));
    if (request.param_index == -1) {
        if (name == hash_name && firmware_.is_px4()) return send_hash(from.link);
        if (const auto index = parameters_.find(name)) return send_value(from.link, *index);
    }
    refuse(from, {.name = name, .index = request.param_index, .error = msg::MAV_PARAM_ERROR_DOES_NOT_EXIST});
}

void ParameterService::on_set(const Client& from, ByteView payload) {
    const auto request = msg::ParamSet::decode(payload);
    const std::string_view name = name_of(request.param_id);
    if (name == hash_name && firmware_.is_px4()) {
        stop(from);
        return refuse(from, {.name = name, .error = msg::MAV_PARAM_ERROR_READ_ONLY});
    }
    if (const auto index = parameters_.find(name)) return change(from, *index, request.param_type, request.param_value);
    refuse(from, {.name = name, .error = msg::MAV_PARAM_ERROR_DOES_NOT_EXIST});
}

// After a refusal, clients that know no PARAM_ERROR see by PARAM_VALUE that the old value holds.
void ParameterService::change(const Client& from, ParamIndex index, std::uint8_t type, float value) {
    if (const auto error = check(index, type, value); error != msg::MAV_PARAM_ERROR_NO_ERROR) {
        refuse(from, {.name = parameters_.info(index).name, .index = index, .error = error});
        return send_value(from.link, index);
    }
    if (firmware_.is_bytewise()) {
        parameters_.set_bits(index, std::bit_cast<std::uint32_t>(value));
    } else {
        parameters_.set(index, double{value});
    }
    on_change_();
    announce(index);
}

// PX4 wants the type of the parameter, and stores any value. ArduPilot converts any type, and stores finite values.
std::uint8_t ParameterService::check(ParamIndex index, std::uint8_t type, float value) const noexcept {
    const ParamInfo& info = parameters_.info(index);
    if (info.is_read_only) return msg::MAV_PARAM_ERROR_READ_ONLY;
    if (!firmware_.is_bytewise())
        return std::isfinite(value) ? msg::MAV_PARAM_ERROR_NO_ERROR : msg::MAV_PARAM_ERROR_VALUE_OUT_OF_RANGE;
    if (type == static_cast<std::uint8_t>(info.type)) return msg::MAV_PARAM_ERROR_NO_ERROR;
    const bool is_known = type == msg::MAV_PARAM_TYPE_INT32 || type == msg::MAV_PARAM_TYPE_REAL32;
    return is_known ? msg::MAV_PARAM_ERROR_TYPE_MISMATCH : msg::MAV_PARAM_ERROR_TYPE_UNSUPPORTED;
}

void ParameterService::stop(const Client& client) {
    std::erase_if(lists_, [&](const List& list) { return list.client == client; });
}

void ParameterService::forget(LinkId link) {
    std::erase_if(lists_, [&](const List& list) { return list.client.link == link; });
}

void ParameterService::pump(Moment /*now*/) {
    std::erase_if(lists_, [this](List& list) {
        for (int sent = 0; sent < values_per_pump && radio_.has_room(list.client.link); ++sent)
            if (!send_next(list)) return true;
        return list.next == parameters_.size();
    });
}

bool ParameterService::send_next(List& list) {
    if (list.has_hash_ahead) {
        list.has_hash_ahead = false;
        send_hash(list.client.link);
        return true;
    }
    if (list.next == parameters_.size()) return false;
    send_value(list.client.link, list.next++);
    return true;
}

void ParameterService::announce(ParamIndex index) {
    for (const LinkId link : radio_.links()) send_value(link, index);
}

void ParameterService::reset(std::string_view prefix) {
    Parameters& parameters = parameters_;
    for (ParamIndex i = 0; i < parameters.size(); ++i) {
        const ParamInfo& info = parameters.info(i);
        if (!info.name.starts_with(prefix) || info.name == firmware_.system_parameter()) continue;
        const std::uint32_t before = parameters.bits(i);
        parameters.set(i, info.initial);
        if (parameters.bits(i) != before) announce(i);
    }
    on_change_();
}

void ParameterService::send_value(LinkId link, ParamIndex index) {
    const Parameters& parameters = parameters_;
    const float value = firmware_.is_bytewise() ? std::bit_cast<float>(parameters.bits(index))
                                                : static_cast<float>(parameters.value(index));
    radio_.send(link, msg::ParamValue{.param_id = id_of(parameters.info(index).name),
                                      .param_value = value,
                                      .param_type = static_cast<std::uint8_t>(parameters.info(index).type),
                                      .param_count = parameters.size(),
                                      .param_index = index});
}

void ParameterService::send_hash(LinkId link) {
    radio_.send(link, msg::ParamValue{.param_id = id_of(hash_name),
                                      .param_value = std::bit_cast<float>(parameters_.hash()),
                                      .param_type = msg::MAV_PARAM_TYPE_UINT32,
                                      .param_count = parameters_.size(),
                                      .param_index = no_index});
}

void ParameterService::refuse(const Client& to, const Refusal& refusal) {
    radio_.send(to.link, msg::ParamError{.target_system = to.id.system.value,
                                         .target_component = to.id.component.value,
                                         .param_id = id_of(refusal.name),
                                         .param_index = static_cast<std::int16_t>(refusal.index),
                                         .error = refusal.error});
}

}  // namespace mavloom::sim
