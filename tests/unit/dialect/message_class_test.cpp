// SPDX-License-Identifier: MIT
// Expected values: the lists of docs/guide/queues.md.
#include "mavloom/dialect/message_class.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "mavloom/dialect/dialect.hpp"

namespace mavloom::dialect {
namespace {

// {message: the words before the colon of its list}
std::map<std::string, std::string> lists_of_the_guide() {
    std::ifstream file(MAVLOOM_TEST_DATA "/../../docs/guide/queues.md");
    std::map<std::string, std::string> lists;
    std::string line, list;
    while (std::getline(file, line)) {
        if (line.starts_with("- ")) list = line.substr(2, line.find(':') - 2);
        else if (!line.starts_with("  ")) list.clear();
        if (list.empty()) continue;
        std::istringstream words(line.starts_with("- ") ? line.substr(line.find(':') + 1) : line);
        for (std::string word; words >> word;) lists[word.substr(0, word.find(','))] = list;
    }
    return lists;
}

std::string list_of(const Message& message) {
    if (class_of(message.id(), &message.wire) == MessageClass::essential) return "essential";
    switch (meaning_of(message.id())) {
        case FrameMeaning::piece: return "pieces of a whole";
        case FrameMeaning::event: return "events";
        case FrameMeaning::answer: return "answers";
        case FrameMeaning::one_of_many: return "one of many";
        case FrameMeaning::one_of_kind: return "several of a kind";
        default: return "";
    }
}

TEST(MessageClass, IsThatOfTheGuide) {
    auto lists = lists_of_the_guide();
    ASSERT_GT(lists.size(), 100u);
    for (auto& [name, list] : lists)
        for (const auto* use : {"presence", "control", "parameters", "missions", "commands", "text"})
            if (list == use) list = "essential";

    for (const auto& message : default_dialect().messages())
        EXPECT_EQ(list_of(message), lists[std::string(message.name)]) << message.name;
    for (const auto& [name, list] : lists) EXPECT_TRUE(default_dialect().message(name).has_value()) << name;
}

TEST(MessageClass, TargetedIsWhatHasATargetSystem) {
    const auto class_by_id = [](std::uint32_t id) {
        return class_of(MessageId{id}, default_dialect().wire_table().find(MessageId{id}));
    };

    for (const std::uint32_t id : {4u, 69u, 110u, 385u}) EXPECT_EQ(class_by_id(id), MessageClass::targeted) << id;
    for (const std::uint32_t id : {30u, 131u, 12345678u}) EXPECT_EQ(class_by_id(id), MessageClass::telemetry) << id;
}

}  // namespace
}  // namespace mavloom::dialect
