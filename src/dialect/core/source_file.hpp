// SPDX-License-Identifier: MIT
// One XML file in memory, parsed, with the line of each element. Not a validator: what the elements mean is the reader's business.
// Bounded: files beyond max_bytes are refused; pugixml expands no entities but XML's own five and parses without recursion.
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

    // `not_found` where there is none, `bad_input` where it is no well-formed XML.
    [[nodiscard]] static SetupResult<SourceFile> read(const std::filesystem::path& path);

    [[nodiscard]] const std::string& shown() const noexcept { return shown_; }  // the path as errors name it
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
