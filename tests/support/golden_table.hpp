// SPDX-License-Identifier: MIT
// The message table of `all` as pymavlink's generator computes it (tests/golden/dialect_all.tsv): for tests below
// module dialect.
#pragma once

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "mavloom/wire/message_table.hpp"

namespace mavloom::test {

inline const wire::MessageTable& golden_table() {
    static const wire::MessageTable table = [] {
        std::ifstream file(MAVLOOM_GOLDEN "/dialect_all.tsv");
        std::vector<wire::MessageInfo> infos;
        for (std::string line; std::getline(file, line);) {
            if (line.substr(0, 2) != "M\t") continue;
            std::istringstream words(line.substr(2));
            std::string name;
            unsigned id = 0, extra = 0, least = 0, most = 0, system = 0, component = 0;
            words >> id >> name >> extra >> least >> most >> system >> component;
            const auto byte = [](unsigned value) { return static_cast<std::uint8_t>(value); };
            infos.push_back({MessageId{id}, byte(extra), byte(least), byte(most), byte(system), byte(component)});
        }
        if (infos.size() < 300) throw std::runtime_error("tests/golden/dialect_all.tsv was not read");
        return wire::MessageTable(infos);
    }();
    return table;
}

}  // namespace mavloom::test
