// SPDX-License-Identifier: MIT
// Subscription: the Python class of that name, one reader of a link. Any thread. Call with the GIL held; a call that
// waits releases it meanwhile.
#pragma once

#include <nanobind/nanobind.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "integer.hpp"
#include "mavloom/feed/channel.hpp"
#include "message/message.hpp"
#include "ring/writer.hpp"
#include "waiting.hpp"

namespace mavloom::python {

// Shared by the readers of a link. Leaked in a forked child, where a channel must not be destroyed.
struct LinkFeed {
    std::shared_ptr<const Origin> origin;
    std::shared_ptr<feed::Channel> channel;
    std::string ring_name;  // the shared-memory ring that is read; empty for other links
};

class Subscription {
public:
    Subscription(const LinkFeed& feed, dialect::Filter filter);
    ~Subscription();
    Subscription(const Subscription&) = delete;
    Subscription& operator=(const Subscription&) = delete;

    // Returns a new reference, or null at the end (iteration.hpp).
    PyObject* iterate();
    nb::object recv(const nb::object& timeout);
    nb::object recv_match(const nb::object& condition, const nb::object& type, const nb::object& blocking,
                          const nb::object& timeout, const OptionalInteger& system, const OptionalInteger& component);

    // Raises UsageError if this link reads `ring`: `pump` would write the ring's own records into it again.
    void check_target(const std::string& ring) const;
    // Writes frames to a ring without an object for each message; returns how many. After the time-out it still writes
    // the frames that were there when it began, as far as the ring has room.
    std::uint64_t pump(PyRingWriter& writer, const nb::object& timeout);

    // For asyncio. After a poll that found nothing, this descriptor becomes readable when another poll may find
    // something.
    int event_fd();
    [[nodiscard]] std::uint64_t missed() const;
    [[nodiscard]] std::string shown() const;  // for a repr
    void close();
    [[nodiscard]] const feed::ChannelReader& reader() const noexcept { return *reader_; }

private:
    // When a call gives up: at its deadline. A poll gives up once it has examined every frame that was there when it
    // began, no matter what arrives meanwhile.
    struct Limit {
        MonoTime deadline;
        std::optional<std::uint64_t> end;  // for a poll: one past the last frame to look at
    };
    struct Pumped {
        std::uint64_t count = 0;
        std::optional<shm::WriteError> error;
        bool full = false, ended = false;
    };

    // Returns an invalid object if no message arrived in time. Sets `ended` if none will ever arrive.
    nb::object next(const dialect::Filter& filter, const Limit& limit, bool& ended);
    nb::object or_closed(const dialect::Filter& filter, const nb::object& condition, MonoTime deadline);
    [[nodiscard]] bool is_past(std::uint64_t end);

    // Call these without the GIL; `put` with mutex_ held. A frame for which the ring has no room is put back.
    void pump_slice(PyRingWriter& writer, MonoTime deadline, Pumped& pumped);
    bool put(PyRingWriter& writer, const feed::FrameBatch::Item& item, MonoTime deadline, Pumped& pumped);

    // Call these with mutex_ held.
    const feed::FrameBatch::Item* next_item();
    [[nodiscard]] nb::object message_of(const feed::FrameBatch::Item& item) const;
    [[nodiscard]] bool is_over(const Limit& limit) const;

    const ForkGuard fork_;
    const std::shared_ptr<const Origin> origin_;
    const std::string ring_name_;
    std::unique_ptr<feed::ChannelReader> reader_;
    std::mutex mutex_;
    feed::FrameBatch batch_;  // batch_ and ended_ are guarded by mutex_
    bool ended_ = false;
};

}  // namespace mavloom::python
