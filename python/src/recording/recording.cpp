// SPDX-License-Identifier: MIT
// class Recording: the messages of a tlog, read in batches without the GIL.
#include <fmt/format.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>

#include <mutex>
#include <optional>

#include "bindings.hpp"
#include "counters_repr.hpp"
#include "errors.hpp"
#include "gil.hpp"
#include "iteration.hpp"
#include "mavloom/base/counted.hpp"
#include "mavloom/feed/frame_batch.hpp"
#include "mavloom/feed/sliced_mutex.hpp"
#include "mavloom/record/tlog_reader.hpp"
#include "message/filter.hpp"
#include "message/message.hpp"
#include "recording/progress.hpp"
#include "recording/summary.hpp"
#include "strings.hpp"
#include "waiting.hpp"

namespace mavloom::python {
namespace {

struct RecordingStats {
    std::uint64_t records, record_bytes, unknown_ids, unknown_flags, junk_bytes, damaged_places;
};

class Recording {
public:
    Recording(std::string path, const nb::object& dialect, const nb::object& type, const OptionalInteger& system,
              const OptionalInteger& component, bool shows_progress)
        : path_(std::move(path)),
          shows_progress_(shows_progress),
          origin_(std::make_shared<Origin>(dialect)),
          filter_(make_filter(origin_->dialect(), type, system, component)),
          reader_(value_or_raise(open())) {
        if (shows_progress_) progress_ = Progress::on_stderr();
        origin_->link_names().add(LinkId{0}, "tlog://" + path_);
    }

    // Returns a new reference, or null at the end.
    PyObject* iterate() { return next_match({}, {}).release().ptr(); }

    nb::object recv_match(const nb::object& condition, const nb::object& type, const nb::object& blocking,
                          const nb::object& timeout, const OptionalInteger& system, const OptionalInteger& component) {
        check_condition(condition);
        const auto filter = make_filter(origin_->dialect(), type, system, component);
        const Limit limit(match_timeout(blocking, timeout));
        for (;;) {
            nb::object message = next_match(filter, limit);
            if (!message.is_valid()) return nb::none();
            if (condition.is_none() || nb::cast<bool>(nb::bool_(condition(message)))) return message;
            if (limit.is_over()) return nb::none();
        }
    }

    void rewind() {
        const auto lock = lock_without_gil(mutex_);
        value_or_raise(reader().seek(0));
        progress_.restart();
        batch_.clear();
        delivered_ = 0;
        ended_ = false;
    }

    [[nodiscard]] double percent() {
        const auto lock = lock_without_gil(mutex_);
        const auto& file = reader();
        if (ended_ && batch_.size() == delivered_) return 100;
        return file.size() == 0 ? 0 : 100.0 * static_cast<double>(file.position()) / static_cast<double>(file.size());
    }

    // For a repr, which works on a closed recording too.
    [[nodiscard]] std::string shown() {
        const auto lock = lock_without_gil(mutex_);
        if (!reader_) return fmt::format("<Recording {}, closed>", path_);
        return fmt::format("<Recording {}: {} read>", path_, counted(reader_->counters().records.value(), "record"));
    }

    [[nodiscard]] RecordingStats stats() {
        const auto lock = lock_without_gil(mutex_);
        if (reader_) note_counters();
        return stats_;
    }

    void close() {
        const auto lock = lock_without_gil(mutex_);
        if (!reader_) return;
        note_counters();
        progress_.clear();
        reader_.reset();
        batch_.clear();
    }

    [[nodiscard]] RecordingSummary summary() const { return summary_of(path_, origin_, shows_progress_); }

    [[nodiscard]] const std::string& path() const noexcept { return path_; }

private:
    static constexpr std::size_t batch_frames = 512;
    static constexpr std::uint64_t max_damage = 1 << 20;  // bytes to read before signals are handled

    // When a call gives up. A poll (time-out 0) looks at everything that is available: for a file, all of it.
    struct Limit {
        Limit() = default;
        explicit Limit(std::optional<Nanoseconds> timeout)
            : deadline(deadline_after(timeout)), polls(timeout == Nanoseconds{}) {}
        [[nodiscard]] bool is_over() const { return !polls && mono_now() >= deadline; }

        MonoTime deadline = MonoTime::max();
        bool polls = false;
    };

    [[nodiscard]] SetupResult<record::TlogReader> open() const {
        const WithoutGil outside;
        return record::TlogReader::open(path_, origin_->dialect().wire_table(), record::File::Empty::report);
    }

    record::TlogReader& reader() {
        if (!reader_) raise_closed(path_ + ": the recording is closed");
        return *reader_;
    }

    void note_counters() {
        const auto& c = reader_->counters();
        stats_ = {c.records.value(),       c.record_bytes.value(), c.unknown_ids.value(),
                  c.unknown_flags.value(), c.lost_bytes.value(),   c.damaged_places.value()};
    }

    // Returns an invalid object at the end or when the limit is reached. Signal handlers run without the lock, because
    // they may use the recording.
    nb::object next_match(const dialect::Filter& filter, const Limit& limit) {
        for (;; check_signals()) {
            const auto lock = lock_without_gil(mutex_);
            reader();
            while (const auto* item = batch_.next()) {
                ++delivered_;
                const auto frame = batch_.frame(*item);
                if (filter.admits(frame)) return make_message(origin_, item->definition, item->time_ns, 0, frame);
            }
            if (ended_ || limit.is_over()) return {};
            if (fill()) continue;
            if (mono_now() >= limit.deadline) return {};
            const WithoutGil outside;
            const auto left = feed::end_of_slice(limit.deadline) - mono_now();
            static_cast<void>(reader_->wait(std::chrono::ceil<std::chrono::milliseconds>(left)));
        }
    }

    // Reads the next batch. Returns false if a pipe is empty. A pipe is read one frame at a time, so that no frame is
    // held back.
    bool fill() {
        batch_.clear();
        delivered_ = 0;
        auto& file = reader();
        show_progress(file);
        auto stop = std::optional<record::TlogReader::Stop>();
        {
            const WithoutGil outside;
            const std::size_t wanted = file.is_file() ? batch_frames : 1;
            for (std::size_t read = 0; read < batch_frames && batch_.size() < wanted && !stop; ++read) {
                const auto record = file.next(max_damage);
                if (!record) stop = record.error();
                else if (filter_.admits(record->frame)) add(*record);
            }
        }
        using Stop = record::TlogReader::Stop;
        ended_ = stop == Stop::end;
        if (ended_) progress_.clear();
        if (stop == Stop::failed && batch_.size() == 0) raise(file.error());
        if (ended_ && file.found_no_record()) raise(file.no_record_error());
        return stop != Stop::nothing_yet || batch_.size() != 0;
    }

    void show_progress(const record::TlogReader& file) {
        if (!progress_.is_due()) return;
        const auto part = file.size() == 0
                              ? std::nullopt
                              : std::optional(static_cast<double>(file.position()) / static_cast<double>(file.size()));
        progress_.show({.frames = file.counters().records.value(), .bytes = file.position(), .part = part});
    }

    void add(const record::Record& record) {
        const auto* definition = record.info == nullptr ? nullptr : origin_->dialect().find(record.frame.id());
        batch_.add({.time_ns = record.time.time_since_epoch().count(), .definition = definition}, record.frame);
    }

    const std::string path_;
    const bool shows_progress_;
    const std::shared_ptr<Origin> origin_;
    const dialect::Filter filter_;
    std::mutex mutex_;
    // Guarded by mutex_:
    std::optional<record::TlogReader> reader_;  // empty: closed
    feed::FrameBatch batch_;
    std::size_t delivered_ = 0;  // frames of batch_ that were delivered
    bool ended_ = false;
    RecordingStats stats_{};
    Progress progress_;
};

}  // namespace

void bind_recording(nb::module_& module) {
    nb::class_<RecordingStats>(module, "RecordingStats", "What was read so far. Every byte of the file counts once.")
        .def_ro("records", &RecordingStats::records)
        .def_ro("record_bytes", &RecordingStats::record_bytes)
        .def_ro("unknown_ids", &RecordingStats::unknown_ids,
                "Records whose message id has no definition; `records` includes them.")
        .def_ro("unknown_flags", &RecordingStats::unknown_flags,
                "Records that were left out because of an undefined incompatibility flag.")
        .def_ro("junk_bytes", &RecordingStats::junk_bytes,
                "Bytes that are damaged, or belong to a record cut off at the end.")
        .def_ro("damaged_places", &RecordingStats::damaged_places, "Contiguous runs of junk bytes.")
        .def("__repr__", &counters_repr);

    nb::class_<Recording>(
        module, "Recording", nb::type_slots(iterator_slots<Recording>), nb::is_final(),
        "Iterates over the messages of a tlog once, in the order of the file. `rewind()` starts again.\n\n"
        "Damage is skipped and counted in `stats`. If reading fails in the middle of the file, the\n"
        "messages before the failure are returned first, then the error is raised. Safe from any thread,\n"
        "one at a time. The GIL is free while reading. `close()`, the end of `with`, and the destruction\n"
        "of the object close the file.\n\n"
        "With `progress=True`, iteration and `summary()` show on stderr how much is read and how long the\n"
        "rest will take, if stderr is a terminal.")
        .def(
            "__init__",
            [](Recording* self, const nb::object& path, const nb::object& type, const OptionalInteger& system,
               const OptionalInteger& component, const nb::object& dialect,
               bool progress) { new (self) Recording(path_of(path), dialect, type, system, component, progress); },
            nb::arg("path"), nb::kw_only(), nb::arg("type") = nb::none(), nb::arg("system") = nb::none(),
            nb::arg("component") = nb::none(), nb::arg("dialect") = nb::none(), nb::arg("progress") = false,
            nb::sig("def __init__(self, path: str | os.PathLike[str], *, type: MessageTypes | None = None, system: int "
                    "| None = None, "
                    "component: int | None = None, dialect: Dialect | None = None, progress: bool = False) -> None"))
        .def(
            "recv_match", &Recording::recv_match, nb::arg("condition") = nb::none(), nb::arg("type") = nb::none(),
            nb::arg("blocking") = nb::none(), nb::arg("timeout") = nb::none(), nb::arg("system") = nb::none(),
            nb::arg("component") = nb::none(),
            nb::sig(
                "def recv_match(self, condition: collections.abc.Callable[[Message], object] | None = None, type: "
                "MessageTypes | None = None, "
                "blocking: bool | None = None, timeout: float | None = None, system: int | None = None, component: int "
                "| None = None) -> Message | None"),
            "Returns the next message of these types for which `condition(message)` is true. Returns None at\n"
            "the end, or if none was found within `timeout` seconds. Without a time-out it searches the whole\n"
            "file.\n\n"
            "Only a pipe makes it wait: at most `timeout` seconds, indefinitely with `blocking=True` and no\n"
            "time-out, and not at all with `blocking=False` or without both.")
        .def(
            "recv",
            [](Recording& r, const nb::object& timeout) {
                return r.recv_match(nb::none(), nb::none(), nb::bool_(true), timeout, {}, {});
            },
            nb::arg("timeout") = nb::none(), nb::sig("def recv(self, timeout: float | None = None) -> Message | None"),
            "Returns the next message, or None at the end, or if a pipe has none for `timeout` seconds.")
        .def("summary", &Recording::summary,
             "Returns what happened in the recording: vehicles, modes, distance, warnings, losses and more.\n\n"
             "It reads the whole file, whatever messages are selected, and does not change which message\n"
             "comes next. A pipe has no summary.")
        .def("rewind", &Recording::rewind, "Starts again at the beginning. Bytes that are read again count again.")
        .def_prop_ro("percent", &Recording::percent, "The percentage of the file that was read, 0 to 100.")
        .def_prop_ro("stats", &Recording::stats, "A snapshot of the counters, as RecordingStats.")
        .def_prop_ro("path", &Recording::path)
        .def("__repr__", &Recording::shown)
        .def("close", &Recording::close, "Closes the file. May be called again. Later reads raise ClosedError.")
        .def(
            "__enter__", [](nb::object self) { return self; }, nb::sig("def __enter__(self) -> Recording"))
        .def(
            "__exit__", [](Recording& r, const nb::args&) { r.close(); },
            nb::sig("def __exit__(self, *args: object) -> None"));
}

}  // namespace mavloom::python
