// SPDX-License-Identifier: MIT
#include "mavloom/control/control.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cerrno>
#include <chrono>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "control/metrics_reports.hpp"
#include "control/sessions.hpp"
#include "mavloom/base/shown.hpp"
#include "mavloom/base/thread.hpp"
#include "mavloom/endpoint/grammar.hpp"
#include "mavloom/http/server.hpp"
#include "mavloom/http/thread.hpp"
#include "mavloom/net/fd.hpp"

namespace mavloom::control {

namespace {

constexpr std::size_t max_sessions = 64;  // a newcomer takes the place of the longest idle client
constexpr std::chrono::seconds check_interval{1};
// Reports take much processor time. On a busy machine they wait for the threads that pass frames on.
constexpr int niceness = 10;
constexpr auto socket_mode = S_IRUSR | S_IWUSR;

// Returns 0 if the file does not exist.
ino_t inode_of(const std::filesystem::path& path) noexcept {
    struct statx status {};
    return ::statx(AT_FDCWD, path.c_str(), AT_SYMLINK_NOFOLLOW, STATX_INO, &status) == 0 ? status.stx_ino : 0;
}

tl::unexpected<SetupError> served(const std::filesystem::path& socket) {
    return setup_error(
        SetupCode::in_use,
        fmt::format("{} is served by another process; give this one another name with --name", socket.string()));
}

std::string in_the_way(const std::filesystem::path& socket, const struct stat& status) {
    const std::string_view what = S_ISDIR(status.st_mode) ? "folder" : S_ISLNK(status.st_mode) ? "link" : "file";
    return fmt::format("a {} is in the place of the socket {}; remove it", what, socket.string());
}

// Ensures that only one program serves a name: locks NAME.ctl.lock, beside the socket. The kernel releases the lock
// however the program ends. With mode 0600, other users cannot open the file and hold the lock. A program that gets the
// lock may remove a socket left behind, because the program that created it is gone.
class NameLock {
public:
    NameLock() = default;
    NameLock(const NameLock&) = delete;
    NameLock& operator=(const NameLock&) = delete;
    ~NameLock() {
        if (fd_ && is_named(fd_.get())) ::unlink(path_.c_str());
    }

    // Takes the lock, or keeps it. If another program removed the file, takes a new one.
    [[nodiscard]] SetupResult<void> take(const std::filesystem::path& socket) {
        path_ = socket.string() + ".lock";
        if (fd_ && !is_named(fd_.get())) fd_ = net::Fd();
        while (!fd_) {
            net::Fd fd(::open(path_.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, socket_mode));
            // The file exists but belongs to another user.
            const bool is_others = !fd && errno == EACCES && inode_of(path_) != 0;
            if (is_others) return served(socket);
            if (!fd) return system_error(fmt::format("control socket {}", path_), errno);
            if (::flock(fd.get(), LOCK_EX | LOCK_NB) != 0)
                return errno == EWOULDBLOCK ? served(socket)
                                            : system_error(fmt::format("control socket {}", path_), errno);
            if (is_named(fd.get())) fd_ = std::move(fd);
        }
        return {};
    }

private:
    // False if the previous owner of the lock ended meanwhile and removed the file.
    [[nodiscard]] bool is_named(int fd) const {
        struct stat held {};
        return ::fstat(fd, &held) == 0 && held.st_ino == inode_of(path_);
    }

    std::string path_;
    net::Fd fd_;
};

// Accepts clients of the control socket for as long as it lives.
class Acceptor {
public:
    Acceptor(asio::io_context& context, Served& served) : acceptor_(context), retry_(context), served_(served) {}

    void open(const Local::endpoint& endpoint) {
        acceptor_.open(endpoint.protocol());
        ::fchmod(acceptor_.native_handle(), socket_mode);
        acceptor_.bind(endpoint);
        acceptor_.listen();
    }
    void accept() {
        acceptor_.async_accept([this](error_code error, Local::socket socket) {
            if (error == asio::error::operation_aborted) return;
            if (error) return accept_later();  // for example, no free descriptors
            if (make_room()) add(std::make_shared<ControlSession>(std::move(socket), served_));
            else ControlSession::turn_away(socket);
            accept();
        });
    }
    void close() {
        error_code error;
        acceptor_.close(error);
    }

private:
    void add(const std::shared_ptr<ControlSession>& session) {
        sessions_.push_back(session);
        session->read();
    }
    // Disconnects the clients that have been idle longest, if there are too many. Returns false if all others await
    // answers.
    bool make_room() {
        std::erase_if(sessions_, [](const auto& session) { return session.expired(); });
        while (sessions_.size() >= max_sessions)
            if (!hang_up_idlest()) return false;
        return true;
    }
    bool hang_up_idlest() {
        std::shared_ptr<ControlSession> idlest;
        for (const auto& weak : sessions_)
            if (auto session = weak.lock();
                idlest == nullptr || session->idle_time().since() < idlest->idle_time().since())
                idlest = std::move(session);
        if (idlest->idle_time().is_busy()) return false;
        idlest->hang_up();
        std::erase_if(sessions_, [&](const auto& session) { return session.lock() == idlest; });
        return true;
    }
    void accept_later() {
        retry_.expires_after(std::chrono::seconds(1));
        retry_.async_wait([this](error_code error) {
            if (!error) accept();
        });
    }

    Local::acceptor acceptor_;
    asio::steady_timer retry_;
    Served& served_;
    std::vector<std::weak_ptr<ControlSession>> sessions_;
};

tl::unexpected<SetupError> error_of(std::string_view what, const boost::system::system_error& error) {
    return system_error(what, error.code().value());
}

}  // namespace

class Control::Impl {
public:
    explicit Impl(Served& served) : served_(served), reports_(served), control_(context_, served) {}
    // Posted work keeps its session alive, and the session's socket needs the context. So drop the work first.
    ~Impl() {
        metrics_.reset();  // its requests are posted to the context
        context_.stop();
        if (thread_.joinable()) thread_.join();
        served_.drop_posted();
        if (!socket_.empty() && inode_of(socket_) == inode_) ::unlink(socket_.c_str());
    }

    SetupResult<void> open(const ControlOptions& options) {
        on_notice_ = options.on_notice;
        if (options.metrics)  // first: if the socket is there, the metrics are, too
            if (auto opened = open_metrics(*options.metrics); !opened) return opened;
        return options.socket.empty() ? SetupResult<void>{} : open_socket(options.socket);
    }

    void start() {
        if (!socket_.empty()) control_.accept();
        thread_ = thread_without_signals([this] {
            ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), niceness);  // of this thread only
            run();
        });
    }

    [[nodiscard]] std::uint16_t metrics_port() const noexcept {
        return metrics_ ? metrics_->addresses().front().port() : 0;
    }

private:
    SetupResult<void> open_socket(const std::filesystem::path& path) {
        if (auto taken = name_.take(path); !taken) return taken;
        if (auto free = remove_left_over(path); !free) return free;
        try {
            control_.open(Local::endpoint(path.string()));
            socket_ = path;
            inode_ = inode_of(path);
        } catch (const boost::system::system_error& error) {
            return error_of(fmt::format("control socket {}", path.string()), error);
        }
        return {};
    }

    // Looks at the socket between two rounds. The context stops at the end, or if there is nothing to serve.
    void run() {
        while (!context_.stopped()) {
            context_.run_for(check_interval);
            if (!socket_.empty() && !context_.stopped()) check_socket();
        }
    }

    // Another program may have removed the socket or its folder, or put something else in its place.
    void check_socket() {
        const ino_t there = inode_of(socket_);
        if (there == inode_ && there != 0) return;
        const std::string_view what = there == 0 ? "removed" : "replaced";
        ::mkdir(socket_.parent_path().c_str(), 0755);
        control_.close();
        const auto created = open_socket(socket_);
        if (created) control_.accept();
        if (created) notify(fmt::format("control socket {} was {}; it is created again", socket_.string(), what));
        else if (!reported_)
            notify(fmt::format("control socket {} was {}: {}", socket_.string(), what, created.error().text));
        reported_ = !created;
    }
    void notify(std::string text) const {
        if (on_notice_) served_.post([on_notice = on_notice_, line = std::move(text)] { on_notice(line); });
    }

    // Removes a socket that no process serves. The probe does not block: a full backlog (EAGAIN) also means that a
    // process listens.
    static SetupResult<void> remove_left_over(const std::filesystem::path& path) {
        const Local::endpoint there(path.string());
        const net::Fd probe(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
        const int error = ::connect(probe.get(), there.data(), static_cast<socklen_t>(there.size())) == 0 ? 0 : errno;
        if (error == 0 || error == EAGAIN) return served(path);
        struct stat status {};
        if (::lstat(path.c_str(), &status) != 0) return {};
        if (!S_ISSOCK(status.st_mode)) return setup_error(SetupCode::in_use, in_the_way(path, status));
        if (error == ECONNREFUSED) ::unlink(path.c_str());
        return {};
    }

    SetupResult<void> open_metrics(const endpoint::HostPort& place) {
        auto address = metrics_address(place);
        if (!address) return tl::unexpected(std::move(address.error()));
        auto thread = http::Thread::start(niceness);
        if (!thread) return tl::unexpected(std::move(thread.error()));
        auto server = http::Server::listen(*thread, metrics_options(*address));
        if (!server) return tl::unexpected(std::move(server.error()).within("metrics"));
        http_thread_.emplace(std::move(*thread));
        metrics_.emplace(std::move(*server));
        return {};
    }
    static SetupResult<net::Address> metrics_address(const endpoint::HostPort& place) {
        if (auto good = endpoint::check_server_address(place); !good)
            return tl::unexpected(std::move(good.error()).within("metrics"));
        return *net::Address::parse(place.host, place.port);  // as check_server_address demands
    }
    // On loopback, clients must name this machine in the Host header, so that web pages in a browser cannot read the
    // metrics. Pages get no leave to read them anyway, whatever their Origin.
    http::ServerOptions metrics_options(const net::Address& address) {
        const auto get = [this](const http::Request&, const http::Respond& respond) {
            asio::post(context_, [this, respond] { respond_with_metrics(respond); });
        };
        return {.addresses = {address},
                .access = {.any_host = !address.is_loopback(), .own_names = false, .origins = {"*"}},
                .routes = {{"/metrics", get}}};
    }
    void respond_with_metrics(const http::Respond& respond) {
        reports_.get(context_.get_executor(), [respond](const MetricsReports::Text& text) {
            respond({.content_type = "text/plain; version=0.0.4; charset=utf-8", .body = text});
        });
    }

    Served& served_;
    asio::io_context context_{1};
    MetricsReports reports_;
    Acceptor control_;
    NameLock name_;  // destroyed after the socket is removed
    std::filesystem::path socket_;
    // Identifies our own socket. Another program may have removed it, and another program created a new one.
    ino_t inode_ = 0;
    std::function<void(std::string_view)> on_notice_;
    bool reported_ = false;  // that the socket is gone and cannot be created
    std::thread thread_;
    std::optional<http::Thread> http_thread_;  // only if there are metrics
    std::optional<http::Server> metrics_;
};

Control::Control(std::unique_ptr<Impl> impl) noexcept : impl_(std::move(impl)) {}
Control::~Control() = default;
std::uint16_t Control::metrics_port() const noexcept { return impl_->metrics_port(); }

SetupResult<std::unique_ptr<Control>> Control::create(Served& served, const ControlOptions& options) {
    try {
        auto impl = std::make_unique<Impl>(served);
        if (auto opened = impl->open(options); !opened) return tl::unexpected(std::move(opened.error()));
        impl->start();
        return std::unique_ptr<Control>(new Control(std::move(impl)));
    } catch (const boost::system::system_error& error) {  // for example, no free descriptors
        return error_of("control socket and metrics", error);
    } catch (const std::system_error& error) {  // the thread cannot start
        return system_error("control socket and metrics", error.code().value());
    }
}

}  // namespace mavloom::control
