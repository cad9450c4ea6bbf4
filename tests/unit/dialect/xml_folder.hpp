// SPDX-License-Identifier: MIT
// A folder of XML files for one test, removed with it.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "mavloom/dialect/dialect.hpp"
#include "support/temp_dir.hpp"

namespace mavloom::dialect::test {

class XmlFolder {
public:
    [[nodiscard]] const std::filesystem::path& path() const { return folder_.path(); }

    void write(std::string_view name, std::string_view text) const {
        const auto file = folder_ / std::string(name);
        std::filesystem::create_directories(file.parent_path());
        std::ofstream(file, std::ios::binary) << text;
    }

    [[nodiscard]] SetupResult<Dialect> load(std::string_view name = "a.xml") const {
        return Dialect::load(folder_ / std::string(name));
    }

    // The error of loading `name`, the folder's path cut out of it; empty where it loads.
    [[nodiscard]] std::string error(std::string_view name = "a.xml") const {
        const auto loaded = load(name);
        if (loaded) return "";
        auto text = loaded.error().text;
        const auto prefix = path().string() + "/";
        for (auto at = text.find(prefix); at != std::string::npos; at = text.find(prefix))
            text.erase(at, prefix.size());
        return text;
    }

private:
    mavloom::test::TempDir folder_;
};

// A file of messages, or of enums, whose content begins on line 2.
inline std::string messages(std::string_view content) {
    return "<mavlink><messages>\n" + std::string(content) + "\n</messages></mavlink>\n";
}
inline std::string enums(std::string_view content) {
    return "<mavlink><enums>\n" + std::string(content) + "\n</enums></mavlink>\n";
}

}  // namespace mavloom::dialect::test
