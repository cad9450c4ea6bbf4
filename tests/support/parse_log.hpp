// SPDX-License-Identifier: MIT
// Collects what a parser reports, in a form that tests compare: "frame 0/7", "bad 30", "junk 5", "flags 0".
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "mavloom/wire/parse_event.hpp"
#include "support/bytes.hpp"

namespace mavloom::test {

struct ParseLog {
    std::vector<std::string> events;
    std::vector<Bytes> frames;

    void operator()(const wire::ParseEvent& event) {
        using Kind = wire::ParseEvent::Kind;
        switch (event.kind) {
            case Kind::frame:
                frames.push_back(copy(event.frame.bytes()));
                events.push_back(fmt::format("frame {}/{}", event.frame.id().value, event.frame.sequence()));
                break;
            case Kind::bad_checksum: events.push_back(fmt::format("bad {}", event.frame.id().value)); break;
            case Kind::junk: events.push_back(fmt::format("junk {}", event.bytes)); break;
            case Kind::unknown_flags: events.push_back(fmt::format("flags {}", event.frame.id().value)); break;
        }
    }
};

// Junk adjacent to junk is one run, however a parser cut it.
inline std::vector<std::string> merged_junk(const std::vector<std::string>& events) {
    std::vector<std::string> merged;
    std::size_t run = 0;
    const auto flush = [&] {
        if (run != 0) merged.push_back(fmt::format("junk {}", run));
        run = 0;
    };
    for (const auto& event : events) {
        if (event.starts_with("junk ")) {
            run += std::stoul(event.substr(5));
        } else {
            flush();
            merged.push_back(event);
        }
    }
    flush();
    return merged;
}

}  // namespace mavloom::test
