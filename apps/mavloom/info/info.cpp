// SPDX-License-Identifier: MIT
// `mavloom info FILE...`: what happened in recordings.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "command.hpp"
#include "info/reports.hpp"
#include "mavloom/base/shown.hpp"
#include "mavloom/feed/summarize.hpp"
#include "mavloom/record/file.hpp"
#include "output.hpp"
#include "progress.hpp"
#include "signals.hpp"

namespace mavloom::app {

namespace {

using namespace std::chrono_literals;

struct InfoOptions {
    std::vector<std::string> files;
    std::string gpx, kml;  // empty: not given
    bool json = false;

    [[nodiscard]] bool has_tracks() const noexcept { return !gpx.empty() || !kml.empty(); }
};

std::optional<double> part_of(const record::TlogReader& reader) {
    if (reader.size() == 0) return std::nullopt;  // a pipe
    return static_cast<double>(reader.position()) / static_cast<double>(reader.size());
}

class InfoReader {
public:
    InfoReader(const Common& common, const dialect::Dialect& dialect, bool with_tracks)
        : dialect_(dialect), progress_(common), with_tracks_(with_tracks) {}

    // If a signal ends the reading, the error has no text.
    SetupResult<RecordingInfo> read(const std::string& file) {
        auto reader = record::TlogReader::open(file, dialect_.wire_table(), record::File::Empty::report);
        if (!reader) return tl::unexpected(std::move(reader.error()));
        using Tracks = observe::Summarizer::Tracks;
        observe::Summarizer summarizer(dialect_, with_tracks_ ? Tracks::yes : Tracks::no);
        progress_.restart();
        const auto done = read_all(*reader, summarizer);
        progress_.clear();
        if (!done) return tl::unexpected(done.error());
        const auto& counters = reader->counters();
        return RecordingInfo{.file = file,
                             .size = reader->position(),
                             .summary = summarizer.summary(),
                             .lost_bytes = counters.lost_bytes.value(),
                             .damaged_places = counters.damaged_places.value(),
                             .unknown_flags = counters.unknown_flags.value()};
    }

private:
    SetupResult<void> read_all(record::TlogReader& reader, observe::Summarizer& summarizer) {
        constexpr std::uint64_t piece = 1 << 20;
        while (!Signals::received()) {
            const auto done = feed::summarize(reader, summarizer, piece);
            if (!done) return tl::unexpected(done.error());
            if (*done == feed::Summarized::all) return {};
            if (*done == feed::Summarized::nothing_yet) static_cast<void>(reader.wait(100ms));
            if (progress_.is_due()) progress_.show({.bytes = reader.position(), .part = part_of(reader)});
        }
        return setup_error(SetupCode::system, "");
    }

    const dialect::Dialect& dialect_;
    Progress progress_;
    const bool with_tracks_;
};

SetupResult<void> refuse_existing(const std::string& file) {
    std::error_code none;
    if (file.empty() || !std::filesystem::exists(std::filesystem::symlink_status(file, none))) return {};
    return setup_error(SetupCode::usage, fmt::format("{} already exists; choose another name", in_quotes(file)));
}

SetupResult<void> write_file(const std::string& path, std::string_view text) {
    auto file = record::File::create(path);
    if (!file) return tl::unexpected(std::move(file.error()));
    const ByteView bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    if (const auto written = file->write(bytes); written.error != 0) return file->failed("cannot write", written.error);
    return file->sync_and_close();
}

Exit write_tracks(const Common& common, const InfoOptions& options, std::span<const RecordingInfo> infos,
                  const dialect::Dialect& dialect) {
    if (!options.has_tracks()) return Exit::done;
    const bool is_empty = std::ranges::all_of(infos, [](const RecordingInfo& info) {
        return std::ranges::all_of(info.summary.senders, [](const auto& one) { return one.journey.track.empty(); });
    });
    if (is_empty) return fail(Exit::bad_input, "no vehicle reports its position, so there is no track to write");
    if (!options.gpx.empty())
        if (const auto done = write_file(options.gpx, gpx(infos, dialect)); !done) return fail(done.error());
    if (!options.kml.empty())
        if (const auto done = write_file(options.kml, kml(infos, dialect)); !done) return fail(done.error());
    if (!options.gpx.empty()) print_notice(common, fmt::format("wrote {}", options.gpx));
    if (!options.kml.empty()) print_notice(common, fmt::format("wrote {}", options.kml));
    return Exit::done;
}

Exit info(const Common& common, const InfoOptions& options) {
    const auto dialect = load_dialect(common);
    if (!dialect) return fail(dialect.error());
    for (const auto& file : {options.gpx, options.kml})
        if (const auto checked = refuse_existing(file); !checked) return fail(checked.error());
    const Signals signals([](void*) noexcept {}, nullptr);
    InfoReader reader(common, *dialect, options.has_tracks());
    Output output;
    std::vector<RecordingInfo> infos;
    auto status = Exit::done;
    for (const auto& file : options.files) {
        auto one = reader.read(file);
        if (Signals::received()) return Signals::status(Exit::failed);
        if (!one) {
            status = fail(of_input_file(std::move(one.error())));
            continue;
        }
        if (one->summary.frames == 0) print_notice(common, fmt::format("{} holds no frames", file));
        if (!options.json && !infos.empty()) output.buffer().push_back('\n');
        output.buffer().append(options.json ? info_json(*one, *dialect) : info_text(*one, *dialect));
        if (output.flush() == Output::State::failed) return fail(output.error());
        infos.push_back(std::move(*one));
    }
    const auto written = infos.empty() ? status : write_tracks(common, options, infos, *dialect);
    return status == Exit::done ? written : status;
}

}  // namespace

Run declare_info(Arguments command, const Common& common) {
    auto options = std::make_shared<InfoOptions>();
    command.add_option("file", "FILE", options->files, "recordings (.tlog)").required();
    command.add_option("--gpx", "FILE", options->gpx, "write the tracks of the vehicles as GPX, for maps");
    command.add_option("--kml", "FILE", options->kml, "write the tracks of the vehicles as KML, for Google Earth");
    command.add_flag("--json", options->json, "print one JSON object per line, one for each recording");
    command.footer(
        "Prints when a recording was made, its vehicles with their modes, armed times, highest altitude and speed,\n"
        "distance and battery, warnings, parameters that changed, losses by sender, and messages with their rates.\n"
        "docs/guide/info.md explains the values.\n\n"
        "Examples:\n"
        "  mavloom info flight.tlog\n"
        "  mavloom info flight.tlog --gpx flight.gpx\n\n"
        "Exit status: 0 even if frames were lost or bytes are damaged, 3 if a file cannot be read or is no recording.");
    return [options, &common] { return info(common, *options); };
}

}  // namespace mavloom::app
