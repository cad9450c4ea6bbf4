// SPDX-License-Identifier: MIT
#include "mavloom/runtime/control.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <array>
#include <boost/asio.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <cerrno>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>

#include "mavloom/runtime/router.hpp"
#include "mavloom/runtime/router_report.hpp"

namespace mavloom::runtime {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using Local = asio::local::stream_protocol;
using Tcp = asio::ip::tcp;
using boost::system::error_code;

namespace {

constexpr std::size_t longest_request = 64 * 1024;
constexpr std::size_t most_sessions = 64;  // of each kind: more are turned away
constexpr auto http_patience = std::chrono::seconds(10);
constexpr auto socket_mode = S_IRUSR | S_IWUSR;

// Work for the router's thread whose result comes back to this one. A session that ended meanwhile is kept by its own pointer.
template <class Ask, class Then>
void on_router(Router& router, const asio::any_io_executor& back, Ask ask, Then then) {
    router.post([ask = std::move(ask), then = std::move(then), back](Router& r) mutable {
        asio::post(back, [result = ask(r), then = std::move(then)]() mutable { then(std::move(result)); });
    });
}

// One client of the socket: a request, its answer, the next request.
class ControlSession : public std::enable_shared_from_this<ControlSession> {
public:
    ControlSession(Local::socket socket, Router& router, std::shared_ptr<void> place)
        : socket_(std::move(socket)), router_(router), place_(std::move(place)), input_(longest_request) {}

    void read() {
        asio::async_read_until(socket_, input_, '\n', [self = shared_from_this()](error_code error, std::size_t) {
            if (!error) self->ask();
        });
    }

private:
    void ask() {
        std::string line;
        std::istream stream(&input_);
        std::getline(stream, line);
        on_router(
            router_, socket_.get_executor(), [line](Router& r) { return answer_request(r, line); },
            [self = shared_from_this()](const Later<Lines>& answer) { self->write(answer()); });
    }
    void write(const Lines& lines) {
        output_.clear();
        for (const auto& line : lines) output_.append(line).push_back('\n');
        asio::async_write(socket_, asio::buffer(output_), [self = shared_from_this()](error_code error, std::size_t) {
            if (!error) self->read();
        });
    }

    Local::socket socket_;
    Router& router_;
    std::shared_ptr<void> place_;  // one of most_sessions
    asio::streambuf input_;
    std::string output_;
};

class MetricsSession : public std::enable_shared_from_this<MetricsSession> {
public:
    MetricsSession(Tcp::socket socket, Router& router, std::shared_ptr<void> place)
        : stream_(std::move(socket)), router_(router), place_(std::move(place)) {}

    void read() {
        request_ = {};
        stream_.expires_after(http_patience);
        http::async_read(stream_, buffer_, request_, [self = shared_from_this()](error_code error, std::size_t) {
            if (!error) self->handle();
        });
    }

private:
    void handle() {
        if (request_.method() != http::verb::get) return write(http::status::method_not_allowed, "GET only\n");
        if (request_.target() != "/metrics") return write(http::status::not_found, "metrics are at /metrics\n");
        on_router(
            router_, stream_.get_executor(), [](Router& r) { return report_metrics(r); },
            [self = shared_from_this()](const Later<std::string>& text) { self->write(http::status::ok, text()); });
    }
    void write(http::status status, std::string body) {
        response_ = {status, request_.version()};
        response_.set(http::field::content_type, "text/plain; version=0.0.4; charset=utf-8");
        response_.keep_alive(request_.keep_alive());
        response_.body() = std::move(body);
        response_.prepare_payload();
        stream_.expires_after(http_patience);
        http::async_write(stream_, response_, [self = shared_from_this()](error_code error, std::size_t) {
            if (!error && self->response_.keep_alive()) self->read();
        });
    }

    beast::tcp_stream stream_;
    Router& router_;
    std::shared_ptr<void> place_;
    beast::flat_buffer buffer_;
    http::request<http::empty_body> request_;
    http::response<http::string_body> response_;
};

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

// ---- names -----------------------------------------------------------------------------------------------------------

bool is_router_name(std::string_view name) noexcept {
    const auto good = [](char c) {
        return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    };
    return !name.empty() && name.size() <= 64 && std::ranges::all_of(name, good);
}

static SetupResult<std::filesystem::path> checked_length(std::filesystem::path path) {
    constexpr std::size_t most = sizeof(sockaddr_un::sun_path) - 1;
    if (path.native().size() <= most) return path;
    return setup_error(SetupCode::permission, fmt::format("control socket {}: a socket's path has at most {} bytes; a "
                                                          "shorter --name or XDG_RUNTIME_DIR helps",
                                                          path.string(), most));
}

SetupResult<std::filesystem::path> control_path(std::string_view name) {
    if (!is_router_name(name))
        return setup_error(SetupCode::usage, fmt::format("'{}' is no name: 1 to 64 of A-Z a-z 0-9 _ -", name));
    std::vector<std::filesystem::path> folders{"/run/mavloom"};
    if (const char* own = std::getenv("XDG_RUNTIME_DIR"); own != nullptr && *own == '/')
        folders.push_back(std::filesystem::path(own) / "mavloom");
    for (const auto& folder : folders) {
        ::mkdir(folder.c_str(), 0755);
        if (::access(folder.c_str(), W_OK | X_OK) == 0) return checked_length(folder / fmt::format("{}.ctl", name));
    }
    return setup_error(SetupCode::permission,
                       "no folder for the control socket: /run/mavloom cannot be made and XDG_RUNTIME_DIR is not set");
}

// ---- asking ----------------------------------------------------------------------------------------------------------

namespace {

SetupResult<std::vector<std::string>> answer_of(std::string_view text) {
    std::vector<std::string> lines;
    for (std::size_t at = 0; at < text.size();) {
        const auto end = std::min(text.find('\n', at), text.size());
        lines.emplace_back(text.substr(at, end - at));
        at = end + 1;
    }
    const auto last = lines.empty() ? nlohmann::json() : nlohmann::json::parse(lines.back(), nullptr, false);
    if (!last.is_object() || !last.value("/ok"_json_pointer, nlohmann::json()).is_boolean())
        return setup_error(SetupCode::unreachable, "the router's answer was cut off");
    if (!last["ok"].get<bool>()) {
        const auto why = last.value("/error"_json_pointer, nlohmann::json());
        return setup_error(SetupCode::unreachable, why.is_string() ? why.get<std::string>() : "the router refused");
    }
    lines.pop_back();
    return lines;
}

}  // namespace

SetupResult<std::vector<std::string>> ask_router(std::string_view name, std::string_view request,
                                                 std::chrono::milliseconds limit) {
    const auto path = control_path(name);
    if (!path) return tl::unexpected(path.error());
    asio::io_context context;
    Local::socket socket(context);
    error_code error;
    socket.connect(Local::endpoint(path->string()), error);
    if (error)
        return setup_error(SetupCode::not_found, fmt::format("no router called '{}' runs here ({}: {})", name,
                                                             path->string(), error.message()));
    // The router closes behind the answer, because nothing more is asked.
    std::string input, output = std::string(request) + "\n";
    bool done = false;
    asio::async_write(socket, asio::buffer(output), [&](error_code e, std::size_t) {
        if (e) return;
        socket.shutdown(Local::socket::shutdown_send, e);
        asio::async_read(socket, asio::dynamic_buffer(input),
                         [&](error_code read_error, std::size_t) { done = read_error == asio::error::eof; });
    });
    context.run_for(limit);
    if (!done)
        return setup_error(SetupCode::unreachable,
                           fmt::format("router '{}' gave no answer within {} ms", name, limit.count()));
    return answer_of(input);
}

}  // namespace mavloom::runtime
