// SPDX-License-Identifier: MIT
// Sources: GPX 1.1 (topografix.com/GPX/1/1), KML 2.2 (OGC 07-147r2). Names consist of numbers, letters and '_', so
// nothing needs to be escaped.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "info/reports.hpp"
#include "mavloom/base/version.hpp"

namespace mavloom::app {

namespace {

using Points = std::span<const observe::TrackPoint>;

// Calls take(name, points) for the track of each vehicle.
template <class Take>
void each_track(std::span<const RecordingInfo> infos, const dialect::Dialect& dialect, Take&& take) {
    for (const auto& info : infos)
        for (const auto& sender : info.summary.senders) {
            const Points points = sender.journey.track;
            if (points.empty()) continue;
            take(fmt::format("{}/{} {} {} UTC", sender.source.system.value, sender.source.component.value,
                             kind_text(sender, dialect), utc_text(points.front().time)),
                 points);
        }
}

// Calls take(points) for each piece of a track.
template <class Take>
void each_piece(Points points, Take&& take) {
    while (!points.empty()) {
        const auto next = std::ranges::find(points.subspan(1), true, &observe::TrackPoint::begins);
        const auto size = static_cast<std::size_t>(next - points.subspan(1).begin()) + 1;
        take(points.first(size));
        points = points.subspan(size);
    }
}

// degE7 or mm as a decimal number, exactly.
std::string decimal(std::int32_t value, int digits) {
    return fmt::format("{:.{}f}", value / (digits == 7 ? 1e7 : 1e3), digits);
}

std::string gpx_time(WallTime time) {
    auto text = utc_text(time);
    text[text.find(' ')] = 'T';
    return fmt::format("{}.{:03}Z", text, (unix_us(time) / 1000 % 1000 + 1000) % 1000);
}

void append_gpx_points(std::string& out, Points points) {
    out += "<trkseg>\n";
    for (const auto& point : points)
        fmt::format_to(std::back_inserter(out), "<trkpt lat=\"{}\" lon=\"{}\"><ele>{}</ele><time>{}</time></trkpt>\n",
                       decimal(point.lat_deg_e7, 7), decimal(point.lon_deg_e7, 7), decimal(point.alt_mm, 3),
                       gpx_time(point.time));
    out += "</trkseg>\n";
}

// A line has at least two points.
void append_kml_points(std::string& out, Points points) {
    const auto* const shape = points.size() == 1 ? "Point" : "LineString";
    fmt::format_to(std::back_inserter(out), "<{}><altitudeMode>absolute</altitudeMode><coordinates>\n", shape);
    for (const auto& point : points)
        fmt::format_to(std::back_inserter(out), "{},{},{}\n", decimal(point.lon_deg_e7, 7),
                       decimal(point.lat_deg_e7, 7), decimal(point.alt_mm, 3));
    fmt::format_to(std::back_inserter(out), "</coordinates></{}>\n", shape);
}

}  // namespace

std::string gpx(std::span<const RecordingInfo> infos, const dialect::Dialect& dialect) {
    auto out = fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<gpx version=\"1.1\" creator=\"mavloom {}\" xmlns=\"http://www.topografix.com/GPX/1/1\">\n",
        version());
    each_track(infos, dialect, [&](const std::string& name, Points points) {
        out += fmt::format("<trk><name>{}</name>\n", name);
        each_piece(points, [&](Points piece) { append_gpx_points(out, piece); });
        out += "</trk>\n";
    });
    return out + "</gpx>\n";
}

std::string kml(std::span<const RecordingInfo> infos, const dialect::Dialect& dialect) {
    std::string out =
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<kml xmlns=\"http://www.opengis.net/kml/2.2\"><Document>\n";
    each_track(infos, dialect, [&](const std::string& name, Points points) {
        out += fmt::format("<Placemark><name>{}</name><MultiGeometry>\n", name);
        each_piece(points, [&](Points piece) { append_kml_points(out, piece); });
        out += "</MultiGeometry></Placemark>\n";
    });
    return out + "</Document></kml>\n";
}

}  // namespace mavloom::app
