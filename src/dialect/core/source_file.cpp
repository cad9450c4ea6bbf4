// SPDX-License-Identifier: MIT
#include "source_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <system_error>

namespace mavloom::dialect {
namespace {

struct Close {
    void operator()(std::FILE* file) const noexcept { (void)std::fclose(file); }
};

SetupResult<std::string> read_whole(const std::filesystem::path& path) {
    std::error_code failure;
    const auto status = std::filesystem::status(path, failure);
    if (status.type() == std::filesystem::file_type::not_found) {
        return setup_error(SetupCode::not_found, fmt::format("{}: no such file", path.string()));
    }
    if (failure) return system_error(path.string(), failure.value());
    if (status.type() != std::filesystem::file_type::regular) {
        return setup_error(SetupCode::bad_input, fmt::format("{}: not a regular file", path.string()));
    }
    const std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), "rb"));
    if (!file) return system_error(path.string(), errno);
    const auto size = std::min<std::uintmax_t>(std::filesystem::file_size(path, failure), SourceFile::max_bytes);
    if (failure) return system_error(path.string(), failure.value());
    std::string text(size + 1, '\0');  // one extra byte detects a file that is too long
    text.resize(std::fread(text.data(), 1, text.size(), file.get()));
    if (std::ferror(file.get()) != 0) return system_error(path.string(), errno);
    return text;
}

}  // namespace

SetupResult<SourceFile> SourceFile::read(const std::filesystem::path& path) {
    auto text = read_whole(path);
    if (!text) return tl::unexpected(std::move(text.error()));
    if (text->size() > max_bytes) {
        return setup_error(SetupCode::bad_input, fmt::format("{}: too long; expected at most {} MiB of definitions",
                                                             path.string(), max_bytes >> 20));
    }
    return parse(*text, path.string());
}

SetupResult<SourceFile> SourceFile::parse(std::string_view text, std::string shown) {
    SourceFile file;
    file.shown_ = std::move(shown);
    file.size_bytes_ = text.size();
    for (std::size_t at = text.find('\n'); at != std::string_view::npos; at = text.find('\n', at + 1))
        file.line_ends_.push_back(static_cast<std::ptrdiff_t>(at));
    file.document_ = std::make_unique<pugi::xml_document>();
    const auto parsed = file.document_->load_buffer(text.data(), text.size(), pugi::parse_default, pugi::encoding_utf8);
    if (!parsed) {
        return setup_error(SetupCode::bad_input, fmt::format("{}:{}: {}; expected well-formed XML", file.shown_,
                                                             file.line_at(parsed.offset), parsed.description()));
    }
    return file;
}

std::size_t SourceFile::line_at(std::ptrdiff_t offset) const noexcept {
    const auto ended = std::ranges::lower_bound(line_ends_, offset) - line_ends_.begin();
    return static_cast<std::size_t>(ended) + 1;
}

}  // namespace mavloom::dialect
