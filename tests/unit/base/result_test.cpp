// SPDX-License-Identifier: MIT
#include "mavloom/base/result.hpp"

#include <gtest/gtest.h>

#include <cerrno>

namespace mavloom {
namespace {

TEST(SetupError, SystemErrorsHaveACodeAndTheSystemsText) {
    const struct {
        int error;
        SetupCode code;
    } cases[] = {{ENOENT, SetupCode::not_found},         {EACCES, SetupCode::permission},
                 {EADDRINUSE, SetupCode::in_use},        {ENOSPC, SetupCode::no_space},
                 {ECONNREFUSED, SetupCode::unreachable}, {EIO, SetupCode::system}};
    for (const auto& [error, code] : cases) {
        const SetupError made = system_error("cannot read x", error).value();
        EXPECT_EQ(made.code, code);
        EXPECT_EQ(made.sys_errno, error);
    }
    EXPECT_EQ(system_error("cannot read x", ENOENT).value().text, "cannot read x: No such file or directory");
}

TEST(SetupError, TheOuterOperationStandsInFront) {
    const auto error = SetupError{SetupCode::usage, 0, "no such port"}.within("endpoint a").within("link b");

    EXPECT_EQ(error.text, "link b: endpoint a: no such port");
    EXPECT_EQ(error.code, SetupCode::usage);
}

}  // namespace
}  // namespace mavloom
