// SPDX-License-Identifier: MIT
// Listens to sources for `mavloom doctor`, and gathers the evidence: what was heard, and what was counted.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command.hpp"
#include "doctor/port_probe.hpp"
#include "mavloom/feed/receiver.hpp"
#include "mavloom/observe/diagnosis.hpp"
#include "page/hop_reporter.hpp"
#include "progress.hpp"

namespace mavloom::app {

class Listening {
public:
    enum class Asked : std::uint8_t { no, yes };  // by the user

    // `common` and `dialect` must outlive the object.
    [[nodiscard]] static SetupResult<std::unique_ptr<Listening>> create(const Common& common,
                                                                        const dialect::Dialect& dialect,
                                                                        std::vector<HopReporter::Program> programs);
    // A live source that cannot be opened is evidence. Wrong options, and a file that cannot be read, are errors.
    [[nodiscard]] SetupResult<void> add(const endpoint::Endpoint& endpoint, Asked asked);

    // Listens for so long, or reads recordings whole. `stop` ends it early; it is async-signal-safe.
    void run(Nanoseconds time);
    void stop() noexcept { receiver_->stop(); }

    // After `run`:
    [[nodiscard]] observe::Evidence evidence();
    [[nodiscard]] const SetupError* error() const noexcept { return receiver_->error(); }

private:
    // Two sources may hear the same vehicle at different times, so each has its own model.
    struct OfSource {
        OfSource(const endpoint::Endpoint& given, Asked asked, const dialect::Dialect& dialect);
        void examine(const observe::Heard& heard);

        endpoint::Endpoint endpoint;
        observe::Listened listened;
        link::EndpointId id{};  // 0: it could not be opened
        PortProbe probe;
        observe::Inspector inspector;
        observe::SenderStreams streams{};
        observe::AskedRates asked_rates{};
        observe::RadioReports radios{};
        observe::FrameLog log;
        std::optional<WallTime> first{}, latest{};
    };

    Listening(const Common& common, const dialect::Dialect& dialect, std::vector<HopReporter::Program> programs,
              std::unique_ptr<feed::Receiver> receiver)
        : common_(common), dialect_(dialect), programs_(std::move(programs)), receiver_(std::move(receiver)) {}

    struct Instant {
        WallTime wall;
        MonoTime mono;
    };
    Instant examine_some(Instant now);  // returns until when all is examined
    void examine(const record::FrameQueue::Entry& entry, MonoTime now);
    [[nodiscard]] OfSource* source_of(LinkId link);
    void tick(Instant now);
    void show_progress(Progress& progress, MonoTime now, MonoTime end);
    [[nodiscard]] bool is_any_open() const;
    [[nodiscard]] std::vector<observe::Hop> hops() const;
    void add_counts(observe::Evidence& evidence);
    void add_source(observe::Evidence& evidence, OfSource& source, const feed::Receiver::Counts& counts);
    void add_heard(observe::Evidence& evidence, const OfSource& source);
    [[nodiscard]] std::uint64_t frames() const;

    const Common& common_;
    const dialect::Dialect& dialect_;
    const std::vector<HopReporter::Program> programs_;
    const std::unique_ptr<feed::Receiver> receiver_;
    std::vector<std::unique_ptr<OfSource>> sources_;
    bool are_recordings_ = false;

    std::vector<observe::HeardLink> links_;
    LinkId last_link_{};
    OfSource* last_source_ = nullptr;
    std::vector<observe::Hop> hops_before_, hops_settled_;
    Nanoseconds listened_{};
    MonoTime tick_at_{};
    std::uint64_t total_bytes_ = 0;  // of the recordings
};

}  // namespace mavloom::app
