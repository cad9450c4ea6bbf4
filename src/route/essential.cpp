// SPDX-License-Identifier: MIT
#include "mavloom/route/essential.hpp"

#include <algorithm>
#include <iterator>

namespace mavloom::route {

// Ids are MAVLink's, rising; docs/guide/queues.md names them.
static constexpr std::uint32_t essential_ids[] = {
    0,                          // HEARTBEAT
    5,     6,   7,              // CHANGE_OPERATOR_CONTROL and its ack, AUTH_KEY
    11,                         // SET_MODE
    20,    21,  22,  23,        // PARAM_REQUEST_READ, PARAM_REQUEST_LIST, PARAM_VALUE, PARAM_SET
    37,    38,  39,  40,  41,   // MISSION_REQUEST_PARTIAL_LIST, _WRITE_PARTIAL_LIST, _ITEM, _REQUEST, _SET_CURRENT
    43,    44,  45,  46,  47,   // MISSION_REQUEST_LIST, _COUNT, _CLEAR_ALL, _ITEM_REACHED, _ACK
    50,    51,  53,             // PARAM_MAP_RC, MISSION_REQUEST_INT, MISSION_CHECKSUM
    73,    75,  76,  77,  80,   // MISSION_ITEM_INT, COMMAND_INT, COMMAND_LONG, COMMAND_ACK, COMMAND_CANCEL
    253,                        // STATUSTEXT
    320,   321, 322, 323, 324,  // PARAM_EXT_REQUEST_READ, _REQUEST_LIST, _VALUE, _SET, _ACK
    60041,                      // PARAM_VALUE_ARRAY
};
static_assert(std::is_sorted(std::begin(essential_ids), std::end(essential_ids)));

bool is_essential(MessageId id) noexcept {
    return std::binary_search(std::begin(essential_ids), std::end(essential_ids), id.value);
}

}  // namespace mavloom::route
