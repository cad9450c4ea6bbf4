// SPDX-License-Identifier: MIT
#include "mavloom/runtime/control.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <boost/asio/io_context.hpp>
#include <thread>
#include <type_traits>
#include <utility>

#include "runtime/control_sessions.hpp"
#include "runtime/folder_lock.hpp"

namespace mavloom::runtime {

namespace {

constexpr std::size_t most_sessions = 64;  // of each kind: more are turned away
constexpr auto socket_mode = S_IRUSR | S_IWUSR;

// Accepts for as long as it lives. Sessions keep a share of `places_`: its use count tells how many there are.
template <class Protocol, class Session>
class Acceptor {
public:
    Acceptor(asio::io_context& context, Router& router) : acceptor_(context), retry_(context), router_(router) {}

    void open(const typename Protocol::endpoint& endpoint) {
        acceptor_.open(endpoint.protocol());
        if constexpr (std::is_same_v<Protocol, Local>) ::fchmod(acceptor_.native_handle(), socket_mode);
        if constexpr (std::is_same_v<Protocol, Tcp>) acceptor_.set_option(asio::socket_base::reuse_address(true));
        acceptor_.bind(endpoint);
        acceptor_.listen();
    }
    void accept() {
        acceptor_.async_accept([this](error_code error, typename Protocol::socket socket) {
            if (error == asio::error::operation_aborted) return;
            if (error) return accept_later();  // no descriptors are left, say
            if (static_cast<std::size_t>(places_.use_count()) <= most_sessions)
                std::make_shared<Session>(std::move(socket), router_, places_)->read();
            else Session::turn_away(socket);
            accept();
        });
    }
    [[nodiscard]] auto local() const { return acceptor_.local_endpoint(); }

private:
    void accept_later() {
        retry_.expires_after(std::chrono::seconds(1));
        retry_.async_wait([this](error_code error) {
            if (!error) accept();
        });
    }

    typename Protocol::acceptor acceptor_;
    asio::steady_timer retry_;
    Router& router_;
    std::shared_ptr<void> places_ = std::make_shared<char>();
};

tl::unexpected<SetupError> error_of(std::string_view what, const boost::system::system_error& error) {
    return system_error(what, error.code().value());
}

}  // namespace

class Control::Impl {
public:
    explicit Impl(Router& router) : router_(router), control_(context_, router), metrics_(context_, router) {}
    // What a session has posted holds that session, whose socket needs the context.
    ~Impl() {
        context_.stop();
        if (thread_.joinable()) thread_.join();
        router_.drop_posted();
        if (!socket_.empty()) ::unlink(socket_.c_str());
    }

    SetupResult<void> open(const ControlOptions& options) {
        if (!options.socket.empty())
            if (auto opened = open_socket(options.socket); !opened) return opened;
        return options.metrics ? open_metrics(*options.metrics) : SetupResult<void>{};
    }

    // Signals are for the router's thread.
    void start() {
        if (!socket_.empty()) control_.accept();
        if (metrics_port() != 0) metrics_.accept();
        sigset_t all, before;
        ::sigfillset(&all);
        ::pthread_sigmask(SIG_SETMASK, &all, &before);
        thread_ = std::thread([this] { context_.run(); });
        ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
    }

    [[nodiscard]] std::uint16_t metrics_port() const noexcept { return metrics_port_; }

private:
    SetupResult<void> open_socket(const std::filesystem::path& path) {
        const FolderLock lock(path.parent_path());
        if (auto taken = take_over(path); !taken) return taken;
        try {
            control_.open(Local::endpoint(path.string()));
            socket_ = path;
        } catch (const boost::system::system_error& error) {
            return error_of(fmt::format("control socket {}", path.string()), error);
        }
        return {};
    }

    SetupResult<void> take_over(const std::filesystem::path& path) {
        Local::socket probe(context_);
        error_code error;
        probe.connect(Local::endpoint(path.string()), error);
        if (!error)
            return setup_error(
                SetupCode::in_use,
                fmt::format("{} is served by a router that runs; --name gives this one another name", path.string()));
        struct stat status {};
        const bool is_left = error == asio::error::connection_refused && ::lstat(path.c_str(), &status) == 0;
        if (is_left && S_ISSOCK(status.st_mode)) ::unlink(path.c_str());
        return {};
    }

    SetupResult<void> open_metrics(const HostPort& address) {
        try {
            error_code error;
            const auto host = asio::ip::make_address(address.host, error);
            if (error)
                return setup_error(SetupCode::usage, fmt::format("--metrics takes an address of this machine in "
                                                                 "numbers, not '{}'",
                                                                 address.host));
            metrics_.open(Tcp::endpoint(host, address.port));
            metrics_port_ = metrics_.local().port();
            return {};
        } catch (const boost::system::system_error& error) {
            return error_of(fmt::format("metrics on {}:{}", address.host, address.port), error);
        }
    }

    Router& router_;
    asio::io_context context_{1};
    Acceptor<Local, ControlSession> control_;
    Acceptor<Tcp, MetricsSession> metrics_;
    std::uint16_t metrics_port_ = 0;
    std::filesystem::path socket_;
    std::thread thread_;
};

Control::Control(std::unique_ptr<Impl> impl) noexcept : impl_(std::move(impl)) {}
Control::~Control() = default;
std::uint16_t Control::metrics_port() const noexcept { return impl_->metrics_port(); }

SetupResult<std::unique_ptr<Control>> Control::create(Router& router, const ControlOptions& options) {
    auto impl = std::make_unique<Impl>(router);
    if (auto opened = impl->open(options); !opened) return tl::unexpected(std::move(opened.error()));
    impl->start();
    return std::unique_ptr<Control>(new Control(std::move(impl)));
}

}  // namespace mavloom::runtime
