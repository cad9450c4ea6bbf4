// SPDX-License-Identifier: MIT
// Any bytes as a specification of faults: no crash; a refusal has a message without control characters. Faults that are
// accepted get pieces of the bytes themselves: what arrives is never longer than what was sent, and the counters
// account for each piece.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "mavloom/dialect/dialect.hpp"
#include "mavloom/fault/faults.hpp"

namespace {

using namespace mavloom;

// Passes pieces at once, whenever they are due.
class Chain final : public link::Next {
public:
    Chain(link::Stages& stages, std::size_t place, MonoTime now, std::uint64_t& arrived)
        : stages_(stages), place_(place), now_(now), arrived_(arrived) {}
    void pass(const link::Piece& piece) noexcept override { pass_at(piece, now_); }
    void pass_at(const link::Piece& piece, MonoTime when) noexcept override {
        if (piece.bytes.empty() || when < MonoTime{}) std::abort();
        if (place_ == stages_.out.size()) {
            ++arrived_;
            return;
        }
        Chain next(stages_, place_ + 1, std::max(now_, when), arrived_);
        stages_.out[place_]->take(piece, next.now_, next);
    }

private:
    link::Stages& stages_;
    std::size_t place_;
    MonoTime now_;
    std::uint64_t& arrived_;
};

void run(const endpoint::Faults& faults, ByteView bytes) {
    link::LinkCounters counters;
    fault::Plan plan;
    plan.out = faults;
    auto stages = fault::stages_of(plan, "fuzz",
                                   {LinkId{1}, "fuzz", true, 0, counters, dialect::default_dialect().wire_table()});
    std::uint64_t sent = 0, arrived = 0;
    for (MonoTime now{std::chrono::hours(1)}; sent < 200; ++sent, now += std::chrono::milliseconds(10))
        Chain(stages, 0, now, arrived).pass({.bytes = bytes.first(1 + sent % bytes.size())});
    const auto dropped = counters.fault_blackout.value() + counters.fault_lost.value() + counters.fault_queue.value();
    if (arrived + dropped != sent + counters.fault_duplicated.value()) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto faults = mavloom::endpoint::parse_faults(text);
    if (faults) {
        if (size != 0) run(*faults, {data, size});
        return 0;
    }
    if (faults.error().text.empty() || faults.error().code != mavloom::SetupCode::usage) std::abort();
    for (const char c : faults.error().text)
        if (static_cast<unsigned char>(c) < 0x20) std::abort();
    return 0;
}
