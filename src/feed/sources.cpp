// SPDX-License-Identifier: MIT
#include "mavloom/feed/sources.hpp"

#include <algorithm>
#include <filesystem>

#include "mavloom/fault/faults.hpp"
#include "mavloom/record/tlog_index.hpp"
#include "mavloom/ring/sources.hpp"

namespace mavloom::feed {

// How often to check an empty pipe for data.
static constexpr std::chrono::milliseconds pipe_poll_interval{5};
// How many bytes of damage to read before checking signals, deadlines and live links again.
static constexpr std::uint64_t damage_a_turn = 256u << 10;
// A drain ends at the first of these limits:
// - last_empty_turns turns in a row without a frame. There are several, because a turn of junk has no frame either.
// - last_late_turns turns in a row without a frame that arrived before the drain began. That many turns read 8 MiB of a
//   stream, at 128 KiB per turn.
// - max_drain_turns turns in all. That many turns empty a receive buffer of 64 MiB, at 64 datagrams of 768 bytes each.
// The first turns wait, because the system may still be delivering what was sent.
static constexpr int last_empty_turns = 16, last_late_turns = 64, max_drain_turns = 1400;
static constexpr std::chrono::milliseconds empty_turn{1};
// How many turns lossless rings wait while the caller has no room: a few hundred milliseconds, for a busy disk.
static constexpr int max_full_turns = 300;

SetupResult<Sources> Sources::create(const dialect::Dialect& dialect, Copies copies) {
    auto links = link::Links::create(dialect);
    if (!links) return tl::unexpected(std::move(links.error()));
    return Sources(std::move(*links), dialect.wire_table(), copies);
}

Sources::Sources(std::unique_ptr<link::Links> links, const wire::MessageTable& table, Copies copies)
    : links_(std::move(links)), table_(&table), rings_(std::make_unique<ring::RingSources>(*links_, table, copies)) {}
Sources::Sources(Sources&&) noexcept = default;
Sources::~Sources() = default;

namespace {

// Builds the index with a second reader, so that `reader` counts damage only once.
SetupResult<void> skip_ahead(record::TlogReader& reader, const std::string& path, const wire::MessageTable& table,
                             Nanoseconds skip) {
    auto scan = record::TlogReader::open(path, table);
    if (!scan) return tl::unexpected(std::move(scan.error()));
    const auto index = record::TlogIndex::build(*scan);
    if (!index) return tl::unexpected(index.error());
    return index->seek(reader, index->earliest().value_or(WallTime{}) + skip);
}

SetupError no_record(const std::string& name) {
    return {SetupCode::bad_input, 0, name + " holds no record: is it a .tlog?"};
}

// False for a pipe or device, because reading consumes its data.
bool may_be_read_twice(const std::string& path) {
    std::error_code unknown;
    const auto type = std::filesystem::status(path, unknown).type();
    return type == std::filesystem::file_type::regular || type == std::filesystem::file_type::not_found;
}

}  // namespace

SetupResult<void> Sources::check(const endpoint::Endpoint& endpoint) const {
    if (auto checked = endpoint::check_source_options(endpoint); !checked) return checked;
    if (!endpoint.is_recording()) return endpoint::check_supported(endpoint, endpoint::RoutingOptions::refused);
    if (!may_be_read_twice(endpoint.path)) return {};
    auto reader = record::TlogReader::open(endpoint.path, *table_);
    if (!reader) {
        reader.error().code = SetupCode::bad_input;
        return tl::unexpected(std::move(reader.error()));
    }
    if (!reader->next() && reader->counters().lost_bytes.value() != 0)
        return tl::unexpected(no_record(endpoint.label()));
    return {};
}

SetupResult<link::EndpointId> Sources::add(const endpoint::Endpoint& endpoint, MonoTime now, double default_speed,
                                           Nanoseconds skip) {
    if (auto checked = check(endpoint); !checked) return tl::unexpected(std::move(checked.error()));
    if (!endpoint.is_recording()) return add_live(endpoint);
    auto reader = record::TlogReader::open(endpoint.path, *table_, record::File::Empty::report);
    if (!reader) {
        reader.error().code = SetupCode::bad_input;  // an input file: exit status 3, whether missing or unreadable
        return tl::unexpected(std::move(reader.error()));
    }
    if (skip != Nanoseconds{} && !reader->is_file())
        return setup_error(SetupCode::usage, endpoint.label() + " is a pipe: it can only be read from its start");
    if (skip != Nanoseconds{})
        if (auto skipped = skip_ahead(*reader, endpoint.path, *table_, skip); !skipped)
            return tl::unexpected(std::move(skipped.error()));
    const auto link = links_->take_link_id();
    const auto id = links_->take_endpoint_id();
    const double speed = endpoint.options.speed.value_or(default_speed);
    record::Pacer pacer(speed, now);
    const MonoTime due = pacer.waits() ? now : MonoTime{};
    recordings_.push_back(
        std::unique_ptr<Recording>(new Recording{link, id, endpoint.label(), std::move(*reader), pacer, {}, {}, due}));
    return id;
}

SetupResult<link::EndpointId> Sources::add_live(const endpoint::Endpoint& endpoint, const dialect::Dialect* dialect) {
    if (endpoint.is_ring()) return rings_->add(endpoint, dialect);
    auto added = fault::add(*links_, endpoint, dialect);
    if (added) live_.push_back(*added);
    return added;
}

void Sources::remove(link::EndpointId live) {
    rings_->remove(live);
    if (std::erase(live_, live) != 0) links_->remove(live);
}

void Sources::hold_ring(link::EndpointId ring, bool held) noexcept { rings_->find(ring)->hold(held); }
SetupResult<link::EndpointId> Sources::inlet(link::EndpointId ring) { return rings_->find(ring)->inlet(); }
const link::LinkCounters& Sources::ring_counters(link::EndpointId ring) const noexcept {
    return rings_->find(ring)->counters();
}
void Sources::add_ring_to(link::EndpointId ring, Totals& totals) const noexcept { totals.add(*rings_->find(ring)); }

std::vector<Sources::SourceLoss> Sources::losses(link::EndpointId endpoint) const {
    std::vector<SourceLoss> losses;
    const auto take = [&](LinkId link, std::span<const wire::SequenceStats> sources) {
        for (const auto& source : sources) losses.push_back({link, source});
    };
    for (const auto& link : links_->links())
        if (link.endpoint == endpoint) take(link.id, links_->sources(link.id));
    if (const auto* ring = rings_->find(endpoint)) ring->each_link(take);
    return losses;
}

std::span<const wire::SequenceStats> Sources::ring_losses(link::EndpointId ring, const std::string& name) const {
    return rings_->find(ring)->losses(name);
}

bool Sources::advance(Recording& recording, link::LinkHandler& handler) {
    const auto record = recording.reader.next(damage_a_turn);
    using Stop = record::TlogReader::Stop;
    if (!record && record.error() == Stop::damage) {
        recording.next.reset();
        if (recording.pacer.waits()) recording.due = mono_now();  // lets the other recordings go first
        return false;
    }
    if (!record && record.error() == Stop::nothing_yet) {
        recording.next.reset();
        recording.due = mono_now() + pipe_poll_interval;
        return true;
    }
    if (!record) {
        recording.ended = true;
        const auto& counters = recording.reader.counters();
        if (record.error() == Stop::failed) {
            recording.error = recording.reader.error();
        } else if (counters.records.value() == 0 && counters.lost_bytes.value() != 0) {
            recording.error = no_record(recording.name);
        } else if (counters.records.value() == 0) {
            handler.on_notice(recording.endpoint, recording.name + " holds no frames");
        }
        return true;
    }
    recording.next = *record;
    // Recordings without pacing are always due; earliest() then orders them by the times of their records.
    if (recording.pacer.waits()) recording.due = recording.pacer.due(record->time);
    else recording.due = MonoTime{};
    return true;
}

// Delivers the records that are due, earliest first, across all recordings.
std::size_t Sources::play(link::LinkHandler& handler, std::size_t max_frames) {
    const MonoTime now = mono_now();
    std::size_t played = 0;
    for (; played < max_frames; ++played) {
        Recording* const first = earliest();
        if (first == nullptr || first->due > now) break;
        if (!first->next) {  // nothing read yet: at the start, after damage or after an empty pipe
            if (!advance(*first, handler)) break;
            continue;
        }
        const auto& record = *first->next;
        const auto& update = first->sequence.update(record.frame, record.info);
        handler.on_frame({record.frame, record.info, first->link, first->endpoint, record.time, &update});
        if (!advance(*first, handler)) return played + 1;
    }
    return played;
}

Sources::Recording* Sources::earliest() noexcept {
    Recording* first = nullptr;
    for (const auto& recording : recordings_) {
        if (recording->ended) continue;
        // A recording whose next record has not been read yet goes first, because that record may be the earliest.
        const bool sooner = first == nullptr || recording->due < first->due ||
                            (recording->due == first->due && first->next &&
                             (!recording->next || recording->next->time < first->next->time));
        if (sooner) first = recording.get();
    }
    return first;
}

std::size_t Sources::turn(link::LinkHandler& handler, MonoTime deadline, Room room) {
    if (const auto* first = earliest(); first != nullptr && room.recordings != 0)
        deadline = std::min(deadline, first->due);
    deadline = std::min(deadline, rings_->due(room));
    const std::size_t frames = links_->turn(handler, deadline);
    const std::size_t of_rings = rings_->play(handler, room);
    return frames + of_rings + play(handler, room.recordings);
}

namespace {

// Notes whether a frame arrived at or before `moment`. A frame from a stream has the time at which it was read.
class EarlyFrames final : public link::LinkHandler {
public:
    EarlyFrames(link::LinkHandler& handler, WallTime moment) : handler_(handler), moment_(moment) {}
    [[nodiscard]] bool take() noexcept { return std::exchange(early_, false); }

private:
    void on_frame(const link::RxFrame& rx) override {
        early_ = early_ || rx.time <= moment_;
        handler_.on_frame(rx);
    }
    void on_link_up(LinkId link, link::EndpointId endpoint, std::string_view name) override {
        handler_.on_link_up(link, endpoint, name);
    }
    void on_link_down(LinkId link, link::EndpointId endpoint, std::string_view why) override {
        handler_.on_link_down(link, endpoint, why);
    }
    void on_notice(link::EndpointId endpoint, std::string_view text) override { handler_.on_notice(endpoint, text); }
    void on_bad_checksum(LinkId link, link::EndpointId endpoint, MessageId id) override {
        handler_.on_bad_checksum(link, endpoint, id);
    }

    link::LinkHandler& handler_;
    WallTime moment_;
    bool early_ = false;
};

}  // namespace

// Limits turns, not time: on a busy machine, much time may pass before the first turn.
void Sources::drain(link::LinkHandler& handler, const std::function<Room()>& room) {
    rings_->stop_at_current_end();
    links_->read_all();
    EarlyFrames early(handler, wall_now());
    int empty_turns = 0, late_turns = 0;
    for (int turns = 0; turns < max_drain_turns && empty_turns < last_empty_turns && late_turns < last_late_turns;
         ++turns) {
        const Room now = room();
        const bool is_full = now.lossless == 0 && turns < max_full_turns && !rings_->empty();
        const MonoTime until = turns < last_empty_turns || is_full ? mono_now() + empty_turn : MonoTime{};
        const bool is_empty = turn(early, until, {0, now.lossless, now.lossy}) == 0 && !is_full;
        empty_turns = is_empty ? empty_turns + 1 : 0;
        late_turns = early.take() || !rings_->at_end() ? 0 : late_turns + 1;
    }
    room();
}

std::size_t Sources::send(const wire::FrameView& frame) {
    std::size_t takers = 0;
    for (const auto id : live_) takers += links_->send(id, frame);
    return takers + rings_->send(frame);
}

void Sources::add_to(Totals& totals) {
    links_->refresh_counters();
    for (const auto& link : links_->links()) totals.add(*link.counters);
    for (const auto& endpoint : links_->endpoints()) totals.add(*endpoint.counters);
    for (const auto& ring : rings_->rings()) totals.add(*ring);
    for (const auto& recording : recordings_) totals.add(recording->reader.counters());
}

std::uint64_t Sources::lost_before_rings() const noexcept {
    std::uint64_t lost = 0;
    for (const auto& ring : rings_->rings()) lost += ring->counters().lost.value();
    return lost;
}

std::span<const std::unique_ptr<ring::RingSource>> Sources::rings() const noexcept { return rings_->rings(); }

bool Sources::are_recordings() const noexcept { return live_.empty() && rings_->empty(); }

bool Sources::finished() const noexcept { return are_recordings() && finished_recordings(); }

bool Sources::finished_recordings() const noexcept {
    return std::ranges::all_of(recordings_, [](const auto& r) { return r->ended; });
}

const SetupError* Sources::error() const noexcept {
    for (const auto& recording : recordings_)
        if (recording->error) return &*recording->error;
    return nullptr;
}

}  // namespace mavloom::feed
