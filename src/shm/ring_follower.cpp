// SPDX-License-Identifier: MIT
#include "mavloom/shm/ring_follower.hpp"

#include <algorithm>
#include <thread>
#include <utility>

namespace mavloom::shm {

// Between two looks at a name that leads nowhere, or at a ring that nobody writes to.
static constexpr Nanoseconds look_distance = std::chrono::milliseconds(20);

bool RingFollower::try_open() {
    if (reader_) return true;
    ReaderOptions options = options_;
    if (std::exchange(looked_, true)) options.from = ReaderOptions::From::oldest;
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

ReadResult<RingRecord> RingFollower::read(MonoTime deadline) {
    for (;;) {
        if (try_open()) {
            auto record = reader_->read(deadline);
            if (record || record.error() == ReadError::empty || record.error() == ReadError::forked) return record;
            // Another ring may stand there now, or soon. A retired one that still bears the name is kept, or it would be read again.
            if (!reader_->is_named()) {
                drop();
                continue;
            }
            if (record.error() == ReadError::damaged) return record;
        }
        const MonoTime now = mono_now();
        if (now >= deadline) return tl::unexpected(ReadError::no_writer);
        std::this_thread::sleep_for(std::min<Nanoseconds>(look_distance, deadline - now));
    }
}

}  // namespace mavloom::shm
