// SPDX-License-Identifier: MIT
// Class Parser: finds the frames in bytes that arrive in chunks of any size.
#include <nanobind/nanobind.h>

#include <mutex>

#include "bindings.hpp"
#include "counters_repr.hpp"
#include "gil.hpp"
#include "integer.hpp"
#include "mavloom/feed/frame_batch.hpp"
#include "mavloom/wire/stream_parser.hpp"
#include "message/encode.hpp"

namespace mavloom::python {
namespace {

class Parser {
public:
    explicit Parser(const nb::object& dialect)
        : origin_(std::make_shared<Origin>(dialect)), parser_(origin_->dialect().wire_table()) {}

    nb::list feed(const nb::object& data, const Integer& time_ns) {
        const Buffer buffer(data);
        return parse([&](auto sink) { parser_.feed(buffer.bytes(), mono_now(), sink); },
                     time_ns.in<std::int64_t>("time_ns"));
    }
    nb::list finish(const Integer& time_ns) {
        return parse([&](auto sink) { parser_.finish(sink); }, time_ns.in<std::int64_t>("time_ns"));
    }

    [[nodiscard]] const wire::ParseCounters& counters() const noexcept { return parser_.counters(); }

private:
    template <class Work>
    nb::list parse(Work work, std::int64_t time_ns) {
        const auto lock = lock_without_gil(mutex_);
        batch_.clear();
        {
            const WithoutGil outside;
            work([&](const wire::ParseEvent& event) {
                if (event.kind != wire::ParseEvent::Kind::frame) return;
                batch_.add({.time_ns = time_ns, .definition = origin_->dialect().find(event.frame.id())}, event.frame);
            });
        }
        nb::list messages;
        while (const auto* item = batch_.next())
            messages.append(make_message(origin_, item->definition, item->time_ns, 0, batch_.frame(*item)));
        return messages;
    }

    std::shared_ptr<const Origin> origin_;
    std::mutex mutex_;
    wire::StreamParser parser_;  // parser_ and batch_ are guarded by mutex_
    feed::FrameBatch batch_;
};

template <auto member>
auto counter() {
    return [](const Parser& parser) { return (parser.counters().*member).value(); };
}

}  // namespace

void bind_parser(nb::module_& module) {
    using wire::ParseCounters;
    nb::class_<Parser>(module, "Parser", nb::is_final(),
                       "Finds the messages in a byte stream. The result does not depend on how the stream is cut into\n"
                       "chunks. Damage is counted and never raises an error. Safe from any thread, one at a time. The\n"
                       "GIL is free while parsing.")
        .def(nb::init<const nb::object&>(), nb::arg("dialect") = nb::none(),
             nb::sig("def __init__(self, dialect: Dialect | None = None) -> None"))
        .def("feed", &Parser::feed, nb::arg("data"), nb::arg("time_ns") = 0,
             nb::sig("def feed(self, data: Buffer, time_ns: int = 0) -> list[Message]"),
             "Returns the messages that end in this chunk (any bytes-like object), all with this time.")
        .def("finish", &Parser::finish, nb::arg("time_ns") = 0,
             nb::sig("def finish(self, time_ns: int = 0) -> list[Message]"),
             "Ends the stream: returns the messages in the bytes that were held back, and counts the rest as\n"
             "junk.")
        .def_prop_ro("frames", counter<&ParseCounters::frames>(), "The number of valid frames.")
        .def_prop_ro("unknown_ids", counter<&ParseCounters::unknown_ids>(),
                     "Valid frames whose id has no definition; `frames` includes them.")
        .def_prop_ro("crc_error", counter<&ParseCounters::crc_error>(), "Apparent frames with a wrong checksum.")
        .def_prop_ro("unknown_flags", counter<&ParseCounters::unknown_flags>(),
                     "Frames that were left out because of an undefined incompatibility flag.")
        .def_prop_ro("junk_bytes", counter<&ParseCounters::junk_bytes>(), "Bytes that belong to no frame.")
        .def("__repr__", &counters_repr);
}

}  // namespace mavloom::python
