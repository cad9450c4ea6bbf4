// SPDX-License-Identifier: MIT
#include "message/message.hpp"

#include <fmt/format.h>
#include <nanobind/operators.h>

#include <algorithm>
#include <optional>
#include <string_view>

#include "errors.hpp"
#include "mavloom/base/suggest.hpp"
#include "mavloom/message/format.hpp"
#include "mavloom/ring/frames.hpp"
#include "mavutil/message.hpp"
#include "message/header_fields.hpp"
#include "message/values.hpp"
#include "strings.hpp"

namespace mavloom::python {

nb::object make_message(const std::shared_ptr<const Origin>& origin, const dialect::Message* definition,
                        std::int64_t time_ns, std::uint32_t link, const wire::FrameView& frame, std::uint8_t verdict) {
    if (origin->style() != nullptr) [[unlikely]]
        return make_mavutil_message(origin, definition, time_ns, link, frame, verdict);
    const auto bytes = frame.bytes();
    auto copy = std::make_unique_for_overwrite<std::uint8_t[]>(bytes.size());
    std::copy(bytes.begin(), bytes.end(), copy.get());
    return nb::cast(
        Message{origin, definition, time_ns, link, static_cast<std::uint16_t>(bytes.size()), verdict, std::move(copy)},
        nb::rv_policy::move);
}

namespace {

using dialect::Field;

std::string type_of(const Message& message) {
    if (message.definition != nullptr) return std::string(message.definition->name);
    return fmt::format("UNKNOWN_{}", message.frame().id().value);
}

nb::object type_object(const Message& message) {
    if (message.definition != nullptr) return message.origin->definitions()->names(*message.definition).message;
    return nb::cast(type_of(message));
}

const Field& field_of(const Message& message, std::string_view name) {
    if (message.definition == nullptr)
        raise_usage(fmt::format("{} has no definition, and so no fields", type_of(message)));
    if (const auto* field = message.definition->find(name)) return *field;
    raise_usage(fmt::format("{} has no field '{}'{}", message.definition->name, name,
                            did_you_mean(name, field_names(*message.definition))));
}

// ---- attributes

PyObject* read(const Message& message, const Field& field) {
    return value_of(*message.definition, message.frame().payload(), field);
}

// `msg.seq` could mean the field or the frame's sequence number.
PyObject* refuse_ambiguous(const Message& message, const Field& field) {
    const auto text = fmt::format(
        "{0} has a field '{1}': write msg[\"{1}\"] for the field, msg.header.{1} for the one of its frame",
        message.definition->name, field.name);
    PyErr_SetString(PyExc_AttributeError, text.c_str());
    return nullptr;
}

// Names made at run time are not interned, so they are not found by their address.
const Field* find_by_text(const Message& message, PyObject* name) noexcept {
    const auto text = message.definition == nullptr ? std::nullopt : utf8_of(name);
    if (!text) PyErr_Clear();
    return text ? message.definition->find(*text) : nullptr;
}

// Returns the field that attribute `name` reads. `ambiguous` is set if the name could mean the frame's header as well.
const Field* field_attribute(const Message& message, PyObject* name, bool& ambiguous) noexcept {
    const auto* definition = message.definition;
    if (definition == nullptr) return nullptr;
    const auto& names = message.origin->definitions()->names(*definition);
    auto place = static_cast<std::size_t>(std::ranges::find(names.attributes, name) - names.attributes.begin());
    if (place == names.attributes.size() && PyUnicode_CHECK_INTERNED(name) == 0) {
        const auto* field = find_by_text(message, name);
        if (field != nullptr) place = static_cast<std::size_t>(field - definition->fields.data());
        if (field != nullptr && names.attributes[place] == nullptr) return nullptr;
    }
    if (place == names.attributes.size()) return nullptr;
    ambiguous = names.ambiguous[place];
    return &definition->fields[place];
}

PyObject* get_attribute(PyObject* self, PyObject* name) noexcept {
    if (!nb::inst_ready(self)) {
        PyErr_SetString(PyExc_TypeError, "a Message is created by a Dialect, a link or a recording");
        return nullptr;
    }
    const Message& message = *nb::inst_ptr<Message>(self);
    bool ambiguous = false;
    if (const auto* field = field_attribute(message, name, ambiguous))
        return ambiguous ? refuse_ambiguous(message, *field) : read(message, *field);
    PyObject* own = PyObject_GenericGetAttr(self, name);
    if (own != nullptr || PyErr_ExceptionMatches(PyExc_AttributeError) == 0 || message.definition == nullptr)
        return own;
    const auto wanted = utf8_during_error(name);
    if (wanted && !wanted->starts_with("__")) set_attribute_error(*message.definition, *wanted);
    return nullptr;
}

int set_attribute(PyObject* self, PyObject* name, PyObject*) noexcept {
    const auto wanted = utf8_of(name);
    if (!wanted) return -1;
    const auto* definition = nb::inst_ready(self) ? nb::inst_ptr<Message>(self)->definition : nullptr;
    const auto text = definition != nullptr && definition->find(*wanted) != nullptr
                          ? fmt::format("messages cannot be changed; make a new one: msg.dialect.message(msg, {}=...)",
                                        *wanted)
                          : fmt::format("messages cannot be changed: no attribute '{}' can be set", *wanted);
    PyErr_SetString(PyExc_AttributeError, text.c_str());
    return -1;
}

// Attributes and fields, without the fields that are items only.
nb::list names_of(nb::handle self) {
    const auto& message = *nb::inst_ptr<Message>(self);
    nb::list names(nb::module_::import_("builtins").attr("object").attr("__dir__")(self));
    if (message.definition == nullptr) return names;
    for (auto* name : message.origin->definitions()->names(*message.definition).attributes)
        if (name != nullptr && !nb::cast<bool>(names.attr("__contains__")(nb::handle(name))))
            names.append(nb::handle(name));
    return names;
}

// ---- forms

nb::object item(const Message& message, std::string_view name) {
    return nb::steal(read(message, field_of(message, name)));
}

nb::dict to_dict(const Message& message) {
    const auto& definitions = *message.origin->definitions();
    if (message.definition == nullptr) {
        nb::dict dict;
        set_item(dict, definitions.type_key(), type_object(message));
        return dict;
    }
    const auto& names = definitions.names(*message.definition);
    auto dict = copy_of(names.unfilled);
    for (std::size_t i = 0; i < names.fields.size(); ++i)
        set_item(dict, names.fields[i], nb::steal(read(message, message.definition->fields[i])));
    return dict;
}

std::string to_json(const Message& message) {
    message::TextBuffer buffer;
    const auto link = message.origin->link_name(message.link);
    message::append_json(buffer, {WallTime{Nanoseconds{message.time_ns}}, link, message.frame(), message.definition});
    return {buffer.data(), buffer.size() - 1};  // without the newline
}

// Formats a message as pymavlink does.
std::string to_text(const Message& message) {
    std::string text = type_of(message) + " {";
    const nb::dict fields = to_dict(message);
    const char* separator = "";
    for (const auto& [name, value] : fields) {
        if (nb::cast<std::string>(name) == "mavpackettype") continue;
        text += fmt::format("{}{} : {}", separator, nb::str(name).c_str(), escaped(nb::repr(value)));
        separator = ", ";
    }
    return text + "}";
}

nb::bytes raw(const Message& message, std::string_view name) {
    return raw_of(message.frame().payload(), field_of(message, name));
}

nb::object name_of(const Message& message) { return message.definition == nullptr ? nb::none() : type_object(message); }

bool same_frame(const Message& a, const Message& b) noexcept {
    return std::ranges::equal(a.frame().bytes(), b.frame().bytes());
}

bool is_verified(const Message& message) noexcept {
    return ring::signature_of(message.verdict) == ring::FrameSignature::good;
}

const char* signature_verdict(const Message& message) noexcept {
    if (!message.frame().is_signed()) return "none";
    if (is_verified(message)) return "good";
    return ring::signature_of(message.verdict) == ring::FrameSignature::bad ? "bad" : "unchecked";
}

nb::object route_verdict(const Message& message) {
    const auto verdict = ring::verdict_of(message.verdict);
    if (!verdict) return nb::none();
    const auto name = route::verdict_name(*verdict);
    return nb::str(name.data(), name.size());
}

// Returns {field: text} for the fields for which `text` is not empty, as pymavlink's message classes have them.
template <class Text>
nb::dict texts_by_name(const Message& message, Text text) {
    nb::dict dict;
    if (message.definition == nullptr) return dict;
    for (const auto& field : message.definition->fields) {
        const std::string_view value = text(field);
        if (!value.empty()) dict[nb::str(field.name.data(), field.name.size())] = nb::str(value.data(), value.size());
    }
    return dict;
}

std::string_view unit_of(const Field& field) { return field.units; }
std::string_view enum_of(const Field& field) {
    return field.enumeration == nullptr ? std::string_view() : field.enumeration->name;
}

nb::list list_of_fields(const Message& message) {
    nb::list list;
    if (message.definition == nullptr) return list;
    for (const auto& name : message.origin->definitions()->names(*message.definition).fields) list.append(name);
    return list;
}

// ---- pickling

nb::tuple reduce(nb::handle self) {
    const auto& message = *nb::inst_ptr<Message>(self);
    return nb::make_tuple(
        nb::module_::import_("mavloom._pickle").attr("restore_message"),
        nb::make_tuple(PyDialect{message.origin->definitions(), nullptr}, bytes_of(message.frame().bytes()),
                       message.time_ns, message.link, message.origin->link_name(message.link), message.verdict));
}

nb::object restore(const PyDialect& dialect, const nb::bytes& frame, std::int64_t time_ns, std::uint32_t link,
                   std::string link_name, std::uint8_t verdict) {
    const ByteView bytes(static_cast<const std::uint8_t*>(frame.data()), frame.size());
    if (wire::frame_length(bytes) != bytes.size()) raise_input("these bytes are not a pickled message");
    auto origin = std::make_shared<Origin>(dialect.definitions);
    origin->link_names().add(LinkId{link}, std::move(link_name));
    const auto view = wire::FrameView::unchecked(bytes);
    return make_message(origin, origin->dialect().find(view.id()), time_ns, link, view, verdict);
}

// The header of a message's frame.
struct Header {
    nb::object message;

    [[nodiscard]] const Message& of() const noexcept { return *nb::inst_ptr<Message>(message); }
    [[nodiscard]] wire::FrameView frame() const noexcept { return of().frame(); }
};

Header header_of(nb::handle self) { return {nb::borrow(self)}; }

std::string header_text(const Header& header) {
    const auto frame = header.frame();
    return fmt::format("<Header of {}: id={}, sys={}, comp={}, seq={}, version={}>", type_of(header.of()),
                       frame.id().value, frame.system().value, frame.component().value, frame.sequence(),
                       static_cast<int>(frame.version()));
}

template <auto get, class Of = Message>
auto from_frame() {
    return [](const Of& of) { return get(of.frame()); };
}

std::uint32_t frame_id(const wire::FrameView& frame) { return frame.id().value; }
int frame_version(const wire::FrameView& frame) { return static_cast<int>(frame.version()); }
bool is_signed(const wire::FrameView& frame) { return frame.is_signed(); }
nb::bytes frame_bytes(const wire::FrameView& frame) { return bytes_of(frame.bytes()); }
nb::bytes payload_bytes(const wire::FrameView& frame) { return bytes_of(frame.payload()); }
int incompat_flags(const wire::FrameView& frame) { return frame.incompat_flags(); }
int compat_flags(const wire::FrameView& frame) { return frame.compat_flags(); }
int payload_length(const wire::FrameView& frame) { return frame.payload_length(); }

PyType_Slot slots[] = {
    {Py_tp_getattro, reinterpret_cast<void*>(get_attribute)},  // NOLINT
    {Py_tp_setattro, reinterpret_cast<void*>(set_attribute)},  // NOLINT
    {0, nullptr},
};

void bind_header(nb::module_& module) {
    nb::class_<Header>(module, "Header", nb::is_final(),
                       "The header of a message's frame, under our names and under pymavlink's.")
        .def_prop_ro(
            "name", [](const Header& header) { return name_of(header.of()); }, nb::sig("def name(self) -> str | None"),
            "The message's name; None for an id without definition.")
        .def_prop_ro("id", from_frame<frame_id, Header>(), "The message's id.")
        .def_prop_ro("sys", from_frame<system_of, Header>(), "The sender's system id.")
        .def_prop_ro("comp", from_frame<component_of, Header>(), "The sender's component id.")
        .def_prop_ro("seq", from_frame<sequence_of, Header>(), "The frame's sequence number, 0 to 255.")
        .def_prop_ro("version", from_frame<frame_version, Header>(), "MAVLink 1 or 2.")
        .def_prop_ro("frame", from_frame<frame_bytes, Header>(), "The whole frame as it arrived.")
        .def_prop_ro("incompat_flags", from_frame<incompat_flags, Header>())
        .def_prop_ro("compat_flags", from_frame<compat_flags, Header>())
        .def_prop_ro("mlen", from_frame<payload_length, Header>(), "The length of the payload in bytes.")
        .def_prop_ro("msgId", from_frame<frame_id, Header>())
        .def_prop_ro("srcSystem", from_frame<system_of, Header>())
        .def_prop_ro("srcComponent", from_frame<component_of, Header>())
        .def("__repr__", &header_text);
}

// Adds the names that pymavlink's messages have.
void bind_pymavlink_names(nb::class_<Message>& type) {
    type.def("get_type", &type_object, nb::sig("def get_type(self) -> str"),
             "The name, or \"UNKNOWN_<id>\" for an id without definition.")
        .def("get_msgId", from_frame<frame_id>(), "The same as `id`.")
        .def("get_srcSystem", from_frame<system_of>(), "The same as `sys`.")
        .def("get_srcComponent", from_frame<component_of>(), "The same as `comp`.")
        .def("get_seq", from_frame<sequence_of>(), "The same as `seq`.")
        .def("get_fieldnames", &list_of_fields, nb::sig("def get_fieldnames(self) -> list[str]"),
             "The fields' names in the order of the definition.")
        .def("get_msgbuf", from_frame<frame_bytes>(), "The same as `frame`.")
        .def("get_payload", from_frame<payload_bytes>(),
             "The payload as it was sent. MAVLink 2 senders cut trailing zeros.")
        .def(
            "get_signed", [](const Message& m) { return is_verified(m); },
            "Whether the signature was verified. `signed` is true for any signed frame.")
        .def("get_header", &header_of, nb::sig("def get_header(self) -> Header"), "The same as `header`.")
        .def_prop_ro(
            "_timestamp",
            [](const Message& m) {
                const auto microseconds = m.time_ns / 1000;
                return static_cast<double>(microseconds) * 1e-6;
            },
            "`time_ns` in seconds, truncated to whole microseconds.")
        .def_prop_ro(
            "_link", [](const Message& m) { return m.link; }, "The same as `link`.")
        .def_prop_ro(
            "fieldunits_by_name", [](const Message& m) { return texts_by_name(m, unit_of); },
            nb::sig("def fieldunits_by_name(self) -> dict[str, str]"), "{field: unit} for the fields that have a unit.")
        .def_prop_ro(
            "fieldenums_by_name", [](const Message& m) { return texts_by_name(m, enum_of); },
            nb::sig("def fieldenums_by_name(self) -> dict[str, str]"),
            "{field: enum} for the fields that have an enum.");
}

}  // namespace

void bind_message(nb::module_& module) {
    bind_header(module);
    nb::class_<Message> type(
        module, "Message", nb::type_slots(slots), nb::is_final(),
        "One message: a frame with its time and link.\n\n"
        "Fields are attributes (`msg.roll`) and items (`msg[\"roll\"]`), decoded when they are read.\n"
        "Numbers are int or float, and arrays are lists. char[] is str without trailing NULs; bytes that\n"
        "are not UTF-8 become U+FFFD, and `raw()` returns the original bytes. Trailing zeros that the\n"
        "sender cut off are restored.\n\n"
        "`header` has the values of the frame's header. `id`, `seq`, `version` and `frame` are short forms of\n"
        "them, except for messages that have a field of that name: these raise an AttributeError, and you\n"
        "write `msg[\"seq\"]` or `msg.header.seq`. `name` is always the message's name; a field of that name\n"
        "is `msg[\"name\"]`.\n\n"
        "Immutable, safe from any thread, and hashable. Messages are equal if their frames are. Can be\n"
        "copied and pickled.");
    type.def_prop_ro("name", &name_of, nb::sig("def name(self) -> str | None"),
                     "For example \"ATTITUDE\"; None for an id without definition.")
        .def_prop_ro("header", &header_of, nb::sig("def header(self) -> Header"),
                     "The header of the frame, for code that handles messages of any type.")
        .def_prop_ro("id", from_frame<frame_id>(), "The message's id.")
        .def_prop_ro("sys", from_frame<system_of>(), "The sender's system id.")
        .def_prop_ro("comp", from_frame<component_of>(), "The sender's component id.")
        .def_prop_ro("seq", from_frame<sequence_of>(), "The frame's sequence number, 0 to 255.")
        .def_prop_ro(
            "link", [](const Message& m) { return m.link; },
            "The number of the link on which it arrived; 0 for a recording.")
        .def_prop_ro(
            "link_name", [](const Message& m) { return m.origin->link_name(m.link); }, "The link's name.")
        .def_prop_ro(
            "time_ns", [](const Message& m) { return m.time_ns; },
            "Receive time: Unix time in ns. For sockets, the kernel's time; for recordings, the recorded time\n"
            "in whole µs.")
        .def_prop_ro("version", from_frame<frame_version>(), "MAVLink 1 or 2.")
        .def_prop_ro("signed", from_frame<is_signed>(), "Whether the frame carries a signature.")
        .def_prop_ro(
            "signature", &signature_verdict,
            nb::sig("def signature(self) -> typing.Literal['none', 'good', 'bad', 'unchecked']"),
            "\"good\" or \"bad\": the signature was checked, by the link or by the router that wrote the ring.\n"
            "\"unchecked\": there was no key. \"none\": the frame has no signature.")
        .def_prop_ro("verdict", &route_verdict, nb::sig("def verdict(self) -> str | None"),
                     "For a message from a router's ring, what the router did with it: \"forwarded\", \"duplicate\",\n"
                     "\"echo\", \"filtered\", ... None for other links, and if the writer stored no verdict.")
        .def_prop_ro("frame", from_frame<frame_bytes>(), "The whole frame as it arrived.")
        .def_prop_ro(
            "dialect",
            [](const Message& m) {
                return PyDialect{m.origin->definitions(), nullptr};
            },
            "The definitions that decode it.")
        .def("raw", &raw, nb::arg("field"), "The bytes of a field in their full length, as on the wire.")
        .def("to_dict", &to_dict, nb::sig("def to_dict(self) -> dict[str, typing.Any]"),
             "{\"mavpackettype\": name, field: value, ...}")
        .def("to_json", &to_json, "One strict JSON object: the line that `mavloom listen --json` prints.")
        .def("__getitem__", &item, nb::arg("field"), nb::sig("def __getitem__(self, field: str, /) -> typing.Any"),
             "Returns the value of a field. For an unknown name, raises UsageError (a ValueError) that\n"
             "suggests the nearest one.")
        .def("__contains__",
             [](const Message& m, std::string_view field) {
                 return m.definition != nullptr && m.definition->find(field) != nullptr;
             })
        .def("__dir__", &names_of, nb::sig("def __dir__(self) -> list[str]"))
        .def("keys", &list_of_fields, nb::sig("def keys(self) -> list[str]"), "The same as `get_fieldnames`.")
        .def("_ipython_key_completions_", &list_of_fields, nb::sig("def _ipython_key_completions_(self) -> list[str]"))
        .def(
            "_repr_html_",
            [](nb::handle self) { return nb::module_::import_("mavloom._views").attr("message_html")(self); },
            nb::sig("def _repr_html_(self) -> str"))
        .def("__str__", &to_text)
        .def("__repr__", &to_text)
        .def("__eq__", &same_frame, nb::is_operator(), nb::sig("def __eq__(self, other: object, /) -> bool"))
        .def("__hash__",
             [](const Message& m) {
                 const auto bytes = m.frame().bytes();
                 return std::hash<std::string_view>{}({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
             })
        .def("__reduce__", &reduce, nb::sig("def __reduce__(self) -> tuple[typing.Any, ...]"));
    bind_pymavlink_names(type);
    module.def("restore_message", &restore,
               nb::sig("def restore_message(dialect: Dialect, frame: bytes, time_ns: int, link: int, link_name: str, "
                       "verdict: int, /) -> Message"));
}

}  // namespace mavloom::python
