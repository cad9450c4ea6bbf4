// SPDX-License-Identifier: MIT
// Counts operator new: printing messages into a buffer that has its size must not allocate, nor must encoding them.
#include <gtest/gtest.h>

#include "mavloom/message/cdr.hpp"
#include "support/count_allocations.hpp"
#include "unit/message/sample_messages.hpp"

namespace mavloom::message {
namespace {

using namespace mavloom::testing;  // NOLINT: the sample definitions

TEST(Formatter, AllocatesNothingForAMessage) {
    const std::vector<std::uint8_t> payload(255, 0xfe);
    const auto& dialect = sample_dialect();
    const JsonFormatter formatter(dialect);
    TextBuffer out;
    out.reserve(64 * 1024);
    for (const auto& message : messages) {
        const SampleFrame frame(message, ByteView(payload).first(message.wire.max_length));
        const auto received = frame.received("a name that is longer than the small string of any library");
        const auto before = test::allocations;
        for (int i = 0; i < 3; ++i) {
            out.clear();
            append_json(out, received);
            formatter.append(out, received);
            append_text(out, received, dialect);
            append_csv_header(out, message);
            append_csv_row(out, received);
        }
        EXPECT_EQ(test::allocations, before) << message.name;
    }
}

TEST(Formatter, AllocatesOnlyUntilTheBufferHasGrown) {
    const SampleFrame frame(sample, std::vector<std::uint8_t>(61, 0xfe));
    TextBuffer out;
    const auto print_many = [&] {
        out.clear();
        for (int i = 0; i < 100; ++i) append_json(out, frame.received());
    };
    print_many();
    const auto before = test::allocations;
    print_many();
    EXPECT_EQ(test::allocations, before);
}

TEST(CdrEncoder, AllocatesNothingForAPayload) {
    const std::vector<std::uint8_t> payload(20, 0xfe);
    for (const auto& message : messages) {
        const CdrEncoder encoder(message);
        std::vector<std::uint8_t> out(encoder.max_size());
        const auto before = test::allocations;
        const auto size = encoder.encode(payload, out);
        EXPECT_EQ(test::allocations, before) << message.name;
        EXPECT_LE(size, out.size());
    }
}

}  // namespace
}  // namespace mavloom::message
