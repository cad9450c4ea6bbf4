// SPDX-License-Identifier: MIT
// Class RecordingWriter: writes messages to a tlog.
#include <fmt/format.h>
#include <nanobind/nanobind.h>

#include <limits>
#include <mutex>
#include <optional>

#include "bindings.hpp"
#include "errors.hpp"
#include "gil.hpp"
#include "integer.hpp"
#include "mavloom/base/counted.hpp"
#include "mavloom/record/rotating_writer.hpp"
#include "mavutil/message.hpp"
#include "message/encode.hpp"
#include "strings.hpp"

namespace mavloom::python {
namespace {

constexpr auto latest_time = std::numeric_limits<std::int64_t>::max();  // in ns; a tlog has no times before 1970

class RecordingWriter {
public:
    RecordingWriter(std::string path, const nb::object& dialect)
        : path_(std::move(path)), definitions_(definitions_of(dialect)) {
        auto opened = [&] {
            const WithoutGil outside;
            return record::RotatingWriter::create(path_);
        }();
        writer_.emplace(value_or_raise(std::move(opened)));
    }

    // A Message has a time; bytes of a frame are written with the present time, unless one is given.
    void write(const nb::object& message, const OptionalInteger& time_ns) {
        std::optional<std::int64_t> given;
        if (time_ns) given = time_ns->in<std::int64_t>("time_ns", 0, latest_time);
        if (nb::isinstance<Message>(message)) {
            const auto& of = *nb::inst_ptr<Message>(message);
            return put(of.frame(), given.value_or(of.time_ns));
        }
        const auto now = wall_now().time_since_epoch().count();
        if (const auto* of = mavutil_message(message)) {
            if (of->base.size == 0)
                raise_usage("this message was not packed or sent yet, so it has no frame to record");
            return put(of->base.frame(), given.value_or(of->base.time_ns == 0 ? now : of->base.time_ns));
        }
        const Buffer buffer(message);
        put(whole_frame(definitions_->dialect(), buffer.bytes()), given.value_or(now));
    }

    void flush() {
        warn_if_removed([&](record::RotatingWriter& writer) {
            const WithoutGil outside;
            return writer.flush();
        });
    }

    void close() {
        if (const auto notice = close_file(); !notice.empty()) warn(notice);
    }

    [[nodiscard]] const std::string& path() const noexcept { return path_; }
    [[nodiscard]] std::uint64_t records() {
        const auto lock = lock_without_gil(mutex_);
        return writer_ ? writer_->taken_records() : records_;
    }

private:
    void put(const wire::FrameView& frame, std::int64_t time_ns) {
        warn_if_removed(
            [&](record::RotatingWriter& writer) { return writer.write(WallTime{Nanoseconds{time_ns}}, frame); });
    }
    // Looks after the file, then calls work(writer).
    template <class Work>
    void warn_if_removed(Work work) {
        const auto notice = [&] {
            const auto lock = lock_without_gil(mutex_);
            if (!writer_) raise_closed(path_ + ": the recording is closed");
            const auto removed = value_or_raise(writer_->maintain(mono_now()));
            value_or_raise(work(*writer_));
            return removed.empty() ? std::string() : writer_->removal_notice(removed);
        }();
        if (!notice.empty()) warn(notice);
    }
    // Returns the notice that the file was removed; empty if it is there.
    std::string close_file() {
        const auto lock = lock_without_gil(mutex_);
        if (!writer_) return {};
        auto removed = [&] {
            const WithoutGil outside;
            return writer_->close();
        }();
        auto notice = removed && !removed->empty() ? writer_->removal_notice(*removed) : std::string();
        records_ = writer_->written_records();
        writer_.reset();
        value_or_raise(std::move(removed));
        return notice;
    }

    const std::string path_;
    const std::shared_ptr<const Definitions> definitions_;
    std::mutex mutex_;
    // Guarded by mutex_:
    std::optional<record::RotatingWriter> writer_;  // empty: closed
    std::uint64_t records_ = 0;
};

}  // namespace

void bind_recording_writer(nb::module_& module) {
    nb::class_<RecordingWriter>(
        module, "RecordingWriter", nb::is_final(),
        "Writes messages to a tlog, which any MAVLink tool reads. A file that exists at this path is\n"
        "renamed to PATH.1, PATH.2, ...; none is overwritten.\n\n"
        "Records are buffered: `flush` and `close` write them to the file, and `write` does so twice a\n"
        "second. Use `with`. Safe from any thread. SystemFailure reports a full disk.\n\n"
        "If another program removes or replaces the file, these functions begin a new one and issue a\n"
        "RuntimeWarning. What was written before is in the old file.")
        .def(
            "__init__",
            [](RecordingWriter* self, const nb::object& path, const nb::object& dialect) {
                new (self) RecordingWriter(path_of(path), dialect);
            },
            nb::arg("path"), nb::kw_only(), nb::arg("dialect") = nb::none(),
            nb::sig("def __init__(self, path: str | os.PathLike[str], *, dialect: Dialect | None = None) -> None"))
        .def("write", &RecordingWriter::write, nb::arg("message"), nb::arg("time_ns") = nb::none(),
             nb::sig("def write(self, message: Message | MavutilMessage | Buffer, time_ns: int | None = None) -> None"),
             "Appends a Message, or the bytes of one whole frame. The time is that of the message; for bytes\n"
             "it is the current time. `time_ns` replaces it.")
        .def("flush", &RecordingWriter::flush, "Writes the buffered records to the file.")
        .def("close", &RecordingWriter::close,
             "Writes the buffered records, waits for the disk and closes the file. May be called again.")
        .def_prop_ro("path", &RecordingWriter::path)
        .def_prop_ro("records", &RecordingWriter::records, "The number of records written or buffered.")
        .def(
            "__enter__", [](nb::object self) { return self; }, nb::sig("def __enter__(self) -> RecordingWriter"))
        .def(
            "__exit__", [](RecordingWriter& writer, const nb::args&) { writer.close(); },
            nb::sig("def __exit__(self, *args: object) -> None"))
        .def("__repr__", [](RecordingWriter& writer) {
            return fmt::format("<RecordingWriter {}: {}>", writer.path(), counted(writer.records(), "record"));
        });
}

}  // namespace mavloom::python
