// SPDX-License-Identifier: MIT
// Our ring as programs use it: `write`, batches read in place, and sleep while there is nothing to read.
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>

#include "mavloom/shm/ring_reader.hpp"
#include "mavloom/shm/ring_writer.hpp"

namespace mavloom::bench {

// Returns the opened object, or ends the program if it could not be opened.
template <class Opened>
auto or_exit(Opened opened) {
    if (opened) return std::move(*opened);
    std::fprintf(stderr, "%s\n", opened.error().text.c_str());
    std::exit(1);
}

class RingTransport {
public:
    explicit RingTransport(std::string_view what, const shm::RingOptions& options = {})
        : name_(fmt::format("bench-{}-{}", ::getpid(), what)), options_(options) {
        (void)or_exit(shm::RingWriter::open(name_, options_));  // so that readers find it
    }
    RingTransport(const RingTransport&) = delete;
    RingTransport& operator=(const RingTransport&) = delete;

    class Writer {
    public:
        explicit Writer(shm::RingWriter&& writer) : writer_(std::move(writer)) {}
        Writer(Writer&&) = default;
        ~Writer() { (void)writer_.close(shm::RingWriter::Leave::nothing); }

        template <class Shared>
        void write(const Shared&, ByteView record) {
            if (!writer_.write(record, {})) std::exit(1);
        }
        template <class Shared>
        void flush(const Shared&) {
            writer_.flush();
        }

    private:
        shm::RingWriter writer_;
    };

    class Reader {
    public:
        explicit Reader(shm::RingReader&& reader) : reader_(std::move(reader)) {}

        template <class Each>
        void poll(Each&& each) {
            if (reader_.try_visit(256, [&](const shm::RingRecord& record) { each(record.data); })) return;
            if (const auto record = reader_.read(mono_now() + std::chrono::milliseconds(100))) each(record->data);
        }

    private:
        shm::RingReader reader_;
    };

    [[nodiscard]] Writer writer() const { return Writer(or_exit(shm::RingWriter::open(name_, options_))); }
    [[nodiscard]] Reader reader(unsigned) const { return Reader(or_exit(open({.lossless = true}))); }
    [[nodiscard]] SetupResult<shm::RingReader> open(const shm::ReaderOptions& options) const {
        return shm::RingReader::open(name_, options);
    }

private:
    std::string name_;
    shm::RingOptions options_;
};

}  // namespace mavloom::bench
