// SPDX-License-Identifier: MIT
// Writes a line for each fault that happens (fault::log_to). Private to module fault. The thread of the links writes.
// If several threads have links, the file has the lines of all.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "mavloom/base/counter.hpp"
#include "mavloom/link/stage.hpp"

namespace mavloom::fault::detail {

// One direction of one link, in the log. Each line is one system call, so that other programs can follow the file and
// a kill loses nothing.
class LogSite {
public:
    LogSite(int file, std::string link, std::string_view way) : file_(file), link_(std::move(link)), way_(way) {}
    void write(std::string_view fault, const link::Piece& piece) const;

private:
    int file_;
    std::string link_;
    std::string_view way_;
};

// Empty unless log_to() was called.
[[nodiscard]] std::shared_ptr<const LogSite> log_site(std::string_view link, std::string_view way);

// Counts what a stage does, and logs it.
class Tally {
public:
    Tally(Counter& counter) noexcept : counter_(&counter) {}  // NOLINT(google-explicit-constructor): without a log
    Tally(Counter& counter, std::string_view fault, std::shared_ptr<const LogSite> site) noexcept
        : counter_(&counter), fault_(fault), site_(std::move(site)) {}
    void note(const link::Piece& piece) noexcept {
        counter_->add();
        if (site_) [[unlikely]]
            site_->write(fault_, piece);
    }

private:
    Counter* counter_;
    std::string_view fault_;
    std::shared_ptr<const LogSite> site_;
};

}  // namespace mavloom::fault::detail
