// SPDX-License-Identifier: MIT
// What a command reports while it runs.
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <ctime>

#include "command.hpp"

namespace mavloom::app {

// systemd states which file is the journal's: DEVICE:INODE.
static bool stderr_is_journal() {
    const char* const journal = std::getenv("JOURNAL_STREAM");
    struct stat status {};
    return journal != nullptr && ::fstat(STDERR_FILENO, &status) == 0 &&
           fmt::format("{}:{}", status.st_dev, status.st_ino) == journal;
}

void print_event(const Common& common, std::string_view text) {
    static const bool has_time = !stderr_is_journal();
    if (!has_time) return print_notice(common, text);
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    std::array<char, 32> time{};
    const auto length = std::strftime(time.data(), time.size(), "%Y-%m-%d %H:%M:%S", ::localtime_r(&now, &local));
    print_notice(common, fmt::format("{} {}", std::string_view(time.data(), length), text));
}

}  // namespace mavloom::app
