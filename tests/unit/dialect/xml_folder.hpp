// SPDX-License-Identifier: MIT
// A folder of XML files for one test, removed with it.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "mavloom/dialect/dialect.hpp"

namespace mavloom::dialect::test {

class XmlFolder {
public:
    XmlFolder() {
        auto pattern = (std::filesystem::temp_directory_path() / "mavloom_xml_XXXXXX").string();
        if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("mkdtemp " + pattern);
        path_ = pattern;
    }
    ~XmlFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    XmlFolder(const XmlFolder&) = delete;
    XmlFolder& operator=(const XmlFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

    void write(std::string_view name, std::string_view text) const {
        const auto file = path_ / name;
        std::filesystem::create_directories(file.parent_path());
        std::ofstream(file, std::ios::binary) << text;
    }

    [[nodiscard]] SetupResult<Dialect> load(std::string_view name = "a.xml") const {
        return Dialect::load(path_ / name);
    }

    // The error of loading `name`, the folder's path cut out of it; empty where it loads.
    [[nodiscard]] std::string error(std::string_view name = "a.xml") const {
        const auto loaded = load(name);
        if (loaded) return "";
        auto text = loaded.error().text;
        const auto prefix = path_.string() + "/";
        for (auto at = text.find(prefix); at != std::string::npos; at = text.find(prefix))
            text.erase(at, prefix.size());
        return text;
    }

private:
    std::filesystem::path path_;
};

// One <message> line, by default the first line of a file's content: line 2 of the file that `messages` makes.
inline std::string messages(std::string_view content) {
    return "<mavlink><messages>\n" + std::string(content) + "\n</messages></mavlink>\n";
}
inline std::string enums(std::string_view content) {
    return "<mavlink><enums>\n" + std::string(content) + "\n</enums></mavlink>\n";
}

}  // namespace mavloom::dialect::test
