// SPDX-License-Identifier: MIT
// Classes RingReader, Record and RecordBatch.
//
// A record's bytes are used through a View. The lease counts a View as in use as long as it lives, whatever was made of
// it. Counting the exports of the record would not suffice: numpy keeps the object behind a memoryview, but drops the
// memoryview itself.
#include <fmt/format.h>
#include <nanobind/stl/optional.h>

#include <optional>
#include <span>

#include "bindings.hpp"
#include "errors.hpp"
#include "mavloom/link/links.hpp"
#include "ring/reader.hpp"
#include "strings.hpp"
#include "waiting.hpp"

namespace mavloom::python {
namespace {

constexpr std::size_t max_in_batch = 1024;
// How often to check whether another thread still uses what it read.
constexpr auto poll_interval = std::chrono::microseconds{100};
constexpr auto longest_patience = std::chrono::seconds{10};  // how long to wait for such a thread

// ---- views, records and batches

class View {
public:
    // `bytes_of(lease)` returns the bytes to view. It is called once they can no longer move.
    template <class BytesOf>
    View(std::shared_ptr<Lease> lease, BytesOf bytes_of) {
        if (!lease->is_copy()) lease->ring_reader()->fork().check();
        const auto pin = lease->pin();
        if (pin == Lease::Pin::refused)
            raise_usage("the record was released by a later read, release() or close(): copy what you keep");
        is_counted_ = pin == Lease::Pin::counted;
        lease_ = std::move(lease);
        bytes_ = bytes_of(*lease_);
        if (holds()) return;
        end();
        raise_evicted();
    }
    View(View&& other) noexcept = default;
    View& operator=(View&&) = delete;
    ~View() { end(); }
    [[nodiscard]] ByteView bytes() const noexcept { return bytes_; }
    // Call after copying from the view: if this raises, the copy is not valid.
    void check() const {
        if (!holds()) raise_evicted();
    }

private:
    [[nodiscard]] bool holds() const noexcept { return lease_->is_copy() || lease_->ring_reader()->holds(); }
    void end() noexcept {
        if (const auto lease = std::exchange(lease_, nullptr); lease && is_counted_) lease->unpin();
    }
    [[noreturn]] static void raise_evicted() {
        raise_error("the writer evicted this reader and may have overwritten the record");
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
    [[nodiscard]] View pinned_view() const {
        return View(lease_, [this](const Lease& lease) { return lease.records()[index_].data; });
    }
    [[nodiscard]] nb::object view() const { return nb::cast(pinned_view()); }
    [[nodiscard]] nb::object data() const {
        if (!lease_->is_copy()) return nb::steal(PyMemoryView_FromObject(view().ptr()));
        const View view = pinned_view();
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

// Never called, because the buffer belongs to the View. The slot must exist all the same: numpy.frombuffer keeps the
// buffer only of types that have it. Of other types it keeps only the object.
void release_record_buffer(PyObject*, Py_buffer*) noexcept {}

PyType_Slot record_slots[] = {
    {Py_bf_releasebuffer, reinterpret_cast<void*>(release_record_buffer)},  // NOLINT
    {Py_bf_getbuffer, reinterpret_cast<void*>(record_buffer)},              // NOLINT
    {0, nullptr},
};

// ---- class RecordBatch

class Batch {
public:
    Batch(Portion taken, std::shared_ptr<SharedRingReader> source)
        : lease_(std::move(taken.lease)), first_(taken.first), ring_reader_(std::move(source)) {}

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
            return ring_reader_->release(*lease_);
        }();
        if (!released) raise_buffer("a view of one of these records is still alive: release or delete it first");
    }

    [[nodiscard]] nb::object array(const nb::object& dtype) const {
        const auto numpy = nb::module_::import_("numpy");
        const nb::object type = numpy.attr("dtype")(dtype);
        if (nb::cast<bool>(type.attr("hasobject"))) raise_usage("a dtype with Python objects: a ring holds bytes");
        const View pin(lease_, [](const Lease&) { return ByteView(); });
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

    const ForkGuard fork_;
    std::shared_ptr<Lease> lease_;
    std::size_t first_;
    std::shared_ptr<SharedRingReader> ring_reader_;
};

// ---- class RingReader

shm::ReaderOptions options_of(bool lossless, const std::string& start, bool foreign) {
    using From = shm::ReaderOptions::From;
    if (start != "newest" && start != "oldest")
        raise_usage(fmt::format("start='{}': expected newest or oldest", start));
    return {.lossless = lossless,
            .from = start == "oldest" ? From::oldest : From::newest,
            .trust = {.foreign = foreign, .user = link::Links::owner_of_inlets()}};
}

class PyRingReader {
    using State = SharedRingReader::State;

public:
    PyRingReader(const std::string& name, bool lossless, const std::string& start, bool foreign) {
        auto opened = [&, options = options_of(lossless, start, foreign)] {
            const WithoutGil outside;
            return shm::RingReader::open(name, options);
        }();
        ring_reader_ = std::make_shared<SharedRingReader>(value_or_raise(std::move(opened)), lossless);
    }
    ~PyRingReader() {
        if (ring_reader_) ring_reader_->abandon();
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
        if (state == State::removed || (state == State::no_writer && ring_reader_->is_removed()))
            raise_closed(fmt::format("ring {} was removed or replaced: open it again", ring_reader_->name()));
        if (!taken.lease) ring_reader_->arm();
        return taken;
    }
    [[nodiscard]] int event_fd() {
        static_cast<void>(open());
        return value_or_raise(ring_reader_->event_fd());
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
        auto batch = batch_or_none(take(max_in_batch, deadline));
        if (batch.is_none()) throw nb::stop_iteration();
        return batch;
    }
    [[nodiscard]] nb::object poll_batch() { return batch_or_none(poll(max_in_batch)); }

    void close() {
        if (!fork_.is_own_process()) return;
        const bool closed = [&] {
            const WithoutGil outside;
            return ring_reader_->close();
        }();
        if (!closed) check(State::pinned);
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

    [[nodiscard]] const SharedRingReader& open() const {
        fork_.check();
        if (ring_reader_->is_closed()) check(State::closed);
        return *ring_reader_;
    }
    [[nodiscard]] const SharedRingReader& ring_reader() const noexcept { return *ring_reader_; }

private:
    [[nodiscard]] State take(std::size_t most, MonoTime deadline, Portion& taken) {
        fork_.check();
        // Reading one record costs less than releasing the GIL, so try that first.
        State state = most == 1 ? ring_reader_->fetch(most, MonoTime{}) : State::nothing;
        MonoTime patient_until{};
        for (bool first = most != 1;; first = false) {
            check_signals();  // if a handler raises or reads here, the records are still pending
            if (state == State::found) state = ring_reader_->take(most, taken);
            const bool is_used = state == State::used_elsewhere;
            if ((state != State::nothing && !is_used) || !(first || mono_now() < deadline)) return state;
            if (!is_used || patient_until == MonoTime{}) patient_until = mono_now() + longest_patience;
            if (is_used && mono_now() >= patient_until) return state;
            const WithoutGil outside;
            ring_reader_->yield_to_waiters();
            if (is_used) std::this_thread::sleep_for(poll_interval);
            state = ring_reader_->fetch(most, deadline);
        }
    }

    [[nodiscard]] static nb::object record_or_none(Portion taken) {
        return taken.lease ? nb::cast(Record(std::move(taken))) : nb::none();
    }
    [[nodiscard]] nb::object batch_or_none(Portion taken) const {
        return taken.lease ? nb::cast(Batch(std::move(taken), ring_reader_)) : nb::none();
    }

    void check(State state) const {
        switch (state) {
            case State::damaged:
                raise_input(fmt::format(
                    "ring {} is damaged: it contains an invalid record; remove it with `mavloom shm remove`",
                    ring_reader_->name()));
            case State::closed: raise_closed(fmt::format("the reader of ring {} is closed", ring_reader_->name()));
            case State::forked: raise_closed("opened before fork: open it again in this process");
            case State::pinned:
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

    const ForkGuard fork_;
    std::shared_ptr<SharedRingReader> ring_reader_;
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
        "One record of a ring. A lossy reader returns copies. A lossless reader returns views into the\n"
        "ring.\n\n"
        "A view ends with the reader's next read: from then on, `data` raises. While a memoryview of the\n"
        "record is alive, or a slice or array made of one, the next read raises BufferError. Supports the\n"
        "buffer protocol: `memoryview(record)`, `numpy.frombuffer(record)`.")
        .def_prop_ro("data", &Record::data, nb::sig("def data(self) -> bytes | memoryview"),
                     "The bytes: for a lossy reader a copy; for a lossless one a new read-only memoryview at each\n"
                     "access.")
        .def_prop_ro("time_ns", of_record([](const shm::RingRecord& record) {
                         return record.info.time.time_since_epoch().count();
                     }),
                     "Receive time: Unix time in ns.")
        .def_prop_ro("link", of_record([](const shm::RingRecord& record) { return record.info.link.value; }),
                     "The link that it came from: a number that the writer assigned.")
        .def_prop_ro("kind", of_record([](const shm::RingRecord& record) { return record.info.kind; }),
                     "The kind of content: a number that the writer assigned; 1 is a MAVLink frame.")
        .def_prop_ro("verdict", of_record([](const shm::RingRecord& record) { return record.info.verdict; }),
                     "The writer's verdict on the record (docs/formats/ring.md).")
        .def_prop_ro("position", of_record([](const shm::RingRecord& record) { return record.position; }),
                     "The record's position in the ring: bytes since the ring was created.")
        .def("__repr__", of_record([](const shm::RingRecord& record) {
                 return fmt::format("<Record of {} bytes, link {}, position {}>", record.data.size(),
                                    record.info.link.value, record.position);
             }));
}

void bind_batch(nb::module_& module) {
    nb::class_<Batch>(module, "RecordBatch", nb::is_final(),
                      "One or more records that were read together. Supports indexing and iteration. The views of a\n"
                      "lossless reader end together, with the next read or `release()`.")
        .def("__len__", &Batch::size)
        .def("__repr__", [](const Batch& batch) { return fmt::format("<RecordBatch of {}>", batch.size()); })
        .def("__getitem__", &Batch::at, nb::arg("index"))
        .def(
            "__iter__", [](nb::handle self) { return nb::steal(PySeqIter_New(self.ptr())); },
            nb::sig("def __iter__(self) -> collections.abc.Iterator[Record]"))
        .def("array", &Batch::array, nb::arg("dtype"),
             nb::sig("def array(self, dtype: typing.Any) -> numpy.typing.NDArray[typing.Any]"),
             "The records as one read-only numpy array. Raises ValueError unless every record has the size of\n"
             "the dtype. For a lossless reader the array is a view and counts as one.")
        .def("release", &Batch::release,
             "Ends the views now, so that the writer may overwrite them. Raises BufferError while a view is\n"
             "alive. May be called again.");
    nb::class_<Batches>(module, "RecordBatches", nb::type_slots(batches_slots), nb::is_final(), "Iterator over batches.")
        .def("__iter__", itself, nb::sig("def __iter__(self) -> RecordBatches"))
        .def("__next__", &Batches::next, nb::sig("def __next__(self) -> RecordBatch"))
        .def(
            "__aiter__",
            [](nb::handle self) { return asynchronous().attr("batches")(self, nb::inst_ptr<Batches>(self)->timeout()); },
            nb::sig("def __aiter__(self) -> collections.abc.AsyncGenerator[RecordBatch, None]"),
            "Like iteration, but continues if the ring has no writer. Ends after the time-out, when the ring\n"
            "is removed, and on close().")
        .def("poll", &Batches::poll, nb::sig("def poll(self) -> RecordBatch | None"), "Like RingReader.poll.")
        .def("event_fd", &Batches::event_fd);
}

}  // namespace

void bind_ring_reader(nb::module_& module) {
    using namespace nb::literals;
    bind_record(module);
    bind_batch(module);
    nb::class_<PyRingReader>(
        module, "RingReader", nb::is_final(),
        "A reader of the ring NAME in shared memory.\n\n"
        "- Lossy: never delays the writer and gets copies. `missed` counts the records that it lost\n"
        "  because it was too slow.\n"
        "- Lossless: gets views. The writer waits for this reader, or evicts it (full=\"evict\").\n\n"
        "`start`: `newest` reads records from now on, `oldest` also those already in the ring. Iteration\n"
        "ends when everything is read and no process writes the ring.\n\n"
        "Safe from any thread. Threads that share a reader take turns, and each record goes to one of\n"
        "them. A read by one thread does not end records that another thread has read.")
        .def(nb::init<const std::string&, bool, const std::string&, bool>(), "name"_a, nb::kw_only(),
             "lossless"_a = false, "start"_a = "newest", "foreign"_a = false,
             nb::sig(
                 "def __init__(self, name: str, *, lossless: bool = False, start: typing.Literal['newest', 'oldest'] = "
                 "'newest', foreign: bool = False) -> None"),
             "NotFoundError lists the existing rings. Raises InputError if the file is not a ring of this\n"
             "version, and SystemFailure for a 65th lossless reader. Without `foreign`, raises\n"
             "PermissionDeniedError in two cases:\n\n"
             "- Users other than the owner may write the ring. They could end this process by shortening it.\n"
             "- The owner is neither this user, nor root, nor the owner of the folder of the sockets\n"
             "  (MAVLOOM_RUN, /run/mavloom).")
        .def(
            "read", [](PyRingReader& reader, const nb::object& timeout) { return reader.read(deadline_after(timeout)); },
            "timeout"_a = nb::none(), nb::sig("def read(self, timeout: float | None = None) -> Record | None"),
            "Returns the next record, or None after `timeout` seconds (0 polls, None waits). Also returns\n"
            "None once everything is read and the ring was removed or has no live writer.\n\n"
            "Releases the previous record, and raises BufferError while a view of it is alive. Raises\n"
            "InputError if the ring is damaged.")
        .def(
            "batches", [](PyRingReader& self, const nb::object& timeout) { return Batches(self, timeout_of(timeout)); },
            "timeout"_a = nb::none(), nb::sig("def batches(self, timeout: float | None = None) -> RecordBatches"),
            "Iterates over batches of up to 1024 records. A batch holds about 1 MiB at most, or for a lossless\n"
            "reader an eighth of the ring. Waits like `read`, and ends where `read` returns None.")
        .def("__iter__", itself, nb::sig("def __iter__(self) -> RingReader"))
        .def("__next__", &PyRingReader::next, nb::sig("def __next__(self) -> Record"))
        .def(
            "__aiter__", [](nb::handle self) { return asynchronous().attr("records")(self); },
            nb::sig("def __aiter__(self) -> collections.abc.AsyncGenerator[Record, None]"),
            "For asyncio, one task at a time. If the writer ends, waits for the next one, which continues the\n"
            "ring. Ends when the ring is removed or the reader is closed.")
        .def("event_fd", &PyRingReader::event_fd,
             "For other event loops: a descriptor. After `poll()` has returned None, the descriptor becomes\n"
             "readable when another call may return a record. Before that call, read the 8 bytes from it. The\n"
             "reader closes it.")
        .def("poll", &PyRingReader::poll_record, nb::sig("def poll(self) -> Record | None"),
             "Returns the next record, or None if there is none yet. Raises ClosedError when everything is\n"
             "read and the ring was removed.")
        .def("close", &PyRingReader::close,
             "Closes the reader and frees its place in the ring. Raises BufferError while a view is alive. May\n"
             "be called again. Later reads raise ClosedError.")
        .def("__enter__", itself, nb::sig("def __enter__(self) -> RingReader"))
        .def("__exit__", &PyRingReader::leave, nb::sig("def __exit__(self, *args: object) -> None"))
        .def("__repr__",
             [](const PyRingReader& reader) {
                 return fmt::format("<RingReader {}{}>", reader.ring_reader().name(),
                                    reader.ring_reader().is_lossless() ? ", lossless" : "");
             })
        .def_prop_ro("name", [](const PyRingReader& reader) { return reader.ring_reader().name(); })
        .def_prop_ro("lossless", [](const PyRingReader& reader) { return reader.ring_reader().is_lossless(); })
        .def_prop_ro(
            "missed", [](const PyRingReader& reader) { return reader.ring_reader().missed(); },
            "The total number of records that the writer overwrote before this reader read them.")
        .def_prop_ro("writer_alive", [](const PyRingReader& reader) { return reader.open().writer_alive(); })
        .def_prop_ro(
            "removed", [](const PyRingReader& reader) { return reader.open().is_removed(); },
            "Whether the ring was removed or replaced. Once everything is read, open the name again.")
        .def_prop_ro(
            "holds", [](const PyRingReader& reader) { return reader.open().holds(); },
            "Whether the data read through the current views is valid. Becomes False when a writer with\n"
            "full=\"evict\" evicts this reader. Copy the data first, then check.");
}

}  // namespace mavloom::python
