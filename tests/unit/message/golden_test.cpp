// SPDX-License-Identifier: MIT
// Every message of the built-in dialect against tests/golden/messages.tsv: frames and values by pymavlink
// (tools/make_golden_messages.py).
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "mavloom/message/builder.hpp"
#include "mavloom/message/view.hpp"
#include "support/bytes.hpp"
#include "unit/message/sample_messages.hpp"

namespace mavloom::message {
namespace {

struct GoldenCase {
    std::string name, which, fields;
    test::Bytes frame;
};

std::vector<GoldenCase> golden_cases() {
    std::ifstream file(MAVLOOM_GOLDEN "/messages.tsv");
    std::vector<GoldenCase> cases;
    for (std::string line; std::getline(file, line);) {
        std::istringstream columns(line);
        GoldenCase c;
        std::string hex;
        std::getline(columns, c.name, '\t');
        std::getline(columns, c.which, '\t');
        std::getline(columns, hex, '\t');
        std::getline(columns, c.fields, '\t');
        c.frame = test::hex(hex);
        cases.push_back(std::move(c));
    }
    return cases;
}

TEST(Golden, HoldsEveryMessage) { EXPECT_EQ(golden_cases().size(), 3 * dialect::default_dialect().messages().size()); }

TEST(Golden, DecodesToPymavlinksValues) {
    for (const auto& c : golden_cases()) {
        const auto* message = dialect::default_dialect().find(c.name);
        ASSERT_NE(message, nullptr) << c.name;
        const auto payload = wire::FrameView::unchecked(c.frame).payload();
        EXPECT_EQ(testing::json_fields_of(*message, payload), c.fields) << c.name << " " << c.which;
    }
}

TEST(Golden, EncodesToPymavlinksBytes) {
    for (const auto& c : golden_cases()) {
        const auto& message = *dialect::default_dialect().find(c.name);
        const auto frame = wire::FrameView::unchecked(c.frame);
        const MessageBuilder builder(message, frame.payload());
        wire::FrameBuffer buffer{};

        const auto again = wire::write_frame(buffer, {wire::Version::v2, frame.sequence(), frame.source()},
                                             message.wire, builder.payload());

        EXPECT_EQ(test::Bytes(again.bytes().begin(), again.bytes().end()), c.frame) << c.name << " " << c.which;
    }
}

}  // namespace
}  // namespace mavloom::message
