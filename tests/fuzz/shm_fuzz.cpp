// SPDX-License-Identifier: MIT
// Any bytes laid over a good ring, also while it is read: readers, writers and who asks for its state give records
// within the mapping or an error with a name, and end. An input is a list of patches: offset (4 bytes), length (1),
// bytes; those with the top bit of the offset set are made between reads.
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "mavloom/shm/counter_page.hpp"
#include "mavloom/shm/ring_info.hpp"
#include "mavloom/shm/ring_reader.hpp"
#include "mavloom/shm/ring_writer.hpp"

namespace {

using namespace mavloom;
using namespace mavloom::shm;

constexpr std::uint32_t later_flag = 0x80000000;
constexpr std::size_t max_reads = 5000;

struct Patch {
    std::uint32_t offset;
    ByteView bytes;
};

std::vector<Patch> patches_in(ByteView input) {
    std::vector<Patch> patches;
    while (input.size() > 5) {
        const auto offset = load_le<std::uint32_t>(input.data());
        const std::size_t length = std::min<std::size_t>(input[4], input.size() - 5);
        patches.push_back({offset, input.subspan(5, length)});
        input = input.subspan(5 + length);
    }
    return patches;
}

// A ring that has gone round once, and its file mapped for the patches.
class Victim {
public:
    Victim() : name_("fuzz-" + std::to_string(::getpid())) {
        auto writer = RingWriter::open(name_, {.capacity = min_capacity});
        if (!writer) std::abort();
        for (std::size_t i = 0; i < 120; ++i)
            if (!writer->write(std::vector<std::uint8_t>(i * 7 % 1400, static_cast<std::uint8_t>(i)), {})) std::abort();
        if (!writer->close()) std::abort();
        const int fd = ::open(path().c_str(), O_RDWR | O_CLOEXEC);
        size_ = static_cast<std::size_t>(::lseek(fd, 0, SEEK_END));
        void* const memory = ::mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
        ::close(fd);
        if (memory == MAP_FAILED) std::abort();
        bytes_ = static_cast<std::uint8_t*>(memory);
        good_.assign(bytes_, bytes_ + size_);
    }
    ~Victim() {
        ::munmap(bytes_, size_);
        ::unlink(path().c_str());
    }

    [[nodiscard]] const std::string& name() const { return name_; }
    void restore() { std::memcpy(bytes_, good_.data(), size_); }
    void apply(const Patch& patch) {
        const std::size_t offset = (patch.offset & ~later_flag) % size_;
        std::memcpy(bytes_ + offset, patch.bytes.data(), std::min(patch.bytes.size(), size_ - offset));
    }

private:
    [[nodiscard]] std::string path() const { return "/dev/shm/mavloom." + name_; }
    std::string name_;
    std::size_t size_ = 0;
    std::uint8_t* bytes_ = nullptr;
    std::vector<std::uint8_t> good_;
};

// `read(reader, i, look)`: for the i-th time; false ends it.
template <class Read>
void read_all(Victim& victim, const std::vector<Patch>& patches, const ReaderOptions& options, Read read) {
    victim.restore();
    for (const auto& patch : patches)
        if ((patch.offset & later_flag) == 0) victim.apply(patch);
    auto reader = RingReader::open(victim.name(), options);
    if (!reader) {
        if (reader.error().text.empty()) std::abort();
        return;
    }
    auto patch = patches.begin();
    std::uint64_t sum = 0;
    const auto look = [&](const RingRecord& record) {
        if (record.data.size() > max_record_bytes) std::abort();
        for (const auto byte : record.data) sum += byte;  // the address sanitizer looks where it is
        while (patch != patches.end() && (patch->offset & later_flag) == 0) ++patch;
        if (patch != patches.end()) victim.apply(*patch++);
    };
    for (std::size_t i = 0; i < max_reads && read(*reader, i, look); ++i) {}
    volatile std::uint64_t sink = sum;
    static_cast<void>(sink);
}

constexpr auto one_by_one = [](RingReader& reader, std::size_t, const auto& look) {
    const auto record = reader.try_read();
    if (record) look(*record);
    return record.has_value();
};

// By visits of changing length; what one of them gives lies in one piece.
constexpr auto by_visits = [](RingReader& reader, std::size_t i, const auto& look) {
    const std::uint8_t* end = nullptr;
    return reader
        .try_visit(1 + i % 7,
                   [&](const RingRecord& record) {
                       if (end != nullptr && record.data.data() != end + record_header_bytes) std::abort();
                       end = record.data.data() + record_size(record.data.size()) - record_header_bytes;
                       look(record);
                   })
        .has_value();
};

void write_one(Victim& victim, const std::vector<Patch>& patches) {
    victim.restore();
    for (const auto& patch : patches) victim.apply(patch);
    static_cast<void>(ring_status(victim.name()));
    auto writer = RingWriter::open(victim.name(), {.capacity = min_capacity, .when_full = WhenFull::evict});
    if (!writer) return;
    for (int i = 0; i < 100; ++i) static_cast<void>(writer->write(std::vector<std::uint8_t>(900), {}));
    victim.restore();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static Victim victim;
    const auto patches = patches_in({data, size});
    read_all(victim, patches, {.from = ReaderOptions::From::oldest}, one_by_one);
    read_all(victim, patches, {.lossless = true, .from = ReaderOptions::From::oldest}, one_by_one);
    read_all(victim, patches, {.lossless = true, .from = ReaderOptions::From::oldest}, by_visits);
    read_all(victim, patches, {.read_only = true}, one_by_one);
    write_one(victim, patches);
    return 0;
}
