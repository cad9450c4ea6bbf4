// SPDX-License-Identifier: MIT
#include "ring/writer.hpp"

#include <fmt/format.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/vector.h>

#include <array>

#include "bindings.hpp"
#include "errors.hpp"
#include "mavloom/base/suggest.hpp"
#include "mavloom/shm/ring_info.hpp"
#include "message/encode.hpp"
#include "ring/claim.hpp"
#include "strings.hpp"

namespace mavloom::python {
namespace {

constexpr std::array<std::string_view, 3> policies{"wait", "drop_newest", "evict"};

shm::WhenFull policy_of(const std::string& full) {
    const auto found = std::ranges::find(policies, full);
    if (found == policies.end())
        raise_usage(fmt::format("full='{}': expected wait, drop_newest or evict{}", full, did_you_mean(full, policies)));
    return static_cast<shm::WhenFull>(found - policies.begin());
}

// Used with the GIL held, or after the interpreter has ended.
std::vector<PyRingWriter*>& open_writers() {
    // Never destroyed: some writers may outlive the interpreter.
    static auto* const writers = new std::vector<PyRingWriter*>;
    return *writers;
}

void close_what_is_left() noexcept {
    for (auto* const writer : open_writers()) writer->close_at_exit();
}

}  // namespace

shm::RecordInfo record_info(const OptionalInteger& time_ns, const Integer& link, const Integer& kind,
                            const Integer& verdict) {
    return {time_ns ? wall_time(*time_ns) : wall_now(), LinkId{link.in<std::uint32_t>("link")},
            kind.in<std::uint16_t>("kind"), verdict.in<std::uint8_t>("verdict")};
}

WallTime wall_time(const Integer& time_ns) { return WallTime{Nanoseconds{time_ns.in<std::int64_t>("time_ns")}}; }

PyRingWriter::PyRingWriter(const std::string& name, const Integer& capacity, const std::string& full,
                           const Integer& mode)
    : name_(name), when_full_(policy_of(full)) {
    const shm::RingOptions options{
        .capacity = capacity.in<std::uint64_t>("capacity", shm::min_capacity, shm::max_capacity),
        .when_full = when_full_,
        .mode = mode.in<std::uint16_t>("mode")};
    auto opened = [&] {
        const WithoutGil outside;  // allocating a large ring takes time
        auto made = shm::RingWriter::open(name, options);
        if (made && WithoutGil::is_for_good()) static_cast<void>(made->close(shm::RingWriter::Leave::ring));
        return made;
    }();
    writer_ = value_or_raise(std::move(opened));
    longest_ = writer_->longest();
    created_ = writer_->created();
    open_writers().push_back(this);
}

PyRingWriter::~PyRingWriter() { std::erase(open_writers(), this); }

void PyRingWriter::check_open() const {
    fork_.check();
    if (closed_) raise_closed(fmt::format("the writer of ring {} is closed", name_));
}

void PyRingWriter::check() const {
    check_open();
    if (const auto claimer = claimer_.load(); claimer != 0 && claimer == feed::this_thread())
        raise_buffer(fmt::format("a claim of the writer of ring {} is open: commit or abandon it first", name_));
}

bool PyRingWriter::write(const nb::object& data, const shm::RecordInfo& info) {
    check();
    const Buffer bytes(data);
    for (;;) {
        wait_for_claim_end();
        const auto written = put_or_wait(bytes.bytes(), info);
        if (written) return true;
        if (written.error() != shm::WriteError::full) raise(written.error(), bytes.bytes().size());
        if (!waits()) return false;
        mutex_.yield_to_waiters();
        check_signals();
        check();
    }
}

shm::WriteResult<void> PyRingWriter::put_or_wait(ByteView data, const shm::RecordInfo& info) {
    if (const auto lock = mutex_.try_take(); lock.owns_lock() && !claim_) {
        const auto written = put_locked(data, info, MonoTime{});
        if (written || written.error() != shm::WriteError::full || !waits()) return written;
    }
    const WithoutGil outside;
    return put(data, info, mono_now() + feed::longest_slice);
}

shm::WriteResult<void> PyRingWriter::put(ByteView data, const shm::RecordInfo& info, MonoTime deadline) {
    auto lock = lock_until(deadline);
    // `full` would mean that the record was dropped.
    while (!lock.owns_lock() && !waits()) lock = lock_until(MonoTime::max());
    if (!lock.owns_lock()) return tl::unexpected(shm::WriteError::full);
    return put_locked(data, info, deadline);
}

feed::SlicedMutex::Lock PyRingWriter::lock_until(MonoTime deadline) {
    auto lock = mutex_.take_until(deadline);
    if (lock.owns_lock() && !claim_ended_.wait_until(lock, feed::end_of_slice(deadline), [&] { return !claim_; }))
        lock.unlock();
    return lock;
}

shm::WriteResult<void> PyRingWriter::put_locked(ByteView data, const shm::RecordInfo& info, MonoTime deadline) {
    if (!writer_) return tl::unexpected(shm::WriteError::removed);
    return writer_->write(data, info, deadline);
}

void PyRingWriter::raise(shm::WriteError error, std::size_t length) const {
    if (error == shm::WriteError::too_long)
        raise_usage(fmt::format("{} bytes: a record of ring {} has at most {}", length, name_, longest_));
    check_open();
    if (error == shm::WriteError::removed)
        raise_closed(fmt::format("ring {} was removed or replaced: open it again", name_));
    raise_closed(std::string(shm::to_text(error)));
}

// ---- claims

void PyRingWriter::wait_for_claim_end() {
    while (claimer_.load() != 0) {
        {
            const WithoutGil outside;
            static_cast<void>(lock_until(MonoTime::max()));
        }
        check_signals();
        check();
    }
}

std::shared_ptr<Claimed> PyRingWriter::claim(std::size_t length) {
    for (;;) {
        check();
        wait_for_claim_end();
        auto claimed = claim_or_wait(length);
        if (claimed) return std::move(*claimed);
        if (claimed.error() != shm::WriteError::full) raise(claimed.error(), length);
        mutex_.yield_to_waiters();
        check_signals();
    }
}

shm::WriteResult<std::shared_ptr<Claimed>> PyRingWriter::claim_or_wait(std::size_t length) {
    if (const auto lock = mutex_.try_take(); lock.owns_lock() && !claim_) {
        auto claimed = claim_locked(length, MonoTime{});
        if (claimed || claimed.error() != shm::WriteError::full) return claimed;
    }
    const WithoutGil outside;
    const auto deadline = mono_now() + feed::longest_slice;
    const auto lock = lock_until(deadline);
    if (!lock.owns_lock()) return tl::unexpected(shm::WriteError::full);
    return claim_locked(length, deadline);
}

shm::WriteResult<std::shared_ptr<Claimed>> PyRingWriter::claim_locked(std::size_t length, MonoTime deadline) {
    if (!writer_) return tl::unexpected(shm::WriteError::removed);
    const auto room = writer_->claim(length, deadline);
    if (!room && room.error() == shm::WriteError::full && !waits()) return std::make_shared<Claimed>(length);
    if (!room) return tl::unexpected(room.error());
    claim_ = std::make_shared<Claimed>(*room);
    claimer_ = feed::this_thread();
    return claim_;
}

bool PyRingWriter::commit(Claimed& claimed, const shm::RecordInfo& info, std::size_t length) {
    fork_.check();
    const Committed committed = [&] {
        if (const auto lock = mutex_.try_take(); lock.owns_lock()) return commit_locked(claimed, info, length);
        const WithoutGil outside;
        const auto lock = mutex_.take();
        return commit_locked(claimed, info, length);
    }();
    if (committed == Committed::over) raise_over();
    if (committed == Committed::pinned) raise_pinned();
    return committed == Committed::yes;
}

PyRingWriter::Committed PyRingWriter::commit_locked(Claimed& claimed, const shm::RecordInfo& info, std::size_t length) {
    if (!claimed.is_dropped && claim_.get() != &claimed) return Committed::over;
    if (!claimed.pins.finish()) return Committed::pinned;
    if (claimed.is_dropped) return Committed::dropped;
    writer_->commit(info, length);
    end_claim();
    return Committed::yes;
}

void PyRingWriter::raise_pinned() {
    raise_buffer("a view of the claim is still alive (a slice, or an array made of it): release or delete it first");
}
void PyRingWriter::raise_over() { raise_closed("the claim is over: it was committed or abandoned"); }

void PyRingWriter::give_up(Claimed& claimed) noexcept {
    claimed.given_up.store(true);
    on_unpinned(claimed);
}

// Waiting with the GIL held is safe here: while a claim is open, the lock is held for moments only, and never by a
// thread that needs the GIL.
void PyRingWriter::on_unpinned(Claimed& claimed) noexcept {
    if (!claimed.given_up.load() || !fork_.is_own_process() || !claimed.pins.finish()) return;
    const auto lock = mutex_.take();
    if (claim_.get() == &claimed) end_claim();
}

void PyRingWriter::end_claim() noexcept {
    claim_.reset();
    claimer_ = 0;
    claim_ended_.notify_all();
}

void PyRingWriter::close(bool remove) {
    if (!fork_.is_own_process()) return;
    bool comes_late = false, is_filled = false;
    auto closed = [&]() -> SetupResult<void> {
        const WithoutGil outside;
        const auto lock = mutex_.take();
        is_filled = claim_ && !claim_->pins.finish();
        if (is_filled) return {};
        end_claim();
        closed_ = true;
        comes_late = remove && !writer_ && !removed_;
        return close_locked(remove);
    }();
    if (is_filled) raise_pinned();
    if (comes_late)
        raise_closed(
            fmt::format("the writer of ring {} was closed and kept the ring; remove it with remove_ring", name_));
    value_or_raise(std::move(closed));
}

SetupResult<void> PyRingWriter::close_locked(bool remove) {
    if (!writer_) return {};
    note_counters();
    using Leave = shm::RingWriter::Leave;
    auto closed = writer_->close(remove ? Leave::nothing : Leave::ring);
    removed_ = remove && closed;
    writer_.reset();
    return closed;
}

void PyRingWriter::close_at_exit() noexcept {
    if (!fork_.is_own_process()) return;
    const auto lock = mutex_.take_until(MonoTime::max());
    if (!lock.owns_lock() || (claim_ && !claim_->pins.finish())) return;
    writer_.reset();
}

void PyRingWriter::note_counters() {
    if (!writer_) return;
    records_ = writer_->records();
    dropped_ = writer_->dropped();
}

bool PyRingWriter::is_removed() {
    check_open();
    const WithoutGil outside;
    const auto lock = mutex_.take();
    return !writer_ || writer_->is_removed();
}

std::uint64_t PyRingWriter::records() {
    fork_.check();
    const WithoutGil outside;
    const auto lock = mutex_.take();
    note_counters();
    return records_;
}

std::uint64_t PyRingWriter::dropped() {
    fork_.check();
    const WithoutGil outside;
    const auto lock = mutex_.take();
    note_counters();
    return dropped_;
}

void bind_ring_writer(nb::module_& module) {
    using namespace nb::literals;
    bind_ring_claim(module);
    static_cast<void>(Py_AtExit(close_what_is_left));  // if Python has no free slot, an exit may look like a kill
    nb::class_<PyRingWriter>(
        module, "RingWriter", nb::is_final(),
        "The only writer of the ring NAME in shared memory. Creates the ring, or continues one whose\n"
        "writer has ended in any way. Safe from any thread.\n\n"
        "`capacity` (bytes, a power of two) and `mode` apply to a new ring. An existing ring of another\n"
        "capacity is replaced if it has no writer.\n\n"
        "`full` decides what happens while lossless readers keep the ring full:\n\n"
        "- `wait` waits for room.\n"
        "- `drop_newest` drops the new record.\n"
        "- `evict` evicts the readers that block.\n\n"
        "Closing the writer keeps the ring for its readers and for the next writer.")
        .def(nb::init<const std::string&, const Integer&, const std::string&, const Integer&>(), "name"_a,
             nb::kw_only(), "capacity"_a = shm::default_capacity, "full"_a = "wait", "mode"_a = 0600,
             nb::sig("def __init__(self, name: str, *, capacity: int = 8388608, full: typing.Literal['wait', "
                     "'drop_newest', 'evict'] = 'wait', mode: int = 0o600) -> None"),
             "Raises ValueError for a wrong name or option. Raises SystemFailure (an OSError) if /dev/shm is\n"
             "full or another process writes the ring; the text then names that process. Raises InputError if\n"
             "the file is not a ring of this version, and leaves it unchanged.")
        .def(
            "write",
            [](PyRingWriter& writer, const nb::object& data, const OptionalInteger& time_ns, const Integer& link,
               const Integer& kind,
               const Integer& verdict) { return writer.write(data, record_info(time_ns, link, kind, verdict)); },
            "data"_a, nb::kw_only(), "time_ns"_a = nb::none(), "link"_a = 0, "kind"_a = 0, "verdict"_a = 0,
            nb::sig("def write(self, data: Buffer | numpy.typing.NDArray[typing.Any], *, time_ns: int | None = None, "
                    "link: int = 0, kind: int = 0, "
                    "verdict: int = 0) -> bool"),
            "Copies any object with a contiguous buffer into the ring as one record of at most `longest`\n"
            "bytes.\n\n"
            "`time_ns` is Unix time; the default is now. Waits while lossless readers keep the ring full.\n"
            "With full=\"drop_newest\" it returns False instead: the record was dropped and counted in\n"
            "`dropped`. Raises ClosedError once the ring was removed.")
        .def("claim", &claim_room, "length"_a, nb::kw_only(), "time_ns"_a = nb::none(), "link"_a = 0, "kind"_a = 0,
             "verdict"_a = 0,
             nb::sig("def claim(self, length: int, *, time_ns: int | None = None, link: int = 0, kind: int = 0, "
                     "verdict: int "
                     "= 0) -> RingClaim"),
             "Reserves room for one record of up to `length` bytes, to be filled in place: `with\n"
             "writer.claim(n) as view` commits it at the end of the block. Waits for room like `write`.\n\n"
             "Only one claim is open at a time. Meanwhile other threads wait, and every write by the claiming\n"
             "thread raises BufferError.")
        .def("close", &PyRingWriter::close, "remove"_a = false, nb::sig("def close(self, remove: bool = False) -> None"),
             "Ends writing. May be called again.\n\n"
             "With `remove` it also removes the ring; readers are notified and can read what is left. If an\n"
             "earlier close kept the ring, `remove` raises ClosedError, because another process may write the\n"
             "ring by now. Use `remove_ring` then.")
        .def(
            "__enter__", [](nb::handle self) { return nb::borrow(self); }, nb::sig("def __enter__(self) -> RingWriter"))
        .def(
            "__exit__", [](PyRingWriter& writer, const nb::args&) { writer.close(false); },
            nb::sig("def __exit__(self, *args: object) -> None"))
        .def("__repr__", [](const PyRingWriter& writer) { return fmt::format("<RingWriter {}>", writer.name()); })
        .def_prop_ro("name", &PyRingWriter::name)
        .def_prop_ro("longest", &PyRingWriter::longest,
                     "The size of the longest record that the ring accepts, in bytes.")
        .def_prop_ro("created", &PyRingWriter::created,
                     "Whether this writer created the ring. False: it continues an existing one.")
        .def_prop_ro("removed", &PyRingWriter::is_removed,
                     "Whether the ring was removed or replaced, so that new readers do not find it.")
        .def_prop_ro("records", &PyRingWriter::records,
                     "The number of records since the ring was created, from all its writers.")
        .def_prop_ro("dropped", &PyRingWriter::dropped,
                     "The number of records dropped since the ring was created, because it was full. A claim counts\n"
                     "when it begins.");

    module.def(
        "remove_ring",
        [](const std::string& name) {
            auto removed = [&] {
                const WithoutGil outside;
                return shm::remove_ring(name);
            }();
            value_or_raise(std::move(removed));
        },
        "name"_a,
        "Removes a ring and its counter page. Programs that have it open are notified; the call does not\n"
        "wait for them. NotFoundError lists the existing rings.");
    module.def("rings", &shm::ring_names, "The names of the rings on this machine (or in this container), sorted.");
}

}  // namespace mavloom::python
