// SPDX-License-Identifier: MIT
#include "page/qr.hpp"

#include <qrencode.h>

#include <cerrno>
#include <cstdlib>
#include <memory>
#include <string_view>

namespace mavloom::app {

namespace {

constexpr int margin = 4;  // modules, as ISO/IEC 18004 wants it
constexpr std::string_view dark_on_light = "\x1b[30;107m", usual_colors = "\x1b[0m";

struct FreeCode {
    void operator()(QRcode* code) const noexcept { QRcode_free(code); }
};
using Code = std::unique_ptr<QRcode, FreeCode>;

// Outside the code, everything is light.
bool is_dark(const QRcode& code, int x, int y) {
    if (x < 0 || y < 0 || x >= code.width || y >= code.width) return false;
    return (code.data[y * code.width + x] & 1) != 0;
}

std::string_view half_block(bool upper, bool lower) {
    if (upper) return lower ? "\u2588" : "\u2580";
    return lower ? "\u2584" : " ";
}

std::string row_of(const QRcode& code, int y, Glyphs glyphs) {
    std::string row;
    for (int x = -margin; x < code.width + margin; ++x) {
        const bool dark = is_dark(code, x, y);
        row += glyphs == Glyphs::half_blocks ? half_block(dark, is_dark(code, x, y + 1)) : dark ? "##" : "  ";
    }
    return row;
}

}  // namespace

Glyphs usual_glyphs() {
    for (const char* const name : {"LC_ALL", "LC_CTYPE", "LANG"}) {
        const char* const value = std::getenv(name);
        if (value == nullptr || *value == '\0') continue;
        const std::string_view locale = value;
        for (const std::string_view utf8 : {"UTF-8", "utf-8", "UTF8", "utf8"})
            if (locale.ends_with(utf8)) return Glyphs::half_blocks;
        return Glyphs::ascii;
    }
    return Glyphs::ascii;
}

SetupResult<std::string> qr_code(const std::string& text, Glyphs glyphs, bool colored) {
    const Code code(QRcode_encodeString8bit(text.c_str(), 0, QR_ECLEVEL_L));
    if (!code) return system_error("cannot make a QR code", errno);
    std::string lines;
    for (int y = -margin; y < code->width + margin; y += glyphs == Glyphs::half_blocks ? 2 : 1) {
        if (colored) lines += dark_on_light;
        lines += row_of(*code, y, glyphs);
        if (colored) lines += usual_colors;
        lines += '\n';
    }
    return lines;
}

}  // namespace mavloom::app
