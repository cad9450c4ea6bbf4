// SPDX-License-Identifier: MIT
// The minimum that moves records from one core to another: each record is copied into shared memory, after 24 bytes of
// tags like those of a ring's record, and published by one store. One reader.
#pragma once

#include <sched.h>
#include <sys/mman.h>

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <new>

#include "mavloom/base/bytes.hpp"

namespace mavloom::bench {

class BareTransport {
    static constexpr std::uint64_t capacity = 8 << 20, longest = 512;
    struct Tags {
        std::uint64_t length, time, link;
    };
    struct Memory {
        alignas(128) std::atomic<std::uint64_t> tail{0};
        alignas(128) std::atomic<std::uint64_t> head{0};
        // With room for a record that starts just before the end.
        alignas(128) std::uint8_t bytes[capacity + longest + sizeof(Tags)];

        [[nodiscard]] std::uint8_t* at(std::uint64_t position) noexcept { return bytes + position % capacity; }
    };
    [[nodiscard]] static std::uint64_t size_of(std::uint64_t length) noexcept {
        return (sizeof(Tags) + length + 7) & ~std::uint64_t{7};
    }

public:
    BareTransport() {
        void* const memory = ::mmap(nullptr, sizeof(Memory), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
        if (memory == MAP_FAILED) std::abort();
        memory_ = new (memory) Memory;
    }

    class Writer {
    public:
        explicit Writer(Memory& memory) : memory_(memory) {}
        template <class Shared>
        void write(const Shared&, ByteView record) {
            const Tags tags{record.size(), 0, 0};
            while (tail_ + size_of(tags.length) - head_ > capacity) wait_for_room();
            std::memcpy(memory_.at(tail_), &tags, sizeof tags);
            std::memcpy(memory_.at(tail_) + sizeof tags, record.data(), record.size());
            tail_ += size_of(tags.length);
            memory_.tail.store(tail_, std::memory_order_release);
        }
        template <class Shared>
        void flush(const Shared&) {}

    private:
        void wait_for_room() {
            const auto head = memory_.head.load(std::memory_order_acquire);
            if (head == head_) ::sched_yield();
            head_ = head;
        }
        Memory& memory_;
        std::uint64_t tail_ = 0, head_ = 0;
    };

    class Reader {
    public:
        explicit Reader(Memory& memory) : memory_(memory) {}
        template <class Each>
        void poll(Each&& each) {
            const auto tail = memory_.tail.load(std::memory_order_acquire);
            if (tail == head_) ::sched_yield();
            while (head_ < tail) {
                Tags tags;
                std::memcpy(&tags, memory_.at(head_), sizeof tags);
                each(ByteView(memory_.at(head_) + sizeof tags, tags.length));
                head_ += size_of(tags.length);
            }
            memory_.head.store(head_, std::memory_order_release);
        }

    private:
        Memory& memory_;
        std::uint64_t head_ = 0;
    };

    [[nodiscard]] Writer writer() const { return Writer(*memory_); }
    [[nodiscard]] Reader reader(unsigned) const { return Reader(*memory_); }

private:
    Memory* memory_;
};

}  // namespace mavloom::bench
