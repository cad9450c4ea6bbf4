// SPDX-License-Identifier: MIT
// Result types: a value, or the error that explains why there is none. Set-up calls (open, bind, load) return
// SetupError. Calls on the data path return one-byte enums of their own module. Library code neither prints nor exits,
// and it does not throw for expected failures. `main` maps codes to exit statuses; the Python package maps them to
// exceptions.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>

namespace mavloom {

template <class T, class E>
using Result = tl::expected<T, E>;

// The kind of failure. A program exits with 2 for `usage`, 3 for `bad_input` and 1 for all others.
enum class SetupCode : std::uint8_t {
    usage,        // an option or address that the user typed is wrong
    bad_input,    // a file's content is wrong: configuration, message definitions, recording
    not_found,    // a file, device or host does not exist
    permission,   // the operating system denied access
    in_use,       // the port or file is in use, or the file already exists
    unreachable,  // the peer does not answer; retrying may help
    no_space,     // disk or memory is full
    system,       // any other system error; see sys_errno
};

struct SetupError {
    SetupCode code = SetupCode::system;
    int sys_errno = 0;  // 0 if no system call failed
    // For the user: what failed, why, and what to do. Gives file and line if the cause is in an input file.
    std::string text;

    // Prefixes the text with the outer operation: "cannot open link X: " + text.
    [[nodiscard]] SetupError within(std::string_view outer) && {
        text.insert(0, std::string(outer) + ": ");
        return std::move(*this);
    }
};

template <class T>
using SetupResult = Result<T, SetupError>;

// Builds the error for a failed system call: maps the errno value `err` to a code and appends its text to `what`.
[[nodiscard]] tl::unexpected<SetupError> system_error(std::string_view what, int err);
[[nodiscard]] inline tl::unexpected<SetupError> setup_error(SetupCode code, std::string text) {
    return tl::unexpected<SetupError>(SetupError{code, 0, std::move(text)});
}

}  // namespace mavloom
