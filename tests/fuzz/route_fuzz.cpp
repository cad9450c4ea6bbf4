// SPDX-License-Identifier: MIT
// Any bytes as the life of a router: links come and go, frames of any content arrive on any link. The engine keeps its
// promises: nothing goes back where it came from or twice to one link, only to links that are there; what explains
// agrees with what routes; every frame is counted.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "mavloom/route/engine.hpp"
#include "mavloom/wire/frame.hpp"
#include "mavloom/wire/message_table.hpp"

namespace {

using namespace mavloom;

void expect(bool holds) {
    if (!holds) std::abort();
}

const wire::MessageTable& table() {
    static const wire::MessageInfo messages[] = {{MessageId{0}, 50, 9, 9},
                                                 {MessageId{2}, 137, 12, 12},
                                                 {MessageId{11}, 89, 6, 6, 4},
                                                 {MessageId{30}, 39, 28, 28},
                                                 {MessageId{77}, 143, 3, 10, 8, 9}};
    static const wire::MessageTable instance(messages);
    return instance;
}

struct Input {
    const std::uint8_t* at;
    const std::uint8_t* end;
    std::uint8_t byte() { return at == end ? std::uint8_t{0} : *at++; }
};

route::LinkPolicy policy_from(Input& in) {
    route::LinkPolicy policy;
    const std::uint8_t bits = in.byte();
    policy.group = route::GroupId{bits & 3u};
    policy.group_mode = static_cast<route::GroupMode>((bits >> 2) % 3);
    policy.tap = (bits & 0x70) == 0x10;
    policy.is_private = (bits & 0x70) == 0x20;
    if ((bits & 0x70) == 0x30) policy.max_bytes_per_s = in.byte();
    if ((bits & 0x70) == 0x40) {
        const std::vector<dialect::RateTerm> terms{{"*", 1000.0 / (1 + in.byte())}};
        policy.max_rate = *dialect::Rates::compile(dialect::default_dialect(), terms);
    }
    return policy;
}

// A frame of the two forms with the header and payload that the input describes. Its checksum does not matter here.
wire::FrameView frame_from(Input& in, std::vector<std::uint8_t>& bytes) {
    bytes.assign(wire::max_frame_length, 0);
    const bool v2 = (in.byte() & 1) != 0;
    bytes[0] = v2 ? wire::stx_v2 : wire::stx_v1;
    bytes[1] = static_cast<std::uint8_t>(in.byte() % 32);
    const std::size_t header = v2 ? wire::header_length_v2 : wire::header_length_v1;
    for (std::size_t i = v2 ? 4 : 2; i < header + bytes[1]; ++i) bytes[i] = in.byte();
    if (v2) bytes[8] = bytes[9] = 0;
    return wire::FrameView::unchecked({bytes.data(), header + bytes[1] + wire::checksum_length});
}

struct Life {
    explicit Life(const route::Options& options) : routing(table(), options), explaining(table(), options) {}

    void add(Input& in) {
        const auto policy = policy_from(in);
        const LinkId id{++last};
        const bool taken = routing.add_link(id, policy);
        expect(taken == explaining.add_link(id, policy));
        if (taken) there.push_back(id);
    }
    void remove(LinkId id) {
        routing.remove_link(id);
        explaining.remove_link(id);
        std::erase(there, id);
    }
    void pass(LinkId from, const wire::FrameView& frame) {
        const auto* info = table().find(frame.id());
        const auto decision = routing.route(frame, info, from, now);
        const auto explained = explaining.explain(frame, info, from, now, why);
        expect(decision.verdict == explained.verdict && std::ranges::equal(decision.links, explained.links));
        expect(why.size() == there.size());
        std::size_t sent = 0;
        for (const auto& e : why) sent += e.reason == route::Reason::sent || e.reason == route::Reason::tap ? 1 : 0;
        expect(sent == decision.links.size());
        for (std::size_t i = 0; i < decision.links.size(); ++i) {
            const LinkId to = decision.links[i];
            expect(to != from && std::find(there.begin(), there.end(), to) != there.end());
            expect(std::count(decision.links.begin(), decision.links.end(), to) == 1);
        }
        if (const auto* c = routing.counters(from); c != nullptr) {
            std::uint64_t sum = 0;
            for (const auto* counter : {&c->forwarded, &c->nowhere, &c->filtered, &c->rate_limited, &c->duplicate,
                                        &c->echo, &c->unknown_target, &c->consumed, &c->tap, &c->private_link})
                sum += counter->value();
            expect(sum == c->frames.value());
        }
    }

    route::Engine routing, explaining;
    std::vector<LinkId> there;
    std::vector<route::Explanation> why;
    std::uint32_t last = 0;
    MonoTime now{std::chrono::hours{1}};
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Input in{data, data + size};
    const std::uint8_t bits = in.byte();
    route::Options options{.recent_frames = 64};
    if ((bits & 1) != 0) options.dedup = std::chrono::milliseconds{in.byte()};
    if ((bits & 2) != 0) options.unknown_target = route::UnknownTarget::flood;
    if ((bits & 4) != 0) options.unknown_component = route::UnknownComponent::drop;
    if ((bits & 8) != 0) options.own = Source{SystemId{in.byte()}, ComponentId{in.byte()}};
    Life life(options);
    std::vector<std::uint8_t> bytes;
    while (in.at != in.end) {
        const std::uint8_t step = in.byte();
        const LinkId link{in.byte() % (life.last + 1) + 1};
        switch (step % 8) {
            case 0: life.add(in); break;
            case 1: life.remove(link); break;
            case 2: life.now += std::chrono::milliseconds{in.byte() * 20}; break;
            case 3:
                life.pass(link, bytes.empty() ? frame_from(in, bytes)
                                              : wire::FrameView::unchecked({bytes.data(), wire::frame_length(bytes)}));
                break;
            default: life.pass(link, frame_from(in, bytes)); break;
        }
    }
    (void)life.routing.routes(life.now);
    return 0;
}
