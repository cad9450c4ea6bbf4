// SPDX-License-Identifier: MIT
#include "mavloom/http/session.hpp"

#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

#include "http/core.hpp"
#include "http/web_socket/frames.hpp"

namespace mavloom::http {

static_assert(net::BlockQueue::classes == 3);

Session::Session(const SessionOptions& options, Peer peer, Orders orders)
    : peer_(std::move(peer)),
      orders_(std::move(orders)),
      pack_bytes_(options.pack_bytes),
      writes_at_once_(options.writes_at_once),
      queue_(options.queue) {
    assert(!writes_at_once_ || pack_bytes_ != 0);
}

// If each block is a message, its first byte in the queue is its kind.
void Session::push(ByteView block, std::uint8_t block_class, std::uint64_t key, MonoTime now, Kind kind) {
    const std::lock_guard lock(mutex_);
    if (has_ended_) return;
    if (pack_bytes_ == 0) {
        scratch_.assign(1, static_cast<std::uint8_t>(kind));
        scratch_.insert(scratch_.end(), block.begin(), block.end());
        block = scratch_;
    }
    const auto pushed = queue_.push(block, block_class, key, now);
    if (pushed.dropped == 0) return;
    counters_.dropped_full.add(pushed.dropped);
    count_drops();
}

void Session::count_drops() {
    for (std::size_t i = 0; i < counters_.dropped.size(); ++i) counters_.dropped[i].set(queue_.dropped()[i]);
}

std::size_t Session::flush() {
    std::size_t sent = 0;
    {
        const std::lock_guard lock(mutex_);
        if (is_writing_ || has_ended_ || queue_.empty()) return 0;
        if (writer_ != nullptr) sent = write_at_once();
        is_writing_ = !queue_.empty() || !rest_.empty();
        if (!is_writing_) return sent;
    }
    orders_.write();
    return sent;
}

// Makes one system call.
std::size_t Session::write_at_once() {
    rest_bytes_ = take_some(rest_, write_size, mono_now(), [&] { take_packed(rest_, writer_); });
    const auto sent = std::max<ssize_t>(::send(socket_, rest_.data(), rest_.size(), MSG_DONTWAIT | MSG_NOSIGNAL), 0);
    rest_.erase(rest_.begin(), rest_.begin() + sent);
    return rest_.empty() ? std::exchange(rest_bytes_, 0) : 0;
}

void Session::lend(int socket, FrameWriter& writer) {
    if (!writes_at_once_) return;
    const std::lock_guard lock(mutex_);
    socket_ = socket;
    writer_ = &writer;
}

void Session::withdraw() {
    const std::lock_guard lock(mutex_);
    writer_ = nullptr;
}

std::size_t Session::take_begun(std::vector<std::uint8_t>& output) {
    const std::lock_guard lock(mutex_);
    is_writing_ = true;
    output.insert(output.end(), rest_.begin(), rest_.end());
    rest_.clear();
    return std::exchange(rest_bytes_, 0);
}

std::size_t Session::take(std::vector<std::uint8_t>& output, std::size_t up_to, FrameWriter& writer, MonoTime now) {
    const std::lock_guard lock(mutex_);
    return take_some(output, up_to, now, [&] {
        if (pack_bytes_ == 0) take_one(output, writer);
        else take_packed(output, &writer);
    });
}

std::size_t Session::take_unframed(std::vector<std::uint8_t>& output, std::size_t up_to, MonoTime now) {
    const std::lock_guard lock(mutex_);
    return take_some(output, up_to, now, [&] { take_packed(output, nullptr); });
}

template <class Append>
std::size_t Session::take_some(std::vector<std::uint8_t>& output, std::size_t up_to, MonoTime now, Append append) {
    if (const auto old = queue_.expire(now)) {
        counters_.dropped_old.add(old);
        count_drops();
    }
    const auto before = counters_.bytes_out.value();
    while (!queue_.empty() && output.size() < up_to) append();
    is_writing_ = !output.empty();
    return counters_.bytes_out.value() - before;
}

void Session::take_one(std::vector<std::uint8_t>& output, FrameWriter& writer) {
    iovec piece{};
    auto from = queue_.front();
    const auto gathered = queue_.gather(from, 0, {&piece, 1});
    const ByteView block(static_cast<const std::uint8_t*>(piece.iov_base), piece.iov_len);
    const bool is_text = static_cast<Kind>(block.front()) == Kind::text;
    writer.append(output, is_text ? Opcode::text : Opcode::binary, block.subspan(1));
    count_message(gathered.blocks, block.size() - 1);
    queue_.pop(from);
}

void Session::take_packed(std::vector<std::uint8_t>& output, FrameWriter* writer) {
    std::array<iovec, 16> pieces{};
    auto from = queue_.front();
    const auto gathered = queue_.gather(from, pack_bytes_, pieces);
    if (writer != nullptr) writer->begin(output, Opcode::binary, gathered.bytes);
    for (std::size_t i = 0; i < gathered.pieces; ++i) {
        const auto* const begin = static_cast<const std::uint8_t*>(pieces[i].iov_base);
        output.insert(output.end(), begin, begin + pieces[i].iov_len);
    }
    if (writer != nullptr) writer->end(output);
    count_message(gathered.blocks, gathered.bytes);
    queue_.pop(from);
}

void Session::count_message(std::size_t blocks, std::size_t bytes) {
    counters_.messages_out.add();
    counters_.blocks_out.add(blocks);
    counters_.bytes_out.add(bytes);
}

std::size_t Session::queued_bytes() const {
    const std::lock_guard lock(mutex_);
    return queue_.bytes();
}

void Session::end() {
    const std::lock_guard lock(mutex_);
    has_ended_ = true;
}

}  // namespace mavloom::http
