// SPDX-License-Identifier: MIT
#include "lines.hpp"

#include <unistd.h>

#include <cerrno>

#include "signals.hpp"

namespace mavloom::app::shm_parts {

bool Lines::next(std::string& line) {
    for (;;) {
        if (const auto end = text_.find('\n', searched_); end != std::string::npos) return take(line, end, end + 1);
        searched_ = text_.size();
        if (Signals::received()) return false;
        if (text_.size() > longest_) return take(line, text_.size(), text_.size());
        if (!read_more()) return !text_.empty() && !Signals::received() && take(line, text_.size(), text_.size());
    }
}

bool Lines::take(std::string& line, std::size_t end, std::size_t used) {
    line.assign(text_, 0, end);
    text_.erase(0, used);
    searched_ = 0;
    return true;
}

bool Lines::read_more() {
    char chunk[16 << 10];
    const auto got = ::read(STDIN_FILENO, chunk, sizeof chunk);
    if (got > 0) text_.append(chunk, static_cast<std::size_t>(got));
    return got > 0 || (got < 0 && errno == EINTR);
}

static int digit(char c) {
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

bool decode_hex(std::string& line) {
    if (line.size() % 2 != 0) return false;
    for (std::size_t i = 0; i < line.size(); i += 2) {
        const int high = digit(line[i]), low = digit(line[i + 1]);
        if (high < 0 || low < 0) return false;
        line[i / 2] = static_cast<char>(high << 4 | low);
    }
    line.resize(line.size() / 2);
    return true;
}

}  // namespace mavloom::app::shm_parts
