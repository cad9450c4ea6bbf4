// SPDX-License-Identifier: MIT
// Classes RingReader, Record and RecordBatch.
//
// A record's bytes are used through a View. The lease counts a View as in use as long as it lives, whatever was made of
// it. Counting the exports of the record would not suffice: numpy keeps the object behind a memoryview, but drops the
// memoryview itself.
#include <fmt/format.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <optional>
#include <span>

#include "bindings.hpp"
#include "errors.hpp"
#include "ring/reader.hpp"
#include "waiting.hpp"

namespace mavloom::python {
namespace {

constexpr std::size_t most_in_batch = 1024;
// How often to check whether another thread still uses what it read.
constexpr auto look_again = std::chrono::microseconds{100};
constexpr auto longest_patience = std::chrono::seconds{10};  // how long to wait for such a thread

// ---- what is given out

class View {
public:
    // `bytes_of(lease)` returns the bytes to view. It is called once they can no longer move.
    template <class BytesOf>
    View(std::shared_ptr<Lease> lease, BytesOf bytes_of) {
        if (!lease->is_copy()) lease->source()->fork().check();
        const auto look = lease->look();
        if (look == Lease::Look::refused)
            raise_usage("the record was released by a later read, release() or close(): copy what you keep");
        is_counted_ = look == Lease::Look::counted;
        lease_ = std::move(lease);
        bytes_ = bytes_of(*lease_);
        if (holds()) return;
        end();
        raise_taken_away();
    }
    View(View&& other) noexcept = default;
    View& operator=(View&&) = delete;
    ~View() { end(); }
    [[nodiscard]] ByteView bytes() const noexcept { return bytes_; }
    // Call after copying from the view: if this raises, the copy is not valid.
    void check() const {
        if (!holds()) raise_taken_away();
    }

private:
    [[nodiscard]] bool holds() const noexcept { return lease_->is_copy() || lease_->source()->holds(); }
    void end() noexcept {
        if (const auto lease = std::exchange(lease_, nullptr); lease && is_counted_) lease->look_away();
    }
    [[noreturn]] static void raise_taken_away() {
        raise_error("the writer took the record away from this reader (it evicts who is slow)");
    }

    std::shared_ptr<Lease> lease_;
    bool is_counted_ = false;
    ByteView bytes_;
};

// Type slots are C functions, so a C++ exception becomes Python's current error.
template <class Work>
int guarded(Work&& work) noexcept {
    try {
        return work();
    } catch (nb::python_error& error) {
        error.restore();
    } catch (const std::exception& error) {
        PyErr_SetString(PyExc_RuntimeError, error.what());
    }
    return -1;
}

bool is_ready(PyObject* self, Py_buffer* out) noexcept {
    out->obj = nullptr;
    if (!nb::inst_ready(self)) PyErr_SetString(PyExc_TypeError, "records are made by a RingReader");
    return nb::inst_ready(self);
}

int view_buffer(PyObject* self, Py_buffer* out, int flags) noexcept {
    if (!is_ready(self, out)) return -1;
    const auto bytes = nb::inst_ptr<View>(self)->bytes();
    // The const_cast is safe: the buffer is read-only.
    auto* const begin = const_cast<std::uint8_t*>(bytes.data());  // NOLINT(cppcoreguidelines-pro-type-const-cast)
    return PyBuffer_FillInfo(out, self, begin, static_cast<Py_ssize_t>(bytes.size()), 1, flags);
}

PyType_Slot view_slots[] = {
    {Py_bf_getbuffer, reinterpret_cast<void*>(view_buffer)},  // NOLINT
    {0, nullptr},
};

class Record {
public:
    explicit Record(Portion taken) : lease_(std::move(taken.lease)), index_(taken.first) {}

    [[nodiscard]] const shm::RingRecord& get() const noexcept { return lease_->records()[index_]; }
    [[nodiscard]] View look() const {
        return View(lease_, [this](const Lease& lease) { return lease.records()[index_].data; });
    }
    [[nodiscard]] nb::object view() const { return nb::cast(look()); }
    [[nodiscard]] nb::object data() const {
        if (!lease_->is_copy()) return nb::steal(PyMemoryView_FromObject(view().ptr()));
        const View view = look();
        return nb::bytes(view.bytes().data(), view.bytes().size());
    }

private:
    std::shared_ptr<Lease> lease_;
    std::size_t index_;
};

int record_buffer(PyObject* self, Py_buffer* out, int flags) noexcept {
    if (!is_ready(self, out)) return -1;
    return guarded([&] { return PyObject_GetBuffer(nb::inst_ptr<Record>(self)->view().ptr(), out, flags); });
}

// Never called, because the buffer belongs to the View. But only if a type has this slot does numpy.frombuffer keep its
// buffer; of other types it keeps the object alone.
void release_record_buffer(PyObject*, Py_buffer*) noexcept {}

PyType_Slot record_slots[] = {
    {Py_bf_releasebuffer, reinterpret_cast<void*>(release_record_buffer)},  // NOLINT
    {Py_bf_getbuffer, reinterpret_cast<void*>(record_buffer)},              // NOLINT
    {0, nullptr},
};

// ---- class RecordBatch

class Batch {
public:
    Batch(Portion taken, std::shared_ptr<RingSource> source)
        : lease_(std::move(taken.lease)), first_(taken.first), source_(std::move(source)) {}

    [[nodiscard]] std::size_t size() const noexcept { return records().size(); }
    [[nodiscard]] Record at(Py_ssize_t index) const {
        const auto count = static_cast<Py_ssize_t>(size());
        if (index < 0) index += count;
        if (index < 0 || index >= count) throw nb::index_error(fmt::format("a batch of {} records", count).c_str());
        return Record({lease_, first_ + static_cast<std::size_t>(index)});
    }
    void release() {
        fork_.check();
        const bool released = [&] {
            const WithoutGil outside;
            return source_->release(*lease_);
        }();
        if (!released) raise_buffer("a view of one of these records is still alive: release or delete it first");
    }

    [[nodiscard]] nb::object array(const nb::object& dtype) const {
        const auto numpy = nb::module_::import_("numpy");
        const nb::object type = numpy.attr("dtype")(dtype);
        if (nb::cast<bool>(type.attr("hasobject"))) raise_usage("a dtype with Python objects: a ring holds bytes");
        const View looking(lease_, [](const Lease&) { return ByteView(); });
        check_lengths(nb::cast<std::size_t>(type.attr("itemsize")));
        const auto records = this->records();
        const ByteView all(records.front().data.data(), (size() - 1) * distance() + records.front().data.size());
        const nb::object bytes = numpy.attr("frombuffer")(nb::cast(View(lease_, [&](const Lease&) { return all; })),
                                                          "u1");
        return numpy.attr("ndarray")(nb::arg("shape") = size(), nb::arg("dtype") = type, nb::arg("buffer") = bytes,
                                     nb::arg("strides") = nb::make_tuple(distance()));
    }

private:
    [[nodiscard]] std::span<const shm::RingRecord> records() const noexcept {
        return std::span(lease_->records()).subspan(first_);
    }
    void check_lengths(std::size_t expected) const {
        const auto records = this->records();
        for (std::size_t i = 0; i < records.size(); ++i)
            if (records[i].data.size() != expected)
                raise_usage(fmt::format("record {} of the batch has {} bytes, and the dtype {}", i,
                                        records[i].data.size(), expected));
        if (expected == 0) raise_usage("records without bytes make no array");
    }
    // The distance in memory from record to record. It is the same for all, because they lie in one piece and have
    // equal lengths.
    [[nodiscard]] std::size_t distance() const {
        const auto records = this->records();
        if (records.size() == 1) return records.front().data.size();
        return static_cast<std::size_t>(records[1].data.data() - records[0].data.data());
    }

    const BeforeFork fork_;
    std::shared_ptr<Lease> lease_;
    std::size_t first_;
    std::shared_ptr<RingSource> source_;
};

// ---- class RingReader

shm::ReaderOptions options_of(bool lossless, const std::string& start) {
    using From = shm::ReaderOptions::From;
    if (start != "newest" && start != "oldest")
        raise_usage(fmt::format("start='{}': expected newest or oldest", start));
    return {.lossless = lossless, .from = start == "oldest" ? From::oldest : From::newest};
}

class PyRingReader {
    using State = RingSource::State;

public:
    PyRingReader(const std::string& name, bool lossless, const std::string& start) {
        auto opened = [&, options = options_of(lossless, start)] {
            const WithoutGil outside;
            return shm::RingReader::open(name, options);
        }();
        source_ = std::make_shared<RingSource>(value_or_raise(std::move(opened)), lossless);
    }
    ~PyRingReader() {
        if (source_) source_->abandon();
    }
    PyRingReader(const PyRingReader&) = delete;
    PyRingReader& operator=(const PyRingReader&) = delete;

    // Returns an empty portion if nothing came in time, or if nothing will come because there is no writer.
    [[nodiscard]] Portion take(std::size_t most, MonoTime deadline) {
        Portion taken;
        check(take(most, deadline, taken));
        return taken;
    }
    // Returns an empty portion if there is no record. The descriptor then becomes readable when another call is
    // worthwhile.
    [[nodiscard]] Portion poll(std::size_t most) {
        Portion taken;
        const State state = take(most, MonoTime{}, taken);
        check(state);
        if (state == State::removed || (state == State::no_writer && source_->is_removed()))
            raise_closed(fmt::format("ring {} was removed or replaced: open it again", source_->name()));
        if (!taken.lease) source_->arm();
        return taken;
    }
    [[nodiscard]] int event_fd() {
        static_cast<void>(open());
        return value_or_raise(source_->event_fd());
    }

    // Returns None if there is no record.
    [[nodiscard]] nb::object read(MonoTime deadline) { return record_or_none(take(1, deadline)); }
    [[nodiscard]] nb::object poll_record() { return record_or_none(poll(1)); }
    [[nodiscard]] nb::object next() {
        auto record = read(MonoTime::max());
        if (record.is_none()) throw nb::stop_iteration();
        return record;
    }
    [[nodiscard]] nb::object next_batch(MonoTime deadline) {
        auto batch = batch_or_none(take(most_in_batch, deadline));
        if (batch.is_none()) throw nb::stop_iteration();
        return batch;
    }
    [[nodiscard]] nb::object poll_batch() { return batch_or_none(poll(most_in_batch)); }

    void close() {
        if (!fork_.is_here()) return;
        const bool closed = [&] {
            const WithoutGil outside;
            return source_->close();
        }();
        if (!closed) check(State::looked_at);
    }

    // The end of a `with` block. An exception on its way is not replaced by a BufferError about views that it keeps
    // alive.
    void leave(const nb::args& why) {
        try {
            close();
        } catch (const nb::python_error& error) {
            if (!error.matches(PyExc_BufferError) || why.empty() || why[0].is_none()) throw;
        }
    }

    [[nodiscard]] const RingSource& open() const {
        fork_.check();
        if (source_->is_closed()) check(State::closed);
        return *source_;
    }
    [[nodiscard]] const RingSource& source() const noexcept { return *source_; }

private:
    [[nodiscard]] State take(std::size_t most, MonoTime deadline, Portion& taken) {
        fork_.check();
        // Reading one record costs less than releasing the GIL, so try that first.
        State state = most == 1 ? source_->fetch(most, MonoTime{}) : State::nothing;
        MonoTime patient_until{};
        for (bool first = most != 1;; first = false) {
            check_signals();  // if a handler raises or reads here, the records are still pending
            if (state == State::found) state = source_->take(most, taken);
            const bool is_used = state == State::used_elsewhere;
            if ((state != State::nothing && !is_used) || !(first || mono_now() < deadline)) return state;
            if (!is_used || patient_until == MonoTime{}) patient_until = mono_now() + longest_patience;
            if (is_used && mono_now() >= patient_until) return state;
            const WithoutGil outside;
            source_->give_way();
            if (is_used) std::this_thread::sleep_for(look_again);
            state = source_->fetch(most, deadline);
        }
    }

    [[nodiscard]] static nb::object record_or_none(Portion taken) {
        return taken.lease ? nb::cast(Record(std::move(taken))) : nb::none();
    }
    [[nodiscard]] nb::object batch_or_none(Portion taken) const {
        return taken.lease ? nb::cast(Batch(std::move(taken), source_)) : nb::none();
    }

    void check(State state) const {
        switch (state) {
            case State::damaged:
                raise_input(
                    fmt::format("ring {} is damaged: what stands there is no record; `mavloom shm remove` makes "
                                "way for a new one",
                                source_->name()));
            case State::closed: raise_closed(fmt::format("the reader of ring {} is closed", source_->name()));
            case State::forked: raise_closed("opened before fork: open it again in this process");
            case State::looked_at:
            case State::used_elsewhere:
                raise_buffer(
                    "a view of the last record or batch is still alive (a memoryview, or an array made of one): "
                    "release or delete it first");
            case State::found:
            case State::nothing:
            case State::no_writer:
            case State::removed: break;
        }
    }

    const BeforeFork fork_;
    std::shared_ptr<RingSource> source_;
};

class Batches {
public:
    Batches(PyRingReader& reader, std::optional<Nanoseconds> timeout)
        : reader_(&reader), holder_(nb::find(reader)), timeout_(timeout) {}

    [[nodiscard]] nb::object next() const {
        if (!holder_.is_valid()) throw nb::stop_iteration();
        return reader_->next_batch(deadline_after(timeout_));
    }
    [[nodiscard]] nb::object poll() const { return holder_.is_valid() ? reader_->poll_batch() : nb::none(); }
    [[nodiscard]] int event_fd() const {
        if (!holder_.is_valid()) throw nb::stop_iteration();
        return reader_->event_fd();
    }
    // Returns seconds, or None.
    [[nodiscard]] nb::object timeout() const {
        if (!timeout_) return nb::none();
        return nb::cast(std::chrono::duration<double>(*timeout_).count());
    }
    [[nodiscard]] PyObject* holder() const noexcept { return holder_.ptr(); }
    void clear() noexcept { holder_.reset(); }

private:
    PyRingReader* reader_;
    nb::object holder_;  // keeps reader_ alive; empty after the garbage collector cleared it
    std::optional<Nanoseconds> timeout_;
};

int traverse_batches(PyObject* self, visitproc visit, void* arg) noexcept {
    Py_VISIT(Py_TYPE(self));
    if (nb::inst_ready(self)) Py_VISIT(nb::inst_ptr<Batches>(self)->holder());
    return 0;
}

int clear_batches(PyObject* self) noexcept {
    if (nb::inst_ready(self)) nb::inst_ptr<Batches>(self)->clear();
    return 0;
}

PyType_Slot batches_slots[] = {
    {Py_tp_traverse, reinterpret_cast<void*>(traverse_batches)},  // NOLINT
    {Py_tp_clear, reinterpret_cast<void*>(clear_batches)},        // NOLINT
    {0, nullptr},
};

template <class Of>
auto of_record(Of of) {
    return [of](const Record& record) { return of(record.get()); };
}

nb::object itself(nb::handle self) { return nb::borrow(self); }
nb::module_ asynchronous() { return nb::module_::import_("mavloom._async"); }

void bind_record(nb::module_& module) {
    nb::class_<View>(module, "RecordView", nb::type_slots(view_slots), nb::is_final(), "Bytes of records, as a buffer.");
    nb::class_<Record>(
        module, "Record", nb::type_slots(record_slots), nb::is_final(),
        "One record of a ring. Of a lossy reader a copy; of a lossless one a view into the ring, which ends "
        "with the reader's next read: `data` raises from then on, and\n"
        "a read while a memoryview of it (or a slice, or an array made of it) lives is a BufferError. Has a "
        "buffer: `memoryview(record)`, `numpy.frombuffer(record)`.")
        .def_prop_ro("data", &Record::data, nb::sig("def data(self) -> bytes | memoryview"),
                     "bytes of a lossy reader; of a lossless one a new read-only memoryview at each access.")
        .def_prop_ro("time_ns", of_record([](const shm::RingRecord& record) {
                         return record.info.time.time_since_epoch().count();
                     }),
                     "When it was received, Unix time.")
        .def_prop_ro("link", of_record([](const shm::RingRecord& record) { return record.info.link.value; }),
                     "Where from: the writer's number.")
        .def_prop_ro("kind", of_record([](const shm::RingRecord& record) { return record.info.kind; }),
                     "What it is: the writer's number.")
        .def_prop_ro("verdict", of_record([](const shm::RingRecord& record) { return record.info.verdict; }),
                     "What the writer found out about it.")
        .def_prop_ro("position", of_record([](const shm::RingRecord& record) { return record.position; }),
                     "Bytes since the ring was made.")
        .def("__repr__", of_record([](const shm::RingRecord& record) {
                 return fmt::format("<Record of {} bytes, link {}, position {}>", record.data.size(),
                                    record.info.link.value, record.position);
             }));
}

void bind_batch(nb::module_& module) {
    nb::class_<Batch>(
        module, "RecordBatch", nb::is_final(),
        "Records that were read together, at least one: index, iterate. Of a lossless reader they are views "
        "that end together, with the next read or `release()`.")
        .def("__len__", &Batch::size)
        .def("__getitem__", &Batch::at, nb::arg("index"))
        .def(
            "__iter__", [](nb::handle self) { return nb::steal(PySeqIter_New(self.ptr())); },
            nb::sig("def __iter__(self) -> collections.abc.Iterator[Record]"))
        .def("array", &Batch::array, nb::arg("dtype"),
             nb::sig("def array(self, dtype: typing.Any) -> numpy.typing.NDArray[typing.Any]"),
             "The records as one read-only numpy array; each has as many bytes as the dtype, else ValueError. Of a "
             "lossless "
             "reader it is a view, and counts as one.")
        .def("release", &Batch::release,
             "Ends the views now, and lets the writer pass; BufferError while one is alive. May be called again.");
    nb::class_<Batches>(module, "RecordBatches", nb::type_slots(batches_slots), nb::is_final(), "Iterator over batches.")
        .def("__iter__", itself, nb::sig("def __iter__(self) -> RecordBatches"))
        .def("__next__", &Batches::next, nb::sig("def __next__(self) -> RecordBatch"))
        .def(
            "__aiter__",
            [](nb::handle self) { return asynchronous().attr("batches")(self, nb::inst_ptr<Batches>(self)->timeout()); },
            nb::sig("def __aiter__(self) -> collections.abc.AsyncGenerator[RecordBatch, None]"),
            "As iteration, but nobody's writing does not end it: the time-out does, the ring's removal, and closing.")
        .def("poll", &Batches::poll, nb::sig("def poll(self) -> RecordBatch | None"), "As RingReader.poll.")
        .def("event_fd", &Batches::event_fd);
}

}  // namespace

void bind_ring_reader(nb::module_& module) {
    using namespace nb::literals;
    bind_record(module);
    bind_batch(module);
    nb::class_<PyRingReader>(module, "RingReader", nb::is_final(),
                             "A reader of the ring NAME in shared memory. Lossy: never holds the writer, gets copies, "
                             "and `missed` counts what it "
                             "was too slow for. Lossless: gets views, and\n"
                             "the writer may not pass them. `start`: `newest` reads what comes from now on, `oldest` "
                             "what the ring holds, too. "
                             "Iterate over records until nobody writes any more.\n"
                             "Any thread: those that share it take turns, each record is one's, and a read of one does "
                             "not end what another got.")
        .def(nb::init<const std::string&, bool, const std::string&>(), "name"_a, nb::kw_only(), "lossless"_a = false,
             "start"_a = "newest",
             nb::sig(
                 "def __init__(self, name: str, *, lossless: bool = False, start: typing.Literal['newest', 'oldest'] = "
                 "'newest') -> None"),
             "NotFoundError names the rings that there are; InputError for a file that is no ring of this version; "
             "SystemFailure for a 65th lossless reader.")
        .def(
            "read", [](PyRingReader& reader, const nb::object& timeout) { return reader.read(deadline_after(timeout)); },
            "timeout"_a = nb::none(), nb::sig("def read(self, timeout: float | None = None) -> Record | None"),
            "The next record; None after `timeout` seconds (0 polls, None waits), and as soon as all is read and no "
            "writer "
            "is alive or the ring was removed. Releases the one\n"
            "before: BufferError while a view of it is alive. InputError where the ring is damaged.")
        .def(
            "batches", [](PyRingReader& self, const nb::object& timeout) { return Batches(self, timeout_of(timeout)); },
            "timeout"_a = nb::none(), nb::sig("def batches(self, timeout: float | None = None) -> RecordBatches"),
            "Iterates over what there is, up to 1024 records at a time (and 1 MiB, or an eighth of the ring), waiting "
            "as "
            "`read` does; ends where `read` gives None.")
        .def("__iter__", itself, nb::sig("def __iter__(self) -> RingReader"))
        .def("__next__", &PyRingReader::next, nb::sig("def __next__(self) -> Record"))
        .def(
            "__aiter__", [](nb::handle self) { return asynchronous().attr("records")(self); },
            nb::sig("def __aiter__(self) -> collections.abc.AsyncGenerator[Record, None]"),
            "On asyncio, one task at a time: waits on where nobody writes, for the next writer carries on in the ring; "
            "ends with its removal, and with close().")
        .def("event_fd", &PyRingReader::event_fd,
             "For loops of your own: a descriptor that becomes readable when `poll()`, which gave None, is worth "
             "another call. Read its 8 bytes first; the reader closes it.")
        .def("poll", &PyRingReader::poll_record, nb::sig("def poll(self) -> Record | None"),
             "The next record, or None where there is none yet. ClosedError when all is read and nothing will come: "
             "the ring was removed.")
        .def("close", &PyRingReader::close,
             "Gives the ring back; BufferError while a view is alive. May be called again, later reads raise "
             "ClosedError.")
        .def("__enter__", itself, nb::sig("def __enter__(self) -> RingReader"))
        .def("__exit__", &PyRingReader::leave, nb::sig("def __exit__(self, *args: object) -> None"))
        .def("__repr__",
             [](const PyRingReader& reader) {
                 return fmt::format("<RingReader {}{}>", reader.source().name(),
                                    reader.source().is_lossless() ? ", lossless" : "");
             })
        .def_prop_ro("name", [](const PyRingReader& reader) { return reader.source().name(); })
        .def_prop_ro("lossless", [](const PyRingReader& reader) { return reader.source().is_lossless(); })
        .def_prop_ro(
            "missed", [](const PyRingReader& reader) { return reader.source().missed(); },
            "Records that the writer overwrote before this reader came to them, in all.")
        .def_prop_ro("writer_alive", [](const PyRingReader& reader) { return reader.open().writer_alive(); })
        .def_prop_ro(
            "removed", [](const PyRingReader& reader) { return reader.open().is_removed(); },
            "Whether the ring was removed or replaced: open the name again once all is read.")
        .def_prop_ro(
            "holds", [](const PyRingReader& reader) { return reader.open().holds(); },
            "Whether what was read through the views in hand is what was written: False once a writer with "
            "full=\"evict\" took them away. Copy, then ask.");
}

}  // namespace mavloom::python
