// SPDX-License-Identifier: MIT
// Finds the rings, routers and simulators of this machine, as far as the user may read them.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "command.hpp"
#include "mavloom/shm/ring_info.hpp"
#include "page/hop_reporter.hpp"

namespace mavloom::app {

struct Running {
    std::vector<shm::RingStatus> rings;     // that a program writes to
    std::vector<std::string> without_ring;  // routers and simulators
    std::string port_taken;                 // which program has the usual port; empty: none, or there are rings
};

[[nodiscard]] Running find_running();

// Returns how to see all messages of a program without a ring. `port`: a source on which it may be heard; empty:
// there is none.
[[nodiscard]] std::string ring_hint(const std::string& program, std::string_view port);

// The serial devices of this machine, by the names that stay the same when it restarts: /dev/serial/by-id/... where
// there are some, else /dev/ttyACM0 and the like.
[[nodiscard]] std::vector<std::string> serial_ports();
// How to read them, for people. Empty: there is none.
[[nodiscard]] std::string serial_hint();

// One line for each: "found the ring px4 of process 4711". `port`: a source on which frames are heard; empty: there is
// none.
[[nodiscard]] std::vector<std::string> lines_of(const Running& running, std::string_view port);

// Where vehicles send to ground stations; and PX4 to companion computers.
inline constexpr std::string_view usual_source = "udpin://0.0.0.0:14550", second_source = "udpin://0.0.0.0:14540";

// Without sources: the rings of this machine; without rings, those of the `usual` ports that are free. A ground station
// often has the first one. If programs without a ring run, whose counters are shown in any case, all may be taken.
[[nodiscard]] SetupResult<Running> find_sources(const Common& common, std::vector<std::string>& sources,
                                                std::initializer_list<std::string_view> usual);
// The error names the program, such as a ground station, that has the port of a udpin source.
[[nodiscard]] SetupResult<void> check_port(std::string_view source);

// Returns the programs whose counters are shown: the writers of the rings, and the programs without a ring.
[[nodiscard]] std::vector<HopReporter::Program> programs_of(const std::vector<std::string>& sources,
                                                            const Running& running);

}  // namespace mavloom::app
