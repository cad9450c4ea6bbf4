// SPDX-License-Identifier: MIT
#include "sim/service/events.hpp"

#include <algorithm>
#include <charconv>
#include <string>

#include "mavloom/msg/current_event_sequence.hpp"
#include "mavloom/msg/enums/mav_event_current_sequence_flags.hpp"
#include "mavloom/msg/enums/mav_event_error_reason.hpp"
#include "mavloom/msg/request_event.hpp"
#include "mavloom/msg/response_event_error.hpp"
#include "sim/metadata/event_catalog.hpp"
#include "sim/store/calendar.hpp"

namespace mavloom::sim {

namespace {

using namespace msg;

constexpr std::array event_ids{RequestEvent::id};

// PX4's times.
constexpr Nanoseconds sequence_interval = std::chrono::seconds{3};
constexpr Nanoseconds report_interval = std::chrono::seconds{2};
constexpr Nanoseconds check_interval = std::chrono::milliseconds{500};
constexpr Nanoseconds first_sequence = std::chrono::milliseconds{50}, first_check = std::chrono::seconds{2};

// The numbers that a text has in the place of each `{}` of a pattern; empty if the text differs.
std::optional<std::vector<double>> match(std::string_view text, std::string_view pattern) {
    std::vector<double> numbers;
    for (;;) {
        const std::size_t hole = pattern.find("{}");
        const std::string_view literal = pattern.substr(0, hole);
        if (!text.starts_with(literal)) return std::nullopt;
        text.remove_prefix(literal.size());
        if (hole == std::string_view::npos) return text.empty() ? std::optional(std::move(numbers)) : std::nullopt;
        pattern.remove_prefix(hole + 2);
        double number = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
        if (error != std::errc{}) return std::nullopt;
        text.remove_prefix(static_cast<std::size_t>(end - text.data()));
        numbers.push_back(number);
    }
}

// Writes values one after the other, little-endian, as far as they fit.
class Packer {
public:
    explicit Packer(ByteSpan out) noexcept : out_(out) {}
    template <class T>
    void put(T value) noexcept {
        if (out_.size() < sizeof value) return;
        store_le(out_.data(), value);
        out_ = out_.subspan(sizeof value);
    }

private:
    ByteSpan out_;
};

}  // namespace

EventService::EventService(const Firmware& firmware, const Flight& flight, const RecordedLogs& logs,
                           const EventTimes& times, Radio& radio, Announcer& announcer) noexcept
    : firmware_(firmware), flight_(flight), logs_(logs), times_(times), radio_(radio), announcer_(announcer) {
    restart();
}

void EventService::restart() {
    booted_ = may_report_ = times_.booted;
    next_sequence_ = booted_ + first_sequence;
    next_check_ = booted_ + first_check;
    sequence_ = count_ = 0;
    next_slot_ = 0;
    reset_ = MAV_EVENT_CURRENT_SEQUENCE_FLAGS_RESET;
    reported_.reset();
}

std::span<const MessageId> EventService::handled() const noexcept { return event_ids; }

FlightTime EventService::wakes_at() const noexcept {
    return firmware_.is_px4() ? std::min(next_sequence_, next_check_) : FlightTime::max();
}

void EventService::pump(Moment now) {
    if (booted_ != times_.booted) restart();
    if (now.flight >= next_sequence_) {
        if (!std::exchange(has_announced_log_, true)) announce_log();
        radio_.broadcast(
            CurrentEventSequence{.sequence = sequence_, .flags = static_cast<std::uint8_t>(std::exchange(reset_, 0))});
        next_sequence_ = now.flight + sequence_interval;
    }
    if (now.flight < next_check_) return;
    next_check_ = now.flight + check_interval;
    if (now.flight < may_report_) return;
    if (const HealthReport report = health_report(flight_, announcer_.has_audience()); report != reported_)
        send_report(report, now.flight);
}

template <class... Arguments>
void EventService::send(std::uint32_t id, Arguments... arguments) {
    std::array<std::uint8_t, 40> bytes{};
    Packer packer(bytes);
    (packer.put(arguments), ...);
    send_packed(id, bytes);
}

void EventService::send_packed(std::uint32_t id, const std::array<std::uint8_t, 40>& arguments) {
    const EventInfo* const info = find_event(id);
    if (info == nullptr) return;
    Event& event = past_[next_slot_];
    next_slot_ = (next_slot_ + 1) % kept;
    count_ = static_cast<std::uint16_t>(std::min<std::size_t>(kept, count_ + 1u));
    event = {.id_ = id,
             .event_time_boot_ms = static_cast<std::uint32_t>((times_.stepped - times_.booted) /
                                                              std::chrono::milliseconds{1}),
             .sequence = ++sequence_,
             .log_levels = info->log_levels,
             .arguments = arguments};
    radio_.broadcast(event);
}

bool EventService::report_text(std::string_view text) {
    if (!firmware_.is_px4()) return false;
    for (const EventText& known : event_texts()) {
        const auto numbers = match(text, known.text);
        const EventInfo* const info = numbers ? find_event(known.id) : nullptr;
        if (info == nullptr) continue;
        std::array<std::uint8_t, 40> arguments{};
        Packer packer(arguments);
        for (std::size_t i = 0; i < info->arguments.size(); ++i) {
            const double value = i < numbers->size() ? (*numbers)[i] : static_cast<double>(known.constant);
            if (info->arguments[i].type == "float") {
                packer.put(static_cast<float>(value));
            } else if (info->arguments[i].type == "int32_t") {
                packer.put(static_cast<std::int32_t>(std::clamp(value, -1e9, 1e9)));
            } else {
                packer.put(known.constant);
            }
        }
        send_packed(known.id, arguments);
        return true;
    }
    return false;
}

void EventService::report_health() {
    if (firmware_.is_px4()) send_report(health_report(flight_, announcer_.has_audience()), times_.now.flight);
}

void EventService::send_report(const HealthReport& report, FlightTime now) {
    constexpr std::uint8_t only_chunk = 0;
    constexpr std::uint32_t no_warnings = 0;
    send(event_id::arming_check_summary, only_chunk, report.arming_errors, report.arming_warnings, report.can_arm,
         report.can_run);
    for (const HealthProblem& problem : report.all())
        if (!problem.has_instance) send_problem(problem);
    send(event_id::health_summary, only_chunk, report.present, report.health_errors, no_warnings);
    for (const HealthProblem& problem : report.all())
        if (problem.has_instance) send_problem(problem);
    reported_ = report;
    may_report_ = now + report_interval;
}

void EventService::send_problem(const HealthProblem& problem) {
    constexpr std::uint8_t first_instance = 0;
    if (problem.has_instance) return send(problem.event, problem.modes, problem.component, first_instance);
    send(problem.event, problem.modes, problem.component);
}

// The newest log that the vehicle brings along begins when the vehicle is created.
void EventService::announce_log() {
    if (logs_.brought_along() == 0) return;
    const auto newest = static_cast<std::uint16_t>(logs_.brought_along() - 1);
    if (const WallTime began = logs_.began_at(newest); began != WallTime{}) {
        const Calendar at = calendar_of(began);
        const auto byte = [](unsigned part) { return static_cast<std::uint8_t>(part); };
        send(event_id::log_opened, static_cast<std::uint16_t>(at.year), byte(at.month), byte(at.day), byte(at.hour),
             byte(at.minute), byte(at.second));
    }
    announcer_.say(Severity::info, "[logger] ./" + logs_.path(newest) + '\t', times_.now.flight);
}

void EventService::receive(const Client& from, MessageId /*id*/, ByteView payload, Moment /*now*/) {
    if (!firmware_.is_px4()) return;
    const auto request = RequestEvent::decode(payload);
    const auto oldest = static_cast<std::uint16_t>(sequence_ - count_ + 1);
    // Distances from the newest event, backwards; sequence numbers wrap.
    const auto age = [&](std::uint16_t sequence) { return static_cast<std::uint16_t>(sequence_ - sequence); };
    if (age(request.first_sequence) >= count_)
        radio_.send(from.link, ResponseEventError{.target_system = from.id.system.value,
                                                  .target_component = from.id.component.value,
                                                  .sequence = request.first_sequence,
                                                  .sequence_oldest_available = oldest,
                                                  .reason = MAV_EVENT_ERROR_REASON_UNAVAILABLE});
    const auto asked = static_cast<std::uint16_t>(request.last_sequence - request.first_sequence);
    for (std::uint16_t i = 0; i < count_; ++i) {
        Event event = past_[(next_slot_ + kept - count_ + i) % kept];
        if (static_cast<std::uint16_t>(event.sequence - request.first_sequence) > asked) continue;
        event.destination_system = from.id.system.value;
        event.destination_component = from.id.component.value;
        radio_.send(from.link, event);
    }
}

}  // namespace mavloom::sim
