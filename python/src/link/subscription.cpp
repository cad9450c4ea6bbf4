// SPDX-License-Identifier: MIT
#include "link/subscription.hpp"

#include <fmt/format.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/variant.h>

#include "bindings.hpp"
#include "errors.hpp"
#include "gil.hpp"
#include "iteration.hpp"
#include "mavloom/feed/sliced_mutex.hpp"
#include "mavloom/ring/frames.hpp"
#include "message/filter.hpp"
#include "strings.hpp"

namespace mavloom::python {

static constexpr std::size_t batch_frames = 256;

Subscription::Subscription(const LinkFeed& feed, dialect::Filter filter)
    : origin_(feed.origin),
      ring_name_(feed.ring_name),
      reader_(std::make_unique<feed::ChannelReader>(feed.channel, std::move(filter))) {}

Subscription::~Subscription() {
    if (!fork_.is_own_process()) static_cast<void>(reader_.release());
}

// ---- messages

nb::object Subscription::next(const dialect::Filter& filter, const Limit& limit, bool& ended) {
    for (;;) {
        fork_.check();
        {
            const auto lock = lock_without_gil(mutex_);
            while (const auto* item = next_item()) {
                if (filter.admits(batch_.frame(*item))) return message_of(*item);
                if (is_over(limit)) return {};
            }
            if (ended_) return ended = true, nb::object();
            if (is_over(limit)) return {};
        }
        {
            const WithoutGil outside;
            reader_->wait(limit.deadline);
        }
        check_signals();
    }
}

const feed::FrameBatch::Item* Subscription::next_item() {
    ended_ = reader_->closed();
    if (ended_) return nullptr;
    if (const auto* item = batch_.next()) return item;
    batch_.clear();
    ended_ = !reader_->take(batch_, batch_frames);
    return batch_.next();
}

nb::object Subscription::message_of(const feed::FrameBatch::Item& item) const {
    return make_message(origin_, item.definition, item.time_ns, item.link, batch_.frame(item), item.verdict);
}

bool Subscription::is_over(const Limit& limit) const {
    if (limit.end) return batch_.left() == 0 && reader_->seen() >= *limit.end;
    return mono_now() >= limit.deadline;
}

PyObject* Subscription::iterate() {
    bool ended = false;
    return next({}, {MonoTime::max(), {}}, ended).release().ptr();
}

nb::object Subscription::recv(const nb::object& timeout) { return or_closed({}, nb::none(), deadline_after(timeout)); }

nb::object Subscription::recv_match(const nb::object& condition, const nb::object& type, const nb::object& blocking,
                                    const nb::object& timeout, const OptionalInteger& system,
                                    const OptionalInteger& component) {
    check_condition(condition);
    const auto filter = make_filter(origin_->dialect(), type, system, component);
    return or_closed(filter, condition, deadline_after(match_timeout(blocking, timeout)));
}

nb::object Subscription::or_closed(const dialect::Filter& filter, const nb::object& condition, MonoTime deadline) {
    fork_.check();
    Limit limit{deadline, {}};
    if (deadline <= mono_now()) limit.end = reader_->newest();
    for (bool ended = false;;) {
        nb::object message = next(filter, limit, ended);
        if (ended) raise_closed("the link is closed");
        if (!message.is_valid()) return nb::none();
        if (condition.is_none() || nb::cast<bool>(nb::bool_(condition(message)))) return message;
        const auto lock = lock_without_gil(mutex_);
        if (is_over(limit)) return nb::none();
    }
}

int Subscription::event_fd() {
    fork_.check();
    return value_or_raise(reader_->event_fd());
}

std::string Subscription::shown() const {
    return fork_.is_own_process() ? fmt::format("<Subscription: {} missed>", reader_->missed())
                                  : "<Subscription, opened before a fork>";
}

std::uint64_t Subscription::missed() const {
    fork_.check();
    return reader_->missed();
}

void Subscription::close() {
    if (fork_.is_own_process()) reader_->close();
}

// ---- into a ring

void Subscription::check_target(const std::string& ring) const {
    if (ring == ring_name_)
        raise_usage(fmt::format("this link reads ring {}, so the ring would be filled with its own records", ring));
}

std::uint64_t Subscription::pump(PyRingWriter& writer, const nb::object& timeout) {
    fork_.check();
    check_target(writer.name());
    const auto deadline = deadline_after(timeout);
    const auto end = reader_->newest();
    for (Pumped pumped;;) {
        writer.check();
        {
            const WithoutGil outside;
            pump_slice(writer, deadline, pumped);
        }
        check_signals();
        fork_.check();
        if (pumped.error) writer.raise(*pumped.error, 0);
        if (pumped.ended || (mono_now() >= deadline && (pumped.full || is_past(end)))) return pumped.count;
    }
}

bool Subscription::is_past(std::uint64_t end) {
    const auto lock = lock_without_gil(mutex_);
    return is_over({{}, end});
}

void Subscription::pump_slice(PyRingWriter& writer, MonoTime deadline, Pumped& pumped) {
    const MonoTime now = mono_now();
    const MonoTime end = now + feed::longest_slice;
    const MonoTime waits_until = now < deadline ? std::min(deadline, end) : MonoTime{};
    do {
        {
            const std::lock_guard lock(mutex_);
            while (const auto* item = next_item())
                if (!put(writer, *item, waits_until, pumped) || mono_now() >= end) return;
            pumped.ended = ended_;
        }
        if (!pumped.ended) reader_->wait(waits_until);
    } while (!pumped.ended && mono_now() < waits_until);
}

bool Subscription::put(PyRingWriter& writer, const feed::FrameBatch::Item& item, MonoTime deadline, Pumped& pumped) {
    const auto frame = batch_.frame(item);
    const shm::RecordInfo info{.time = WallTime{Nanoseconds{item.time_ns}},
                               .link = LinkId{item.link},
                               .kind = ring::ring_kind_frame,
                               .verdict = item.verdict};
    const auto written = writer.put(frame.bytes(), info, deadline);
    pumped.full = !written && written.error() == shm::WriteError::full;
    if (written) return ++pumped.count, true;
    if (pumped.full && !writer.waits()) return true;  // dropped by the ring's policy, and counted by the ring
    if (!pumped.full) pumped.error = written.error();
    batch_.put_back();
    return false;
}

// ---- binding

static constexpr const char* match_signature =
    "def recv_match(self, condition: collections.abc.Callable[[Message], object] | None = None, type: MessageTypes | "
    "None = None, "
    "blocking: bool | None = None, timeout: float | None = None, system: int | None = None, component: int | None = "
    "None) -> "
    "Message | None";

void bind_subscription(nb::module_& module) {
    nb::class_<Subscription>(
        module, "Subscription", nb::type_slots(iterator_slots<Subscription>), nb::is_final(),
        "One reader of a link's messages, from the moment it was created. Use iteration, `async for` (one\n"
        "task at a time), or `recv`.\n\n"
        "A reader that is slower than the link's buffer allows misses the oldest messages; `missed`\n"
        "counts them. Safe from any thread. Iteration ends when the link is closed.")
        .def("recv", &Subscription::recv, nb::arg("timeout") = nb::none(),
             nb::sig("def recv(self, timeout: float | None = None) -> Message | None"),
             "Returns the next message, or None after `timeout` seconds (0 polls, None waits indefinitely).\n"
             "Raises ClosedError when the link is closed.")
        .def("recv_match", &Subscription::recv_match, nb::arg("condition") = nb::none(), nb::arg("type") = nb::none(),
             nb::arg("blocking") = nb::none(), nb::arg("timeout") = nb::none(), nb::arg("system") = nb::none(),
             nb::arg("component") = nb::none(), nb::sig(match_signature),
             "Returns the next message of these types for which `condition(message)` is true, and skips those\n"
             "before it. Returns None if there is none: after `timeout` seconds, or at once without a time-out.\n"
             "With `blocking=True` and no time-out it waits indefinitely; with `blocking=False` it never waits.")
        .def("check_target", &Subscription::check_target, nb::arg("ring"),
             "Raises UsageError if this link reads the ring: `pump` would write the ring's own records into it\n"
             "again.")
        .def("pump", &Subscription::pump, nb::arg("writer"), nb::arg("timeout") = nb::none(),
             nb::sig("def pump(self, writer: RingWriter, timeout: float | None = None) -> int"),
             "Writes the frames that arrive to a ring, for `timeout` seconds (None: until the link is closed).\n"
             "Works in C++ without the GIL. Returns the number of frames written.\n\n"
             "Each record is a whole frame of kind 1 with its receive time and link. `verdict` is 0 for\n"
             "unsigned, 16 for signed but not checked, 32 for signed and verified (docs/formats/ring.md).\n"
             "If a full ring has no room for a frame, the frame stays with this reader for its next call.")
        .def("event_fd", &Subscription::event_fd,
             "For other event loops: a descriptor. After `recv(0)` has returned None, the descriptor becomes\n"
             "readable when another call may return a message. Before that call, read the 8 bytes from it.\n"
             "The subscription closes it.")
        .def("__repr__", &Subscription::shown)
        .def_prop_ro("missed", &Subscription::missed, "Frames that were overwritten before this reader read them.")
        .def("close", &Subscription::close,
             "Closes the reader and wakes the threads that wait on it. May be called again.")
        .def(
            "__aiter__", [](nb::handle self) { return nb::module_::import_("mavloom._async").attr("messages")(self); },
            nb::sig("def __aiter__(self) -> collections.abc.AsyncGenerator[Message, None]"));
}

}  // namespace mavloom::python
