// SPDX-License-Identifier: MIT
#include "mavutil/message.hpp"

#include <fmt/format.h>
#include <nanobind/stl/optional.h>

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

#include "bindings.hpp"
#include "errors.hpp"
#include "integer.hpp"
#include "message/encode.hpp"
#include "message/header_fields.hpp"
#include "strings.hpp"

namespace mavloom::python {

using dialect::Field;

nb::handle MavutilStyle::class_of(const Definitions& definitions, const dialect::Message* message) {
    const auto messages = definitions.dialect().messages();
    if (classes_.empty()) classes_.resize(messages.size() + 1);
    auto& made = classes_[message == nullptr ? messages.size() : static_cast<std::size_t>(message - messages.data())];
    if (!made.is_valid()) made = class_of_(message == nullptr ? nb::none() : definitions.names(*message).message);
    return made;
}

std::span<const Field> MavutilMessage::fields() const noexcept {
    if (base.definition == nullptr) return {};
    const auto all = base.definition->fields;
    if (!hides_extensions) return all;
    const auto shown = std::ranges::find_if(all, [](const Field& field) { return field.extension; }) - all.begin();
    return all.first(static_cast<std::size_t>(shown));
}

void MavutilMessage::set(const nb::object& name, const nb::object& value) {
    if (!extra.is_valid()) extra = nb::dict();
    if (PyDict_SetItem(extra.ptr(), name.ptr(), value.ptr()) != 0) throw nb::python_error();
}

MavutilMessage* mavutil_message(nb::handle object) noexcept {
    return nb::isinstance<MavutilMessage>(object) && nb::inst_ready(object) ? nb::inst_ptr<MavutilMessage>(object)
                                                                            : nullptr;
}

nb::object make_mavutil_message(const std::shared_ptr<const Origin>& origin, const dialect::Message* definition,
                                std::int64_t time_ns, std::uint32_t link, const wire::FrameView& frame,
                                std::uint8_t verdict) {
    auto& style = *origin->style();
    if (frame.is_v2() && style.hides_extensions) style.hides_extensions = false;
    const auto bytes = frame.bytes();
    auto copy = std::make_unique_for_overwrite<std::uint8_t[]>(bytes.size());
    std::copy(bytes.begin(), bytes.end(), copy.get());
    nb::object made = nb::inst_alloc(style.class_of(*origin->definitions(), definition));
    new (nb::inst_ptr<MavutilMessage>(made)) MavutilMessage{
        {origin, definition, time_ns, link, static_cast<std::uint16_t>(bytes.size()), verdict, std::move(copy)},
        {},
        style.hides_extensions};
    nb::inst_mark_ready(made);
    return made;
}

namespace {

// ---- attributes

PyObject* read_field(const MavutilMessage& message, const Field& field) {
    return value_of(*message.base.definition, message.payload(), field, TextForm::ascii);
}

const Field* find_interned(const MavutilMessage& message, PyObject* name) noexcept {
    const auto* definition = message.base.definition;
    if (definition == nullptr) return nullptr;
    const auto& fields = message.base.origin->definitions()->names(*definition).fields;
    const auto found = std::ranges::find_if(fields, [&](const nb::object& field) { return field.ptr() == name; });
    return found == fields.end() ? nullptr : &definition->fields[static_cast<std::size_t>(found - fields.begin())];
}

// For a text field `text`, `_text_raw` is its bytes without trailing NULs. Returns null if `name` is no such name.
const Field* raw_field(const dialect::Message& definition, std::string_view name) noexcept {
    constexpr std::string_view end = "_raw";
    if (!name.starts_with('_') || !name.ends_with(end) || name.size() <= end.size() + 1) return nullptr;
    const auto* field = definition.find(name.substr(1, name.size() - end.size() - 1));
    return field != nullptr && field->is_text() ? field : nullptr;
}

PyObject* read_raw(const MavutilMessage& message, const Field& field) {
    const auto bytes = raw_of(message.payload(), field);
    const std::string_view text(bytes.c_str(), bytes.size());
    const auto last = text.find_last_not_of('\0');
    return PyBytes_FromStringAndSize(text.data(), static_cast<Py_ssize_t>(last == text.npos ? 0 : last + 1));
}

// After a generic look-up has failed: a name made at run time, or the bytes of a text field.
PyObject* read_by_text(const MavutilMessage& message, PyObject* name) {
    const auto wanted = utf8_during_error(name);
    if (!wanted || message.base.definition == nullptr || wanted->starts_with("__")) return nullptr;
    const auto& definition = *message.base.definition;
    const auto* field = definition.find(*wanted);
    const auto* raw = field == nullptr ? raw_field(definition, *wanted) : nullptr;
    if (field == nullptr && raw == nullptr) {
        set_attribute_error(definition, *wanted);
        return nullptr;
    }
    PyErr_Clear();
    return field != nullptr ? read_field(message, *field) : read_raw(message, *raw);
}

PyObject* get_mavutil_attribute(PyObject* self, PyObject* name) noexcept {
    if (!nb::inst_ready(self)) return PyObject_GenericGetAttr(self, name);
    const auto& message = *nb::inst_ptr<MavutilMessage>(self);
    if (message.extra.is_valid()) {
        PyObject* set = PyDict_GetItemWithError(message.extra.ptr(), name);
        if (set != nullptr) return Py_NewRef(set);
        if (PyErr_Occurred() != nullptr) return nullptr;
    }
    if (const auto* field = find_interned(message, name)) return read_field(message, *field);
    if (PyUnicode_CHECK_INTERNED(name) == 0 && message.base.definition != nullptr) {
        const auto wanted = utf8_of(name);
        if (!wanted) return nullptr;
        if (const auto* field = message.base.definition->find(*wanted)) return read_field(message, *field);
    }
    PyObject* own = PyObject_GenericGetAttr(self, name);
    if (own != nullptr || PyErr_ExceptionMatches(PyExc_AttributeError) == 0) return own;
    return read_by_text(message, name);
}

// Forgets `_text_raw` when `text` is set.
int forget_raw(MavutilMessage& message, PyObject* name) noexcept {
    const auto* definition = message.base.definition;
    const auto wanted = utf8_of(name);
    if (!wanted) return -1;
    const auto* field = definition == nullptr ? nullptr : definition->find(*wanted);
    if (field == nullptr || !field->is_text()) return 0;
    const nb::object raw = nb::steal(PyUnicode_FromFormat("_%U_raw", name));
    if (!raw.is_valid()) return -1;
    const int has = PyDict_Contains(message.extra.ptr(), raw.ptr());
    return has == 1 ? PyDict_DelItem(message.extra.ptr(), raw.ptr()) : has;
}

int set_mavutil_attribute(PyObject* self, PyObject* name, PyObject* value) noexcept {
    if (!nb::inst_ready(self) || PyUnicode_Check(name) == 0) return PyObject_GenericSetAttr(self, name, value);
    auto& message = *nb::inst_ptr<MavutilMessage>(self);
    if (!message.extra.is_valid()) {
        message.extra = nb::steal(PyDict_New());
        if (!message.extra.is_valid()) return -1;
    }
    if (value != nullptr) {
        if (PyDict_SetItem(message.extra.ptr(), name, value) != 0) return -1;
        return forget_raw(message, name);
    }
    if (PyDict_DelItem(message.extra.ptr(), name) == 0) return 0;
    if (PyErr_ExceptionMatches(PyExc_KeyError) == 0) return -1;
    PyErr_Clear();
    PyErr_Format(PyExc_AttributeError, "'%.100s' object has no attribute '%U' that can be deleted",
                 Py_TYPE(self)->tp_name, name);
    return -1;
}

int traverse(PyObject* self, visitproc visit, void* arg) noexcept {
    Py_VISIT(Py_TYPE(self));
    if (nb::inst_ready(self)) Py_VISIT(nb::inst_ptr<MavutilMessage>(self)->extra.ptr());
    return 0;
}

int clear(PyObject* self) noexcept {
    if (nb::inst_ready(self)) nb::inst_ptr<MavutilMessage>(self)->extra.reset();
    return 0;
}

PyType_Slot mavutil_slots[] = {
    {Py_tp_getattro, reinterpret_cast<void*>(get_mavutil_attribute)},  // NOLINT
    {Py_tp_setattro, reinterpret_cast<void*>(set_mavutil_attribute)},  // NOLINT
    {Py_tp_traverse, reinterpret_cast<void*>(traverse)},               // NOLINT
    {Py_tp_clear, reinterpret_cast<void*>(clear)},                     // NOLINT
    {0, nullptr},
};

// ---- making

// `values` are those of the fields, in the order of the definition.
void construct(MavutilMessage* self, const PyDialect& dialect, std::optional<std::string> name, const nb::tuple& values,
               bool hides_extensions) {
    const auto& definitions = *dialect.definitions;
    const auto* definition = name ? value_or_raise(definitions.dialect().message(*name)) : nullptr;
    new (self) MavutilMessage{
        {std::make_shared<Origin>(dialect.definitions), definition, 0, 0, 0, 0, nullptr}, {}, hides_extensions};
    if (definition == nullptr) return;
    const auto& names = definitions.names(*definition).fields;
    for (std::size_t i = 0; i < std::min(names.size(), values.size()); ++i) {
        nb::object value = nb::borrow(values[i]);
        if (definition->fields[i].is_text() && PyObject_CheckBuffer(value.ptr()) != 0) {
            const Buffer buffer(value);
            const auto bytes = bytes_of(buffer.bytes());
            self->set(nb::steal(PyUnicode_FromFormat("_%U_raw", names[i].ptr())), bytes);
            const std::string_view text(bytes.c_str());  // up to the first NUL
            value = nb::steal(PyUnicode_DecodeASCII(text.data(), static_cast<Py_ssize_t>(text.size()), "replace"));
        }
        self->set(names[i], value);
    }
}

nb::object cut_array(const nb::object& values, const Field& field) {
    const auto count = static_cast<Py_ssize_t>(field.count());
    if (PySequence_Check(values.ptr()) == 0 || PySequence_Size(values.ptr()) <= count) {
        PyErr_Clear();  // `set_fields` reports what is no array
        return values;
    }
    nb::object cut = nb::steal(PySequence_GetSlice(values.ptr(), 0, count));
    if (!cut.is_valid()) throw nb::python_error();
    return cut;
}

// The values that were set, by field. Text and arrays that are too long are cut, as pymavlink does.
nb::object packed_value(const MavutilMessage& message, const Field& field, const nb::object& name) {
    nb::object value;
    if (field.is_text())
        value = nb::borrow(
            PyDict_GetItem(message.extra.ptr(), nb::str(fmt::format("_{}_raw", field.name).c_str()).ptr()));
    if (!value.is_valid()) value = nb::borrow(PyDict_GetItem(message.extra.ptr(), name.ptr()));
    if (value.is_valid() && field.is_array() && !field.is_text()) return cut_array(value, field);
    if (!value.is_valid() || !field.is_text()) return value;
    std::optional<std::string_view> text;
    if (PyUnicode_Check(value.ptr()) != 0) text = utf8_of(value.ptr());
    if (PyBytes_Check(value.ptr()) != 0)
        text.emplace(PyBytes_AS_STRING(value.ptr()), static_cast<std::size_t>(PyBytes_GET_SIZE(value.ptr())));
    PyErr_Clear();  // the error for text that is not UTF-8 comes from `set_fields`
    return text && text->size() > field.size() ? nb::bytes(text->data(), field.size()) : value;
}

message::MessageBuilder builder_of(const MavutilMessage& message) {
    if (message.base.definition == nullptr) raise_usage("a message without a definition cannot be packed");
    message::MessageBuilder builder(*message.base.definition, message.payload());
    if (!message.extra.is_valid()) return builder;
    const auto& definitions = *message.base.origin->definitions();
    const auto& names = definitions.names(*message.base.definition).fields;
    nb::dict fields;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const auto value = packed_value(message, message.base.definition->fields[i], names[i]);
        if (value.is_valid()) fields[names[i]] = value;
    }
    set_fields(definitions.dialect(), builder, nb::borrow<nb::kwargs>(fields));
    return builder;
}

void set_frame(MavutilMessage& message, ByteView bytes) {
    auto copy = std::make_unique_for_overwrite<std::uint8_t[]>(bytes.size());
    std::copy(bytes.begin(), bytes.end(), copy.get());
    message.base.bytes = std::move(copy);
    message.base.size = static_cast<std::uint16_t>(bytes.size());
}

// Writes the frame that `get_msgbuf` then returns. With `key`, signs it with that link id and time.
nb::bytes pack_message(MavutilMessage& message, const Integer& system, const Integer& component, const Integer& sequence,
                       bool v1, const std::optional<nb::bytes>& key, const Integer& link_id, const Integer& timestamp) {
    const auto builder = builder_of(message);
    const wire::FrameHeader header{.version = v1 ? wire::Version::v1 : wire::Version::v2,
                                   .sequence = sequence.in<std::uint8_t>("seq"),
                                   .source = {SystemId{system.in<std::uint8_t>("srcSystem")},
                                              ComponentId{component.in<std::uint8_t>("srcComponent")}}};
    check_version(header.version, builder.definition());
    wire::FrameBuffer buffer;
    std::optional<wire::Signer> signer;
    wire::Signing signing;
    if (key) {
        std::array<std::uint8_t, wire::SigningKey::length> bytes{};
        if (key->size() != bytes.size()) raise_usage(fmt::format("a signing key has 32 bytes, not {}", key->size()));
        std::copy_n(static_cast<const std::uint8_t*>(key->data()), bytes.size(), bytes.begin());
        signer.emplace(wire::SigningKey(bytes), link_id.in<std::uint8_t>("link_id"));
        signing = {&*signer, {timestamp.in<std::uint64_t>("timestamp", 0, (std::int64_t{1} << 48) - 1)}};
    }
    const auto frame = wire::write_frame(buffer, header, builder.definition().wire, builder.payload(), signing);
    set_frame(message, frame.bytes());
    return bytes_of(frame.bytes());
}

// ---- forms

nb::object mavutil_type(const MavutilMessage& message) {
    if (message.base.definition != nullptr)
        return message.base.origin->definitions()->names(*message.base.definition).message;
    return nb::cast(fmt::format("UNKNOWN_{}", message.base.size == 0 ? 0 : message.base.frame().id().value));
}

nb::list field_list(const MavutilMessage& message) {
    nb::list list;
    const auto shown = message.fields().size();
    for (std::size_t i = 0; i < shown; ++i)
        list.append(message.base.origin->definitions()->names(*message.base.definition).fields[i]);
    return list;
}

// The fields that were set replace those of the payload.
void replace_set_fields(const nb::dict& extra, nb::dict& dict) {
    for (const auto& [name, value] : extra) {
        const int is_field = PyDict_Contains(dict.ptr(), name.ptr());
        if (is_field < 0 || (is_field == 1 && PyDict_SetItem(dict.ptr(), name.ptr(), value.ptr()) != 0))
            throw nb::python_error();
    }
}

void add_fields(const MavutilMessage& message, nb::dict& dict) {
    const auto fields = message.fields();
    if (fields.empty()) return;
    const auto& definition = *message.base.definition;
    const auto& names = message.base.origin->definitions()->names(definition).fields;
    const auto payload = message.payload();
    for (std::size_t i = 0; i < fields.size(); ++i)
        set_item(dict, names[i], nb::steal(value_of(definition, payload, fields[i], TextForm::ascii)));
    if (message.extra.is_valid()) replace_set_fields(nb::borrow<nb::dict>(message.extra), dict);
}

// Has the keys of all fields already, unless some are hidden.
nb::dict unfilled_dict(const MavutilMessage& message) {
    const auto* definition = message.base.definition;
    const auto& definitions = *message.base.origin->definitions();
    if (definition != nullptr && message.fields().size() == definition->fields.size())
        return copy_of(definitions.names(*definition).unfilled);
    nb::dict dict;
    set_item(dict, definitions.type_key(), mavutil_type(message));
    return dict;
}

nb::dict mavutil_dict(const MavutilMessage& message) {
    auto dict = unfilled_dict(message);
    add_fields(message, dict);
    if (message.extra.is_valid())  // an attribute may have the key's name
        set_item(dict, message.base.origin->definitions()->type_key(), mavutil_type(message));
    return dict;
}

nb::dict fields_dict(const MavutilMessage& message) {
    nb::dict dict;
    add_fields(message, dict);
    return dict;
}

// `Type {field : value, ...}`; text without quotes.
std::string mavutil_text(const MavutilMessage& message) {
    std::string text = nb::str(mavutil_type(message)).c_str() + std::string(" {");
    const char* separator = "";
    for (const auto& [name, value] : fields_dict(message)) {
        text += fmt::format("{}{} : {}", separator, nb::str(name).c_str(), escaped(nb::str(value)));
        separator = ", ";
    }
    return text + "}";
}

nb::object extras(const MavutilMessage& message) {
    return message.extra.is_valid() ? nb::object(message.extra) : nb::object(nb::dict());
}

// A frame's header field, or 0 before the message is packed.
template <auto get>
auto of_frame() {
    return [](const MavutilMessage& message) -> int {
        return message.base.size == 0 ? 0 : static_cast<int>(get(message.base.frame()));
    };
}

int incompat_flags_of(const wire::FrameView& frame) { return frame.incompat_flags(); }
int compat_flags_of(const wire::FrameView& frame) { return frame.compat_flags(); }
int payload_length_of(const wire::FrameView& frame) { return frame.payload_length(); }

double time_in_seconds(const MavutilMessage& message) {
    const auto microseconds = message.base.time_ns / 1000;  // pymavlink's times have no more
    return static_cast<double>(microseconds) * 1e-6;
}

// ---- pickling

nb::tuple pickled_state(const MavutilMessage& message) {
    return nb::make_tuple(PyDialect{message.base.origin->definitions(), nullptr},
                          message.base.definition == nullptr ? nb::none() : mavutil_type(message),
                          bytes_of(message.base.size == 0 ? ByteView() : message.base.frame().bytes()),
                          message.base.time_ns, message.base.link, message.hides_extensions, extras(message));
}

void restore_state(MavutilMessage& message, const nb::bytes& frame, std::int64_t time_ns, std::uint32_t link,
                   const nb::dict& extra) {
    const ByteView bytes(static_cast<const std::uint8_t*>(frame.data()), frame.size());
    if (!bytes.empty()) {
        if (wire::frame_length(bytes) != bytes.size()) raise_input("these bytes are not a pickled message");
        set_frame(message, bytes);
    }
    message.base.time_ns = time_ns;
    message.base.link = link;
    if (!extra.empty()) message.extra = nb::steal<nb::dict>(PyDict_Copy(extra.ptr()));
}

}  // namespace

void bind_mavutil_message(nb::module_& module) {
    nb::class_<MavutilMessage>(module, "MavutilMessage", nb::type_slots(mavutil_slots), nb::is_weak_referenceable(),
                               "The base of the message classes of mavloom.mavutil.")
        .def("__init__", &construct, nb::arg("dialect"), nb::arg("name").none(), nb::arg("values"),
             nb::arg("hides_extensions"),
             nb::sig("def __init__(self, dialect: Dialect, name: str | None, values: tuple[typing.Any, ...], "
                     "hides_extensions: bool) -> None"))
        .def("get_type", &mavutil_type, nb::sig("def get_type(self) -> str"), "The message's name.")
        .def("get_srcSystem", of_frame<system_of>())
        .def("get_srcComponent", of_frame<component_of>())
        .def("get_seq", of_frame<sequence_of>())
        .def("get_fieldnames", &field_list, nb::sig("def get_fieldnames(self) -> list[str]"))
        .def("to_dict", &mavutil_dict, nb::sig("def to_dict(self) -> dict[str, typing.Any]"),
             "{\"mavpackettype\": name, field: value, ...}")
        .def("__str__", &mavutil_text)
        .def("_fields", &fields_dict, nb::sig("def _fields(self) -> dict[str, typing.Any]"))
        .def("_extras", &extras, nb::sig("def _extras(self) -> dict[str, typing.Any]"))
        .def("_pack", &pack_message, nb::arg("system"), nb::arg("component"), nb::arg("sequence"), nb::arg("v1"),
             nb::arg("key").none(), nb::arg("link_id"), nb::arg("timestamp"),
             nb::sig("def _pack(self, system: int, component: int, sequence: int, v1: bool, key: bytes | None, "
                     "link_id: int, timestamp: int) -> bytes"))
        .def("_state", &pickled_state, nb::sig("def _state(self) -> tuple[typing.Any, ...]"))
        .def("_restore", &restore_state, nb::arg("frame"), nb::arg("time_ns"), nb::arg("link"), nb::arg("extra"))
        .def_prop_ro(
            "_frame",
            [](const MavutilMessage& m) { return bytes_of(m.base.size == 0 ? ByteView() : m.base.frame().bytes()); })
        .def_prop_ro("_frame_payload", [](const MavutilMessage& m) { return bytes_of(m.payload()); })
        .def_prop_ro("_frame_incompat", of_frame<incompat_flags_of>())
        .def_prop_ro("_frame_compat", of_frame<compat_flags_of>())
        .def_prop_ro("_frame_mlen", of_frame<payload_length_of>())
        .def_prop_ro("_timestamp", &time_in_seconds)
        .def_prop_ro("_link", [](const MavutilMessage& m) { return m.base.link; });

    module.def(
        "mavutil_dialect",
        [](const PyDialect& dialect, nb::object class_of, bool hides_extensions) {
            auto style = std::make_shared<MavutilStyle>(std::move(class_of));
            style->hides_extensions = hides_extensions;
            return PyDialect{dialect.definitions, std::move(style)};
        },
        nb::arg("dialect"), nb::arg("class_of"), nb::arg("hides_extensions"),
        nb::sig("def mavutil_dialect(dialect: Dialect, class_of: collections.abc.Callable[[str | None], type], "
                "hides_extensions: bool) -> Dialect"),
        "Returns the dialect in the form that makes messages of mavloom.mavutil.");
    module.def(
        "hides_extensions",
        [](const PyDialect& dialect) { return dialect.style != nullptr && dialect.style->hides_extensions; },
        nb::arg("dialect"));
}

}  // namespace mavloom::python
