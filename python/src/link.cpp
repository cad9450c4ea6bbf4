// SPDX-License-Identifier: MIT
// Links as Python sees them: _core.Port (mavloom.Link is built on it) and class Subscription.
#include <fmt/format.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/variant.h>

#include <mutex>

#include "bindings.hpp"
#include "channel.hpp"
#include "encode.hpp"
#include "errors.hpp"
#include "gil.hpp"
#include "hub.hpp"
#include "mavloom/runtime/ring_frames.hpp"
#include "ring_alarm.hpp"
#include "ring_writer.hpp"
#include "waiting.hpp"

namespace mavloom::python {
namespace {

using OptionalByte = std::optional<std::uint8_t>;

// ---- class Subscription

class Subscription {
public:
    Subscription(std::shared_ptr<Channel> channel, Filter filter)
        : consumer_(std::make_unique<Consumer>(std::move(channel), std::move(filter))) {}
    ~Subscription() {
        if (!fork_.is_here()) static_cast<void>(consumer_.release());
    }

    // When a call gives up: at its deadline. One that only polls: when it has looked at what was there as it began, whatever arrives meanwhile.
    struct Limit {
        MonoTime deadline;
        std::optional<std::uint64_t> end;  // of a poll: the frame behind
    };

    // Invalid when nothing came in time, or, with `ended`, when nothing ever will.
    nb::object next(const Filter& filter, const Limit& limit, bool& ended) {
        for (;;) {
            fork_.check();
            {
                const auto lock = lock_without_gil(mutex_);
                while (const auto* item = next_item()) {
                    if (filter.takes(batch_.frame(*item))) return message_of(*item);
                    if (is_over(limit)) return {};
                }
                if (ended_) return ended = true, nb::object();
                if (is_over(limit)) return {};
            }
            {
                const WithoutGil outside;
                consumer_->wait(limit.deadline);
            }
            check_signals();
        }
    }

    PyObject* iterate() {
        bool ended = false;
        return next({}, {MonoTime::max(), {}}, ended).release().ptr();
    }

    nb::object recv(const nb::object& timeout) { return or_closed({}, nb::none(), deadline_after(timeout)); }

    nb::object recv_match(const nb::object& condition, const nb::object& type, bool blocking, const nb::object& timeout,
                          OptionalByte system, OptionalByte component) {
        check_condition(condition);
        const auto filter = make_filter(channel().origin()->dialect(), type, system, component);
        return or_closed(filter, condition, blocking ? deadline_after(timeout) : MonoTime{});
    }

    // Into a ring, without an object for each message; how many. Also after the time what was there when it began, as far as the ring has room.
    std::uint64_t pump(PyRingWriter& writer, const nb::object& timeout) {
        fork_.check();
        const auto deadline = deadline_after(timeout);
        const auto end = consumer_->newest();
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

    // For asyncio: tells when to ask again after a poll that found nothing.
    int event_fd() {
        fork_.check();
        return value_or_raise(consumer_->event_fd());
    }

    [[nodiscard]] std::uint64_t missed() const {
        fork_.check();
        return consumer_->missed();
    }
    void close() {
        if (fork_.is_here()) consumer_->close();
    }
    [[nodiscard]] const Channel& channel() const noexcept { return *consumer_->channel(); }

private:
    static constexpr std::size_t batch_frames = 256;

    // With mutex_ held.
    const FrameBatch::Item* next_item() {
        ended_ = consumer_->closed();
        if (ended_) return nullptr;
        if (const auto* item = batch_.next()) return item;
        batch_.clear();
        ended_ = !consumer_->take(batch_, batch_frames);
        return batch_.next();
    }
    nb::object message_of(const FrameBatch::Item& item) const {
        return make_message(channel().origin(), item.definition, item.time_ns, item.link, batch_.frame(item),
                            item.verified);
    }

    struct Pumped {
        std::uint64_t count = 0;
        std::optional<shm::WriteError> error;
        bool full = false, ended = false;
    };

    // Without the GIL.
    void pump_slice(PyRingWriter& writer, MonoTime deadline, Pumped& pumped) {
        const MonoTime now = mono_now();
        const MonoTime end = now + longest_slice;
        const MonoTime waits_until = now < deadline ? std::min(deadline, end) : MonoTime{};
        do {
            {
                const std::lock_guard lock(mutex_);
                while (const auto* item = next_item())
                    if (!put(writer, *item, waits_until, pumped) || mono_now() >= end) return;
                pumped.ended = ended_;
            }
            if (!pumped.ended) consumer_->wait(waits_until);
        } while (!pumped.ended && mono_now() < waits_until);
    }

    // With mutex_ held. What the ring has no room for comes again.
    bool put(PyRingWriter& writer, const FrameBatch::Item& item, MonoTime deadline, Pumped& pumped) {
        const auto frame = batch_.frame(item);
        const shm::RecordInfo info{.time = WallTime{Nanoseconds{item.time_ns}},
                                   .link = LinkId{item.link},
                                   .kind = runtime::ring_kind_frame,
                                   .verdict = runtime::ring_verdict(signature_of(frame, item.verified))};
        const auto written = writer.put(frame.bytes(), info, deadline);
        pumped.full = !written && written.error() == shm::WriteError::full;
        if (written) return ++pumped.count, true;
        if (pumped.full && !writer.waits()) return true;  // dropped, as it was asked to, and counted by the ring
        if (!pumped.full) pumped.error = written.error();
        batch_.put_back();
        return false;
    }

    static runtime::FrameSignature signature_of(const wire::FrameView& frame, bool verified) noexcept {
        using runtime::FrameSignature;
        if (!frame.is_signed()) return FrameSignature::none;
        return verified ? FrameSignature::good : FrameSignature::unchecked;
    }

    nb::object or_closed(const Filter& filter, const nb::object& condition, MonoTime deadline) {
        fork_.check();
        Limit limit{deadline, {}};
        if (deadline <= mono_now()) limit.end = consumer_->newest();
        for (bool ended = false;;) {
            nb::object message = next(filter, limit, ended);
            if (ended) raise_closed("the link is closed");
            if (!message.is_valid()) return nb::none();
            if (condition.is_none() || nb::cast<bool>(nb::bool_(condition(message)))) return message;
            const auto lock = lock_without_gil(mutex_);
            if (is_over(limit)) return nb::none();
        }
    }

    [[nodiscard]] bool is_past(std::uint64_t end) {
        const auto lock = lock_without_gil(mutex_);
        return is_over({{}, end});
    }

    // With mutex_ held.
    [[nodiscard]] bool is_over(const Limit& limit) const {
        if (limit.end) return batch_.left() == 0 && consumer_->seen() >= *limit.end;
        return mono_now() >= limit.deadline;
    }

    const BeforeFork fork_;
    std::unique_ptr<Consumer> consumer_;
    std::mutex mutex_;
    FrameBatch batch_;  // this and the next: guarded by mutex_
    bool ended_ = false;
};

PyObject* next_message(PyObject* self) noexcept {
    try {
        if (nb::inst_ready(self)) return nb::inst_ptr<Subscription>(self)->iterate();
        PyErr_SetString(PyExc_TypeError, "a Subscription is made by a Link");
    } catch (nb::python_error& error) {
        error.restore();
    } catch (const std::exception& error) {
        PyErr_SetString(PyExc_RuntimeError, error.what());
    }
    return nullptr;
}

PyType_Slot subscription_slots[] = {
    {Py_tp_iternext, reinterpret_cast<void*>(next_message)},   // NOLINT
    {Py_tp_iter, reinterpret_cast<void*>(PyObject_SelfIter)},  // NOLINT
    {0, nullptr},
};

// ---- class Port

runtime::Endpoint endpoint_of(const std::string& url) {
    auto endpoint = value_or_raise(runtime::parse_endpoint(url));
    if (endpoint.scheme == runtime::Scheme::tlog)
        raise_usage(fmt::format("'{}' is a recording: mavloom.read() and mavloom.columns() read it", url));
    if (endpoint.scheme == runtime::Scheme::shm)
        raise_usage(fmt::format("'{}' is a ring, which connect() does not read", url));
    return endpoint;
}

class Port {
public:
    Port(const std::string& url, std::uint8_t system, std::uint8_t component, const nb::object& dialect,
         std::size_t buffer_bytes)
        : origin_(std::make_shared<Origin>(definitions_of(dialect))), source_{SystemId{system}, ComponentId{component}} {
        const auto endpoint = endpoint_of(url);
        channel_ = std::make_shared<Channel>(origin_, buffer_bytes, !endpoint.options.verify_key_file.empty());
        // Before anything can arrive.
        reader_ = nb::cast(new Subscription(channel_, {}), nb::rv_policy::take_ownership);
        auto opened = [&]() -> SetupResult<Hub::Opened> {
            const WithoutGil outside;
            auto hub = Hub::get(origin_->definitions());
            if (!hub) return tl::unexpected(std::move(hub.error()));
            hub_ = std::move(*hub);
            return hub_->open(endpoint, channel_);
        }();
        if (!opened) hub_gone();
        opened_ = value_or_raise(std::move(opened));
    }
    ~Port() {
        if (fork_.is_here() && !WithoutGil::ended()) {
            close();
            return;
        }
        static_cast<void>(
            new std::shared_ptr(std::move(hub_)));  // left alone in a forked child, and at the interpreter's end
        static_cast<void>(new std::shared_ptr(std::move(channel_)));
    }
    Port(const Port&) = delete;
    Port& operator=(const Port&) = delete;

    void close() {
        if (!fork_.is_here()) return;
        const WithoutGil outside;
        const std::lock_guard lock(mutex_);
        if (!hub_) return;
        last_ = hub_->close(opened_.endpoint);
        hub_.reset();
    }

    std::size_t send(const nb::object& message, const nb::kwargs& fields) {
        fork_.check();
        const auto builder = build(*origin_->definitions(), message, fields);
        const WithoutGil outside;
        const std::unique_lock lock(mutex_);
        if (!hub_) {
            const nb::gil_scoped_acquire acquire;
            raise_closed("the link is closed");
        }
        const auto peers = channel_->peers();
        if (peers == 0) return ++no_peer_, 0;
        wire::FrameBuffer buffer;
        hub_->send(opened_.endpoint, wire::write_frame(buffer, {.sequence = sequence_++, .source = source_},
                                                       builder.definition().wire, builder.payload()));
        return peers;
    }

    nb::object latest(const nb::object& type, OptionalByte system, OptionalByte component,
                      const std::optional<Instance>& instance, const nb::object& max_age) {
        check();
        const auto filter = make_filter(origin_->dialect(), type, system, component);
        const auto not_before = max_age.is_none() ? MonoTime::min() : mono_now() - duration_of("max_age", max_age);
        const auto found = channel_->latest(filter, instance, not_before);
        if (!found) return nb::none();
        const auto frame = wire::FrameView::unchecked(found->bytes);
        return make_message(origin_, origin_->dialect().find(frame.id()), found->head.time_ns, found->head.link, frame,
                            found->head.verified);
    }

    nb::object subscribe(const nb::object& type, OptionalByte system, OptionalByte component) {
        check();
        auto filter = make_filter(origin_->dialect(), type, system, component);
        return nb::cast(new Subscription(channel_, std::move(filter)), nb::rv_policy::take_ownership);
    }

    [[nodiscard]] LinkStats stats() {
        fork_.check();
        const WithoutGil outside;
        const std::lock_guard lock(mutex_);
        auto stats = hub_ ? hub_->stats(opened_.endpoint) : last_;
        stats.no_peer = no_peer_;
        stats.not_kept = channel_->not_kept();
        stats.missed = nb::inst_ptr<Subscription>(reader_)->missed();
        return stats;
    }

    [[nodiscard]] nb::object reader() const { return reader_; }
    [[nodiscard]] PyDialect dialect() const { return {origin_->definitions()}; }
    [[nodiscard]] const std::string& name() const noexcept { return opened_.name; }
    [[nodiscard]] int port() const noexcept { return opened_.port; }
    [[nodiscard]] Source target() const {
        fork_.check();
        return channel_->target();
    }

private:
    void check() {
        fork_.check();
        const auto lock = lock_without_gil(mutex_);
        if (!hub_) raise_closed("the link is closed");
    }
    // Ends the loop thread where nothing else needs it.
    void hub_gone() {
        const WithoutGil outside;
        hub_.reset();
    }

    const BeforeFork fork_;
    const std::shared_ptr<Origin> origin_;
    const Source source_;
    std::shared_ptr<Channel> channel_;
    nb::object reader_;
    Hub::Opened opened_;
    std::mutex mutex_;
    // Guarded by mutex_.
    std::shared_ptr<Hub> hub_;  // null: closed
    LinkStats last_;
    std::uint64_t no_peer_ = 0;
    std::uint8_t sequence_ = 0;
};

template <auto member>
auto of_links() {
    return [](const LinkStats& stats) { return (stats.links.*member).value(); };
}
template <auto member>
auto of_endpoint() {
    return [](const LinkStats& stats) { return (stats.endpoint.*member).value(); };
}

void bind_stats(nb::module_& module) {
    using L = runtime::LinkCounters;
    using E = runtime::EndpointCounters;
    nb::class_<LinkStats>(module, "LinkStats", nb::is_final(),
                          "A link's counters, over all its peers, those that went included. Every loss has a name.")
        .def_ro("peers", &LinkStats::peers, "Peers or clients that are there now.")
        .def_prop_ro("frames_in", of_links<&L::frames_in>())
        .def_prop_ro("bytes_in", of_links<&L::bytes_in>())
        .def_prop_ro("frames_out", of_links<&L::frames_out>())
        .def_prop_ro("bytes_out", of_links<&L::bytes_out>())
        .def_ro("missed", &LinkStats::missed,
                "Frames that the link's own reader was too slow for: overwritten in the buffer.")
        .def_ro("not_kept", &LinkStats::not_kept,
                "Messages that `latest` does not know: it keeps 16,384 of different source, id and instance.")
        .def_ro("no_peer", &LinkStats::no_peer, "Messages that `send` had nobody for.")
        .def_prop_ro("lost", of_links<&L::lost>(),
                     "Lost on the way here, by sequence numbers; late and doubled frames are no loss.")
        .def_prop_ro("late", of_links<&L::late>())
        .def_prop_ro("duplicate", of_links<&L::duplicate>())
        .def_prop_ro("resync", of_links<&L::resync>(), "Jumps too long to be loss: a reboot.")
        .def_prop_ro("kernel_drop", of_endpoint<&E::kernel_drop>(), "Datagrams that the kernel had no room for.")
        .def_prop_ro("crc_error", of_links<&L::crc_error>())
        .def_prop_ro("junk_bytes", of_links<&L::junk_bytes>())
        .def_prop_ro("unknown_ids", of_links<&L::unknown_ids>())
        .def_prop_ro("unknown_flags", of_links<&L::unknown_flags>())
        .def_prop_ro("bad_signature", of_links<&L::bad_signature>())
        .def_prop_ro("wrong_peer", of_endpoint<&E::wrong_peer>())
        .def_prop_ro("stray_bytes", of_endpoint<&E::stray_bytes>())
        .def_prop_ro("queue_bytes", of_links<&L::queue_bytes>(), "Frames dropped on the way out: the queue was full.")
        .def_prop_ro("queue_age", of_links<&L::queue_age>(), "Frames dropped on the way out: too old.")
        .def_prop_ro("not_sent", of_links<&L::frames_not_sent>(), "Frames that the kernel refused.")
        .def_prop_ro("reconnects", of_endpoint<&E::reconnects>());
}

constexpr const char* match_signature =
    "def recv_match(self, condition: collections.abc.Callable[[Message], object] | None = None, type: MessageTypes | "
    "None = None, "
    "blocking: bool = False, timeout: float | None = None, system: int | None = None, component: int | None = None) -> "
    "Message | None";

}  // namespace

void bind_link(nb::module_& module) {
    Hub::watch_forks();
    bind_stats(module);
    nb::class_<Subscription>(module, "Subscription", nb::type_slots(subscription_slots), nb::is_final(),
                             "Messages of a link from the moment it was made, for one reader: iterate, `async for` "
                             "(one at a time), or `recv`. A reader that is slower than the\n"
                             "link's buffer allows misses the oldest ones and is told how many. Any thread. Iteration "
                             "ends when the link is closed.")
        .def("recv", &Subscription::recv, nb::arg("timeout") = nb::none(),
             nb::sig("def recv(self, timeout: float | None = None) -> Message | None"),
             "The next message; None after `timeout` seconds (0 polls, None waits for ever). ClosedError when the link "
             "is closed.")
        .def("recv_match", &Subscription::recv_match, nb::arg("condition") = nb::none(), nb::arg("type") = nb::none(),
             nb::arg("blocking") = false, nb::arg("timeout") = nb::none(), nb::arg("system") = nb::none(),
             nb::arg("component") = nb::none(), nb::sig(match_signature),
             "The next message of these types for which `condition(message)` is true; what comes before it is passed "
             "over. None when there is none: at once,\n"
             "or with `blocking` after `timeout` seconds.")
        .def(
            "pump", &Subscription::pump, nb::arg("writer"), nb::arg("timeout") = nb::none(),
            nb::sig("def pump(self, writer: RingWriter, timeout: float | None = None) -> int"),
            "Writes the frames that arrive into a ring, in C++ and without the GIL, for `timeout` seconds (None: "
            "until the "
            "link is closed). Returns how many. Each record is a\n"
            "whole frame of kind 1 with its receive time and link; `verdict` is 0 unsigned, 16 signed and not checked, "
            "32 signed and verified, as docs/formats/ring.md has it. What a full ring has no room for stays with\n"
            "the reader.")
        .def("event_fd", &Subscription::event_fd)
        .def_prop_ro("missed", &Subscription::missed,
                     "Frames of the link that were overwritten before this reader came to them.")
        .def("close", &Subscription::close, "Wakes who waits; may be called again.")
        .def(
            "__aiter__", [](nb::handle self) { return nb::module_::import_("mavloom._async").attr("messages")(self); },
            nb::sig("def __aiter__(self) -> collections.abc.AsyncGenerator[Message, None]"));

    nb::class_<Port>(module, "Port", nb::is_final())
        .def(nb::init<const std::string&, std::uint8_t, std::uint8_t, const nb::object&, std::size_t>(), nb::arg("url"),
             nb::arg("source_system"), nb::arg("source_component"), nb::arg("dialect").none(), nb::arg("buffer"),
             nb::sig("def __init__(self, url: str, source_system: int, source_component: int, dialect: Dialect | None, "
                     "buffer: int) -> None"))
        .def("close", &Port::close)
        .def("send", &Port::send, nb::arg(), nb::arg("fields"),
             nb::sig("def send(self, message: str | Message, /, **fields: typing.Any) -> int"))
        .def("latest", &Port::latest, nb::arg("type").none(), nb::arg("system").none(), nb::arg("component").none(),
             nb::arg("instance").none(), nb::arg("max_age").none(),
             nb::sig("def latest(self, type: MessageTypes | None, system: int | None, component: int | None, instance: "
                     "int | str | None, "
                     "max_age: float | None) -> Message | None"))
        .def("subscribe", &Port::subscribe, nb::keep_alive<0, 1>(), nb::arg("type").none(), nb::arg("system").none(),
             nb::arg("component").none(),
             nb::sig("def subscribe(self, type: MessageTypes | None, system: int | None, component: int | None) -> "
                     "Subscription"))
        .def_prop_ro("stats", &Port::stats)
        .def_prop_ro("reader", &Port::reader, nb::sig("def reader(self) -> Subscription"))
        .def_prop_ro("dialect", &Port::dialect)
        .def_prop_ro("name", &Port::name)
        .def_prop_ro("port", &Port::port)
        .def_prop_ro("target_system", [](const Port& link) { return link.target().system.value; })
        .def_prop_ro("target_component", [](const Port& link) { return link.target().component.value; });

    module.def("stop_all", [] {
        const nb::gil_scoped_release release;
        WithoutGil::end();
        Hub::stop_all();
        RingAlarm::stop_all();
    });
}

}  // namespace mavloom::python
