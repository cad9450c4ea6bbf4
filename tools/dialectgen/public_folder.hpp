// SPDX-License-Identifier: MIT
// The public definition files of a folder, in memory.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "dialect/core/loader.hpp"
#include "generate.hpp"

namespace mavloom::dialectgen {

class PublicFolder {
public:
    // An empty path is a folder without files.
    [[nodiscard]] static SetupResult<PublicFolder> read(const std::filesystem::path& folder);

    [[nodiscard]] std::span<const dialect::PublicFile> files() const noexcept { return files_; }  // by name

private:
    std::map<std::string, std::string> texts_;  // by name; its nodes keep their addresses
    std::vector<dialect::PublicFile> files_;
};

// Writes the files as the function mavloom::dialect::builtin_files().
[[nodiscard]] SetupResult<void> write_files(const PublicFolder& folder, const Options& options);

}  // namespace mavloom::dialectgen
