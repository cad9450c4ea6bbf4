// SPDX-License-Identifier: MIT
#include "mavutil/state.hpp"

#include <nanobind/stl/optional.h>

#include <utility>

#include "bindings.hpp"
#include "errors.hpp"
#include "mavloom/base/clock.hpp"
#include "mavloom/feed/vehicle.hpp"
#include "mavloom/message/instance.hpp"
#include "mavloom/message/view.hpp"
#include "mavloom/msg/gps_raw_int.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/high_latency2.hpp"
#include "mavloom/msg/param_value.hpp"

namespace mavloom::python {
namespace {

// The 3DR radio, which counts its own sequence.
constexpr Source radio{SystemId{'3'}, ComponentId{'D'}};

bool concerns_connection(MessageId id) noexcept {
    return id == msg::Heartbeat::id || id == msg::ParamValue::id || id == msg::GpsRawInt::id ||
           id == msg::HighLatency2::id;
}

// On a slow link, a vehicle sends HIGH_LATENCY2 in place of heartbeats.
bool is_from_vehicle(const wire::FrameView& frame) noexcept {
    if (frame.id() != msg::HighLatency2::id) return feed::is_vehicle_heartbeat(frame);
    const auto summary = msg::HighLatency2::decode(frame.payload());
    return feed::is_vehicle(summary.type, summary.autopilot);
}

nb::object instance_value(const nb::object& message, const MavutilMessage& of, const dialect::Field& field) {
    if (of.base.size == 0) return nb::getattr(message, nb::str(field.name.data(), field.name.size()));
    auto value = nb::steal(value_of(*of.base.definition, of.payload(), field, TextForm::ascii));
    if (!value.is_valid()) throw nb::python_error();
    return value;
}

nb::object name_of_instance(const nb::object& name, const nb::object& value) {
    auto text = nb::steal(PyUnicode_FromFormat("%U[%S]", name.ptr(), value.ptr()));
    if (!text.is_valid()) throw nb::python_error();
    return text;
}

}  // namespace

nb::dict MavutilState::messages(std::uint8_t system) {
    auto& messages = messages_[system];
    if (!messages.is_valid()) messages = nb::object(messages_of_(system));
    return nb::borrow<nb::dict>(messages);
}

std::optional<bool> MavutilState::note(const nb::object& message) {
    auto* given = mavutil_message(message);
    if (given == nullptr) raise_usage("not a message of mavloom.mavutil");
    if (std::exchange(given->is_noted, true)) return std::nullopt;
    if (given->base.time_ns == 0) given->base.time_ns = wall_now().time_since_epoch().count();
    time_ns = given->base.time_ns;
    if (given->base.definition == nullptr) return true;
    if (given->base.size == 0) return note_made(message, *given);
    const auto frame = given->base.frame();
    if (target == 0 && is_from_vehicle(frame)) target = frame.system().value;
    add(messages(frame.system().value), message, *given);
    if (frame.source() == radio) add_to_all(message, *given);
    note_uptime(*given);
    if (frame.source() != radio) note_sequence(frame.source(), frame.sequence());
    return concerns_connection(frame.id());
}

// A message that the program made has source 0 and sequence number 0.
bool MavutilState::note_made(const nb::object& message, const MavutilMessage& of) {
    add(messages(0), message, of);
    note_sequence({}, 0);
    return concerns_connection(of.base.definition->id());
}

void MavutilState::note_sequence(Source source, std::uint8_t sequence) {
    ++count;
    if (last_ == sequences_.end() || last_->first != source) {
        const auto [place, is_new] = sequences_.try_emplace(source, sequence);
        last_ = place;
        if (is_new) return;
    }
    loss += static_cast<std::uint8_t>(sequence - last_->second - 1);
    last_->second = sequence;
}

void MavutilState::note_uptime(const MavutilMessage& message) {
    const auto* clock = message.base.origin->definitions()->names(*message.base.definition).clock;
    if (clock == nullptr) return;
    const message::MessageView view(*message.base.definition, message.payload());
    uptime_s = view.number(*clock) * (clock->name == "usec" ? 1e-6 : 1e-3);
}

void MavutilState::add(const nb::dict& messages, const nb::object& message, const MavutilMessage& of) {
    const auto& name = of.base.origin->definitions()->names(*of.base.definition).message;
    if (const auto* instance = message::instance_field(*of.base.definition))
        add_instance_of(messages, message, of, *instance);
    if (PyDict_SetItem(messages.ptr(), name.ptr(), message.ptr()) != 0) throw nb::python_error();
}

void MavutilState::add_to_all(const nb::object& message, const MavutilMessage& of) {
    static_cast<void>(messages(0));  // makes it
    for (const auto& one : messages_)
        if (one.is_valid()) add(nb::borrow<nb::dict>(one), message, of);
}

void MavutilState::add_instance_of(const nb::dict& messages, const nb::object& message, const MavutilMessage& of,
                                   const dialect::Field& instance) {
    const auto& name = of.base.origin->definitions()->names(*of.base.definition).message;
    const nb::object value = instance_value(message, of, instance);
    const nb::object previous = nb::borrow(PyDict_GetItem(messages.ptr(), name.ptr()));
    nb::object instances = previous.is_valid() ? nb::getattr(previous, instances_key_, nb::none()) : nb::none();
    if (!nb::isinstance<nb::dict>(instances)) instances = nb::dict();  // a program may set the attribute
    nb::setattr(message, instances_key_, instances);
    if (nb::len(instances) >= static_cast<std::size_t>(max_messages) &&
        PyDict_Contains(instances.ptr(), value.ptr()) != 1)
        return;
    nb::dict of_message = nb::borrow<nb::dict>(instances), of_system = messages;
    set_item(of_message, value, message);
    if (!previous.is_valid()) set_item(of_system, name, message);  // before its instances, in the order of the dict
    set_item(of_system, name_of_instance(name, value), message);
}

void MavutilState::add_to_target(const nb::object& message) {
    const auto* given = mavutil_message(message);
    if (given == nullptr || given->base.definition == nullptr) return;
    add(messages(target), message, *given);
}

nb::dict MavutilState::last_sequences() const {
    nb::dict found;
    for (const auto& [source, sequence] : sequences_)
        found[nb::make_tuple(source.system.value, source.component.value)] = sequence;
    return found;
}

void bind_mavutil_state(nb::module_& module) {
    nb::class_<MavutilState>(module, "MavutilState", nb::is_final(),
                             "What a connection of mavloom.mavutil remembers of the messages that it has read.")
        .def(nb::init<nb::object>(), nb::arg("messages_of"),
             nb::sig("def __init__(self, messages_of: collections.abc.Callable[[int], dict[str, typing.Any]]) -> None"))
        .def("note", &MavutilState::note, nb::arg("message"),
             nb::sig("def note(self, message: MavutilMessage) -> bool | None"))
        .def("messages", &MavutilState::messages, nb::arg("system"),
             nb::sig("def messages(self, system: int) -> dict[str, typing.Any]"))
        .def_prop_ro("last_sequences", &MavutilState::last_sequences,
                     nb::sig("def last_sequences(self) -> dict[tuple[int, int], int]"))
        .def_rw("target", &MavutilState::target)
        .def_rw("count", &MavutilState::count)
        .def_rw("loss", &MavutilState::loss)
        .def_rw("time_ns", &MavutilState::time_ns)
        .def_rw("uptime_s", &MavutilState::uptime_s);
}

}  // namespace mavloom::python
