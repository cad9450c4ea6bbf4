// SPDX-License-Identifier: MIT
// Views of a claim are counted like views of a record (reader_binding.cpp): through objects that live as long as
// everything that was made of them.
#include "ring/claim.hpp"

#include <fmt/format.h>
#include <nanobind/stl/optional.h>

#include "errors.hpp"

namespace mavloom::python {
namespace {

// A view of claimed memory. It keeps the writer alive, and so the mapping.
class ClaimView {
public:
    ClaimView(nb::object holder, PyRingWriter& writer, std::shared_ptr<Claimed> claimed)
        : holder_(std::move(holder)), writer_(&writer) {
        if (!claimed->pins.pin()) PyRingWriter::raise_over();
        claimed_ = std::move(claimed);
    }
    ClaimView(ClaimView&& other) noexcept = default;
    ClaimView& operator=(ClaimView&&) = delete;
    ~ClaimView() {
        if (claimed_ && claimed_->pins.unpin()) writer_->on_unpinned(*claimed_);
    }
    [[nodiscard]] ByteSpan bytes() const noexcept { return claimed_->bytes; }

private:
    nb::object holder_;
    PyRingWriter* writer_;
    std::shared_ptr<Claimed> claimed_;
};

int claim_view_buffer(PyObject* self, Py_buffer* out, int flags) noexcept {
    out->obj = nullptr;
    if (!nb::inst_ready(self)) {
        PyErr_SetString(PyExc_TypeError, "views are made by a RingClaim");
        return -1;
    }
    const auto bytes = nb::inst_ptr<ClaimView>(self)->bytes();
    return PyBuffer_FillInfo(out, self, bytes.data(), static_cast<Py_ssize_t>(bytes.size()), 0, flags);
}

PyType_Slot claim_view_slots[] = {
    {Py_bf_getbuffer, reinterpret_cast<void*>(claim_view_buffer)},  // NOLINT
    {0, nullptr},
};

std::size_t length_within(const Integer& length, std::size_t most) {
    return length.in<std::size_t>("length", 0, static_cast<std::int64_t>(most));
}

class Claim {
public:
    Claim(nb::object holder, PyRingWriter& writer, std::shared_ptr<Claimed> claimed, bool has_time,
          const shm::RecordInfo& info)
        : holder_(std::move(holder)), writer_(&writer), claimed_(std::move(claimed)), has_time_(has_time), info_(info) {}
    Claim(const Claim&) = delete;
    Claim& operator=(const Claim&) = delete;
    ~Claim() {
        view_.reset();
        if (!is_over_) writer_->give_up(*claimed_);
    }

    // Returns the only memoryview of the room, which ends with the claim.
    [[nodiscard]] nb::object data() {
        fork_.check();
        if (is_over_) PyRingWriter::raise_over();
        if (!view_.is_valid())
            view_ = nb::steal(PyMemoryView_FromObject(nb::cast(ClaimView(holder_, *writer_, claimed_)).ptr()));
        return view_;
    }

    bool commit(const OptionalInteger& length, const OptionalInteger& time_ns) {
        if (is_over_) PyRingWriter::raise_over();
        const auto most = claimed_->bytes.size();
        const auto used = length ? length_within(*length, most) : most;
        if (time_ns) info_.time = wall_time(*time_ns);
        else if (!has_time_) info_.time = wall_now();
        end_view();
        const bool written = writer_->commit(*claimed_, info_, used);
        is_over_ = true;
        return written;
    }

    // A view that is still alive keeps the room. That is no error here, because another exception may be on its way
    // already.
    void abandon() {
        if (is_over_) return;
        is_over_ = true;
        if (view_.is_valid() && !nb::steal(PyObject_CallMethod(view_.ptr(), "release", nullptr)).is_valid())
            PyErr_Clear();
        view_.reset();
        writer_->give_up(*claimed_);
    }

    void exit(bool failed) {
        if (failed) abandon();
        if (!is_over_) commit({}, {});
    }

private:
    // Ends the memoryview even if the user still has a name for it. Raises BufferError if slices or arrays of it
    // remain.
    void end_view() {
        if (!view_.is_valid()) return;
        try {
            view_.attr("release")();
        } catch (const nb::python_error& error) {
            if (!error.matches(PyExc_BufferError)) throw;
            PyRingWriter::raise_pinned();
        }
        view_.reset();
    }

    const ForkGuard fork_;
    nb::object holder_;  // keeps writer_ alive
    PyRingWriter* writer_;
    std::shared_ptr<Claimed> claimed_;
    nb::object view_;
    bool is_over_ = false;
    const bool has_time_;
    shm::RecordInfo info_;
};

}  // namespace

nb::object claim_room(const nb::object& writer, const Integer& length, const OptionalInteger& time_ns,
                      const Integer& link, const Integer& kind, const Integer& verdict) {
    auto& of = nb::cast<PyRingWriter&>(writer);
    const auto info = record_info(time_ns, link, kind, verdict);
    auto claimed = of.claim(length_within(length, of.longest()));
    return nb::cast(new Claim(writer, of, std::move(claimed), time_ns.has_value(), info), nb::rv_policy::take_ownership);
}

void bind_ring_claim(nb::module_& module) {
    using namespace nb::literals;
    nb::class_<ClaimView>(module, "RingClaimView", nb::type_slots(claim_view_slots), nb::is_final(),
                          "The bytes of a claim, as a buffer.");
    nb::class_<Claim>(module, "RingClaim", nb::is_final(),
                      "Room for one record in a ring, to be filled without a copy.\n\n"
                      "`with writer.claim(n) as view: view[:] = ...` commits the record at the end of the block, or\n"
                      "abandons it if the block raises. Delete slices and arrays made of the view before the block\n"
                      "ends. Otherwise BufferError is raised and the record is not written. A claim that is\n"
                      "garbage-collected is abandoned.")
        .def_prop_ro("data", &Claim::data, nb::sig("def data(self) -> memoryview"),
                     "One writable memoryview of the room, which ends with the claim. Its initial content is\n"
                     "undefined.")
        .def("commit", &Claim::commit, "length"_a = nb::none(), nb::kw_only(), "time_ns"_a = nb::none(),
             nb::sig("def commit(self, length: int | None = None, *, time_ns: int | None = None) -> bool"),
             "Publishes the first `length` bytes, by default all. The record has the time given here, else the\n"
             "time given to `claim`, else the current time.\n\n"
             "Returns False if a full ring dropped the record and counted it (only with full=\"drop_newest\").\n"
             "Raises BufferError while a slice or an array is alive: delete it and commit again. Raises\n"
             "ClosedError if the claim is over.")
        .def("abandon", &Claim::abandon,
             "Ends the claim without writing a record. May be called again. While a slice or an array is\n"
             "alive, the room stays reserved.")
        .def(
            "__enter__", [](Claim& claim) { return claim.data(); }, nb::sig("def __enter__(self) -> memoryview"))
        .def(
            "__exit__",
            [](Claim& claim, const nb::args& raised) { claim.exit(!raised.empty() && !raised[0].is_none()); },
            nb::sig("def __exit__(self, *args: object) -> None"))
        .def("__repr__", [](const Claim&) { return "<RingClaim>"; });
}

}  // namespace mavloom::python
