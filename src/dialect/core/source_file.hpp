// SPDX-License-Identifier: MIT
// One parsed XML file in memory, with the line number of each element. It does not interpret the elements.
// Rejects files larger than max_bytes. pugixml expands only the five predefined XML entities and parses without
// recursion.
#pragma once

#include <filesystem>
#include <memory>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/base/result.hpp"

namespace mavloom::dialect {

class SourceFile {
public:
    static constexpr std::size_t max_bytes = 8u << 20;  // MAVLink's largest is under 1 MiB

    // Errors: `not_found` if the file does not exist, `bad_input` if it is not a regular file, too long or not
    // well-formed XML. Failed system calls give their own codes.
    [[nodiscard]] static SetupResult<SourceFile> read(const std::filesystem::path& path);
    // `shown` is the name for errors.
    [[nodiscard]] static SetupResult<SourceFile> parse(std::string_view text, std::string shown);

    [[nodiscard]] const std::string& shown() const noexcept { return shown_; }  // the path, as shown in errors
    [[nodiscard]] std::size_t size_bytes() const noexcept { return size_bytes_; }
    [[nodiscard]] pugi::xml_node root() const noexcept { return document_->document_element(); }
    [[nodiscard]] std::size_t line_of(pugi::xml_node node) const noexcept { return line_at(node.offset_debug()); }

private:
    [[nodiscard]] std::size_t line_at(std::ptrdiff_t offset) const noexcept;

    std::string shown_;
    std::size_t size_bytes_ = 0;
    std::vector<std::ptrdiff_t> line_ends_;
    std::unique_ptr<pugi::xml_document> document_;
};

}  // namespace mavloom::dialect
