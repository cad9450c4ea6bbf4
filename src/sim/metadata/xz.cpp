// SPDX-License-Identifier: MIT
#include "sim/metadata/xz.hpp"

#include <lzma.h>

#include <array>

namespace mavloom::sim {

namespace {

// A preset's dictionary would take 90 MB of memory for files of 100 kB. Presets above 3 take ten times as long and save
// little on files of this size.
constexpr std::uint32_t dictionary = 256 * 1024;
constexpr std::uint32_t preset = 2;

}  // namespace

std::vector<std::uint8_t> compress_xz(std::string_view text) {
    lzma_options_lzma options;
    if (lzma_lzma_preset(&options, preset) != 0) return {};
    options.dict_size = dictionary;
    std::array<lzma_filter, 2> filters{{{LZMA_FILTER_LZMA2, &options}, {LZMA_VLI_UNKNOWN, nullptr}}};
    std::vector<std::uint8_t> out(lzma_stream_buffer_bound(text.size()));
    std::size_t size = 0;
    const auto status = lzma_stream_buffer_encode(filters.data(), LZMA_CHECK_CRC64, nullptr,
                                                  reinterpret_cast<const std::uint8_t*>(text.data()), text.size(),
                                                  out.data(), &size, out.size());
    out.resize(status == LZMA_OK ? size : 0);
    out.shrink_to_fit();
    return out;
}

}  // namespace mavloom::sim
