// SPDX-License-Identifier: MIT
// The page: the files of web/dist, which are inside the program, compressed.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "mavloom/http/server.hpp"

namespace mavloom::web {

struct PageFile {
    std::string_view path, type, gzip;
};

[[nodiscard]] const std::array<PageFile, 4>& page_files();
// Answers with the page's files, decompressed for clients that do not accept gzip. A browser that has the same version
// already gets status 304.
[[nodiscard]] std::vector<http::Route> page_routes();

}  // namespace mavloom::web
