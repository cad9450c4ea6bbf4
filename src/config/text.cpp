// SPDX-License-Identifier: MIT
#include "config/text.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <fstream>

namespace mavloom::config::detail {

SetupResult<std::string> read_config_text(const std::filesystem::path& file) {
    std::error_code error;
    if (std::filesystem::is_directory(file, error))
        return system_error(fmt::format("cannot read {}", file.string()), EISDIR);
    std::ifstream stream(file, std::ios::binary);
    if (!stream) return system_error(fmt::format("cannot read {}", file.string()), errno);
    constexpr std::size_t longest = 4 * 1024 * 1024;
    std::string text(longest + 1, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (stream.bad()) return system_error(fmt::format("cannot read {}", file.string()), EIO);
    text.resize(static_cast<std::size_t>(stream.gcount()));
    if (text.size() > longest)
        return setup_error(SetupCode::bad_input,
                           fmt::format("{} is too long for a configuration (at most 4 MiB)", file.string()));
    return text;
}

}  // namespace mavloom::config::detail
