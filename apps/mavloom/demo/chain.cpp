// SPDX-License-Identifier: MIT
#include "chain.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "mavloom/control/control.hpp"
#include "mavloom/router/report.hpp"
#include "mavloom/shm/counter_page.hpp"
#include "mavloom/shm/ring_info.hpp"

namespace mavloom::app::demo_parts {

namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr auto patience = 5s;                          // until a program ends that was asked to
constexpr auto start_patience = 30s;                   // Python on a busy machine
constexpr std::string_view own_heartbeat = "255/191";  // ground stations are 255/190

constexpr std::array all_stages{Stage::vehicle, Stage::router, Stage::listener, Stage::relay};

std::string own_program() {
    std::error_code failed;
    return fs::read_symlink("/proc/self/exe", failed).string();
}

// In a build folder, the package is beside the folder of the program, and ./run's Python two levels up.
std::string package_folder() {
    const auto folder = fs::path(own_program()).parent_path().parent_path() / "python";
    return fs::exists(folder / "mavloom") ? folder.string() : std::string();
}

// In a wheel, the program is inside the package: PREFIX/lib/python3.N/site-packages/mavloom/bin.
std::string python_of_wheel() {
    const auto package = fs::path(own_program()).parent_path().parent_path();
    const auto prefix = package.parent_path().parent_path().parent_path().parent_path();
    const auto python = prefix / "bin/python3";
    return fs::exists(package / "__init__.py") && fs::exists(python) ? python.string() : std::string();
}

std::string usual_python() {
    if (auto python = python_of_wheel(); !python.empty()) return python;
    if (const char* const active = std::getenv("VIRTUAL_ENV")) return fs::path(active) / "bin" / "python3";
    const auto of_build = fs::path(own_program()).parent_path().parent_path().parent_path() / "venv/bin/python3";
    return fs::exists(of_build) ? of_build.string() : std::string("python3");
}

// execve() does not search.
std::string found_in_path(const std::string& program) {
    if (program.find('/') != std::string::npos) return program;
    const char* const path = std::getenv("PATH");
    std::string_view folders = path == nullptr ? std::string_view("/usr/local/bin:/usr/bin:/bin") : path;
    while (!folders.empty()) {
        const auto folder = folders.substr(0, folders.find(':'));
        folders.remove_prefix(std::min(folders.size(), folder.size() + 1));
        const auto file = fs::path(folder) / program;
        if (::access(file.c_str(), X_OK) == 0) return file;
    }
    return program;
}

// Our variables, so that Python also finds the package of a build folder.
std::vector<std::string> environment_of_children() {
    std::vector<std::string> all;
    std::string path = package_folder();
    for (char** at = environ; *at != nullptr; ++at) {
        const std::string_view variable = *at;
        if (!path.empty() && variable.starts_with("PYTHONPATH=")) path += fmt::format(":{}", variable.substr(11));
        else all.emplace_back(variable);
    }
    if (!path.empty()) all.push_back("PYTHONPATH=" + path);
    return all;
}

std::string udp(std::string_view scheme, std::uint16_t port) { return fmt::format("{}://127.0.0.1:{}", scheme, port); }

}  // namespace

Chain::~Chain() { stop_all(); }

const Child* Chain::program(Stage stage) const noexcept {
    const auto& program = programs_[static_cast<std::size_t>(stage)];
    return program ? &*program : nullptr;
}

bool Chain::is_up(Stage stage) const noexcept {
    const Child* const child = program(stage);
    return child != nullptr && child->is_running();
}

// The router's last line about the endpoint: "mavloom: TIME LABEL: cannot open /dev/ttyACM0: ..."
std::string Chain::why_not_heard() const {
    const auto label = router::parse_router_endpoint(options_.source)->label();
    const Child* const router = program(Stage::router);
    const auto text = router == nullptr ? std::string_view() : router->said();
    const auto at = text.rfind(label + ": ");
    const auto line = at == std::string_view::npos ? std::string_view() : text.substr(at, text.find('\n', at) - at);
    if (line.empty() || line.find(": listening") != std::string_view::npos)
        return fmt::format("{}: no frame was heard yet", label);
    return std::string(line);
}

std::vector<std::string> Chain::words_of(Stage stage) const {
    const Places& p = options_.places;
    const auto mavloom = own_program();
    switch (stage) {
        case Stage::vehicle:
            return {mavloom, "sim", "--listen", udp("udpin", p.vehicle) + "?name=router", "--name", p.simulator_name()};
        case Stage::router:
            return {mavloom,
                    "route",
                    options_.source.empty()
                        ? fmt::format("{}?bind=127.0.0.1:{}&name=vehicle", udp("udpout", p.vehicle), p.router)
                        : options_.source,
                    udp("udpout", p.listener) + "?name=listener&heartbeat=false",
                    "--heartbeat",
                    std::string(own_heartbeat),
                    "--ring",
                    p.router_name()};
        case Stage::listener:
            return {found_in_path(options_.python.empty() ? usual_python() : options_.python),
                    "-m",
                    "mavloom.hear",
                    udp("udpin", p.listener),
                    "--ring",
                    p.name,
                    "--json"};
        case Stage::relay: {
            std::vector<std::string> words{mavloom,
                                           "relay",
                                           fmt::format("shm://{}?from=oldest", p.name),
                                           "--to",
                                           fmt::format("{}?bind=127.0.0.1:{}", udp("udpout", p.station), p.relay),
                                           "--json"};
            if (options_.copy) words.insert(words.end(), {"--to", udp("udpout", *options_.copy)});
            return words;
        }
    }
    return {};
}

SetupResult<void> Chain::start(Stage stage) {
    auto child = Child::start(words_of(stage), environment_of_children());
    if (!child) return tl::unexpected(std::move(child.error()));
    at(stage).emplace(std::move(*child));
    was_up_[static_cast<std::size_t>(stage)] = true;
    return {};
}

// The router calls the vehicle, which then begins to send. So the router starts last.
SetupResult<void> Chain::start(const std::function<bool()>& gives_up) {
    if (auto started = start(Stage::listener); !started) return started;
    if (auto started = start(Stage::relay); !started) return started;
    if (options_.source.empty())
        if (auto started = start(Stage::vehicle); !started) return started;
    if (auto listens = wait_for_listener(gives_up); !listens || gives_up()) return listens;
    return start(Stage::router);
}

SetupResult<void> Chain::wait_for_listener(const std::function<bool()>& gives_up) {
    const auto end = mono_now() + start_patience;
    while (at(Stage::listener)->said().find("hearing on") == std::string_view::npos) {
        if (gives_up()) return {};
        for (const auto& ended : look(mono_now() + 100ms))
            return is_up(Stage::listener) ? setup_error(SetupCode::system, ended) : tl::unexpected(listener_failed());
        if (mono_now() >= end) return tl::unexpected(listener_failed());
    }
    return {};
}

SetupError Chain::listener_failed() const {
    const Child& listener = *program(Stage::listener);
    const auto python = words_of(Stage::listener).front();
    const auto why = listener.said().empty() ? listener.ending() : std::string(last_line(listener.said()));
    if (listener.said().find("No module named") == std::string_view::npos &&
        listener.said().find("ImportError") == std::string_view::npos && !listener.said().empty())
        return {SetupCode::system, 0, fmt::format("the listener did not start: {}", why)};
    return {SetupCode::system, 0,
            fmt::format("{} -m mavloom.hear did not start: {}. The listener needs Python's package mavloom: type "
                        "./run build, or pip install . in the source folder, or name an interpreter that has it by "
                        "--python",
                        python, why)};
}

std::vector<std::string> Chain::look(MonoTime end) {
    std::vector<pollfd> outputs;
    for (const auto& program : programs_)
        if (program)
            for (const int fd : {program->output(), program->errors()})
                if (fd >= 0) outputs.push_back({fd, POLLIN, 0});
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(std::max(end - mono_now(), Nanoseconds{}));
    ::poll(outputs.data(), outputs.size(), static_cast<int>(left.count()));
    std::vector<std::string> ended;
    for (std::size_t i = 0; i < programs_.size(); ++i) {
        auto& program = programs_[i];
        if (!program) continue;
        program->look();
        if (!was_up_[i] || program->is_running()) continue;
        was_up_[i] = false;
        // A killed program could not log a reason: its last line is about something else.
        const auto why = program->was_killed() ? std::string_view() : last_line(program->said());
        ended.push_back(
            fmt::format("the {} ended with {}{}{}", stage_names[i], program->ending(), why.empty() ? "" : ": ", why));
    }
    return ended;
}

void Chain::stop(Stage stage) {
    auto& program = at(stage);
    if (!program) return;
    was_up_[static_cast<std::size_t>(stage)] = false;
    program->terminate();
    program->join(mono_now() + patience);
}

void Chain::stop_vehicle() {
    if (!is_up(options_.source.empty() ? Stage::vehicle : Stage::router)) return;
    const Places& p = options_.places;
    const auto& source = options_.source;
    const auto name = source.empty() ? "router" : router::parse_router_endpoint(source)->label();
    const nlohmann::json request{{"cmd", "remove"}, {"name", name}};
    (void)control::send_request(source.empty() ? p.simulator_name() : p.router_name(), request.dump(), patience);
}

void Chain::stop_all() {
    for (const Stage stage : all_stages) stop(stage);
    remove_left_by(Stage::vehicle, options_.places.simulator_name());
    remove_left_by(Stage::router, options_.places.router_name());
    remove_left_by(Stage::listener, options_.places.name);
}

// Removes the ring, the counter page, the sockets and the lock files of this name, unless a running program has taken
// the name since.
void Chain::remove_left_by(Stage stage, const std::string& name) const {
    if (const Child* const its = program(stage); its == nullptr || !its->was_killed()) return;
    const auto page = shm::read_counters(name);
    const auto ring = shm::ring_status(name);
    if ((page && page->owner_alive) || (ring && ring->writer_alive)) return;
    (void)shm::remove_ring(name);
    const auto socket = control::control_path(name);
    if (!socket) return;
    std::error_code ignored;
    for (const auto& file : fs::directory_iterator(socket->parent_path(), ignored))
        if (file.path().filename().string().starts_with(name + ".")) fs::remove(file.path(), ignored);
}

}  // namespace mavloom::app::demo_parts
