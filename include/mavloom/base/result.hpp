// SPDX-License-Identifier: MIT
// Results that carry their error. Data-path calls use one-byte enums of their module; set-up calls (open, bind, load) use SetupError.
// Library code neither throws for expected failures nor prints nor exits; `main` and Python map codes to exit status and exceptions.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>

namespace mavloom {

template <class T, class E>
using Result = tl::expected<T, E>;

// What a program does next depends on the kind: exit 2 for `usage`, 3 for `bad_input`, 1 for the rest (DESIGN.md section 5).
enum class SetupCode : std::uint8_t {
    usage,        // an option or address that the user typed is wrong
    bad_input,    // a file's content is wrong: configuration, definitions, recording
    not_found,    // a file, device or host does not exist
    permission,   // the system refused
    in_use,       // a port or file belongs to somebody else
    unreachable,  // the far side does not answer (yet); worth retrying
    no_space,     // disk or memory is full
    system,       // anything else the system reported; see sys_errno
};

struct SetupError {
    SetupCode code = SetupCode::system;
    int sys_errno = 0;  // 0 where no system call failed
    std::string text;  // for the user: what failed, why, what to do; names file and line of his input where there is one

    // The same error with the outer operation put in front: "cannot open link X: " + text.
    [[nodiscard]] SetupError within(std::string_view outer) && {
        text.insert(0, std::string(outer) + ": ");
        return std::move(*this);
    }
};

template <class T>
using SetupResult = Result<T, SetupError>;

// Builds the error for a failed system call: maps errno to a code and appends its text.
[[nodiscard]] tl::unexpected<SetupError> system_error(std::string_view what, int err);
[[nodiscard]] inline tl::unexpected<SetupError> setup_error(SetupCode code, std::string text) {
    return tl::unexpected<SetupError>(SetupError{code, 0, std::move(text)});
}

}  // namespace mavloom
