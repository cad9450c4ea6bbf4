// SPDX-License-Identifier: MIT
#include "mavloom/shm/ring_follower.hpp"

#include <unistd.h>

#include <algorithm>
#include <thread>
#include <utility>

#include "shm/segment.hpp"

namespace mavloom::shm {

// A cheap check that avoids building the list of rings for an error text.
static bool is_there(const std::string& name) { return ::access(path_of(name).c_str(), F_OK) == 0; }

bool RingFollower::try_open() {
    if (reader_) return true;
    if (error_ && error_->code == SetupCode::not_found && !is_there(name_)) return false;
    ReaderOptions options = options_;
    if (std::exchange(attempted_, true)) options.from = ReaderOptions::From::oldest;
    auto reader = RingReader::open(name_, options);
    if (!reader) {
        error_ = std::move(reader.error());
        return false;
    }
    error_.reset();
    reader_ = std::move(*reader);
    ++opened_;
    return true;
}

void RingFollower::drop() {
    missed_ += reader_->missed();
    reader_.reset();
}

// Keeps a retired ring that still has its name. Otherwise the follower would open and read it again.
bool RingFollower::moved_on(ReadError error) {
    if (error == ReadError::empty || error == ReadError::forked || reader_->is_named()) return false;
    drop();
    return true;
}

ReadResult<RingRecord> RingFollower::poll() {
    while (try_open()) {
        auto record = reader_->poll();
        if (record) return record;
        if (moved_on(record.error())) continue;
        if (record.error() == ReadError::retired) return tl::unexpected(ReadError::no_writer);
        return record;
    }
    return tl::unexpected(ReadError::no_writer);
}

ReadResult<RingRecord> RingFollower::read(MonoTime deadline) {
    for (;;) {
        if (try_open()) {
            auto record = reader_->read(deadline);
            if (record) return record;
            if (moved_on(record.error())) continue;
            if (record.error() == ReadError::empty || record.error() == ReadError::forked) return record;
            if (record.error() == ReadError::damaged) return record;
        }
        const MonoTime now = mono_now();
        if (now >= deadline) return tl::unexpected(ReadError::no_writer);
        std::this_thread::sleep_for(std::min<Nanoseconds>(poll_interval, deadline - now));
    }
}

}  // namespace mavloom::shm
