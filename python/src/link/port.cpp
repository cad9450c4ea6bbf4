// SPDX-License-Identifier: MIT
// _core.Port, on which the Python class mavloom.Link is built.
#include <fmt/format.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/variant.h>

#include <mutex>

#include "bindings.hpp"
#include "errors.hpp"
#include "gil.hpp"
#include "link/link_stats.hpp"
#include "link/recorder.hpp"
#include "link/subscription.hpp"
#include "mavloom/feed/hub.hpp"
#include "mavloom/feed/ring_alarm.hpp"
#include "mavloom/feed/vehicle.hpp"
#include "message/encode.hpp"
#include "message/filter.hpp"
#include "strings.hpp"
#include "waiting.hpp"

namespace mavloom::python {
namespace {

endpoint::Endpoint endpoint_of(const std::string& url) {
    auto endpoint = value_or_raise(endpoint::parse_endpoint(url));
    if (endpoint.is_recording())
        raise_usage(fmt::format("'{}' is a recording: mavloom.read() and mavloom.columns() read it", url));
    return endpoint;
}

// 0 addresses every system or component, and is no sender.
SystemId sender_system(const Integer& given) { return SystemId{given.in<std::uint8_t>("source_system", 1, 255)}; }
ComponentId sender_component(const Integer& given) {
    return ComponentId{given.in<std::uint8_t>("source_component", 1, 255)};
}

class Port {
public:
    Port(const std::string& url, const Integer& system, const Integer& component, const nb::object& dialect,
         const Integer& buffer, const Integer& version)
        : origin_(std::make_shared<Origin>(definitions_of(dialect))),
          source_{sender_system(system), sender_component(component)},
          version_(version_of("version", version)) {
        const auto endpoint = endpoint_of(url);
        feed_ = feed_of(endpoint, buffer.in<std::size_t>("buffer", 0, feed::FrameRing::max_capacity));
        // The reader must exist before anything can arrive. For mavloom.mavutil, it alone returns messages of that
        // style.
        auto read = feed_;
        if (auto style = style_of(dialect)) read.origin = std::make_shared<Origin>(*origin_, std::move(style));
        reader_ = nb::cast(new Subscription(read, {}), nb::rv_policy::take_ownership);
        auto opened = [&]() -> SetupResult<feed::Hub::Opened> {
            const WithoutGil outside;
            auto hub = feed::Hub::get();
            if (!hub) return tl::unexpected(std::move(hub.error()));
            hub_ = std::move(*hub);
            return hub_->open(endpoint, feed_.channel, nb::inst_ptr<Subscription>(reader_)->reader());
        }();
        if (!opened) hub_gone();
        opened_ = value_or_raise(std::move(opened));
        to_ = opened_.endpoint;
    }
    ~Port() {
        if (fork_.is_own_process() && !WithoutGil::ended()) {
            close();
            return;
        }
        // In a forked child and at the interpreter's end, neither may be destroyed: leak them.
        static_cast<void>(new std::shared_ptr(std::move(hub_)));
        static_cast<void>(new std::shared_ptr(std::move(feed_.channel)));
    }
    Port(const Port&) = delete;
    Port& operator=(const Port&) = delete;

    void close() {
        if (!fork_.is_own_process()) return;
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
                      const nb::object& instance, const nb::object& max_age) {
        check();
        const auto filter = make_filter(origin_->dialect(), type, system, component);
        const auto wanted = instance_from(instance);
        if (wanted && !type.is_none())
            for (const auto& message : origin_->dialect().messages())
                if (filter.admits(message.id())) check_instance(message, *wanted);
        const auto not_before = max_age.is_none() ? MonoTime::min() : mono_now() - duration_of("max_age", max_age);
        const auto found = feed_.channel->latest(filter, wanted, not_before);
        if (!found) return nb::none();
        const auto frame = found->frame();
        return make_message(origin_, origin_->dialect().find(frame.id()), found->head.time_ns, found->head.link, frame,
                            found->head.verdict);
    }

    nb::object subscribe(const nb::object& type, const OptionalInteger& system, const OptionalInteger& component) {
        check();
        auto filter = make_filter(origin_->dialect(), type, system, component);
        return nb::cast(new Subscription(feed_, std::move(filter)), nb::rv_policy::take_ownership);
    }

    [[nodiscard]] LinkStats stats() {
        fork_.check();
        const WithoutGil outside;
        const std::lock_guard lock(mutex_);
        LinkStats stats{hub_ ? hub_->stats(opened_.endpoint) : last_};
        stats.no_peer = no_peer_;
        stats.not_kept = feed_.channel->not_kept();
        stats.missed = nb::inst_ptr<Subscription>(reader_)->missed();
        stats.hints = hints_of(origin_->dialect(), stats);
        return stats;
    }

    [[nodiscard]] std::string silence_reason() {
        fork_.check();
        const WithoutGil outside;
        const std::lock_guard lock(mutex_);
        return hub_ ? hub_->silence_reason(opened_.endpoint) : "the link is closed";
    }

    // Bytes of frames that were sent and not yet handed to the kernel; 0 for a closed link.
    [[nodiscard]] std::size_t queued_bytes() {
        fork_.check();
        const WithoutGil outside;
        const std::lock_guard lock(mutex_);
        return hub_ ? hub_->queued_bytes(opened_.endpoint) : 0;
    }

    // Records every frame that arrives, until the recorder or the link is closed.
    nb::object record(const nb::object& path) {
        check();
        return nb::cast(new LinkRecorder(feed_.channel, path_of(path)), nb::rv_policy::take_ownership);
    }

    [[nodiscard]] int source_system() { return source().system.value; }
    [[nodiscard]] int source_component() { return source().component.value; }
    [[nodiscard]] int sequence() {
        const auto lock = lock_without_gil(mutex_);
        return sequence_;
    }
    void set_source_system(const Integer& system) {
        const auto given = sender_system(system);
        const auto lock = lock_without_gil(mutex_);
        source_.system = given;
    }
    void set_source_component(const Integer& component) {
        const auto given = sender_component(component);
        const auto lock = lock_without_gil(mutex_);
        source_.component = given;
    }
    void set_sequence(const Integer& sequence) {
        const auto given = sequence.in<std::uint8_t>("seq");
        const auto lock = lock_without_gil(mutex_);
        sequence_ = given;
    }

    [[nodiscard]] nb::object reader() const { return reader_; }
    [[nodiscard]] PyDialect dialect() const { return {origin_->definitions(), nullptr}; }
    [[nodiscard]] const std::string& name() const noexcept { return opened_.name; }
    [[nodiscard]] int port() const noexcept { return opened_.port; }
    [[nodiscard]] int version() const noexcept { return static_cast<int>(version_); }
    [[nodiscard]] Source target() const {
        fork_.check();
        return feed_.channel->target();
    }

private:
    // The channel shares the definitions and the names of links with the messages.
    [[nodiscard]] LinkFeed feed_of(const endpoint::Endpoint& endpoint, std::size_t buffer_bytes) const {
        auto channel = std::make_shared<feed::Channel>(
            std::shared_ptr<const dialect::Dialect>(origin_->definitions(), &origin_->dialect()),
            origin_->shared_link_names(), buffer_bytes, !endpoint.options.verify_key_file.empty());
        const bool is_ring = endpoint.is_ring();
        return {origin_, std::move(channel), is_ring ? endpoint.path : std::string()};
    }
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
        const auto peers = feed_.channel->peers();
        if (peers == 0) return ++no_peer_, 0;
        hub_->send(to_, make());
        return peers;
    }
    [[nodiscard]] Source source() {
        const auto lock = lock_without_gil(mutex_);
        return source_;
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

    const ForkGuard fork_;
    const std::shared_ptr<Origin> origin_;
    Source source_;  // guarded by mutex_, once the object is made
    const wire::Version version_;
    LinkFeed feed_;
    nb::object reader_;
    feed::Hub::Opened opened_;
    std::mutex mutex_;
    // Guarded by mutex_:
    std::shared_ptr<feed::Hub> hub_;  // null: closed
    link::EndpointId to_;             // where frames are sent; for a ring its inlet, from the first frame on
    feed::EndpointStats last_;        // of a link that is closed
    std::uint64_t no_peer_ = 0;
    std::uint8_t sequence_ = 0;
};

}  // namespace

void bind_link(nb::module_& module) {
    bind_link_stats(module);
    bind_subscription(module);
    bind_link_recorder(module);
    nb::class_<Port>(module, "Port", nb::is_final())
        .def(nb::init<const std::string&, const Integer&, const Integer&, const nb::object&, const Integer&,
                      const Integer&>(),
             nb::arg("url"), nb::arg("source_system").none(), nb::arg("source_component").none(),
             nb::arg("dialect").none(), nb::arg("buffer").none(), nb::arg("version").none(),
             nb::sig("def __init__(self, url: str, source_system: int, source_component: int, dialect: Dialect | None, "
                     "buffer: int, version: int) -> None"))
        .def("__repr__", [](const Port& port) { return "<Port of the Link " + port.name() + ">"; })
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
        .def("record", &Port::record, nb::arg("path"),
             nb::sig("def record(self, path: str | os.PathLike[str]) -> LinkRecorder"))
        .def_prop_rw("source_system", &Port::source_system, &Port::set_source_system, nb::for_setter(nb::arg().none()),
                     nb::for_setter(nb::sig("def source_system(self, value: int, /) -> None")))
        .def_prop_rw("source_component", &Port::source_component, &Port::set_source_component,
                     nb::for_setter(nb::arg().none()),
                     nb::for_setter(nb::sig("def source_component(self, value: int, /) -> None")))
        .def_prop_rw("sequence", &Port::sequence, &Port::set_sequence, nb::for_setter(nb::arg().none()),
                     nb::for_setter(nb::sig("def sequence(self, value: int, /) -> None")))
        .def_prop_ro("stats", &Port::stats)
        .def_prop_ro("silence_reason", &Port::silence_reason)
        .def_prop_ro("queued_bytes", &Port::queued_bytes)
        .def_prop_ro("reader", &Port::reader, nb::sig("def reader(self) -> Subscription"))
        .def_prop_ro("dialect", &Port::dialect)
        .def_prop_ro("name", &Port::name)
        .def_prop_ro("port", &Port::port)
        .def_prop_ro("version", &Port::version)
        .def_prop_ro("target_system", [](const Port& link) { return link.target().system.value; })
        .def_prop_ro("target_component", [](const Port& link) { return link.target().component.value; });

    module.def("is_vehicle", &feed::is_vehicle, nb::arg("type"), nb::arg("autopilot"),
               "Whether a HEARTBEAT with these values comes from a vehicle.");
    module.def("stop_all", [] {
        const auto recorders = LinkRecorder::all();
        const nb::gil_scoped_release release;
        WithoutGil::end();
        feed::Hub::stop_all();
        feed::RingAlarm::stop_all();
        for (const auto& recorder : recorders) recorder->wait();  // the hub has ended them
    });
}

}  // namespace mavloom::python
