// SPDX-License-Identifier: MIT
// Trust: whose rings and counter pages a reader uses. The owner of a file can write anything into it, and can end a
// process that has it mapped by shortening it.
#pragma once

#include <sys/types.h>

#include <optional>

namespace mavloom::shm {

struct Trust {
    // Reads every file that the permissions allow. Otherwise the reader refuses two kinds of files:
    // - those whose owner is neither this user, nor root, nor `user`
    // - in a program that does not survive lost mappings (lost_mapping.hpp), those that others than the owner may
    //   write, because they could end the program
    bool foreign = false;
    std::optional<uid_t> user{};
};

}  // namespace mavloom::shm
