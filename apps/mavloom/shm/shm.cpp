// SPDX-License-Identifier: MIT
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "parts.hpp"

namespace mavloom::app {

namespace {

struct Part {
    std::string_view name, description, footer;
    Declare declare;
};

constexpr std::array parts{
    Part{"list", "list every ring with its writer, readers and records", "Example: mavloom shm list --json",
         shm_parts::declare_list},
    Part{"stat", "show one ring: its writer and readers, how far behind they are, and what was lost",
         "Example: mavloom shm stat px4", shm_parts::declare_stat},
    Part{"write", "write each line of standard input as a record; exit status 4 if a full ring dropped some",
         "If the ring exists and has no writer, the command appends to it. The ring stays after the command ends, "
         "unless "
         "--remove is given.\n\n"
         "Examples: mavloom shm write px4 --capacity 1M < lines.txt\n"
         "          mavloom shm write px4 --hex --full evict < frames.hex",
         shm_parts::declare_write},
    Part{"read", "print the records of a ring; exit status 4 if some were missed",
         "If the ring does not exist, waits for it. If its writer ends, waits for the next one. Never delays the "
         "writer, "
         "unless --lossless is given.\n\n"
         "Examples: mavloom shm read px4 --json --count 10 --for 1s\n"
         "          mavloom shm read px4 --from oldest --drain --data",
         shm_parts::declare_read},
    Part{"remove", "remove rings and their counters; programs that use a ring are notified",
         "Example: mavloom shm remove px4", shm_parts::declare_remove},
};

}  // namespace

Run declare_shm(Arguments command, const Common& common) {
    command.require_subcommand();
    command.footer(
        "Rings are the files /dev/shm/mavloom.NAME. See docs/guide/shm.md and docs/formats/ring.md.\n\n"
        "Examples: mavloom shm list\n"
        "          mavloom shm stat px4\n"
        "          mavloom shm read px4 --from oldest --for 1s");
    std::vector<std::pair<Arguments, Run>> runs;
    for (const auto& part : parts) {
        auto added = command.add_subcommand(std::string(part.name), std::string(part.description));
        added.fallthrough();
        added.footer(std::string(part.footer));
        runs.emplace_back(added, part.declare(added, common));
    }
    return [runs] {
        for (const auto& [part, run] : runs)
            if (part.parsed()) return run();
        return Exit::wrong_use;
    };
}

}  // namespace mavloom::app
