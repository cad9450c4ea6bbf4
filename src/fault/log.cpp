// SPDX-License-Identifier: MIT
#include "fault/log.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/shown.hpp"
#include "mavloom/fault/faults.hpp"
#include "mavloom/wire/frame.hpp"

namespace mavloom::fault {

namespace {

// Of the process; open until it ends. -1: there is none.
std::atomic<int> log_file{-1};

constexpr std::string_view log_head = "time_us\tlink\tdirection\tfault\tbytes\tmessage\tsender\tsequence\n";

// A full disk may take only the first part of a line. A line break then separates it from the next line.
void write_line(int file, std::string line) {
    static std::atomic<bool> is_torn{false};
    const bool was_torn = is_torn.exchange(false);
    if (was_torn) line.insert(0, 1, '\n');
    const auto written = ::write(file, line.data(), line.size());
    is_torn = written < 0 ? was_torn : static_cast<std::size_t>(written) < line.size();
}

// Message, sender and sequence number, if the piece is one whole frame.
std::string frame_text(ByteView bytes) {
    if (bytes.size() < 8 || wire::frame_length(bytes) != bytes.size()) return "\t\t";
    const auto frame = wire::FrameView::unchecked(bytes);
    const auto source = frame.source();
    return fmt::format("{}\t{}/{}\t{}", frame.id().value, source.system.value, source.component.value, frame.sequence());
}

}  // namespace

// A log continues; every other file stays as it is.
SetupResult<void> log_to(const std::string& path) {
    if (path.empty()) return {};
    if (log_file.load() >= 0) return setup_error(SetupCode::in_use, "there is a fault log already");
    const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_NONBLOCK | O_CLOEXEC, 0644);
    if (file < 0) return system_error(fmt::format("cannot create the fault log {}", path), errno);
    std::string head(log_head.size(), '\0');
    const auto size = ::pread(file, head.data(), head.size(), 0);  // fails if it is no file
    if (size != 0 && head != log_head) {
        ::close(file);
        return setup_error(SetupCode::in_use, fmt::format("{} is no fault log, and stays as it is", path));
    }
    if (size == 0) write_line(file, std::string(log_head));
    log_file = file;
    return {};
}

namespace detail {

void LogSite::write(std::string_view fault, const link::Piece& piece) const {
    write_line(file_, fmt::format("{}\t{}\t{}\t{}\t{}\t{}\n", unix_us(wall_now()), link_, way_, fault,
                                  piece.bytes.size(), frame_text(piece.bytes)));
}

std::shared_ptr<const LogSite> log_site(std::string_view link, std::string_view way) {
    const int file = log_file.load();
    return file < 0 ? nullptr : std::make_shared<const LogSite>(file, printable(link), way);
}

}  // namespace detail

}  // namespace mavloom::fault
