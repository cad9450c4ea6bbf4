// SPDX-License-Identifier: MIT
// Byte helpers that tests of all modules share.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/base/bytes.hpp"

namespace mavloom::test {

using Bytes = std::vector<std::uint8_t>;

inline Bytes hex(std::string_view digits) {
    if (digits.size() % 2 != 0) throw std::invalid_argument("odd number of hexadecimal digits");
    Bytes bytes;
    for (std::size_t i = 0; i < digits.size(); i += 2)
        bytes.push_back(static_cast<std::uint8_t>(std::stoi(std::string(digits.substr(i, 2)), nullptr, 16)));
    return bytes;
}

inline Bytes join(std::initializer_list<Bytes> parts) {
    Bytes all;
    for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

inline Bytes copy(ByteView view) { return {view.begin(), view.end()}; }

}  // namespace mavloom::test
