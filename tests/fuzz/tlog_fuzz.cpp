// SPDX-License-Identifier: MIT
// Any bytes as a recording, through a file in memory: no crash, every byte accounted for, and the records found are the
// records of a file that holds only them.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "mavloom/record/tlog_index.hpp"
#include "mavloom/record/tlog_reader.hpp"
#include "mavloom/wire/message_table.hpp"

namespace {

using namespace mavloom;

const wire::MessageTable& table() {
    static const wire::MessageInfo messages[] = {
        {MessageId{0}, 50, 9, 9}, {MessageId{30}, 39, 28, 28}, {MessageId{77}, 143, 3, 10, 8, 9}};
    static const wire::MessageTable instance(messages);
    return instance;
}

struct MemoryFile {
    MemoryFile(const std::uint8_t* data, std::size_t size) : fd(::memfd_create("tlog", MFD_CLOEXEC)) {
        if (fd < 0 || ::write(fd, data, size) != static_cast<ssize_t>(size)) std::abort();
    }
    ~MemoryFile() { ::close(fd); }
    [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(fd); }
    int fd;
};

std::vector<std::uint8_t> records_of(const MemoryFile& file, std::size_t size) {
    auto reader = record::TlogReader::open(file.path(), table());
    if (!reader) std::abort();
    std::vector<std::uint8_t> records;
    while (const auto found = reader->next()) {
        std::uint8_t time[record::time_length];
        store_be64(time, static_cast<std::uint64_t>(unix_us(found->time)));
        records.insert(records.end(), time, time + sizeof time);
        records.insert(records.end(), found->frame.bytes().begin(), found->frame.bytes().end());
    }
    const auto& counters = reader->counters();
    if (counters.record_bytes.value() + counters.flagged_bytes.value() + counters.lost_bytes.value() != size)
        std::abort();
    if (counters.record_bytes.value() != records.size()) std::abort();
    if (!reader->seek(0)) std::abort();
    const auto index = record::TlogIndex::build(*reader, 2);
    if (!index || !index->seek(*reader, wall_from_us(1'700'000'000'000'000))) std::abort();
    return records;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto records = records_of(MemoryFile(data, size), size);
    if (records_of(MemoryFile(records.data(), records.size()), records.size()) != records) std::abort();
    return 0;
}
