// SPDX-License-Identifier: MIT
// Trust: from which users a reader accepts rings and counter pages. The owner of a file can write anything into it. By
// shortening the file, the owner can also crash a process that has it mapped.
#pragma once

#include <sys/types.h>

#include <optional>

namespace mavloom::shm {

struct Trust {
    // True: the reader uses every file that the permissions allow. False: it refuses two kinds of files:
    // - files whose owner is neither this user, nor root, nor `user`
    // - in a program that does not survive lost mappings (lost_mapping.hpp), files that users other than the owner may
    //   write, because any of them could crash the program
    bool foreign = false;
    std::optional<uid_t> user{};
};

}  // namespace mavloom::shm
