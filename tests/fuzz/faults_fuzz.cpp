// SPDX-License-Identifier: MIT
// Any bytes as a specification of faults: no crash; a refusal has a message without control characters. Faults that are
// accepted get pieces of the bytes themselves, in both directions of a stream: the counters account for each piece.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string_view>
#include <vector>

#include "mavloom/dialect/dialect.hpp"
#include "mavloom/fault/faults.hpp"

namespace {

using namespace mavloom;

using Chain = std::vector<std::unique_ptr<link::Stage>>;

// The pieces that reached one place of a chain.
struct Arrived {
    std::uint64_t pieces = 0, bytes = 0;
};

// Passes pieces at once, whenever they are due, and counts them where they arrive: before each stage, and at the end.
class Passing final : public link::Next {
public:
    Passing(Chain& chain, std::size_t place, MonoTime now, std::vector<Arrived>& arrived)
        : chain_(chain), place_(place), now_(now), arrived_(arrived) {}
    void pass(const link::Piece& piece) noexcept override { pass_at(piece, now_); }
    void pass_at(const link::Piece& piece, MonoTime when) noexcept override {
        if (piece.bytes.empty() || when < MonoTime{}) std::abort();
        ++arrived_[place_].pieces;
        arrived_[place_].bytes += piece.bytes.size();
        if (place_ == chain_.size()) return;
        Passing next(chain_, place_ + 1, std::max(now_, when), arrived_);
        chain_[place_]->take(piece, next.now_, next);
    }

private:
    Chain& chain_;
    std::size_t place_;
    MonoTime now_;
    std::vector<Arrived>& arrived_;
};

std::uint64_t dropped(const link::LinkCounters& counters) {
    return counters.fault_blackout.value() + counters.fault_lost.value() + counters.fault_queue.value();
}

struct Link {
    explicit Link(const fault::Plan& plan)
        : stages(fault::stages_of(plan, "fuzz",
                                  {LinkId{1}, "fuzz", true, 0, counters, dialect::default_dialect().wire_table()})) {}

    link::LinkCounters counters;
    link::Stages stages;
};

// Sends beginnings of `bytes` through `chain`, 10 ms apart, and returns what arrived at each place.
std::vector<Arrived> send(Chain& chain, ByteView bytes) {
    std::vector<Arrived> arrived(chain.size() + 1);
    MonoTime now{std::chrono::hours(1)};
    for (std::size_t i = 0; i < 200; ++i, now += std::chrono::milliseconds(10))
        Passing(chain, 0, now, arrived).pass({.bytes = bytes.first(1 + i % bytes.size())});
    if (chain.empty()) return arrived;
    Passing rest(chain, 1, now, arrived);
    chain.front()->finish({}, rest);
    return arrived;
}

void check_outward(const endpoint::Faults& faults, ByteView bytes) {
    fault::Plan plan;
    plan.out = faults;
    Link link(plan);
    const auto arrived = send(link.stages.out, bytes);
    const auto copies = link.counters.fault_duplicated.value();
    if (arrived.back().pieces + dropped(link.counters) != arrived.front().pieces + copies) std::abort();
}

// The first stage cuts what arrives on a stream into frames: no byte is missing behind it, and none is there twice.
void check_inward(const endpoint::Faults& faults, ByteView bytes) {
    fault::Plan plan;
    plan.in = faults;
    Link link(plan);
    const auto arrived = send(link.stages.in, bytes);
    if (link.stages.in.empty()) return;
    if (arrived[1].bytes != arrived[0].bytes) std::abort();
    const auto copies = link.counters.fault_duplicated.value();
    if (arrived.back().pieces + dropped(link.counters) != arrived[1].pieces + copies) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto faults = mavloom::endpoint::parse_faults(text);
    if (faults) {
        if (size == 0) return 0;
        check_outward(*faults, {data, size});
        check_inward(*faults, {data, size});
        return 0;
    }
    if (faults.error().text.empty() || faults.error().code != mavloom::SetupCode::usage) std::abort();
    for (const char c : faults.error().text)
        if (static_cast<unsigned char>(c) < 0x20) std::abort();
    return 0;
}
