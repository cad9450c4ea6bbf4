// SPDX-License-Identifier: MIT
#include "sim/parts.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "mavloom/msg/current_mode.hpp"
#include "mavloom/msg/extended_sys_state.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/home_position.hpp"
#include "mavloom/msg/mission_current.hpp"
#include "sim/calibration/calibration.hpp"
#include "sim/calibration/compass_calibration.hpp"
#include "sim/payload/gimbal.hpp"
#include "sim/service/events.hpp"
#include "sim/service/guard.hpp"
#include "sim/service/other_services.hpp"
#include "sim/store/file_service.hpp"
#include "sim/store/log_service.hpp"
#include "sim/store/parameter_service.hpp"
#include "sim/store/plan_service.hpp"

namespace mavloom::sim {

Parts::Parts(const VehicleOptions& given, Sink& sink, Moment moment)
    : options(given),
      firmware(Firmware::of(given.autopilot, given.kind)),
      booted(moment.flight),
      stepped(moment.flight),
      now(moment),
      parameters(firmware.parameters()),
      flight(options, firmware, parameters, *this),
      radio(options.system, sink),
      streams(options, firmware, parameters, radio),
      announcer(radio),
      commands(*this),
      gimbal(options.has_gimbal ? std::make_unique<Gimbal>(options, flight) : nullptr),
      guard(std::make_unique<Guard>(flight, radio, *this)),
      parameter_service(std::make_unique<ParameterService>(firmware, parameters, radio, announcer,
                                                           options.limits.clients, [this] { retune(); })),
      plan_service(std::make_unique<PlanService>(firmware, flight, radio, *this, options.limits, stepped)),
      log_service(std::make_unique<LogService>(options, firmware, parameters, flight, radio, booted)),
      file_service(std::make_unique<FileService>(options, firmware, parameters, radio, log_service->logs())),
      event_service(std::make_unique<EventService>(firmware, flight, log_service->logs(),
                                                   EventTimes{booted, stepped, now}, radio, announcer)),
      calibration_service(
          std::make_unique<CalibrationService>(firmware, parameters, flight, radio, *parameter_service, *this)),
      compass_calibration(std::make_unique<CompassCalibration>(*this)),
      other_services(make_other_services(*this)),
      created_(moment) {
    parameters.put(firmware.system_parameter(), options.system.value);
    if (gimbal) add(*gimbal);
    add(commands);
    add(*guard);
    add(*parameter_service);
    add(*plan_service);
    add(*file_service);
    add(*log_service);
    add(*event_service);
    add(*calibration_service);
    add(*compass_calibration);
    for (const auto& service : other_services) add(*service);
}

Parts::~Parts() = default;

void Parts::add(Service& service) {
    services.push_back(&service);
    for (const MessageId id : service.handled()) service_of_.at(id.value) = static_cast<std::uint8_t>(services.size());
}

Service* Parts::service_for(MessageId id) const noexcept {
    const std::uint8_t index = id.value < direct_ids ? service_of_[id.value] : 0;
    return index == 0 ? nullptr : services[index - 1u];
}

View Parts::view() const {
    return {.options = options,
            .firmware = firmware,
            .parameters = parameters,
            .flight = flight,
            .gimbal = gimbal.get(),
            .servos = &servos,
            .since_boot = stepped - booted,
            .utc = utc_at(stepped),
            .has_utc = has_utc()};
}

void Parts::step_to(Moment moment) {
    now = moment;
    flight.set_real_time(moment.real);
    radio.set_utc(signing_time(moment));
    if (silent_until_ != FlightTime::min() && moment.flight >= silent_until_) {
        fly_to(silent_until_);  // a silent vehicle moves until then, whether or not it was called meanwhile
        end_silence();
    }
    fly_to(moment.flight);
}

void Parts::fly_to(FlightTime time) {
    FlightRecorder& recorder = log_service->recorder();
    for (; stepped + step_time <= time; stepped += step_time) {
        flight.step();
        recorder.step();
        if (gimbal) gimbal->step();
    }
}

void Parts::report_changes() {
    using namespace msg;
    if (std::exchange(state_changed_, false)) {
        parameters.put("COM_FLIGHT_UUID", flight.flights());
        streams.send_now(view(), std::array{Heartbeat::id, ExtendedSysState::id, CurrentMode::id});
    }
    if (std::exchange(home_changed_, false)) streams.send_now(view(), std::array{HomePosition::id});
    if (std::exchange(mission_changed_, false)) streams.send_now(view(), std::array{MissionCurrent::id});
    if (wanted_silence_.count() != 0) begin_silence();
    schedule_pump();
}

void Parts::schedule_pump() noexcept {
    bool busy = false;
    wake_ = FlightTime::max();
    for (const Service* const service : services) {
        busy = busy || service->is_busy();
        wake_ = std::min(wake_, service->wakes_at());
    }
    if (!busy) {
        busy_pump_ = FlightTime::max();
    } else if (busy_pump_ == FlightTime::max()) {
        busy_pump_ = now.flight;
    }
}

FlightTime Parts::next_pump() const noexcept { return std::min(busy_pump_, wake_); }

void Parts::pump(Moment moment) {
    busy_pump_ = moment.flight + pump_interval;
    for (Service* const service : services)
        if (service->is_busy() || service->wakes_at() <= moment.flight) service->pump(moment);
    report_changes();
}

void Parts::retune() {
    flight.retune();
    streams.retune(now.flight);
}

void Parts::put_parameter(std::string_view name, double value) {
    parameters.put(name, value);
    retune();
    if (const auto index = parameters.find(name)) parameter_service->announce(*index);
}

Outcome Parts::set_fault(const Fault& fault) {
    if (fault.part == FaultPart::sequence) radio.restart_sequences();
    else if (fault.part == FaultPart::autopilot) reboot(true);
    else if (Outcome outcome = flight.set_fault(fault); !outcome.is_accepted()) return outcome;
    if (fault.part == FaultPart::all) failures.clear();
    radio.set_off(flight.is_off(FaultPart::radio));
    radio.withhold_heartbeat(flight.is_off(FaultPart::heartbeat));
    return Result::accepted;
}

void Parts::begin_silence() {
    const Nanoseconds length = std::exchange(wanted_silence_, Nanoseconds{0});
    silent_until_ = length == Nanoseconds::max() ? FlightTime::max() : now.flight + length;
    radio.set_silent(true);
    (void)flight.disarm(true, OrderedBy::vehicle);  // without its autopilot, it falls
}

void Parts::end_silence() {
    booted = stepped = silent_until_;
    silent_until_ = FlightTime::min();
    radio.set_silent(false);
    for (Service* const service : services) service->reboot();
    failures.clear();
    flight.reboot();
    take_system();
    streams.reset(booted);
}

// The system id that the parameter asks for. 255 is the ground stations'. If another vehicle has it, the old one stays.
void Parts::take_system() {
    const std::string_view name = firmware.system_parameter();
    const double wanted = std::clamp(parameters.get(name, radio.system().value), 1.0, 254.0);
    const SystemId system{static_cast<std::uint8_t>(wanted)};
    if (system == radio.system() || !is_free_system || is_free_system(system)) return radio.set_system(system);
    parameters.put(name, radio.system().value);
    on_text(Severity::critical, "System id is in use");
}

// PX4 ends a text with a tab if it is also an event, so that ground stations show one of the two.
void Parts::on_text(Severity severity, std::string_view text) {
    log_service->recorder().note(severity, text);
    if (!event_service->report_text(text)) return announcer.say(severity, text, now.flight);
    announcer.say(severity, std::string(text) + '\t', now.flight);
}

void Parts::on_payload_item(const PlanItem& item) { carry_out_payload_item(*this, item); }

void Parts::on_item_reached(std::uint16_t seq) { plan_service->report_reached(seq); }

}  // namespace mavloom::sim
