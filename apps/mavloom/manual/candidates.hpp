// SPDX-License-Identifier: MIT
// What may stand next on a command line.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "manual/declared.hpp"

namespace mavloom::app {

struct Candidate {
    std::string word, description{};
};

struct Candidates {
    std::vector<Candidate> all;
    bool and_files = false;
};

// Words that depend on the machine or on the dialect. Called only if they are wanted.
struct Vocabulary {
    std::vector<std::string> (*messages)(), (*rings)(), (*running)(), (*actions)();
    std::vector<std::string> (*fields)(const std::string& message);
    std::vector<std::string> (*links)(const std::string& program);  // of a running router or simulator
};

// Continuations of the last of `words`, which may be empty; the words before it are complete, without "mavloom".
[[nodiscard]] Candidates candidates(const DeclaredCommand& program, std::span<const std::string> words,
                                    const Vocabulary& vocabulary);

}  // namespace mavloom::app
