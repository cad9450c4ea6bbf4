// SPDX-License-Identifier: MIT
#include <sys/inotify.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>

#include "mavloom/base/clock.hpp"
#include "mavloom/net/serial.hpp"

namespace mavloom::net {

namespace fs = std::filesystem;

static fs::path target_of(const fs::path& name) {
    std::error_code failed;
    fs::path target = fs::canonical(name, failed);
    return failed ? fs::path{} : target;
}

static bool is_there(const fs::path& name) {
    std::error_code failed;
    return !name.empty() && fs::exists(name, failed) && !failed;
}

// Returns the link that leads to the device at `name`: the known link if it still does, otherwise the first one by
// name.
std::string SerialDevice::id_of(const std::string& name) const {
    const fs::path target = target_of(name);
    if (target.empty()) return {};
    if (!id_link_.empty() && target_of(id_link_) == target) return id_link_;
    std::string found;
    std::error_code failed;
    for (fs::directory_iterator it(id_folder_, failed), end; !failed && it != end; it.increment(failed)) {
        if (target_of(it->path()) != target) continue;
        if (found.empty() || it->path().string() < found) found = it->path().string();
    }
    return found;
}

void SerialDevice::note_opened(const std::string& name) {
    if (auto link = id_of(name); !link.empty()) id_link_ = std::move(link);
}

static bool is_new(const std::string& name) {
    struct stat status;
    if (::stat(name.c_str(), &status) != 0) return true;
    const WallTime made{std::chrono::seconds(status.st_ctim.tv_sec) + Nanoseconds(status.st_ctim.tv_nsec)};
    const Nanoseconds age = wall_now() - made;
    return age >= Nanoseconds{} && age < SerialDevice::link_delay;
}

std::vector<std::string> SerialDevice::places() const {
    if (id_link_.empty()) return {path_};
    const bool link_there = is_there(id_link_);
    if (!is_there(path_)) return link_there ? std::vector{id_link_} : std::vector{path_};
    if (id_of(path_) == id_link_) return {path_};
    if (link_there) return {id_link_};
    if (is_new(path_)) return {};
    return {path_};
}

// Returns the folder of a path, or the nearest parent that exists.
static std::string folder_of(const fs::path& name) {
    fs::path folder = name.parent_path();
    while (folder.has_relative_path() && !is_there(folder)) folder = folder.parent_path();
    return folder.empty() ? "." : folder.string();
}

std::vector<std::string> SerialDevice::folders() const {
    std::vector<std::string> all{folder_of(path_), folder_of(fs::path(id_folder_) / "link")};
    std::error_code failed;
    if (const fs::path target = fs::read_symlink(path_, failed); !failed) {
        all.push_back(folder_of(target.is_absolute() ? target : fs::path(path_).parent_path() / target));
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
}

SetupResult<FolderWatch> FolderWatch::create() {
    FolderWatch watch;
    watch.fd_ = Fd(inotify_init1(IN_NONBLOCK | IN_CLOEXEC));
    if (!watch.fd_) return system_error("cannot watch folders", errno);
    return watch;
}

void FolderWatch::add(const std::string& folder) noexcept {
    constexpr std::uint32_t events = IN_CREATE | IN_ATTRIB | IN_MOVED_TO | IN_DELETE | IN_DELETE_SELF | IN_ONLYDIR;
    inotify_add_watch(fd(), folder.c_str(), events);
}

void FolderWatch::drain() noexcept {
    alignas(inotify_event) std::array<char, 4096> events;
    while (::read(fd(), events.data(), events.size()) > 0) {}
}

}  // namespace mavloom::net
