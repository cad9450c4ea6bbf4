// SPDX-License-Identifier: MIT
#include "observe/text_joiner.hpp"

namespace mavloom::observe {

bool TextJoiner::add(Source source, const msg::Statustext& part) {
    const std::string_view field(part.text.data(), part.text.size());
    const bool continues = part.id_ != 0 && part.chunk_seq != 0 && source == source_ && part.id_ == id_ &&
                           part.chunk_seq == next_chunk_ && text_.size() < max_size;
    if (!continues) text_.clear();
    text_ += field.substr(0, field.find('\0'));
    source_ = source;
    id_ = part.id_;
    next_chunk_ = static_cast<std::uint8_t>(part.chunk_seq + 1);
    return continues;
}

}  // namespace mavloom::observe
