// SPDX-License-Identifier: MIT
#include "mavloom/observe/summarizer.hpp"

#include <algorithm>

#include "observe/summary/summary_parts.hpp"

namespace mavloom::observe {

Summarizer::Summarizer(const dialect::Dialect& dialect, Tracks tracks)
    : parts_(new SummaryParts{.dialect = dialect,
                              .with_tracks = tracks == Tracks::yes,
                              .readers = readers_of(dialect.wire_table().messages())}) {}
Summarizer::Summarizer(Summarizer&&) noexcept = default;
Summarizer::~Summarizer() = default;

void Summarizer::add(const wire::FrameView& frame, const wire::MessageInfo* info, WallTime time) {
    auto& parts = *parts_;
    if (const auto step = parts.clock.set(time)) [[unlikely]] {
        parts.count_entry(parts.jumps.size() < max_entries);
        if (parts.jumps.size() < max_entries) parts.jumps.push_back({parts.clock.now(), *step});
    }
    ++parts.frames;
    parts.bytes += frame.size();
    parts.losses.update(frame, info);
    auto* const sender = parts.find_or_add(frame.source());
    if (sender == nullptr) [[unlikely]] {
        ++parts.unlisted_frames;
        return;
    }
    if (info == nullptr) [[unlikely]] {
        parts.unlisted_frames += sender->count_unknown(frame.id(), frame.size()) ? 0 : 1;
        return;
    }
    const auto place = static_cast<std::size_t>(info - parts.messages.data());
    sender->count(place, frame.size());
    if (const auto reader = parts.readers[place]) read(reader, parts, *sender, frame.payload(), parts.clock.now());
}

Summary Summarizer::summary() const {
    const auto& parts = *parts_;
    Summary all{.begin = parts.clock.first(),
                .duration = parts.clock.longest(),
                .frames = parts.frames,
                .bytes = parts.bytes,
                .clock_jumps = parts.jumps,
                .parameters = parts.parameters.changes(),
                .unlisted_frames = parts.unlisted_frames,
                .unlisted_entries = parts.unlisted_entries};
    if (all.begin) all.end = parts.clock.now().time;
    auto texts = parts.texts;
    const auto losses = parts.losses.sources();
    for (const auto& sender : parts.senders) {
        all.unlisted_entries += texts.add(sender.source(), sender.open_text) ? 0 : 1;
        all.senders.push_back(sender.summary(parts.dialect));
        const auto its = std::ranges::find(losses, sender.source(), &wire::SequenceStats::source);
        if (its != losses.end()) all.senders.back().losses = *its;
    }
    all.texts = texts.texts();
    std::ranges::stable_sort(all.texts, {}, [](const TextSummary& text) { return text.first.at; });
    return all;
}

}  // namespace mavloom::observe
