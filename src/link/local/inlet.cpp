// SPDX-License-Identifier: MIT
#include "link/local/inlet.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <functional>
#include <string_view>
#include <unordered_map>

#include "link/peer_list.hpp"
#include "mavloom/base/shown.hpp"
#include "mavloom/net/local.hpp"
#include "mavloom/net/local_sender.hpp"
#include "mavloom/wire/datagram_parser.hpp"

namespace mavloom::link::detail {

namespace {

struct Sender final : Link {
    Sender(EndpointId owner, const wire::MessageTable& table, std::string_view from)
        : Link(owner, {}), address(from), parser(table) {
        sending = Link::Sending::found_in_ring;
    }
    void schedule() override {}

    std::string address;  // empty: shared by all unbound senders
    wire::DatagramParser parser;
    MonoTime last_heard{};  // time of the last good frame
    std::uint64_t datagrams = 0;

    [[nodiscard]] PeerPolicy::Candidate candidate() const noexcept { return {id, datagrams > 1, last_heard}; }
};

struct HashText {
    using is_transparent = void;
    std::size_t operator()(std::string_view text) const noexcept { return std::hash<std::string_view>{}(text); }
};

// Identifies the file at the socket's path. The socket's own descriptor does not reveal it.
struct FileId {
    dev_t device = 0;
    ino_t number = 0;

    [[nodiscard]] static FileId of(const std::filesystem::path& path) noexcept {
        struct stat status {};
        return ::lstat(path.c_str(), &status) == 0 ? FileId{status.st_dev, status.st_ino} : FileId{};
    }
    friend bool operator==(const FileId&, const FileId&) = default;
};

class Inlet final : public OpenEndpoint, public net::IoHandler, public net::TimerHandler {
public:
    explicit Inlet(Opening& opening)
        : OpenEndpoint(opening),
          core_(opening.core),
          newcomer_parser_(opening.core.dialects.of(opening.id).table),
          senders_(core_, *this) {}
    ~Inlet() override;

    SetupResult<void> open(const std::filesystem::path& path, unsigned mode);
    std::size_t send(const wire::FrameView& frame) override { return senders_.send(frame); }
    [[nodiscard]] std::size_t queued_bytes() const override { return 0; }
    bool close_link(LinkId link) override;
    void on_io(net::IoEvents events) override;
    void on_timer(MonoTime now) override;

private:
    SetupResult<void> bind();
    void check_socket();
    void take(const net::LocalDatagram& datagram);
    [[nodiscard]] Sender* sender_of(const net::LocalDatagram& datagram);
    [[nodiscard]] Sender* newcomer(const net::LocalDatagram& datagram);
    [[nodiscard]] bool holds_frame(ByteView datagram);
    [[nodiscard]] bool make_room();
    void drop(Sender& sender, std::string_view why);

    static constexpr std::chrono::seconds idle{60}, check_interval{1};

    Core& core_;
    std::optional<net::LocalSocket> socket_;
    net::WatchId watch_;
    std::filesystem::path path_;
    unsigned mode_ = 0;
    FileId bound_;
    bool reported_ = false;  // that the socket cannot be recreated
    wire::DatagramParser newcomer_parser_;
    PeerList<Sender> senders_;
    std::unordered_map<std::string, Sender*, HashText, std::equal_to<>> by_address_;
    Sender* last_ = nullptr;  // datagrams arrive in runs
    net::TimerId timer_;
};

// ---- the socket -----------------------------------------------------------------------------------------------------

SetupResult<void> take_over(const std::filesystem::path& path) {
    struct stat status {};
    const bool is_there = ::lstat(path.c_str(), &status) == 0;
    if (is_there && status.st_uid != ::geteuid())
        return setup_error(SetupCode::permission,
                           fmt::format("{} belongs to another user (id {}); remove it", path.string(), status.st_uid));
    const auto probe = net::LocalSender::connect(path);
    if (probe) {
        const auto process = net::process_serving(path);
        return setup_error(SetupCode::in_use,
                           fmt::format("{} is already served by {}; end it, or use another ring", path.string(),
                                       process ? fmt::format("process {}", *process) : "another process"));
    }
    if (is_there && !S_ISSOCK(status.st_mode))
        return setup_error(SetupCode::bad_input, fmt::format("{} exists and is not a socket; remove it", path.string()));
    if (probe.error().sys_errno == ECONNREFUSED) ::unlink(path.c_str());
    return {};
}

SetupResult<void> Inlet::open(const std::filesystem::path& path, unsigned mode) {
    path_ = path;
    mode_ = mode;
    auto bound = bind();
    if (bound) timer_ = core_.loop().start_timer(core_.now() + check_interval, *this);
    return bound;
}

SetupResult<void> Inlet::bind() {
    if (auto taken = take_over(path_); !taken) return taken;
    auto socket = net::LocalSocket::open(path_, mode_);
    if (!socket) return tl::unexpected(std::move(socket).error());
    bound_ = FileId::of(path_);
    auto watch = core_.loop().watch(socket->fd(), true, false, *this);
    if (!watch) return tl::unexpected(std::move(watch).error());
    core_.loop().unwatch(watch_);
    socket_ = std::move(*socket);
    watch_ = *watch;
    return {};
}

Inlet::~Inlet() {
    core_.loop().cancel_timer(timer_);
    core_.loop().unwatch(watch_);
    if (bound_ != FileId{} && bound_ == FileId::of(path_)) ::unlink(path_.c_str());
}

// Another program may have removed the socket or its folder.
void Inlet::check_socket() {
    if (bound_ == FileId::of(path_)) return;
    const auto bound = bind();
    if (bound) core_.events.notice(info.id, fmt::format("inlet {} was removed; it is created again", path_.string()));
    else if (!reported_)
        core_.events.notice(info.id, fmt::format("inlet {} was removed: {}", path_.string(), bound.error().text));
    reported_ = !bound;
}

void Inlet::on_io(net::IoEvents) {
    const auto count = socket_->receive();
    if (!count) return;
    if (*count == net::LocalSocket::slots) core_.note_more_waits();
    for (std::size_t i = 0; i < *count; ++i) take((*socket_)[i]);
}

// ---- senders --------------------------------------------------------------------------------------------------------

// Examples: "/run/app.sock", "@abstract", "unbound".
std::string name_of(std::string_view address) {
    if (address.empty()) return "unbound";
    return address.front() == '\0' ? fmt::format("@{}", printable(address.substr(1))) : printable(address);
}

void Inlet::take(const net::LocalDatagram& datagram) {
    Sender* const sender = sender_of(datagram);
    if (sender == nullptr) return;
    const WallTime time = datagram.time == WallTime{} ? wall_now() : datagram.time;
    const std::uint64_t frames_before = sender->counters.frames_in.value();
    sender->parser.parse(datagram.bytes, [&](const wire::ParseEvent& event) { core_.on_event(*sender, event, time); });
    sender->counters.junk_bytes.add(datagram.cut);
    sender->counters.implausible_unknown.set(sender->parser.counters().implausible_unknown.value());
    if (sender->counters.frames_in.value() == frames_before) return;
    sender->last_heard = core_.now();
    ++sender->datagrams;
}

Sender* Inlet::sender_of(const net::LocalDatagram& datagram) {
    if (last_ != nullptr && last_->address == datagram.from) return last_;
    const auto known = by_address_.find(datagram.from);
    last_ = known != by_address_.end() ? known->second : newcomer(datagram);
    return last_;
}

Sender* Inlet::newcomer(const net::LocalDatagram& datagram) {
    if (!holds_frame(datagram.bytes)) {
        counters.stray_bytes.add(datagram.bytes.size() + datagram.cut);
        return nullptr;
    }
    if (!make_room()) {
        counters.peers_refused.add();
        return nullptr;
    }
    auto sender = std::make_unique<Sender>(info.id, core_.dialects.of(info.id).table, datagram.from);
    sender->name = fmt::format("{}#{}", info.label(), name_of(datagram.from));
    sender->last_heard = core_.now();
    by_address_.emplace(sender->address, sender.get());
    return &senders_.add(std::move(sender), Rank::own);
}

// The checksum of a defined message proves a MAVLink sender. An id without definition does not.
bool Inlet::holds_frame(ByteView datagram) {
    bool found = false;
    newcomer_parser_.parse(datagram, [&](const wire::ParseEvent& event) {
        found = found || (event.kind == wire::ParseEvent::Kind::frame && event.info != nullptr);
    });
    return found;
}

bool Inlet::make_room() {
    if (!senders_.is_full()) return true;
    const auto first = PeerPolicy::to_evict(senders_.candidates(), core_.now());
    if (!first) return false;
    counters.peers_evicted.add();
    drop(*senders_.find(*first), "too many senders, and this one was silent longest");
    return true;
}

void Inlet::drop(Sender& sender, std::string_view why) {
    senders_.remove(sender, why);
    by_address_.erase(sender.address);
    last_ = nullptr;
}

void Inlet::on_timer(MonoTime now) {
    timer_ = core_.loop().start_timer(now + check_interval, *this);
    senders_.expire(now, idle, [&](Sender& sender) { drop(sender, "idle"); });
    check_socket();
}

bool Inlet::close_link(LinkId link) {
    Sender* const sender = senders_.find(link);
    if (sender != nullptr) drop(*sender, "closed");
    return sender != nullptr;
}

}  // namespace

Opened open_inlet(Opening opening, const std::filesystem::path& path, unsigned mode) {
    auto inlet = std::make_unique<Inlet>(opening);
    if (auto done = inlet->open(path, mode); !done) return tl::unexpected(std::move(done.error()).within("inlet"));
    return inlet;
}

}  // namespace mavloom::link::detail
