// SPDX-License-Identifier: MIT
// The assembler copies the files that cmake/MavloomPage.cmake compressed.
#include "web/page.hpp"

// Each file is followed by a zero.
// NOLINTBEGIN(bugprone-macro-parentheses): `symbol` is declared.
#define MAVLOOM_PAGE_FILE(symbol, name)                                                                                \
    __asm__(".section .rodata\n.global " #symbol "\n.hidden " #symbol "\n" #symbol ":\n.incbin \"" MAVLOOM_PAGE_FOLDER \
            "/" name "\"\n.global " #symbol "_end\n.hidden " #symbol "_end\n" #symbol "_end:\n.byte 0\n.text\n");      \
    extern "C" {                                                                                                       \
    [[gnu::visibility("hidden")]] extern const char symbol[], symbol##_end[];                                          \
    }
// NOLINTEND(bugprone-macro-parentheses)

MAVLOOM_PAGE_FILE(mavloom_page_html, "index.html.gz")
MAVLOOM_PAGE_FILE(mavloom_page_js, "app.js.gz")
MAVLOOM_PAGE_FILE(mavloom_page_css, "app.css.gz")
MAVLOOM_PAGE_FILE(mavloom_page_licences, "licences.txt.gz")

namespace mavloom::web {

const std::array<PageFile, 4>& page_files() {
    const auto view = [](const char* from, const char* end) {
        return std::string_view(from, static_cast<std::size_t>(end - from));
    };
    static const std::array<PageFile, 4> files{
        {{"/", "text/html; charset=utf-8", view(mavloom_page_html, mavloom_page_html_end)},
         {"/app.js", "text/javascript; charset=utf-8", view(mavloom_page_js, mavloom_page_js_end)},
         {"/app.css", "text/css; charset=utf-8", view(mavloom_page_css, mavloom_page_css_end)},
         {"/licences.txt", "text/plain; charset=utf-8", view(mavloom_page_licences, mavloom_page_licences_end)}}};
    return files;
}

}  // namespace mavloom::web
