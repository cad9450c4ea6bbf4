// SPDX-License-Identifier: MIT
// FrameBatch: copies of frames that were read together, for callers that take them one by one. Not synchronized. The
// memory is reused from batch to batch.
#pragma once

#include <cstdint>
#include <vector>

#include "mavloom/dialect/dialect.hpp"
#include "mavloom/wire/frame.hpp"

namespace mavloom::feed {

class FrameBatch {
public:
    struct Item {
        std::int64_t time_ns = 0;                      // Unix time
        const dialect::Message* definition = nullptr;  // null: an id without definition
        std::uint32_t link = 0;
        std::uint32_t offset = 0;  // in the batch's bytes
        std::uint16_t size = 0;
        std::uint8_t verdict = 0;  // see mavloom/ring/frames.hpp
    };

    void clear() noexcept {
        bytes_.clear();
        items_.clear();
        next_ = 0;
    }
    void add(Item item, const wire::FrameView& frame) {
        item.offset = static_cast<std::uint32_t>(bytes_.size());
        item.size = static_cast<std::uint16_t>(frame.size());
        const auto bytes = frame.bytes();
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
        items_.push_back(item);
    }
    [[nodiscard]] std::size_t size() const noexcept { return items_.size(); }
    [[nodiscard]] std::size_t left() const noexcept { return items_.size() - next_; }

    // Returns the next frame, or null after the last one.
    [[nodiscard]] const Item* next() noexcept { return next_ == items_.size() ? nullptr : &items_[next_++]; }
    // Undoes the last `next`, which then returns the same frame again.
    void put_back() noexcept { --next_; }
    [[nodiscard]] wire::FrameView frame(const Item& item) const noexcept {
        return wire::FrameView::unchecked({bytes_.data() + item.offset, item.size});
    }

private:
    std::vector<std::uint8_t> bytes_;
    std::vector<Item> items_;
    std::size_t next_ = 0;
};

}  // namespace mavloom::feed
