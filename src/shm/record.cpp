// SPDX-License-Identifier: MIT
#include "mavloom/shm/record.hpp"

namespace mavloom::shm {

std::string_view to_text(WriteError error) noexcept {
    switch (error) {
        case WriteError::too_long: return "the record is too long for the ring";
        case WriteError::full: return "readers keep the ring full";
        case WriteError::removed: return "the ring was removed";
        case WriteError::forked: return "the ring was opened before fork()";
    }
    return "unknown error";
}

std::string_view to_text(ReadError error) noexcept {
    switch (error) {
        case ReadError::empty: return "no record arrived";
        case ReadError::no_writer: return "the ring has no writer";
        case ReadError::retired: return "the ring was removed";
        case ReadError::damaged: return "the ring is damaged";
        case ReadError::forked: return "the ring was opened before fork()";
    }
    return "unknown error";
}

std::string_view to_text(WhenFull policy) noexcept {
    switch (policy) {
        case WhenFull::wait: return "wait";
        case WhenFull::drop_newest: return "drop_newest";
        case WhenFull::evict: return "evict";
    }
    return "unknown";
}

}  // namespace mavloom::shm
