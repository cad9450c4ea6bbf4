// SPDX-License-Identifier: MIT
// Frames made by pymavlink 2.4.50 (dialect common, stock wheel), sources and sequence numbers as named. tools:
// pymavlink's MAVLink_*_message.pack().
#pragma once

#include <array>

#include "bytes.hpp"
#include "mavloom/wire/message_table.hpp"

namespace mavloom::test {

// HEARTBEAT type=2 autopilot=12 base_mode=81 custom_mode=33816576 system_status=4 mavlink_version=3, seq 7, 1/1.
inline const Bytes heartbeat_v2 = hex("fd09000007010100000000000402020c5104033de7");
inline const Bytes heartbeat_v1 = hex("fe090701010000000402020c51040363e6");
// The same with key 00 01 02 … 1f, link id 5, time 1 and time 0x123456789abc.
inline const Bytes heartbeat_signed_1 = hex("fd09010007010100000000000402020c510403da1f05010000000000a6b835e13d07");
inline const Bytes heartbeat_signed_late = hex("fd09010007010100000000000402020c510403da1f05bc9a785634124a7aea33a789");
// ATTITUDE time_boot_ms=123456 roll=0.1 pitch=-0.2 yaw=3.0 rates 0, seq 200: MAVLink 2 drops the zeros, MAVLink 1 keeps
// them.
inline const Bytes attitude_v2 = hex("fd100000c801011e000040e20100cdcccc3dcdcc4cbe00004040e6f4");
inline const Bytes attitude_v1 = hex("fe1cc801011e40e20100cdcccc3dcdcc4cbe0000404000000000000000000000000096c5");
// PING with all fields 0, seq 0: one payload byte stays.
inline const Bytes ping_zero_v2 = hex("fd01000000010104000000bf2f");
// COMMAND_ACK 400 accepted, result_param2=50, to 255/190, seq 255.
inline const Bytes command_ack_v2 = hex("fd0a0000ff01014d00009001003200000000ffbe7738");
// TUNNEL (id 385) with 128 bytes 00…7f, payload_type 3, length 4, to 1/2, seq 9.
inline const Bytes tunnel_v2 = hex(
    "fd8500000901018101000300010204000102030405060708090a0b0c0d0e0f101112131415161718191a1b1c1d1e1f2021222324252627"
    "28292a2b2c2d2e2f303132333435363738393a3b3c3d3e3f404142434445464748494a4b4c4d4e4f505152535455565758595a5b5c5d5e5f60"
    "6162"
    "636465666768696a6b6c6d6e6f707172737475767778797a7b7c7d7e7f1566");

// Their definitions: ids, CRC_EXTRA and lengths as pymavlink has them.
inline const std::array golden_messages{
    wire::MessageInfo{MessageId{0}, 50, 9, 9},
    wire::MessageInfo{MessageId{4}, 237, 14, 14, 12, 13},
    wire::MessageInfo{MessageId{30}, 39, 28, 28},
    wire::MessageInfo{MessageId{77}, 143, 3, 10, 8, 9},
    wire::MessageInfo{MessageId{385}, 147, 133, 133, 2, 3},
};

}  // namespace mavloom::test
