// SPDX-License-Identifier: MIT
// Reads the input of `shm write`: lines of text or of hexadecimal digits from standard input.
#pragma once

#include <cstddef>
#include <string>

namespace mavloom::app::shm_parts {

// Reads standard input line by line, until its end or a signal.
class Lines {
public:
    explicit Lines(std::size_t longest) : longest_(longest) {}
    [[nodiscard]] std::size_t longest() const noexcept { return longest_; }
    // Sets `line` to the next line without its newline. Returns false if there are no more. If a line is longer than
    // `longest`, sets `line` to the part that was read so far.
    [[nodiscard]] bool next(std::string& line);
    // Whether the input read so far holds another whole line.
    [[nodiscard]] bool has_more() const noexcept { return text_.find('\n') != std::string::npos; }

private:
    bool take(std::string& line, std::size_t end, std::size_t used);
    bool read_more();

    std::size_t longest_;
    std::string text_;
    std::size_t searched_ = 0;
};

// Decodes pairs of hexadecimal digits in place. Returns false if the line contains anything else.
[[nodiscard]] bool decode_hex(std::string& line);

}  // namespace mavloom::app::shm_parts
