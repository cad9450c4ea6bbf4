// SPDX-License-Identifier: MIT
#include "web/page.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "mavloom/http/gzip.hpp"

namespace mavloom::web {

namespace {

// FNV-1a, which differs between versions of a file.
std::uint64_t hash_of(std::string_view bytes) noexcept {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3;
    return hash;
}

bool accepts_gzip(std::string_view header) noexcept {
    const auto at = header.find("gzip");
    if (at == std::string_view::npos) return false;
    const auto rest = header.substr(at, header.find(',', at) - at);
    return !(rest.ends_with("q=0") || rest.ends_with("q=0.0"));
}

struct Form {
    std::string tag, headers;
};

Form make_form(std::string tag, std::string_view encoding) {
    auto headers = fmt::format("ETag: {}\r\nCache-Control: no-cache\r\nVary: Accept-Encoding\r\n{}", tag, encoding);
    return {std::move(tag), std::move(headers)};
}

// Most clients take the file as it is in the program.
std::shared_ptr<const std::string> body_of(const PageFile& file, bool is_gzip) {
    if (is_gzip) return std::make_shared<const std::string>(file.gzip);
    return std::make_shared<const std::string>(http::gunzip(file.gzip).value_or(""));
}

http::Route route_of(const PageFile& file) {
    const auto hash = hash_of(file.gzip);
    const auto plain = make_form(fmt::format("\"{:016x}\"", hash), "");
    const auto gzip = make_form(fmt::format("\"{:016x}-gzip\"", hash), "Content-Encoding: gzip\r\n");
    return {std::string(file.path), [plain, gzip, file](const auto& request, const auto& respond) {
                const bool is_gzip = accepts_gzip(request.accept_encoding);
                const Form& form = is_gzip ? gzip : plain;
                const bool is_known = request.if_none_match.find(form.tag) != std::string::npos;
                respond({.status = is_known ? 304 : 200,
                         .content_type = std::string(file.type),
                         .headers = form.headers,
                         .body = is_known ? nullptr : body_of(file, is_gzip)});
            }};
}

}  // namespace

std::vector<http::Route> page_routes() {
    std::vector<http::Route> routes;
    for (const auto& file : page_files()) routes.push_back(route_of(file));
    return routes;
}

}  // namespace mavloom::web
