// SPDX-License-Identifier: MIT
// Finds frames in bytes, for the datagram and the stream parser. It steps from frame to frame by the frames' lengths
// and checks each frame. After anything that is not a good frame it continues at the next byte, so it finds every
// intact frame that overlaps no damaged byte. One owner thread; allocates nothing after construction.
#pragma once

#include <cstddef>
#include <cstdint>

#include "mavloom/wire/crc.hpp"
#include "mavloom/wire/parse_event.hpp"
#include "mavloom/wire/unknown_ids.hpp"

namespace mavloom::wire::detail {

// Whether more bytes may follow those that were passed to the scanner.
enum class End : std::uint8_t {
    open,    // more bytes of the stream: an incomplete frame waits
    idle,    // none for now: an incomplete frame still waits, but a whole frame of unknown id is accepted
    closed,  // none (a datagram's end): an incomplete frame is junk
};

class Scanner {
public:
    static constexpr std::size_t enough_slack = 64;

    explicit Scanner(const MessageTable& table) : table_(&table) {}

    // Consumes the bytes that already form a frame or junk, calls sink(const ParseEvent&) for each event, and returns
    // the number of bytes consumed. The scanner may also read `slack` bytes after `bytes`; their values do not matter.
    // With at least `enough_slack`, it checks frames at the end of `bytes` as fast as all others.
    template <class Sink>
    std::size_t scan(ByteView bytes, End end, Sink&& sink, std::size_t slack = 0) {
        std::size_t at = 0;
        while (at != bytes.size()) {
            const std::size_t used = scan_one(bytes.subspan(at), end, sink, slack);
            if (used == 0) break;
            at += used;
        }
        return at;
    }

    // One step of `scan`: consumes a frame, or one byte that begins no frame. Returns 0 if more bytes are needed.
    // `bytes` is not empty.
    template <class Sink>
    std::size_t scan_one(ByteView bytes, End end, Sink&& sink, std::size_t slack = 0) {
        const Candidate found = examine(bytes.data(), bytes.size(), end, slack);
        if (found.kind == Candidate::Kind::frame) [[likely]] {
            end_junk(sink);
            counters_.frames.add();
            counters_.frame_bytes.add(found.size);
            in_sync_ = true;
            sink(ParseEvent{ParseEvent::Kind::frame, FrameView::unchecked(bytes.first(found.size)), found.info, 0});
            return found.size;
        }
        return found.kind == Candidate::Kind::incomplete ? 0 : refuse(found, bytes.data(), sink);
    }

    // Reports a run of junk that has not ended.
    template <class Sink>
    void end_junk(Sink&& sink) {
        if (junk_run_ == 0) [[likely]]
            return;
        sink(ParseEvent{ParseEvent::Kind::junk, {}, nullptr, junk_run_});
        junk_run_ = 0;
    }

    // Counts one byte that begins no frame as junk.
    template <class Sink>
    void add_junk(Sink&& sink) {
        counters_.junk_bytes.add();
        in_sync_ = false;
        if (++junk_run_ == longest_junk_event) end_junk(sink);
    }

    // Whether an intact frame of known id lies wholly in `bytes`.
    [[nodiscard]] bool holds_known_frame(ByteView bytes) const noexcept;

    [[nodiscard]] const ParseCounters& counters() const noexcept { return counters_; }

private:
    static constexpr std::size_t longest_junk_event = 4096;

    struct Candidate {
        enum class Kind : std::uint8_t { nothing, frame, incomplete, bad_checksum, unknown_flags };
        Kind kind = Kind::nothing;
        std::size_t size = 0;
        const MessageInfo* info = nullptr;
    };

    [[nodiscard]] static std::size_t frame_length(const std::uint8_t* p, std::size_t size) noexcept {
        return wire::frame_length({p, size});
    }

    // `readable` bytes from the start of the frame may be read.
    [[nodiscard]] static bool checksum_agrees(const FrameView& frame, std::size_t readable,
                                              const MessageInfo& info) noexcept {
        const auto covered = frame.bytes().subspan(1, frame.header_length() - 1 + frame.payload_length());
        return crc_agrees(covered, readable - 1, info.crc_extra, frame.checksum());
    }

    [[nodiscard]] Candidate examine(const std::uint8_t* p, std::size_t size, End end, std::size_t slack) noexcept {
        if (*p == stx_v2) [[likely]]
            return examine_start(p, size, end, slack);
        return *p == stx_v1 ? examine_start(p, size, end, slack) : Candidate{};
    }

    // Inlined into both branches of `examine`, so that the compiler knows the MAVLink version in each.
    [[nodiscard, gnu::always_inline]] Candidate examine_start(const std::uint8_t* p, std::size_t size, End end,
                                                              std::size_t slack) noexcept {
        const std::size_t length = frame_length(p, size);
        if (length == 0 || length > size)
            return {end == End::closed ? Candidate::Kind::nothing : Candidate::Kind::incomplete, 0, nullptr};
        const auto frame = FrameView::unchecked({p, length});
        const MessageInfo* info = table_->find(frame.id());
        if (info == nullptr) [[unlikely]]
            return examine_unknown(frame, ByteView{p + length, size - length}, end);
        if (!checksum_agrees(frame, size + slack, *info)) return {Candidate::Kind::bad_checksum, length, info};
        if ((frame.incompat_flags() & ~incompat_signed) != 0) return {Candidate::Kind::unknown_flags, length, info};
        return {Candidate::Kind::frame, length, info};
    }

    [[nodiscard]] Candidate examine_unknown(const FrameView& frame, ByteView behind, End end) noexcept;

    // Reports a candidate that is not a good frame. Returns the number of bytes consumed.
    template <class Sink>
    std::size_t refuse(const Candidate& found, const std::uint8_t* p, Sink&& sink) {
        if (found.kind == Candidate::Kind::unknown_flags) {
            end_junk(sink);
            counters_.unknown_flags.add();
            counters_.flagged_bytes.add(found.size);
            sink(ParseEvent{ParseEvent::Kind::unknown_flags, FrameView::unchecked({p, found.size}), found.info, 0});
            return found.size;
        }
        if (found.kind == Candidate::Kind::bad_checksum) {
            end_junk(sink);
            counters_.crc_error.add();
            sink(ParseEvent{ParseEvent::Kind::bad_checksum, FrameView::unchecked({p, found.size}), found.info, 0});
        }
        add_junk(sink);
        return 1;
    }

    const MessageTable* table_;
    UnknownIds unknown_;
    ParseCounters counters_;
    std::size_t junk_run_ = 0;
    bool in_sync_ = false;  // the bytes just before were a good frame
};

}  // namespace mavloom::wire::detail
