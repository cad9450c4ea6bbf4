// SPDX-License-Identifier: MIT
#include "sim/store/plan_service.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "mavloom/msg/enums/mav_cmd.hpp"
#include "mavloom/msg/enums/mav_frame.hpp"
#include "mavloom/msg/enums/mav_mission_result.hpp"
#include "mavloom/msg/enums/mav_mission_type.hpp"
#include "mavloom/msg/mission_ack.hpp"
#include "mavloom/msg/mission_clear_all.hpp"
#include "mavloom/msg/mission_item_reached.hpp"
#include "mavloom/msg/mission_request.hpp"
#include "mavloom/msg/mission_request_int.hpp"
#include "mavloom/msg/mission_request_list.hpp"
#include "mavloom/msg/mission_request_partial_list.hpp"
#include "mavloom/msg/mission_set_current.hpp"
#include "mavloom/msg/mission_write_partial_list.hpp"
#include "sim/service/shares.hpp"
#include "sim/store/plan_items.hpp"

namespace mavloom::sim {

namespace {

using namespace msg;
using flight::Result;  // and not mavloom::Result

constexpr std::array plan_ids{MissionCount::id,
                              MissionItemInt::id,
                              MissionItem::id,
                              MissionRequestList::id,
                              MissionRequestInt::id,
                              MissionRequest::id,
                              MissionAck::id,
                              MissionClearAll::id,
                              MissionSetCurrent::id,
                              MissionWritePartialList::id,
                              MissionRequestPartialList::id};

// Of a transfer without an answer.
struct Patience {
    Nanoseconds before_repeat, before_end;
    std::string_view end;
};
constexpr Patience px4_patience{std::chrono::milliseconds{250}, std::chrono::seconds{5}, "Mission sync timeout"};
constexpr Patience ardupilot_patience{std::chrono::seconds{1}, std::chrono::seconds{8}, "Mission upload timeout"};
// How many requests of PX4's usual form stay without an answer before it tries the other form.
constexpr unsigned tries_of_form = 4;

const Patience& patience_of(const Firmware& firmware) noexcept {
    return firmware.is_px4() ? px4_patience : ardupilot_patience;
}
constexpr int reached_repeats = 10;
constexpr Nanoseconds reached_interval = std::chrono::seconds{1};

// ArduPilot's values of MISSION_ITEM.current that make an item an order.
constexpr std::uint8_t current_guided = 2, current_altitude = 3;

std::uint8_t number_of(PlanType type) noexcept { return static_cast<std::uint8_t>(type); }

// m above mean sea level.
double altitude_of(const PlanItem& item, const Flight& flight) {
    switch (item.frame) {
        case MAV_FRAME_GLOBAL_RELATIVE_ALT:
        case MAV_FRAME_GLOBAL_RELATIVE_ALT_INT:
            return double{item.z} + (flight.home() ? flight.home()->altitude : flight.ground_altitude());
        case MAV_FRAME_GLOBAL_TERRAIN_ALT:
        case MAV_FRAME_GLOBAL_TERRAIN_ALT_INT: return double{item.z} + flight.ground_altitude();
        default: return double{item.z};
    }
}

}  // namespace

std::span<const MessageId> PlanService::handled() const noexcept { return plan_ids; }

void PlanService::receive(const Client& from, MessageId id, ByteView payload, Moment now) {
    const auto on_form = [&](const auto& m, bool is_int) {
        on_item(from, {item_of(m), m.seq, m.current, m.mission_type, is_int}, now);
    };
    const auto on_item_request = [&](const auto& m, bool is_int) {
        on_request(from, m.seq, m.mission_type, is_int, now);
    };
    if (id == MissionItemInt::id) return on_form(MissionItemInt::decode(payload), true);
    if (id == MissionItem::id) return on_form(MissionItem::decode(payload), false);
    if (id == MissionRequestInt::id) return on_item_request(MissionRequestInt::decode(payload), true);
    if (id == MissionRequest::id) return on_item_request(MissionRequest::decode(payload), false);
    if (id == MissionCount::id) return on_count(from, MissionCount::decode(payload), now);
    if (id == MissionRequestList::id) return on_list(from, MissionRequestList::decode(payload).mission_type, now);
    if (id == MissionAck::id) return on_ack(from, payload, now);
    if (id == MissionClearAll::id) return on_clear(from, MissionClearAll::decode(payload).mission_type);
    if (id == MissionSetCurrent::id) return on_set_current(MissionSetCurrent::decode(payload).seq, now);
    if (id == MissionWritePartialList::id) return on_partial_write(from, payload, now);
    // Neither firmware lets clients read a part of the list.
    acknowledge(from, MissionRequestPartialList::decode(payload).mission_type, MAV_MISSION_UNSUPPORTED);
}

// --- Upload

void PlanService::on_count(const Client& from, const MissionCount& message, Moment now) {
    const auto type = plan_type(message.mission_type);
    if (!type) return acknowledge(from, message.mission_type, MAV_MISSION_UNSUPPORTED);
    if (message.count > limit(*type)) return acknowledge(from, message.mission_type, MAV_MISSION_NO_SPACE);
    Transfer* const transfer = begin_upload(from, *type, now);
    if (transfer == nullptr) return acknowledge(from, message.mission_type, MAV_MISSION_ERROR);
    transfer->end = message.count;
    transfer->items.resize(message.count);
    if (message.count == 0) return finish(*transfer);
    ask(*transfer, now);
}

// Null: another client uploads this type, or too many transfers run.
PlanService::Transfer* PlanService::begin_upload(const Client& from, PlanType type, Moment now) {
    if (is_uploaded_by_another(from, type)) return nullptr;
    drop(from, type);
    if (!make_room(transfers_, from.link, limits_.clients)) return nullptr;
    transfers_.push_back(
        {.client = from, .type = type, .stage = Stage::upload, .asks_int = firmware_.is_px4(), .heard = now.real});
    return &transfers_.back();
}

// ArduPilot replaces a range of items, and may append one. PX4 does not know this.
void PlanService::on_partial_write(const Client& from, ByteView payload, Moment now) {
    const auto message = MissionWritePartialList::decode(payload);
    const auto type = plan_type(message.mission_type);
    if (firmware_.is_px4() || !type) return acknowledge(from, message.mission_type, MAV_MISSION_UNSUPPORTED);
    const auto items = flight_.plans().of(*type).items();
    const int first = message.start_index, last = message.end_index;
    if (first < 0 || last < first || last > static_cast<int>(items.size()))
        return acknowledge(from, message.mission_type, MAV_MISSION_ERROR);
    const auto end = static_cast<std::uint16_t>(last + 1);
    if (end > limit(*type)) return acknowledge(from, message.mission_type, MAV_MISSION_NO_SPACE);
    Transfer* const transfer = begin_upload(from, *type, now);
    if (transfer == nullptr) return acknowledge(from, message.mission_type, MAV_MISSION_ERROR);
    transfer->items.assign(items.begin(), items.end());
    transfer->items.resize(std::max<std::size_t>(items.size(), end));
    transfer->next = static_cast<std::uint16_t>(first);
    transfer->end = end;
    ask(*transfer, now);
}

void PlanService::on_item(const Client& from, const Request& request, Moment now) {
    if (!firmware_.is_px4() && (request.current == current_guided || request.current == current_altitude))
        return on_guided_item(from, request);
    const auto type = plan_type(request.mission_type);
    Transfer* const transfer = type ? find(from, *type) : nullptr;
    if (transfer == nullptr || transfer->stage == Stage::download) {
        if (firmware_.is_px4() && texts_.spend(now.flight))
            observer_.on_text(Severity::critical, "IGN MISSION_ITEM: No transfer");
        return acknowledge(from, request.mission_type, MAV_MISSION_ERROR);
    }
    transfer->heard = now.real;
    transfer->has_form = true;
    if (firmware_.is_px4()) transfer->asks_int = request.is_int;
    if (transfer->stage == Stage::finished) {
        // The last MISSION_ACK was lost.
        const std::uint32_t id = flight_.plans().of(*type).id();
        if (request.seq + 1 == transfer->end) acknowledge(from, request.mission_type, MAV_MISSION_ACCEPTED, id);
        return;
    }
    if (request.seq == transfer->next) return store_item(*transfer, request, now);
    // An older item is a late duplicate. PX4 ignores newer ones as well and repeats its request.
    if (request.seq > transfer->next && !firmware_.is_px4())
        acknowledge(from, request.mission_type, MAV_MISSION_INVALID_SEQUENCE);
}

void PlanService::store_item(Transfer& transfer, const Request& request, Moment now) {
    const auto count = static_cast<std::uint16_t>(transfer.items.size());
    const auto result = check_item(request.item, transfer.type, count, firmware_.is_px4());
    if (result != MAV_MISSION_ACCEPTED) {
        acknowledge(transfer.client, request.mission_type, result);
        return drop(transfer.client, transfer.type);
    }
    transfer.items[request.seq] = request.item;
    if (request.current == 1) transfer.current = request.seq;
    ++transfer.next;
    if (transfer.next == transfer.end) return finish(transfer);
    ask(transfer, now);
}

void PlanService::finish(Transfer& transfer) {
    transfer.stage = Stage::finished;
    replace(transfer.type, std::exchange(transfer.items, {}));
    Flight& flight = flight_;
    // ArduPilot ignores the mark. A refusal does not matter: the mission then begins with its first item.
    const bool marks = transfer.type == PlanType::mission && transfer.current && firmware_.is_px4();
    if (marks && *transfer.current != flight.mission().current) (void)flight.set_current_item(transfer.current, false);
    acknowledge(transfer.client, number_of(transfer.type), MAV_MISSION_ACCEPTED, flight.plans().of(transfer.type).id());
    const Texts& texts = firmware_.texts();
    if (transfer.type == PlanType::mission) announce(texts.mission_received);
    if (transfer.type == PlanType::rally) announce(texts.rally_received);
}

void PlanService::announce(std::string_view text) {
    if (!text.empty()) observer_.on_text(Severity::info, text);
}

void PlanService::replace(PlanType type, std::vector<PlanItem> items) {
    if (type == PlanType::mission) reached_.repeats = 0;
    flight_.plans().of(type).replace(std::move(items));
    flight_.on_plan_changed(type);
    observer_.on_mission_progress();  // MISSION_CURRENT has the ids of all plans
}

// PX4 changes to the form that its client speaks. ArduPilot always asks by MISSION_REQUEST, and takes both answers.
void PlanService::ask(Transfer& transfer, Moment now) { request_item(transfer, transfer.asks_int, now); }

// Clients that know only one form of the request do not answer the other one.
void PlanService::ask_again(Transfer& transfer, Moment now) {
    const bool may_try = firmware_.is_px4() && !transfer.has_form;
    const bool tries_other_form = may_try && ++transfer.repeats % tries_of_form == 0;
    request_item(transfer, transfer.asks_int != tries_other_form, now);
}

void PlanService::request_item(Transfer& transfer, bool as_int, Moment now) {
    transfer.sent = now.real;
    const auto fill = [&](auto message) {
        message.target_system = transfer.client.id.system.value;
        message.target_component = transfer.client.id.component.value;
        message.seq = transfer.next;
        message.mission_type = number_of(transfer.type);
        radio_.send(transfer.client.link, message);
    };
    if (as_int) return fill(MissionRequestInt{});
    fill(MissionRequest{});
}

// --- Download

void PlanService::on_list(const Client& from, std::uint8_t mission_type, Moment now) {
    const auto type = plan_type(mission_type);
    if (!type) return acknowledge(from, mission_type, MAV_MISSION_UNSUPPORTED);
    drop(from, *type);
    const Plan& plan = flight_.plans().of(*type);
    Transfer transfer{.client = from,
                      .type = *type,
                      .stage = Stage::download,
                      .end = plan.size(),
                      .edition = plan.edition(),
                      .heard = now.real};
    if (!plan.empty() && !make_room(transfers_, from.link, limits_.clients))
        return acknowledge(from, mission_type, MAV_MISSION_ERROR);
    send_count(transfer, now);
    if (!plan.empty()) transfers_.push_back(std::move(transfer));
}

void PlanService::send_count(Transfer& transfer, Moment now) {
    transfer.sent = now.real;
    radio_.send(transfer.client.link, MissionCount{.target_system = transfer.client.id.system.value,
                                                   .target_component = transfer.client.id.component.value,
                                                   .count = transfer.end,
                                                   .mission_type = number_of(transfer.type),
                                                   .opaque_id = flight_.plans().of(transfer.type).id()});
}

// Any item at any time, also without MISSION_REQUEST_LIST before: MAVProxy asks for several at once and sends no
// MISSION_ACK at the end.
void PlanService::on_request(const Client& from, std::uint16_t seq, std::uint8_t mission_type, bool is_int, Moment now) {
    const auto type = plan_type(mission_type);
    if (!type) return acknowledge(from, mission_type, MAV_MISSION_UNSUPPORTED);
    const Plan& plan = flight_.plans().of(*type);
    Transfer* const transfer = find(from, *type);
    if (transfer != nullptr && transfer->stage == Stage::download) {
        if (transfer->edition != plan.edition()) {
            // Another client replaced the plan: the rest would not fit to what was sent.
            drop(from, *type);
            return acknowledge(from, mission_type, MAV_MISSION_ERROR);
        }
        transfer->heard = now.real;
        transfer->was_asked = true;
    }
    if (seq >= plan.size() && !is_home(*type, seq))
        return acknowledge(from, mission_type, MAV_MISSION_INVALID_SEQUENCE);
    send_item(from, *type, seq, is_int);
}

// ArduPilot returns the present home as item 0, also if there is no mission.
bool PlanService::is_home(PlanType type, std::uint16_t seq) const noexcept {
    return type == PlanType::mission && seq == 0 && firmware_.has_home_in_mission();
}

PlanItem PlanService::stored_item(PlanType type, std::uint16_t seq) const {
    if (!is_home(type, seq)) return flight_.plans().of(type).items()[seq];
    const auto& home = flight_.home();
    if (!home) return {.command = MAV_CMD_NAV_WAYPOINT, .frame = MAV_FRAME_GLOBAL};
    return {.command = MAV_CMD_NAV_WAYPOINT,
            .frame = MAV_FRAME_GLOBAL,
            .x = static_cast<std::int32_t>(std::lround(home->latitude * 1e7)),
            .y = static_cast<std::int32_t>(std::lround(home->longitude * 1e7)),
            .z = static_cast<float>(home->altitude)};
}

void PlanService::send_item(const Client& to, PlanType type, std::uint16_t seq, bool is_int) {
    const PlanItem item = stored_item(type, seq);
    const bool is_px4 = firmware_.is_px4();
    const auto fill = [&](auto message) {
        message.target_system = to.id.system.value;
        message.target_component = to.id.component.value;
        message.seq = seq;
        message.current = type == PlanType::mission && seq == flight_.mission().current ? 1 : 0;
        message.mission_type = number_of(type);
        radio_.send(to.link, message);
    };
    if (is_int) return fill(int_form(item, is_px4));
    fill(float_form(item));
}

// --- Both

void PlanService::on_ack(const Client& from, ByteView payload, Moment now) {
    const auto message = MissionAck::decode(payload);
    const auto type = plan_type(message.mission_type);
    Transfer* const transfer = type ? find(from, *type) : nullptr;
    if (transfer == nullptr || transfer->stage == Stage::finished) return;
    if (transfer->stage == Stage::download || message.type == MAV_MISSION_OPERATION_CANCELLED) return drop(from, *type);
    if (message.type != MAV_MISSION_UNSUPPORTED || !firmware_.is_px4()) return;
    // A client that refuses both forms is asked no faster than one that does not answer.
    if (std::exchange(transfer->was_refused, true)) return;
    transfer->asks_int = !transfer->asks_int;
    ask(*transfer, now);
}

void PlanService::on_clear(const Client& from, std::uint8_t mission_type) {
    const bool all = mission_type == MAV_MISSION_TYPE_ALL;
    if (!all && !plan_type(mission_type)) return acknowledge(from, mission_type, MAV_MISSION_UNSUPPORTED);
    const auto is_meant = [&](std::uint8_t type) { return all || type == mission_type; };
    for (std::uint8_t i = 0; i < plan_types; ++i)
        if (is_meant(i) && is_uploaded_by_another(from, static_cast<PlanType>(i)))
            return acknowledge(from, mission_type, MAV_MISSION_ERROR);
    for (std::uint8_t i = 0; i < plan_types; ++i) {
        if (!is_meant(i)) continue;
        drop(from, static_cast<PlanType>(i));
        replace(static_cast<PlanType>(i), {});
    }
    acknowledge(from, mission_type, MAV_MISSION_ACCEPTED);
}

// There is no MISSION_ACK, because clients would take it for that of a transfer. A refusal is a text.
void PlanService::on_set_current(std::uint16_t seq, Moment now) {
    if (!flight_.set_current_item(seq, false).is_accepted() && texts_.spend(now.flight))
        observer_.on_text(Severity::warning, fmt::format("The mission has no item {}", seq));
    observer_.on_mission_progress();
}

void PlanService::on_guided_item(const Client& from, const Request& request) {
    const double altitude = altitude_of(request.item, flight_);
    Outcome outcome = Result::denied;
    if (request.current == current_altitude) {
        if (std::isfinite(altitude)) outcome = flight_.change_altitude(altitude);
    } else if (const auto place = position_of(request.item); place && std::isfinite(altitude)) {
        outcome = flight_.reposition(
            {.latitude = place->latitude, .longitude = place->longitude, .altitude = altitude, .may_change_mode = false});
    }
    acknowledge(from, request.mission_type, outcome.is_accepted() ? MAV_MISSION_ACCEPTED : MAV_MISSION_ERROR);
}

void PlanService::acknowledge(const Client& to, std::uint8_t mission_type, std::uint8_t result, std::uint32_t plan_id) {
    radio_.send(to.link, MissionAck{.target_system = to.id.system.value,
                                    .target_component = to.id.component.value,
                                    .type = result,
                                    .mission_type = mission_type,
                                    .opaque_id = plan_id});
}

// --- Time

FlightTime PlanService::wakes_at() const noexcept { return reached_.repeats > 0 ? reached_.due : FlightTime::max(); }

void PlanService::pump(Moment now) {
    std::erase_if(transfers_, [&](Transfer& transfer) { return !keep_alive(transfer, now); });
    if (reached_.repeats == 0 || now.flight < reached_.due) return;
    --reached_.repeats;
    reached_.due += reached_interval;
    radio_.broadcast(MissionItemReached{.seq = reached_.seq});
}

bool PlanService::keep_alive(Transfer& transfer, Moment now) {
    const Patience& patience = patience_of(firmware_);
    if (now.real - transfer.heard >= patience.before_end) {
        if (transfer.stage != Stage::upload) return false;
        observer_.on_text(Severity::critical, patience.end);
        acknowledge(transfer.client, number_of(transfer.type), MAV_MISSION_OPERATION_CANCELLED);
        return false;
    }
    if (now.real - transfer.sent < patience.before_repeat) return true;
    if (transfer.stage == Stage::upload) ask_again(transfer, now);
    if (transfer.stage == Stage::download && !transfer.was_asked) send_count(transfer, now);
    return true;
}

void PlanService::reboot() {
    transfers_.clear();
    reached_ = {};
}

void PlanService::forget(LinkId link) {
    std::erase_if(transfers_, [&](const Transfer& transfer) { return transfer.client.link == link; });
}

void PlanService::report_reached(std::uint16_t seq) {
    radio_.broadcast(MissionItemReached{.seq = seq});
    if (firmware_.is_px4()) reached_ = {seq, reached_repeats, stepped_ + reached_interval};
}

PlanService::Transfer* PlanService::find(const Client& client, PlanType type) noexcept {
    const auto at = std::ranges::find_if(
        transfers_, [&](const Transfer& transfer) { return transfer.client == client && transfer.type == type; });
    return at == transfers_.end() ? nullptr : &*at;
}

bool PlanService::is_uploaded_by_another(const Client& client, PlanType type) const noexcept {
    return std::ranges::any_of(transfers_, [&](const Transfer& transfer) {
        return transfer.stage == Stage::upload && transfer.type == type && transfer.client != client;
    });
}

void PlanService::drop(const Client& client, PlanType type) noexcept {
    std::erase_if(transfers_,
                  [&](const Transfer& transfer) { return transfer.client == client && transfer.type == type; });
}

std::size_t PlanService::limit(PlanType type) const noexcept {
    const Limits& limits = limits_;
    switch (type) {
        case PlanType::mission: return limits.mission_items;
        case PlanType::fence: return limits.fence_items;
        case PlanType::rally: break;
    }
    return limits.rally_items;
}

}  // namespace mavloom::sim
