// SPDX-License-Identifier: MIT
// Links for Python: _core.Port, on which mavloom.Link is built, and class Subscription.
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
#include "iteration.hpp"
#include "link_stats.hpp"
#include "mavloom/ring/frames.hpp"
#include "ring_alarm.hpp"
#include "ring_writer.hpp"
#include "waiting.hpp"

namespace mavloom::python {
namespace {

// ---- class Subscription

class Subscription {
public:
    Subscription(std::shared_ptr<Channel> channel, Filter filter)
        : consumer_(std::make_unique<Consumer>(std::move(channel), std::move(filter))) {}
    ~Subscription() {
        if (!fork_.is_here()) static_cast<void>(consumer_.release());
    }

    // When a call gives up: at its deadline. A poll gives up once it has looked at every frame that was there when it
    // began, whatever arrives meanwhile.
    struct Limit {
        MonoTime deadline;
        std::optional<std::uint64_t> end;  // for a poll: one past the last frame to look at
    };

    // Returns an invalid object if nothing came in time or, with `ended` set, if nothing will ever come.
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
                          const OptionalInteger& system, const OptionalInteger& component) {
        check_condition(condition);
        const auto filter = make_filter(channel().origin()->dialect(), type, system, component);
        return or_closed(filter, condition, blocking ? deadline_after(timeout) : MonoTime{});
    }

    // Raises UsageError if `ring` is the ring that is read: it would be filled with itself.
    void check_target(const std::string& ring) const {
        if (ring == channel().ring_name())
            raise_usage(fmt::format("ring {} is what is heard here: it would be filled with itself", ring));
    }
    // Writes frames to a ring without an object for each message; returns how many. After the time-out it still writes
    // the frames that were there when it began, as far as the ring has room.
    std::uint64_t pump(PyRingWriter& writer, const nb::object& timeout) {
        fork_.check();
        check_target(writer.name());
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

    // For asyncio: after a poll that found nothing, this descriptor becomes readable when another poll is worthwhile.
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
    [[nodiscard]] const Consumer& consumer() const noexcept { return *consumer_; }

private:
    static constexpr std::size_t batch_frames = 256;

    // Call with mutex_ held.
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
                            item.verdict);
    }

    struct Pumped {
        std::uint64_t count = 0;
        std::optional<shm::WriteError> error;
        bool full = false, ended = false;
    };

    // Call without the GIL.
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

    // Call with mutex_ held. A frame for which the ring has no room is put back.
    bool put(PyRingWriter& writer, const FrameBatch::Item& item, MonoTime deadline, Pumped& pumped) {
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

    // Call with mutex_ held.
    [[nodiscard]] bool is_over(const Limit& limit) const {
        if (limit.end) return batch_.left() == 0 && consumer_->seen() >= *limit.end;
        return mono_now() >= limit.deadline;
    }

    const BeforeFork fork_;
    std::unique_ptr<Consumer> consumer_;
    std::mutex mutex_;
    FrameBatch batch_;  // batch_ and ended_ are guarded by mutex_
    bool ended_ = false;
};

// ---- class Port

endpoint::Endpoint endpoint_of(const std::string& url) {
    auto endpoint = value_or_raise(endpoint::parse_endpoint(url));
    if (endpoint.scheme == endpoint::Scheme::tlog)
        raise_usage(fmt::format("'{}' is a recording: mavloom.read() and mavloom.columns() read it", url));
    return endpoint;
}

class Port {
public:
    Port(const std::string& url, const Integer& system, const Integer& component, const nb::object& dialect,
         const Integer& buffer, const Integer& version)
        : origin_(std::make_shared<Origin>(definitions_of(dialect))),
          source_{SystemId{system.in<std::uint8_t>("source_system")},
                  ComponentId{component.in<std::uint8_t>("source_component")}},
          version_(version_of("version", version)) {
        const auto endpoint = endpoint_of(url);
        channel_ = std::make_shared<Channel>(origin_, buffer.in<std::size_t>("buffer", 0, FrameRing::max_capacity),
                                             endpoint);
        // The reader must exist before anything can arrive.
        reader_ = nb::cast(new Subscription(channel_, {}), nb::rv_policy::take_ownership);
        auto opened = [&]() -> SetupResult<Hub::Opened> {
            const WithoutGil outside;
            auto hub = Hub::get();
            if (!hub) return tl::unexpected(std::move(hub.error()));
            hub_ = std::move(*hub);
            return hub_->open(endpoint, channel_, nb::inst_ptr<Subscription>(reader_)->consumer());
        }();
        if (!opened) hub_gone();
        opened_ = value_or_raise(std::move(opened));
        to_ = opened_.endpoint;
    }
    ~Port() {
        if (fork_.is_here() && !WithoutGil::ended()) {
            close();
            return;
        }
        // In a forked child and at the interpreter's end, neither may be destroyed: leak them.
        static_cast<void>(new std::shared_ptr(std::move(hub_)));
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
        const auto& info = builder.definition().wire;
        check_version(version_, builder.definition());
        wire::FrameBuffer buffer;
        return send_frame([&] {
            const wire::FrameHeader header{.version = version_, .sequence = sequence_++, .source = source_};
            return wire::write_frame(buffer, header, info, builder.payload());
        });
    }

    std::size_t forward(const nb::object& message) {
        fork_.check();
        if (nb::isinstance<Message>(message)) {
            const auto frame = nb::inst_ptr<Message>(message)->frame();
            return send_frame([&] { return frame; });
        }
        const Buffer buffer(message);
        const auto frame = whole_frame(origin_->dialect(), buffer.bytes());
        return send_frame([&] { return frame; });
    }

    void serve_inlet(const std::string& ring, const Integer& mode) {
        fork_.check();
        const auto bits = mode.in<unsigned>("mode", 0, 0777);
        auto opened = [&]() -> std::optional<SetupResult<void>> {
            const WithoutGil outside;
            const std::lock_guard lock(mutex_);
            if (!hub_) return std::nullopt;
            return hub_->serve_inlet(opened_.endpoint, ring, bits & 0666u);
        }();
        if (!opened) raise_closed("the link is closed");
        value_or_raise(std::move(*opened));
    }

    nb::object latest(const nb::object& type, const OptionalInteger& system, const OptionalInteger& component,
                      const std::optional<Instance>& instance, const nb::object& max_age) {
        check();
        const auto filter = make_filter(origin_->dialect(), type, system, component);
        const auto not_before = max_age.is_none() ? MonoTime::min() : mono_now() - duration_of("max_age", max_age);
        const auto found = channel_->latest(filter, instance, not_before);
        if (!found) return nb::none();
        const auto frame = wire::FrameView::unchecked(found->bytes);
        return make_message(origin_, origin_->dialect().find(frame.id()), found->head.time_ns, found->head.link, frame,
                            found->head.verdict);
    }

    nb::object subscribe(const nb::object& type, const OptionalInteger& system, const OptionalInteger& component) {
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
        stats.hints = hints_of(origin_->dialect(), stats);
        return stats;
    }

    [[nodiscard]] nb::object reader() const { return reader_; }
    [[nodiscard]] PyDialect dialect() const { return {origin_->definitions()}; }
    [[nodiscard]] const std::string& name() const noexcept { return opened_.name; }
    [[nodiscard]] int port() const noexcept { return opened_.port; }
    [[nodiscard]] int version() const noexcept { return static_cast<int>(version_); }
    [[nodiscard]] Source target() const {
        fork_.check();
        return channel_->target();
    }

private:
    // `make` returns the frame. It is called only if there is a peer.
    template <class Make>
    std::size_t send_frame(Make make) {
        const auto peers = send_if_open(make);
        if (!peers) raise_closed("the link is closed");
        return *peers;
    }
    template <class Make>
    std::optional<std::size_t> send_if_open(Make make) {
        const WithoutGil outside;
        const std::lock_guard lock(mutex_);
        if (!hub_) return std::nullopt;
        if (opened_.is_ring && to_ == opened_.endpoint) to_ = hub_->inlet(to_).value_or(to_);
        const auto peers = channel_->peers();
        if (peers == 0) return ++no_peer_, 0;
        hub_->send(to_, make());
        return peers;
    }
    void check() {
        fork_.check();
        const auto lock = lock_without_gil(mutex_);
        if (!hub_) raise_closed("the link is closed");
    }
    // Lets go of the hub, which ends the loop thread if no other link needs it.
    void hub_gone() {
        const WithoutGil outside;
        hub_.reset();
    }

    const BeforeFork fork_;
    const std::shared_ptr<Origin> origin_;
    const Source source_;
    const wire::Version version_;
    std::shared_ptr<Channel> channel_;
    nb::object reader_;
    Hub::Opened opened_;
    std::mutex mutex_;
    // Guarded by mutex_:
    std::shared_ptr<Hub> hub_;  // null: closed
    link::EndpointId to_;       // where frames are sent; for a ring its inlet, from the first frame on
    LinkStats last_;
    std::uint64_t no_peer_ = 0;
    std::uint8_t sequence_ = 0;
};

constexpr const char* match_signature =
    "def recv_match(self, condition: collections.abc.Callable[[Message], object] | None = None, type: MessageTypes | "
    "None = None, "
    "blocking: bool = False, timeout: float | None = None, system: int | None = None, component: int | None = None) -> "
    "Message | None";

}  // namespace

void bind_link(nb::module_& module) {
    Hub::watch_forks();
    bind_link_stats(module);
    nb::class_<Subscription>(module, "Subscription", nb::type_slots(iterator_slots<Subscription>), nb::is_final(),
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
        .def("check_target", &Subscription::check_target, nb::arg("ring"),
             "UsageError for the name of the ring that is read: `pump` would fill it with itself.")
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
        .def(nb::init<const std::string&, const Integer&, const Integer&, const nb::object&, const Integer&,
                      const Integer&>(),
             nb::arg("url"), nb::arg("source_system"), nb::arg("source_component"), nb::arg("dialect").none(),
             nb::arg("buffer"), nb::arg("version"),
             nb::sig("def __init__(self, url: str, source_system: int, source_component: int, dialect: Dialect | None, "
                     "buffer: int, version: int) -> None"))
        .def("close", &Port::close)
        .def("send", &Port::send, nb::arg(), nb::arg("fields"),
             nb::sig("def send(self, message: str | Message, /, **fields: typing.Any) -> int"))
        .def("forward", &Port::forward, nb::arg(), nb::sig("def forward(self, message: Message | Buffer, /) -> int"))
        .def("serve_inlet", &Port::serve_inlet, nb::arg("ring"), nb::arg("mode"),
             nb::sig("def serve_inlet(self, ring: str, mode: int) -> None"))
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
        .def_prop_ro("version", &Port::version)
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
