// SPDX-License-Identifier: MIT
// Frames and a small network around an Engine, for the tests of module route.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mavloom/dialect/dialect.hpp"
#include "mavloom/dialect/rates.hpp"
#include "mavloom/route/engine.hpp"
#include "mavloom/wire/frame_writer.hpp"
#include "support/bytes.hpp"
#include "support/filter.hpp"

namespace mavloom::route::test {

using mavloom::test::Bytes;
using Fields = std::vector<std::pair<std::string_view, std::uint32_t>>;
using Ids = std::vector<std::uint32_t>;

struct Id {
    std::uint8_t system, component;
    operator Source() const { return {SystemId{system}, ComponentId{component}}; }
};
inline constexpr Id gcs{255, 190};
inline constexpr Id vehicle{1, 1};

// A frame with these fields set and all others 0.
inline Bytes make_frame(std::string_view name, Id source, const Fields& fields = {}, std::uint8_t sequence = 0,
                        wire::Version version = wire::Version::v2) {
    const auto message = dialect::default_dialect().message(name);
    if (!message) throw std::invalid_argument(message.error().text);
    std::vector<std::uint8_t> payload((*message)->wire.max_length);
    for (const auto& [field_name, value] : fields) {
        const auto* field = (*message)->find(field_name);
        if (field == nullptr) throw std::invalid_argument(std::string(field_name));
        for (std::size_t i = 0; i < field->size() && i < 4; ++i)
            payload[field->offset + i] = static_cast<std::uint8_t>(value >> (8 * i));
    }
    wire::FrameBuffer buffer{};
    const auto frame = wire::write_frame(buffer, {.version = version, .sequence = sequence, .source = source},
                                         (*message)->wire, payload);
    return mavloom::test::copy(frame.bytes());
}

// An id that no dialect has, with a payload of which the first bytes look like a target.
inline Bytes make_unknown(Id source, std::uint8_t sequence = 0) {
    const wire::MessageInfo info{.id = MessageId{0xabcde}, .crc_extra = 17, .min_length = 4, .max_length = 4};
    const std::uint8_t payload[] = {1, 1, 1, 1};
    wire::FrameBuffer buffer{};
    return mavloom::test::copy(
        wire::write_frame(buffer, {.sequence = sequence, .source = source}, info, payload).bytes());
}

inline std::vector<std::uint32_t> ids_of(std::span<const LinkId> links) {
    std::vector<std::uint32_t> ids;
    for (const LinkId id : links) ids.push_back(id.value);
    std::sort(ids.begin(), ids.end());
    return ids;
}

// Links 1, 2, 3... of an Engine, and a clock that stands until it is moved. Every frame has bytes of its own.
class Network {
public:
    explicit Network(const Options& options = {}) : engine(dialect::default_dialect().wire_table(), options) {}

    Network& links(std::uint32_t n, const LinkPolicy& policy = {}) {
        for (std::uint32_t i = 0; i < n; ++i) link(policy);
        return *this;
    }
    std::uint32_t link(const LinkPolicy& policy = {}) {
        if (!engine.add_link(LinkId{++last_link}, policy)) throw std::logic_error("the link was refused");
        return last_link;
    }
    // The link hears a heartbeat of this source.
    Ids hears(std::uint32_t link, Id source) { return send(link, "HEARTBEAT", source, {{"custom_mode", ++count}}); }
    // Where a frame goes that comes in on `link`.
    Ids send(std::uint32_t link, std::string_view name, Id source, const Fields& fields = {}) {
        return pass(link, make_frame(name, source, fields, static_cast<std::uint8_t>(count++)));
    }
    Ids command(std::uint32_t link, Id source, Id target) {
        return send(link, "COMMAND_LONG", source,
                    {{"target_system", target.system}, {"target_component", target.component}, {"param1", ++count}});
    }
    Ids pass(std::uint32_t link, const Bytes& bytes, bool is_repeated = false) {
        const auto frame = wire::FrameView::unchecked(bytes);
        const auto* const info = dialect::default_dialect().wire_table().find(frame.id());
        const auto decision = engine.route(frame, engine.mark_of(frame), info, LinkId{link}, now, is_repeated);
        verdict = decision.verdict;
        return ids_of(decision.links);
    }
    std::map<std::uint32_t, Reason> explain(std::uint32_t link, const Bytes& bytes) {
        const auto frame = wire::FrameView::unchecked(bytes);
        std::vector<Explanation> why;
        verdict = engine
                      .explain(frame, dialect::default_dialect().wire_table().find(frame.id()), LinkId{link}, now, why)
                      .verdict;
        std::map<std::uint32_t, Reason> reasons;
        for (const auto& e : why) reasons[e.link.value] = e.reason;
        return reasons;
    }
    Network& wait(Nanoseconds time) {
        now += time;
        return *this;
    }
    [[nodiscard]] const LinkCounters& counters(std::uint32_t link) const { return *engine.counters(LinkId{link}); }

    Engine engine;
    MonoTime now{std::chrono::hours{1}};
    Verdict verdict = Verdict::nowhere;
    std::uint32_t count = 0;
    std::uint32_t last_link = 0;
};

using mavloom::test::make_filter;

inline dialect::Rates make_rates(const std::vector<dialect::RateTerm>& terms) {
    auto rates = dialect::Rates::compile(dialect::default_dialect(), terms);
    if (!rates) throw std::invalid_argument(rates.error().text);
    return *rates;
}

// One of the elements, chosen by a random byte.
template <class T, std::size_t n>
const T& pick(const T (&from)[n], std::uint8_t by) {
    return from[by % n];
}

}  // namespace mavloom::route::test
