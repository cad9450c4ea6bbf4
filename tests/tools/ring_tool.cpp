// SPDX-License-Identifier: MIT
// Writers and readers of a ring for tests/system/program/test_shm.py and test_shm_sources.py, which kill them.
//  ring_tool write NAME COUNT POLICY       COUNT records (0: until killed); "ready" on stdout once the ring is open
//  ring_tool die NAME RECORDS STEP         RECORDS whole ones; from then on kills itself with SIGKILL before the STEPth
//                                          access to shared memory
//  ring_tool read NAME lossy|lossless|polling COUNT   until record COUNT - 1 was there (0: until killed); checks each,
//                                          ends with a JSON object
//  ring_tool count NAME                    until killed, evicting, records that hold only their sequence number: tens
//                                          of millions a second
//  ring_tool follow NAME COUNT             a lossy reader of these, until number COUNT - 1 was there; it sleeps now and
//                                          then until it is lapped; ends with a JSON object
//  ring_tool feed NAME POLICY CAPACITY [LINK=NAME]...   each line "TIME_NS LINK HEX" or "TIME_NS LINK/KIND/VERDICT HEX"
//                                          of stdin becomes a record; "ready" on stdout; a counter page if names are
//                                          given
//  ring_tool check NAME                    all that the ring holds, whole and in order; a JSON object
// The record with sequence number n has (n * 7919) % 1500 bytes that follow from n.
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/shm/counter_page.hpp"
#include "mavloom/shm/ring_reader.hpp"
#include "mavloom/shm/ring_writer.hpp"
#include "shm/ring_file.hpp"

namespace {

using namespace mavloom;
using namespace mavloom::shm;

[[noreturn]] void fail(std::string_view why) {
    fmt::print(stderr, "ring_tool: {}\n", why);
    std::exit(1);
}

std::vector<std::uint8_t> content_of(std::uint64_t sequence) {
    std::vector<std::uint8_t> bytes(sequence * 7919 % 1500);
    std::uint64_t state = sequence * 0x9e3779b97f4a7c15u + 1;
    for (auto& byte : bytes) {
        state ^= state << 13, state ^= state >> 7, state ^= state << 17;
        byte = static_cast<std::uint8_t>(state);
    }
    return bytes;
}

bool is_good(const RingRecord& record) {
    const auto expected = content_of(record.sequence);
    return std::equal(expected.begin(), expected.end(), record.data.begin(), record.data.end()) &&
           record.info.link == LinkId{static_cast<std::uint32_t>(record.sequence)};
}

RecordInfo info_of(std::uint64_t sequence) { return {wall_now(), LinkId{static_cast<std::uint32_t>(sequence)}, 1, 2}; }

RingOptions options_of(std::string_view policy) {
    return {.capacity = min_capacity,
            .when_full = policy == "evict"         ? WhenFull::evict
                         : policy == "drop_newest" ? WhenFull::drop_newest
                                                   : WhenFull::wait};
}

void ready() {
    std::puts("ready");
    std::fflush(stdout);
}

int write(const std::string& name, std::uint64_t count, std::string_view policy) {
    auto writer = RingWriter::open(name, options_of(policy));
    if (!writer) fail(writer.error().text);
    ready();
    for (std::uint64_t n = 0; count == 0 || n < count; ++n) {
        const std::uint64_t sequence = writer->records();
        if (const auto written = writer->write(content_of(sequence), info_of(sequence));
            !written && written.error() != WriteError::full)
            fail(to_text(written.error()));
    }
    return 0;
}

// ---- very many small records

int count(const std::string& name) {
    auto writer = RingWriter::open(name, options_of("evict"));
    if (!writer) fail(writer.error().text);
    ready();
    for (;;) {
        std::array<std::uint8_t, 8> number;
        store_le(number.data(), writer->records());
        if (const auto written = writer->write(number, {}); !written) fail(to_text(written.error()));
    }
}

int follow(const std::string& name, std::uint64_t end) {
    auto reader = RingReader::open(name);
    if (!reader) fail(reader.error().text);
    ready();
    constexpr std::uint64_t doze_after = 1'000'000;
    std::optional<std::uint64_t> first;
    std::uint64_t next = 0, delivered = 0, missed = 0;
    while (next < end) {
        const auto record = reader->read();
        if (!record) fail(to_text(record.error()));
        if (record->data.size() != 8) fail("a record of another size");
        const auto number = load_le<std::uint64_t>(record->data.data());
        if (!first) first = next = number - record->missed;
        if (number != record->sequence || number != next + record->missed)
            fail(fmt::format("number {} where {} was due behind {} that were missed", number, next + record->missed,
                             record->missed));
        next = number + 1;
        missed += record->missed;
        if (++delivered % doze_after != 0) continue;
        while (reader->end_position() - reader->position() < 2 * min_capacity) ::usleep(100);
    }
    fmt::print("{{\"first\":{},\"delivered\":{},\"missed\":{},\"next\":{}}}\n", *first, delivered, missed, next);
    return 0;
}

// ---- a writer of given records

std::vector<std::uint8_t> bytes_of(std::string_view hex) {
    std::vector<std::uint8_t> bytes;
    for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
        bytes.push_back(static_cast<std::uint8_t>(std::stoul(std::string(hex.substr(i, 2)), nullptr, 16)));
    return bytes;
}

void name_links(CounterPage& page, const std::vector<std::string>& names) {
    for (const auto& word : names) {
        const auto equals = word.find('=');
        const auto link = static_cast<std::uint32_t>(std::stoul(word.substr(0, equals)));
        if (!page.name_link(LinkId{link}, word.substr(equals + 1))) fail("the page is full");
    }
}

RecordInfo info_of(std::int64_t time_ns, const std::string& tags) {
    std::uint32_t link = 0, kind = 0, verdict = 0;
    std::sscanf(tags.c_str(), "%u/%u/%u", &link, &kind, &verdict);
    return {WallTime{Nanoseconds{time_ns}}, LinkId{link}, static_cast<std::uint16_t>(kind),
            static_cast<std::uint8_t>(verdict)};
}

int feed(const std::string& name, std::string_view policy, std::uint64_t capacity,
         const std::vector<std::string>& names) {
    auto options = options_of(policy);
    options.capacity = capacity;
    auto writer = RingWriter::open(name, options);
    if (!writer) fail(writer.error().text);
    std::optional<CounterPage> page;
    if (!names.empty()) {
        auto made = CounterPage::create(name);
        if (!made) fail(made.error().text);
        page = std::move(*made);
        name_links(*page, names);
    }
    ready();
    std::int64_t time_ns = 0;
    for (std::string tags, hex; std::cin >> time_ns >> tags >> hex;) {
        const auto written = writer->write(bytes_of(hex), info_of(time_ns, tags), MonoTime::max());
        if (!written) fail(to_text(written.error()));
    }
    return 0;
}

// ---- a writer that counts its steps

std::uint64_t steps_left = ~std::uint64_t{0};

template <class T>
class DyingWord {
public:
    T load(std::memory_order order) const { return step().load(order); }
    void store(T value, std::memory_order order) { step().store(value, order); }
    T fetch_or(T bits, std::memory_order order) { return step().fetch_or(bits, order); }
    T fetch_and(T bits, std::memory_order order) { return step().fetch_and(bits, order); }
    T fetch_add(T more, std::memory_order order) { return step().fetch_add(more, order); }

private:
    const std::atomic<T>& step() const {
        count();
        return word_;
    }
    std::atomic<T>& step() {
        count();
        return word_;
    }
    static void count() {
        if (steps_left-- == 0) ::kill(::getpid(), SIGKILL);
    }
    std::atomic<T> word_;
};

struct DyingWords {
    using Word32 = DyingWord<std::uint32_t>;
    using Word64 = DyingWord<std::uint64_t>;
    static void sleep(const Word32&, std::uint32_t, Nanoseconds) {}
    static void wake(Word32&) {}
    static MonoTime now() { return mono_now(); }
};

int die(const std::string& name, std::uint64_t records, std::uint64_t step) {
    const auto segment = writer_segment(name, options_of("evict"));
    if (!segment) fail(segment.error().text);
    const auto real = memory_of(*segment);
    shm::detail::Producer<DyingWords> producer({reinterpret_cast<RingControl<DyingWords>*>(real.control),
                                                reinterpret_cast<ReaderSlot<DyingWords>*>(real.slots),
                                                reinterpret_cast<DyingWords::Word64*>(real.data), real.capacity});
    if (!producer.recover()) fail("the ring is damaged");
    for (std::uint64_t n = 0;; ++n) {
        if (n == records) steps_left = step;
        const auto content = content_of(producer.records());
        while (producer.claim(content.size()) != shm::detail::Producer<DyingWords>::Room::there)
            producer.drop_holds(producer.blockers(content.size()));
        producer.store_payload(content);
        producer.commit(info_of(producer.records()), content.size());
    }
}

// ---- readers

int read(const std::string& name, std::string_view kind, std::uint64_t count) {
    auto reader = RingReader::open(
        name, {.lossless = kind == "lossless", .from = ReaderOptions::From::oldest, .read_only = kind == "polling"});
    if (!reader) fail(reader.error().text);
    ready();
    std::uint64_t next = 0, delivered = 0, missed = 0;
    while (count == 0 || next < count) {
        const auto record = reader->read();
        if (!record && record.error() == ReadError::no_writer) {
            ::usleep(1000);
            continue;
        }
        if (!record) fail(to_text(record.error()));
        if (delivered != 0 && record->sequence != next + record->missed) fail("a record was left out and not counted");
        // A view whose hold an evicting writer took meanwhile may be overwritten: looked at first, asked about
        // afterwards.
        if (!is_good(*record) && reader->holds())
            fail(fmt::format("record {} is not what was written", record->sequence));
        next = record->sequence + 1;
        missed += record->missed;
        ++delivered;
    }
    fmt::print("{{\"delivered\":{},\"missed\":{},\"next\":{}}}\n", delivered, missed, next);
    return 0;
}

int check(const std::string& name) {
    auto reader = RingReader::open(name, {.from = ReaderOptions::From::oldest, .read_only = true});
    if (!reader) fail(reader.error().text);
    std::uint64_t first = 0, count = 0;
    for (;;) {
        const auto record = reader->try_read();
        if (!record && record.error() == ReadError::empty) break;
        if (!record) fail(to_text(record.error()));
        if (count == 0) first = record->sequence;
        if (record->sequence != first + count++) fail("the records are not in order");
        if (!is_good(*record)) fail(fmt::format("record {} is not what was written", record->sequence));
    }
    fmt::print("{{\"first\":{},\"count\":{}}}\n", first, count);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    const std::vector<std::string> words(argv + 1, argv + argc);
    const auto number = [&](std::size_t i) { return std::strtoull(words.at(i).c_str(), nullptr, 10); };
    if (words.size() == 4 && words[0] == "write") return write(words[1], number(2), words[3]);
    if (words.size() == 4 && words[0] == "die") return die(words[1], number(2), number(3));
    if (words.size() == 4 && words[0] == "read") return read(words[1], words[2], number(3));
    if (words.size() == 2 && words[0] == "count") return count(words[1]);
    if (words.size() == 3 && words[0] == "follow") return follow(words[1], number(2));
    if (words.size() >= 4 && words[0] == "feed")
        return feed(words[1], words[2], number(3), {words.begin() + 4, words.end()});
    if (words.size() == 2 && words[0] == "check") return check(words[1]);
    fail("see tests/tools/ring_tool.cpp");
}
