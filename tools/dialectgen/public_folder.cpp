// SPDX-License-Identifier: MIT
#include "public_folder.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <fstream>
#include <iterator>

#include "output.hpp"

namespace mavloom::dialectgen {

namespace fs = std::filesystem;

SetupResult<PublicFolder> PublicFolder::read(const fs::path& folder) {
    PublicFolder all;
    if (folder.empty()) return all;
    std::error_code failure;
    for (const auto& entry : fs::directory_iterator(folder, failure)) {
        if (entry.path().extension() != ".xml") continue;
        std::ifstream file(entry.path(), std::ios::binary);
        all.texts_.emplace(entry.path().filename().string(), std::string(std::istreambuf_iterator<char>(file), {}));
        if (!file) return system_error("cannot read " + entry.path().string(), errno);
    }
    if (failure) return system_error("cannot read " + folder.string(), failure.value());
    for (const auto& [name, text] : all.texts_) all.files_.push_back({name, text});
    return all;
}

SetupResult<void> write_files(const PublicFolder& folder, const Options& options) {
    std::string records;
    for (const auto& [name, text] : folder.files())
        records += fmt::format("    {{{}, {{R\"xml({})xml\", {}}}}},\n", literal(name), text, text.size());
    return write_file(
        options.out / "tables" / "files.cpp",
        fmt::format("// Made by mavloom_dialectgen; do not edit.\n#include \"dialect/core/loader.hpp\"\n\n"
                    "namespace mavloom::dialect {{\n\n"
                    "static constexpr PublicFile files[] = {{\n{}    {{}}}};\n\n"
                    "std::span<const PublicFile> builtin_files() noexcept {{ return {{files, {}}}; }}\n\n"
                    "}}  // namespace mavloom::dialect\n",
                    records, folder.files().size()));
}

}  // namespace mavloom::dialectgen
