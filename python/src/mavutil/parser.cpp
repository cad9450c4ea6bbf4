// SPDX-License-Identifier: MIT
// Class MavutilParser: finds messages in bytes for mavloom.mavutil. Bytes that are no message become BAD_DATA.
#include <nanobind/nanobind.h>

#include <algorithm>
#include <deque>
#include <mutex>
#include <vector>

#include "bindings.hpp"
#include "errors.hpp"
#include "gil.hpp"
#include "mavloom/wire/stream_parser.hpp"
#include "mavutil/damage.hpp"
#include "mavutil/message.hpp"
#include "message/encode.hpp"
#include "strings.hpp"

namespace mavloom::python {
namespace {

class MavutilParser {
public:
    explicit MavutilParser(const nb::object& dialect)
        : origin_(std::make_shared<Origin>(dialect)), parser_(origin_->dialect().wire_table()) {}

    // Returns a list of messages, and of (bytes, reason) for bytes that are no message.
    nb::list feed(const nb::object& data, std::int64_t time_ns) {
        const Buffer buffer(data);
        const auto lock = lock_without_gil(mutex_);
        nb::list made;
        const auto bytes = buffer.bytes();
        left_.insert(left_.end(), bytes.begin(), bytes.end());
        const auto sink = [&](const wire::ParseEvent& event) { take(event, time_ns, made); };
        parser_.feed(bytes, MonoTime{}, sink);
        parser_.settle(sink);
        return made;
    }

    // How many bytes of an incomplete frame are held.
    [[nodiscard]] std::size_t pending() const noexcept { return left_.size(); }
    // How many bytes are needed before more can be returned.
    [[nodiscard]] std::size_t needed() const noexcept {
        const std::vector<std::uint8_t> start(left_.begin(),
                                              left_.begin() + std::min<std::ptrdiff_t>(3, std::ssize(left_)));
        const auto length = std::max(wire::frame_length(start), wire::min_frame_length);
        return length > left_.size() ? length - left_.size() : 1;
    }

private:
    void take(const wire::ParseEvent& event, std::int64_t time_ns, nb::list& made) {
        using Kind = wire::ParseEvent::Kind;
        switch (event.kind) {
            case Kind::bad_checksum: return take_damaged(event.frame, made);
            case Kind::junk: return take_junk(event.bytes, made);
            case Kind::unknown_flags: break;
            case Kind::frame:
                made.append(make_mavutil_message(origin_, origin_->dialect().find(event.frame.id()), time_ns, 0,
                                                 event.frame, 0));
        }
        drop(event.frame.size());
    }

    // The parser continues to look for frames behind the start byte of the damaged one.
    void take_damaged(const wire::FrameView& frame, nb::list& made) {
        if (returned_ != 0) return;
        returned_ = frame.size();
        made.append(nb::make_tuple(bytes_of(frame.bytes()), crc_reason(frame, origin_->dialect().find(frame.id()))));
    }

    void take_junk(std::size_t count, nb::list& made) {
        const auto known = std::min(count, returned_);
        drop(known);
        if (known == count) return;
        const auto end = left_.begin() + static_cast<std::ptrdiff_t>(count - known);
        made.append(nb::make_tuple(bytes_of(std::vector<std::uint8_t>(left_.begin(), end)), bad_prefix));
        drop(count - known);
    }

    void drop(std::size_t count) {
        left_.erase(left_.begin(), left_.begin() + static_cast<std::ptrdiff_t>(count));
        returned_ -= std::min(returned_, count);
    }

    const std::shared_ptr<Origin> origin_;
    std::mutex mutex_;
    // Guarded by mutex_:
    wire::StreamParser parser_;
    std::deque<std::uint8_t> left_;  // bytes that were fed and are in no event yet
    std::size_t returned_ = 0;       // bytes at the front of left_ that were returned as a damaged frame
};

}  // namespace

void bind_mavutil_parser(nb::module_& module) {
    nb::class_<MavutilParser>(module, "MavutilParser", nb::is_final(), "Finds messages in bytes for mavloom.mavutil.")
        .def(nb::init<const nb::object&>(), nb::arg("dialect"), nb::sig("def __init__(self, dialect: Dialect) -> None"))
        .def("feed", &MavutilParser::feed, nb::arg("data"), nb::arg("time_ns"),
             nb::sig("def feed(self, data: Buffer, time_ns: int) -> list[typing.Any]"),
             "Returns the messages that end in this chunk, and (bytes, reason) for bytes that are not a message.")
        .def_prop_ro("pending", &MavutilParser::pending)
        .def_prop_ro("needed", &MavutilParser::needed);
}

}  // namespace mavloom::python
