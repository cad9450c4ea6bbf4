// SPDX-License-Identifier: MIT
#include "message/definitions.hpp"

#include <fmt/format.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "errors.hpp"
#include "gil.hpp"
#include "mavloom/base/suggest.hpp"
#include "message/encode.hpp"
#include "message/message.hpp"
#include "message/values.hpp"
#include "strings.hpp"

namespace mavloom::python {
namespace {

nb::object interned(std::string_view text) {
    PyObject* object = PyUnicode_FromStringAndSize(text.data(), static_cast<Py_ssize_t>(text.size()));
    if (object == nullptr) throw nb::python_error();
    PyUnicode_InternInPlace(&object);
    return nb::steal(object);
}

// ---- what users see of a definition

struct FieldInfo {
    std::shared_ptr<const Definitions> owner;
    const dialect::Field* field;
};

struct MessageInfo {
    std::shared_ptr<const Definitions> owner;
    const dialect::Message* message;
};

std::string_view type_name(dialect::FieldType type) noexcept {
    constexpr std::string_view names[] = {"char",    "uint8_t",  "int8_t",  "uint16_t", "int16_t", "uint32_t",
                                          "int32_t", "uint64_t", "int64_t", "float",    "double"};
    return names[static_cast<std::size_t>(type)];
}

void bind_infos(nb::module_& module) {
    nb::class_<FieldInfo>(module, "FieldInfo", nb::is_final(), "The definition of a field.")
        .def_prop_ro("name", [](const FieldInfo& f) { return f.field->name; })
        .def_prop_ro(
            "type", [](const FieldInfo& f) { return type_name(f.field->type); },
            "\"uint16_t\", \"float\", \"char\", ...")
        .def_prop_ro(
            "array_length", [](const FieldInfo& f) { return f.field->array_length; },
            "The number of elements; 0 for a scalar.")
        .def_prop_ro(
            "units", [](const FieldInfo& f) { return f.field->units; },
            "For example \"rad/s\"; empty if the field has no unit.")
        .def_prop_ro(
            "enum",
            [](const FieldInfo& f) {
                return f.field->enumeration == nullptr ? std::string_view() : f.field->enumeration->name;
            },
            "The name of the enum; empty if the field has none.")
        .def_prop_ro("bitmask", [](const FieldInfo& f) { return f.field->bitmask; })
        .def_prop_ro(
            "invalid", [](const FieldInfo& f) { return f.field->invalid; },
            "The definition's text for \"no value\"; empty if there is none.")
        .def_prop_ro(
            "extension", [](const FieldInfo& f) { return f.field->extension; },
            "Whether it is an extension field, which MAVLink 1 cannot carry.")
        .def_prop_ro(
            "instance", [](const FieldInfo& f) { return f.field->instance; },
            "Whether this field distinguishes several sensors in one message.")
        .def("__repr__", [](const FieldInfo& f) {
            return f.field->is_array()
                       ? fmt::format("<{} {}[{}]>", type_name(f.field->type), f.field->name, f.field->array_length)
                       : fmt::format("<{} {}>", type_name(f.field->type), f.field->name);
        });
    nb::class_<MessageInfo>(module, "MessageInfo", nb::is_final(), "The definition of a message.")
        .def_prop_ro("name", [](const MessageInfo& m) { return m.message->name; })
        .def_prop_ro("id", [](const MessageInfo& m) { return m.message->id().value; })
        .def_prop_ro("crc_extra", [](const MessageInfo& m) { return m.message->wire.crc_extra; })
        .def_prop_ro(
            "max_length", [](const MessageInfo& m) { return m.message->wire.max_length; },
            "The length of the payload with all fields, in bytes.")
        .def_prop_ro(
            "fields",
            [](const MessageInfo& m) {
                std::vector<FieldInfo> fields;
                for (const auto& field : m.message->fields) fields.push_back({m.owner, &field});
                return fields;
            },
            "The fields in the order of the definition.")
        .def("__repr__", [](const MessageInfo& m) {
            return fmt::format("<message {} {}>", m.message->name, m.message->id().value);
        });
}

// ---- class Dialect

// Returns null if no message has this id.
const dialect::Message* find_by_id(const dialect::Dialect& dialect, const nb::object& id) {
    int overflow = 0;
    const auto value = PyLong_AsLongLongAndOverflow(id.ptr(), &overflow);
    if (PyErr_Occurred() != nullptr) throw nb::python_error();
    if (overflow != 0 || !std::in_range<std::uint32_t>(value)) return nullptr;
    return dialect.find(MessageId{static_cast<std::uint32_t>(value)});
}

MessageInfo find(const PyDialect& dialect, const nb::object& name_or_id) {
    const auto& definitions = dialect.definitions->dialect();
    if (PyUnicode_Check(name_or_id.ptr()))
        return {dialect.definitions, value_or_raise(definitions.message(nb::cast<std::string>(name_or_id)))};
    if (const auto* found = find_by_id(definitions, name_or_id)) return {dialect.definitions, found};
    raise_usage(fmt::format("no message has id {}", escaped(nb::str(name_or_id))));
}

bool contains(const PyDialect& dialect, const nb::object& name_or_id) {
    const auto& definitions = dialect.definitions->dialect();
    if (PyUnicode_Check(name_or_id.ptr())) return definitions.find(nb::cast<std::string>(name_or_id)) != nullptr;
    return find_by_id(definitions, name_or_id) != nullptr;
}

nb::list message_names(const PyDialect& dialect) {
    nb::list names;
    for (const auto& message : dialect.definitions->dialect().messages())
        names.append(dialect.definitions->names(message).message);
    return names;
}

nb::list enum_names(const PyDialect& dialect) {
    nb::list names;
    for (const auto& enumeration : dialect.definitions->dialect().enums())
        names.append(nb::str(enumeration.name.data(), enumeration.name.size()));
    return names;
}

// Returns (bitmask, {entry: value}), from which mavloom._enums makes the class.
nb::tuple enum_entries(const PyDialect& dialect, std::string_view name) {
    const auto& definitions = dialect.definitions->dialect();
    const auto* enumeration = definitions.find_enum(name);
    if (enumeration == nullptr) {
        std::vector<std::string_view> names;
        for (const auto& one : definitions.enums()) names.push_back(one.name);
        raise_usage(fmt::format("unknown enum '{}'{}", name, did_you_mean(name, names)));
    }
    nb::dict entries;
    for (const auto& entry : enumeration->entries) entries[nb::str(entry.name.data(), entry.name.size())] = entry.value;
    return nb::make_tuple(enumeration->bitmask, entries);
}

// ArduPilot accepts system 255 as its ground station. Component 193 is not used by ground stations; QGroundControl uses
// 190.
constexpr Source default_source{SystemId{255}, ComponentId{193}};

// A message that is encoded again keeps its header, except for what the caller gives.
wire::FrameHeader header_for(const nb::object& message, const OptionalInteger& system, const OptionalInteger& component,
                             const OptionalInteger& seq, const OptionalInteger& version) {
    wire::FrameHeader header{.source = default_source};
    if (nb::isinstance<Message>(message)) {
        const auto frame = nb::inst_ptr<Message>(message)->frame();
        header = {frame.version(), frame.sequence(), frame.source(), frame.compat_flags()};
    }
    if (version) header.version = version_of("frame_version", *version);
    if (seq) header.sequence = seq->in<std::uint8_t>("frame_seq");
    if (system) header.source.system = SystemId{system->in<std::uint8_t>("source_system")};
    if (component) header.source.component = ComponentId{component->in<std::uint8_t>("source_component")};
    return header;
}

nb::bytes encode(const PyDialect& dialect, const nb::object& message, const OptionalInteger& system,
                 const OptionalInteger& component, const OptionalInteger& seq, const OptionalInteger& version,
                 const nb::kwargs& fields) {
    const auto builder = build(*dialect.definitions, message, fields);
    wire::FrameBuffer buffer;
    const auto bytes = write(buffer, header_for(message, system, component, seq, version), builder).bytes();
    return nb::bytes(bytes.data(), bytes.size());
}

nb::object make(const PyDialect& dialect, const nb::object& name, const nb::kwargs& fields) {
    const auto builder = build(*dialect.definitions, name, fields);
    wire::FrameBuffer buffer;
    const auto frame = write(buffer, header_for(name, {}, {}, {}, {}), builder);
    return make_message(std::make_shared<Origin>(dialect.definitions), &builder.definition(), 0, 0, frame);
}

nb::object decode_bytes(const PyDialect& dialect, const nb::object& bytes, const Integer& time_ns) {
    const Buffer buffer(bytes);
    return decode(std::make_shared<Origin>(dialect.definitions), buffer.bytes(), time_ns.in<std::int64_t>("time_ns"));
}

nb::object path_or_none(const PyDialect& dialect) {
    const auto& path = dialect.definitions->path();
    return path.empty() ? nb::none() : nb::object(nb::str(path.c_str(), path.size()));
}

// Nothing of a file that cannot be read, which the reader reports.
std::string key_of(const std::string& path) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    const auto changed = fs::last_write_time(path, ignored).time_since_epoch().count();
    const auto size = fs::file_size(path, ignored);
    return fmt::format("{} {} {}", fs::absolute(path, ignored).string(), changed, size);
}

}  // namespace

Definitions::Definitions(dialect::Dialect dialect, std::string path, std::string key)
    : dialect_(std::move(dialect)), path_(std::move(path)), key_(std::move(key)), type_key_(interned("mavpackettype")) {
    const nb::handle message_type = nb::type<Message>();
    constexpr std::string_view of_header[] = {"frame", "id", "seq", "version"};
    names_.reserve(dialect_.messages().size());
    for (const auto& message : dialect_.messages()) {
        Names names{interned(message.name), {}, {}, {}, {}, nullptr};
        set_item(names.unfilled, type_key_, names.message);
        for (const auto& field : message.fields) {
            names.fields.push_back(interned(field.name));
            const auto& name = names.fields.back();
            set_item(names.unfilled, name, nb::none());
            const bool ambiguous = std::ranges::find(of_header, field.name) != std::end(of_header);
            const bool taken = !ambiguous && PyObject_HasAttr(message_type.ptr(), name.ptr()) != 0;
            names.attributes.push_back(taken ? nullptr : name.ptr());
            names.ambiguous.push_back(ambiguous);
            if (field.name == "time_boot_ms" || (field.name == "usec" && names.clock == nullptr)) names.clock = &field;
        }
        names_.push_back(std::move(names));
    }
}

std::shared_ptr<const Definitions> Definitions::builtin() {
    // Uses a mutex of its own, not the hidden lock of a static object's initialization. Without a GIL, a thread that
    // waits for the hidden lock blocks the garbage collector. The initializing thread may have to wait for the
    // collector, which would be a deadlock.
    static nb::ft_mutex making;
    // Never destroyed: that would need the interpreter.
    static const std::shared_ptr<const Definitions>* made = nullptr;
    const nb::ft_lock_guard lock(making);
    if (made == nullptr)
        made = new auto(std::make_shared<const Definitions>(dialect::default_dialect(), std::string(), std::string()));
    return *made;
}

std::shared_ptr<const Definitions> Definitions::load(const std::string& path) {
    auto key = key_of(path);  // before the file is read: a change meanwhile makes another key for later readers
    auto dialect = [&] {
        const WithoutGil outside;
        auto own = dialect::Dialect::load(path);
        return own ? dialect::default_dialect().with(*own) : std::move(own);
    }();
    return std::make_shared<Definitions>(value_or_raise(std::move(dialect)), path, std::move(key));
}

std::shared_ptr<const Definitions> definitions_of(const nb::object& dialect) {
    if (dialect.is_none()) return Definitions::builtin();
    if (!nb::isinstance<PyDialect>(dialect)) {
        PyErr_Format(PyExc_TypeError, "dialect= takes a mavloom.Dialect, not %R", dialect.ptr());
        throw nb::python_error();
    }
    return nb::inst_ptr<PyDialect>(dialect)->definitions;
}

std::shared_ptr<MavutilStyle> style_of(const nb::object& dialect) {
    return nb::isinstance<PyDialect>(dialect) ? nb::inst_ptr<PyDialect>(dialect)->style : nullptr;
}

void bind_dialect(nb::module_& module) {
    bind_infos(module);
    module.def(
        "dialect_key",
        [](const PyDialect& dialect) {
            const auto& key = dialect.definitions->key();
            return nb::bytes(key.data(), key.size());
        },
        nb::arg("dialect"),
        "Equal for dialects that were read from the same state of one file; empty for the built-in definitions.");
    nb::class_<PyDialect>(
        module, "Dialect", nb::is_final(),
        "Message definitions: the built-in ones. If `path` is given, the definitions of that XML file and\n"
        "its includes are added, or replace built-in ones.\n\n"
        "A process may hold several. Immutable and safe from any thread. InputError names file and line\n"
        "of an error in the XML.")
        .def(
            "__init__",
            [](PyDialect* self, const nb::object& path) {
                if (path.is_none()) {
                    new (self) PyDialect{Definitions::builtin(), nullptr};
                    return;
                }
                new (self) PyDialect{Definitions::load(path_of(path)), nullptr};
            },
            nb::arg("path") = nb::none(),
            nb::sig("def __init__(self, path: str | os.PathLike[str] | None = None) -> None"))
        .def_prop_ro("path", &path_or_none, nb::sig("def path(self) -> str | None"),
                     "The XML file; None for the built-in definitions.")
        .def_prop_ro("message_names", &message_names, nb::sig("def message_names(self) -> list[str]"),
                     "The message names, by ascending id.")
        .def_prop_ro("enum_names", &enum_names, nb::sig("def enum_names(self) -> list[str]"))
        .def("enum_entries", &enum_entries,
             nb::sig("def enum_entries(self, name: str, /) -> tuple[bool, dict[str, int]]"))
        .def(
            "enum",
            [](nb::handle self, nb::handle name) {
                return nb::module_::import_("mavloom._enums").attr("make")(self, name);
            },
            nb::arg("name"), nb::sig("def enum(self, name: str) -> type[IntEnum] | type[IntFlag]"),
            "Returns the enum as a class: an IntFlag for flags, else an IntEnum. UsageError suggests the\n"
            "nearest name.")
        .def_prop_ro(
            "enums", [](nb::handle self) { return nb::module_::import_("mavloom._enums").attr("Enums")(self); },
            nb::sig("def enums(self) -> collections.abc.Mapping[str, collections.abc.Mapping[int, IntEnum | "
                    "IntFlag]]"),
            "The enums in pymavlink's form: dialect.enums[\"MAV_CMD\"][16].name.")
        .def("__getitem__", &find, nb::sig("def __getitem__(self, name_or_id: str | int, /) -> MessageInfo"),
             "Returns the definition of a message. For an unknown name, raises UsageError (a ValueError) that\n"
             "suggests the nearest one.")
        .def("__contains__", &contains, nb::sig("def __contains__(self, name_or_id: str | int, /) -> bool"))
        .def(
            "__len__", [](const PyDialect& d) { return d.definitions->dialect().messages().size(); },
            "The number of messages.")
        .def("encode", &encode, nb::arg(), nb::kw_only(), nb::arg("source_system") = nb::none(),
             nb::arg("source_component") = nb::none(), nb::arg("frame_seq") = nb::none(),
             nb::arg("frame_version") = nb::none(), nb::arg("fields"),
             nb::sig(
                 "def encode(self, message: str | Message, /, *, source_system: int | None = None, source_component: "
                 "int | None = None, "
                 "frame_seq: int | None = None, frame_version: int | None = None, **fields: typing.Any) -> bytes"),
             "Returns one whole frame. `message` is a name or a Message.\n\n"
             "- For a name, the header defaults to 255/193, sequence 0, MAVLink 2, and fields that are not\n"
             "  given are 0 (HEARTBEAT.mavlink_version is 3).\n"
             "- For a Message, header and fields that are not given are those of the Message.\n"
             "  encode(decode(frame)) == frame for unsigned frames.\n\n"
             "Values are numbers or names of enum entries (\"A|B\" for flags), str (encoded as UTF-8) or bytes\n"
             "for char[], and sequences of the right length for arrays. A float may also be given as its bytes,\n"
             "little-endian. A value that does not fit raises UsageError (a ValueError) that names message, field\n"
             "and range.")
        .def("message", &make, nb::arg(), nb::arg("fields"),
             nb::sig("def message(self, name: str | Message, /, **fields: typing.Any) -> Message"),
             "Returns a Message with header 255/193 and time 0. Fields are given as for `encode`.")
        .def("decode", &decode_bytes, nb::arg("frame"), nb::arg("time_ns") = 0,
             nb::sig("def decode(self, frame: Buffer, time_ns: int = 0) -> Message"),
             "Decodes one whole frame (any bytes-like object, which is copied). Raises InputError if the bytes\n"
             "are not exactly one frame or the checksum is wrong.\n\n"
             "A frame whose id has no definition gives a Message without name and fields. Signatures are not\n"
             "checked.")
        .def(
            "__reduce__",
            [](nb::handle self) {
                return nb::make_tuple(nb::module_::import_("mavloom._pickle").attr("restore_dialect"),
                                      nb::make_tuple(path_or_none(*nb::inst_ptr<PyDialect>(self))));
            },
            nb::sig("def __reduce__(self) -> tuple[typing.Any, ...]"))
        .def("__repr__", [](const PyDialect& d) {
            return d.definitions->path().empty() ? std::string("Dialect()")
                                                 : fmt::format("Dialect('{}')", d.definitions->path());
        });
}

}  // namespace mavloom::python
