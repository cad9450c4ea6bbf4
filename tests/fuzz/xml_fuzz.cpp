// SPDX-License-Identifier: MIT
// Any bytes as a definitions file: an error with a text, or a dialect whose layout holds together.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "mavloom/dialect/dialect.hpp"

namespace {

using namespace mavloom;

void require(bool holds, const char* what) {
    if (holds) return;
    (void)std::fprintf(stderr, "broken: %s\n", what);
    std::abort();
}

// A file that is only in memory.
class MemoryFile {
public:
    MemoryFile(const std::uint8_t* data, std::size_t size) : fd_(memfd_create("xml", MFD_CLOEXEC)) {
        require(fd_ >= 0 && write(fd_, data, size) == static_cast<ssize_t>(size), "memfd");
    }
    ~MemoryFile() { (void)close(fd_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(fd_); }

private:
    int fd_;
};

void check_message(const dialect::Dialect& dialect, const dialect::Message& message) {
    std::vector<bool> used(message.wire.max_length);
    std::size_t bytes = 0;
    for (const auto& field : message.fields) {
        bytes += field.size();
        require(field.offset + field.size() <= message.wire.max_length, "a field ends behind the payload");
        require(field.extension || field.offset + field.size() <= message.wire.min_length,
                "a base field ends behind min_length");
        for (std::size_t i = 0; i < field.size(); ++i) {
            require(!used[field.offset + i], "two fields share a byte");
            used[field.offset + i] = true;
        }
    }
    require(bytes == message.wire.max_length, "the payload has gaps");
    require(dialect.find(message.id()) == &message && dialect.find(message.name) == &message, "a message is not found");
}

void check(const dialect::Dialect& dialect) {
    for (const auto& message : dialect.messages()) check_message(dialect, message);
    for (const auto& e : dialect.enums()) {
        require(dialect.find_enum(e.name) == &e, "an enum is not found");
        for (const auto& entry : e.entries)
            require(e.find(entry.value) == &entry && e.find(entry.name) == &entry, "an entry is not found");
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const MemoryFile file(data, size);
    const auto loaded = dialect::Dialect::load(file.path());
    if (!loaded) {
        require(!loaded.error().text.empty(), "an error without text");
        return 0;
    }
    check(*loaded);
    if (const auto both = loaded->with(*loaded)) check(*both);
    return 0;
}
