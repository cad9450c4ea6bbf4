// SPDX-License-Identifier: MIT
#include "message/encode.hpp"

#include <fmt/format.h>

#include <cstring>
#include <string>
#include <string_view>

#include "errors.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/wire/frame_checksum.hpp"
#include "strings.hpp"

namespace mavloom::python {
namespace {

using dialect::Field;
using message::MessageBuilder;

bool is_real(const Field& field) noexcept {
    return field.type == dialect::FieldType::f32 || field.type == dialect::FieldType::f64;
}

[[noreturn]] void refuse(const MessageBuilder& builder, const Field& field, std::string_view why) {
    raise_usage(fmt::format("{}.{}: {}", builder.definition().name, field.name, why));
}

// Clears a TypeError. Any other error is rethrown: KeyboardInterrupt, or what the value itself raised.
void clear_type_error() {
    if (!PyErr_ExceptionMatches(PyExc_TypeError)) throw nb::python_error();
    PyErr_Clear();
}

// `number` is an int.
void set_int(MessageBuilder& builder, const Field& field, const nb::object& number, std::size_t index) {
    int overflow = 0;
    const long long value = PyLong_AsLongLongAndOverflow(number.ptr(), &overflow);
    if (overflow == 0) return value_or_raise(builder.set_integer(field, value, index));
    if (overflow > 0) {
        const unsigned long long large = PyLong_AsUnsignedLongLong(number.ptr());
        if (PyErr_Occurred() == nullptr) return value_or_raise(builder.set_unsigned(field, large, index));
        PyErr_Clear();
    }
    if (is_real(field)) {
        const double real = PyLong_AsDouble(number.ptr());
        if (PyErr_Occurred() == nullptr) return value_or_raise(builder.set_number(field, real, index));
        PyErr_Clear();
    }
    refuse(builder, field, fmt::format("{} is out of range", digits_of(number)));
}

void set_number(MessageBuilder& builder, const Field& field, const nb::handle& value, std::size_t index) {
    if (!PyFloat_Check(value.ptr()) && PyIndex_Check(value.ptr()) != 0) {
        const nb::object number = nb::steal(PyNumber_Index(value.ptr()));
        if (!number.is_valid()) throw nb::python_error();
        return set_int(builder, field, number, index);
    }
    const double real = PyFloat_AsDouble(value.ptr());
    if (PyErr_Occurred() != nullptr) {
        clear_type_error();
        refuse(builder, field, fmt::format("expected a number, not {}", escaped(nb::repr(value))));
    }
    value_or_raise(builder.set_number(field, real, index));
}

// Lone surrogates, which stand for bytes that are not UTF-8, cannot be sent as text.
std::string_view utf8_or_raise(const nb::handle& text) {
    if (const auto utf8 = utf8_of(text.ptr())) return *utf8;
    PyErr_Clear();
    raise_usage(fmt::format("{} cannot be encoded as UTF-8; pass bytes instead", escaped(nb::repr(text))));
}

void set_text(MessageBuilder& builder, const Field& field, const nb::object& value) {
    if (PyUnicode_Check(value.ptr())) return value_or_raise(builder.set_text(field, utf8_or_raise(value)));
    if (PyObject_CheckBuffer(value.ptr()) == 0)
        refuse(builder, field, fmt::format("expected str or bytes, not {}", escaped(nb::repr(value))));
    const Buffer buffer(value);
    const auto bytes = buffer.bytes();
    value_or_raise(builder.set_text(field, {reinterpret_cast<const char*>(bytes.data()), bytes.size()}));
}

void set_array(MessageBuilder& builder, const Field& field, const nb::object& values) {
    const nb::object list = nb::steal(PySequence_Fast(values.ptr(), ""));
    if (!list.is_valid()) {
        clear_type_error();
        refuse(builder, field,
               fmt::format("expected a sequence of {} numbers, not {}", field.count(), escaped(nb::repr(values))));
    }
    const auto given = static_cast<std::size_t>(PySequence_Fast_GET_SIZE(list.ptr()));
    if (given != field.count())
        refuse(builder, field, fmt::format("expected {} elements, not {}", field.count(), given));
    for (std::size_t i = 0; i < given; ++i)
        set_number(builder, field, PySequence_Fast_GET_ITEM(list.ptr(), static_cast<Py_ssize_t>(i)), i);
}

// The bytes of a float, for protocols that put other values into it (PX4's integer parameters).
void set_real_bytes(MessageBuilder& builder, const Field& field, const nb::object& value) {
    const ByteView bytes(reinterpret_cast<const std::uint8_t*>(PyBytes_AS_STRING(value.ptr())),
                         static_cast<std::size_t>(PyBytes_GET_SIZE(value.ptr())));
    if (bytes.size() != field.size())
        refuse(builder, field,
               fmt::format("expected a number, or its {} bytes, not {} bytes", field.size(), bytes.size()));
    if (bytes.size() == sizeof(std::uint32_t)) builder.put(field, load_le<std::uint32_t>(bytes.data()));
    else builder.put(field, load_le<std::uint64_t>(bytes.data()));
}

void set_value(MessageBuilder& builder, const Field& field, const nb::object& value) {
    if (field.type == dialect::FieldType::char8) return set_text(builder, field, value);
    if (PyUnicode_Check(value.ptr())) {  // the name of an enum entry, A|B for flags
        if (field.enumeration == nullptr || field.is_array()) refuse(builder, field, "expected a number, not text");
        return value_or_raise(builder.set_from_text(field, utf8_or_raise(value)));
    }
    if (field.is_array()) return set_array(builder, field, value);
    if (is_real(field) && PyBytes_Check(value.ptr())) return set_real_bytes(builder, field, value);
    set_number(builder, field, value, 0);
}

// Whether a buffer's format (PEP 3118) includes Python objects. Names in it stand between colons.
bool has_objects(const char* format) {
    if (format == nullptr || std::strchr(format, 'O') == nullptr) return false;
    bool is_name = false;
    for (; *format != '\0'; ++format) {
        if (*format == ':') is_name = !is_name;
        if (*format == 'O' && !is_name) return true;
    }
    return false;
}

// Whether an array holds Python objects. Not detected if the object does not declare it, as with packed ctypes
// structures.
bool has_objects(const nb::object& array) {
    if (PyBytes_Check(array.ptr()) || PyByteArray_Check(array.ptr())) return false;
    if (PyMemoryView_Check(array.ptr())) return has_objects(PyMemoryView_GET_BUFFER(array.ptr())->format);
    const nb::object type = nb::getattr(array, "dtype", nb::none());
    if (!type.is_none()) return nb::cast<bool>(nb::bool_(nb::getattr(type, "hasobject", nb::bool_(false))));
    Py_buffer view;
    if (PyObject_GetBuffer(array.ptr(), &view, PyBUF_ND | PyBUF_FORMAT) != 0) {
        PyErr_Clear();
        return false;
    }
    const bool has = has_objects(view.format);
    PyBuffer_Release(&view);
    return has;
}

}  // namespace

Buffer::Buffer(const nb::object& object) {
    if (PyObject_CheckBuffer(object.ptr()) != 0 && has_objects(object))
        raise_usage("expected bytes, not an array of Python objects");
    if (PyObject_GetBuffer(object.ptr(), &view_, PyBUF_SIMPLE) != 0) throw nb::python_error();
}

void set_fields(const dialect::Dialect& dialect, MessageBuilder& builder, const nb::kwargs& fields) {
    for (const auto& [key, value] : fields) {
        const auto name = utf8_or_raise(key);
        const auto* field = builder.definition().find(name);
        if (field == nullptr)
            // This error suggests the nearest name.
            raise(dialect.field(fmt::format("{}.{}", builder.definition().name, name)).error());
        set_value(builder, *field, nb::borrow(value));
    }
}

// A HEARTBEAT states the version of the protocol, which is 3 for MAVLink 1 and 2. All other fields are 0.
static void set_defaults(MessageBuilder& builder) {
    const auto& definition = builder.definition();
    if (definition.id() != msg::Heartbeat::id) return;
    if (const auto* version = definition.find("mavlink_version")) value_or_raise(builder.set_integer(*version, 3));
}

MessageBuilder build(const Definitions& definitions, const nb::object& message, const nb::kwargs& fields) {
    const auto& dialect = definitions.dialect();
    if (PyUnicode_Check(message.ptr())) {
        MessageBuilder builder(*value_or_raise(dialect.message(utf8_or_raise(message))));
        set_defaults(builder);
        set_fields(dialect, builder, fields);
        return builder;
    }
    if (!nb::isinstance<Message>(message)) {
        PyErr_Format(PyExc_TypeError, "expected the name of a message, or a Message, not %R", message.ptr());
        throw nb::python_error();
    }
    const auto& given = *nb::inst_ptr<Message>(message);
    if (given.definition == nullptr)
        raise_usage(fmt::format("UNKNOWN_{} has no definition: its `frame` can only be passed on as it is",
                                given.frame().id().value));
    MessageBuilder builder(*given.definition, given.frame().payload());
    set_fields(given.origin->dialect(), builder, fields);
    return builder;
}

wire::Version version_of(const char* what, const Integer& given) {
    return given.in<int>(what, 1, 2) == 1 ? wire::Version::v1 : wire::Version::v2;
}

void check_version(wire::Version version, const dialect::Message& message) {
    if (version == wire::Version::v1 && !wire::fits_v1(message.wire))
        raise_usage(fmt::format("{} has id {}: MAVLink 1 allows at most 255", message.name, message.id().value));
}

wire::FrameView write(wire::FrameBuffer& out, const wire::FrameHeader& header, const MessageBuilder& builder) {
    check_version(header.version, builder.definition());
    return wire::write_frame(out, header, builder.definition().wire, builder.payload());
}

wire::FrameView whole_frame(const dialect::Dialect& dialect, ByteView bytes) {
    const auto length = wire::frame_length(bytes);
    if (length == 0) raise_input("not a MAVLink frame: a frame begins with 0xfd or 0xfe and has at least 8 bytes");
    if (length != bytes.size())
        raise_input(fmt::format("{} bytes given, but the frame's header states {}", bytes.size(), length));
    const auto frame = wire::FrameView::unchecked(bytes);
    const auto* definition = dialect.find(frame.id());
    const auto before = wire::checksum_before_extra(frame);
    const bool good = definition == nullptr ? wire::crc_extra_between(before, frame.checksum()) >= 0
                                            : wire::crc_update(before, definition->wire.crc_extra) == frame.checksum();
    if (!good)
        raise_input(fmt::format("{}: wrong checksum: damaged, or encoded with another definition of the message",
                                definition == nullptr ? "an id without definition" : definition->name));
    if ((frame.incompat_flags() & ~wire::incompat_signed) != 0)
        raise_input(fmt::format("incompatibility flags {:#x}, which are not defined", frame.incompat_flags()));
    return frame;
}

nb::object decode(const std::shared_ptr<const Origin>& origin, ByteView bytes, std::int64_t time_ns) {
    const auto frame = whole_frame(origin->dialect(), bytes);
    return make_message(origin, origin->dialect().find(frame.id()), time_ns, 0, frame);
}

}  // namespace mavloom::python
