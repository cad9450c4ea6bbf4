// SPDX-License-Identifier: MIT
// Prints the summary of a recording in the forms of `mavloom info`: text, JSON, GPX and KML.
#pragma once

#include <span>
#include <string>

#include "mavloom/dialect/dialect.hpp"
#include "mavloom/observe/summary.hpp"
#include "mavloom/record/tlog_reader.hpp"

namespace mavloom::app {

struct RecordingInfo {
    std::string file;
    std::uint64_t size = 0;  // in bytes
    observe::Summary summary;
    std::uint64_t lost_bytes = 0, damaged_places = 0, unknown_flags = 0;
};

[[nodiscard]] std::string info_text(const RecordingInfo& info, const dialect::Dialect& dialect);
// One JSON object and a newline. docs/guide/info.md lists the keys.
[[nodiscard]] std::string info_json(const RecordingInfo& info, const dialect::Dialect& dialect);

// Tracks for maps: one for each vehicle of each recording.
[[nodiscard]] std::string gpx(std::span<const RecordingInfo> infos, const dialect::Dialect& dialect);
[[nodiscard]] std::string kml(std::span<const RecordingInfo> infos, const dialect::Dialect& dialect);

// "PX4 QUADROTOR", "GCS"
[[nodiscard]] std::string kind_text(const observe::SenderSummary& sender, const dialect::Dialect& dialect);
// "2026-11-14 10:22:31", in UTC.
[[nodiscard]] std::string utc_text(WallTime time);

}  // namespace mavloom::app
