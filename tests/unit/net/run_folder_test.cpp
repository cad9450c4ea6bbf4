// SPDX-License-Identifier: MIT
#include "mavloom/net/run_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "mavloom/net/local.hpp"
#include "support/temp_dir.hpp"

namespace mavloom::net {
namespace {

using testing::HasSubstr;

struct RunFolder : testing::Test {
    RunFolder() { ::setenv(run_variable, (dir.path() / "run").c_str(), 1); }
    ~RunFolder() override { ::unsetenv(run_variable); }
    test::TempDir dir;
};

TEST_F(RunFolder, IsTheOneThatTheVariableNamesAndIsMade) {
    EXPECT_EQ(run_path("px4", "ctl", "control socket").value(), dir.path() / "run" / "px4.ctl");
    EXPECT_TRUE(std::filesystem::is_directory(dir.path() / "run"));
}

TEST_F(RunFolder, ThatCannotBeMadeIsNamed) {
    std::ofstream(dir.path() / "run") << "a file";
    const auto path = run_path("px4", "in", "inlet");
    ASSERT_FALSE(path);
    EXPECT_THAT(path.error().text, HasSubstr("no folder for the inlet: MAVLOOM_RUN=" + (dir.path() / "run").string()));
}

TEST_F(RunFolder, NamesAreChecked) {
    EXPECT_EQ(run_path("../px4", "ctl", "control socket").error().code, SetupCode::usage);
    EXPECT_EQ(connect_in_run_folder("", "in").error().code, SetupCode::usage);
}

TEST_F(RunFolder, WhatNobodyServesIsNotFoundAndNothingIsMade) {
    EXPECT_EQ(connect_in_run_folder("px4", "in").error().code, SetupCode::not_found);
    EXPECT_FALSE(std::filesystem::exists(dir.path() / "run"));
}

}  // namespace
}  // namespace mavloom::net
