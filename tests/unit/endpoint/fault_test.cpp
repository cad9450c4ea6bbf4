// SPDX-License-Identifier: MIT
// Specifications of faults. The forms and limits are those of docs/guide/faults.md.
#include "mavloom/endpoint/fault.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mavloom/endpoint/endpoint.hpp"

namespace mavloom::endpoint {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

Faults faults(std::string_view text) {
    auto parsed = parse_faults(text);
    EXPECT_TRUE(parsed) << text << ": " << (parsed ? "" : parsed.error().text);
    return parsed ? *std::move(parsed) : Faults{};
}

std::string error_of(std::string_view text) {
    const auto parsed = parse_faults(text);
    EXPECT_FALSE(parsed) << text;
    if (parsed) return "";
    EXPECT_EQ(parsed.error().code, SetupCode::usage);
    return parsed.error().text;
}

TEST(Faults, HaveTheValuesThatWereTyped) {
    const Faults all = faults(
        "blackout:1s/30s,loss:0.05/8,duplicate:0.01,corrupt:0.02,cut:0.03,delay:80ms~20ms,stall:2s/1m,reorder:0.04/"
        "50ms,"
        "rate:2400/2k");
    EXPECT_EQ(all.blackout, (Episodes{1s, 30s}));
    EXPECT_EQ(all.loss, 0.05);
    EXPECT_EQ(all.burst, 8);
    EXPECT_EQ(all.duplicate, 0.01);
    EXPECT_EQ(all.corrupt, 0.02);
    EXPECT_EQ(all.cut, 0.03);
    EXPECT_EQ(all.delay, 80ms);
    EXPECT_EQ(all.jitter, 20ms);
    EXPECT_EQ(all.stall, (Episodes{2s, 60s}));
    EXPECT_EQ(all.reorder, 0.04);
    EXPECT_EQ(all.reorder_by, 50ms);
    EXPECT_EQ(all.rate_bytes_s, 2400u);
    EXPECT_EQ(all.rate_queue_bytes, 2048u);
    EXPECT_TRUE(all.any());
}

TEST(Faults, HaveDefaults) {
    EXPECT_EQ(faults("loss:0.5").burst, 0);
    EXPECT_EQ(faults("delay:80ms").jitter, 0ms);
    EXPECT_EQ(faults("reorder:0.1").reorder_by, 20ms);
    EXPECT_EQ(faults("rate:9600").rate_queue_bytes, 9600u) << "what is sent in a second";
    EXPECT_EQ(faults("rate:100").rate_queue_bytes, 1024u) << "but room for a few frames";
    EXPECT_FALSE(faults("off").any());
    EXPECT_FALSE(faults("loss:0,delay:0").any());
}

TEST(Faults, LaterTermsReplaceThoseOfThePreset) {
    const Faults edge = faults("sik-edge");
    EXPECT_GT(edge.burst, 0);
    const Faults changed = faults("sik-edge,loss:0.3,delay:1s");
    EXPECT_EQ(changed.loss, 0.3);
    EXPECT_EQ(changed.burst, 0);
    EXPECT_EQ(changed.delay, 1s);
    EXPECT_EQ(changed.jitter, 0s);
    EXPECT_EQ(changed.rate_bytes_s, edge.rate_bytes_s);
}

TEST(Faults, EveryPresetIsALineOfTheGrammar) {
    for (const FaultPreset& preset : fault_presets()) {
        Faults by_name = faults(preset.name);
        by_name.text = preset.faults;
        EXPECT_EQ(by_name, faults(preset.faults)) << preset.name;
        EXPECT_TRUE(by_name.any()) << preset.name;
    }
}

struct Wrong {
    std::string_view text, error;
};

class WrongFaults : public ::testing::TestWithParam<Wrong> {};

TEST_P(WrongFaults, AreRefusedWithTheWrongWord) {
    EXPECT_THAT(error_of(GetParam().text), HasSubstr(std::string(GetParam().error)));
}

INSTANTIATE_TEST_SUITE_P(
    Faults, WrongFaults,
    ::testing::Values(
        Wrong{"", "a preset such as sik, or off"}, Wrong{"loss:0.1,", "an empty term"},
        Wrong{"los:0.1", "'los', did you mean 'loss'?"}, Wrong{"sik-edgy", "'sik-edgy', did you mean 'sik-edge'?"},
        Wrong{"zzz", "there are blackout, loss"}, Wrong{"loss", "'loss' needs a value, as in loss:0.05"},
        Wrong{"loss:", "loss: '' is not a share from 0 to 1"}, Wrong{"loss:0.1,loss:0.2", "'loss' stands twice"},
        Wrong{"loss:0.1,sik", "the preset 'sik' stands before"}, Wrong{"off,loss:0.1", "'off' stands alone"},
        Wrong{"loss:0.1,off", "'off' stands alone"}, Wrong{"loss:5%", "for 5 %, type 0.05"},
        Wrong{"loss:1.5", "'1.5' is not a share from 0 to 1"}, Wrong{"loss:-0.5", "is not a share"},
        Wrong{"loss:nan", "is not a share"}, Wrong{"loss:inf", "is not a share"},
        Wrong{"duplicate:2", "duplicate: '2' is not a share"}, Wrong{"corrupt:x", "corrupt: 'x' is not a share"},
        Wrong{"loss:0.5/0.5", "'0.5' is not a length of bursts from 1 to 10000"},
        Wrong{"loss:0.9/2", "in bursts of 2, at most 0.666 of all can be lost"}, Wrong{"loss:1/10000", "at most 0.999"},
        Wrong{"delay:80", "'80' has no unit; type 80ms"}, Wrong{"delay:1h", "'1h' is not a time from 0 to 600000 ms"},
        Wrong{"delay:10ms~20ms", "the jitter '20ms' exceeds the delay '10ms'"}, Wrong{"delay:-5ms", "'-5ms' is not a"},
        Wrong{"reorder:0.1/1us", "is not a time from 1 to 10000 ms"}, Wrong{"rate:0", "'0' is not from 1 to"},
        Wrong{"rate:9600/100", "'100' is not from 280 to"}, Wrong{"rate:fast", "'fast' is not a size"},
        Wrong{"blackout:1s", "'1s' does not state how often; type 1s/30s"},
        Wrong{"blackout:30s/1s", "'30s' is not shorter than '1s'"}, Wrong{"stall:0/1s", "stall: '0' is not a time"}));

// ---- as options -----------------------------------------------------------------------------------------------------

Endpoint with_options(const std::string& options) {
    auto parsed = parse_endpoint("udpin://127.0.0.1:14550?" + options);
    EXPECT_TRUE(parsed) << options << ": " << (parsed ? "" : parsed.error().text);
    return parsed ? *std::move(parsed) : Endpoint{};
}

TEST(FaultOptions, OfADirectionGoBeforeThoseOfBoth) {
    const Endpoint both = with_options("fault=loss:0.1");
    EXPECT_EQ(inward_faults(both.options).loss, 0.1);
    EXPECT_EQ(outward_faults(both.options).loss, 0.1);
    for (const char* options : {"fault=loss:0.1&in_fault=loss:0.2", "in_fault=loss:0.2&fault=loss:0.1"}) {
        EXPECT_EQ(inward_faults(with_options(options).options).loss, 0.2) << options;
        EXPECT_EQ(outward_faults(with_options(options).options).loss, 0.1) << options;
    }
    const Endpoint out = with_options("out_fault=sik&fault_seed=18446744073709551615");
    EXPECT_FALSE(inward_faults(out.options).any());
    EXPECT_EQ(out.options.fault_seed, 18446744073709551615u);
}

TEST(FaultOptions, ThatCannotBeObeyedAreRefused) {
    const auto error = [](const char* url) {
        const auto parsed = parse_endpoint(url);
        return parsed ? std::string() : parsed.error().text;
    };
    EXPECT_THAT(error("udpin://127.0.0.1:1?fault_seed=2"), HasSubstr("has no effect without fault="));
    EXPECT_THAT(error("udpin://127.0.0.1:1?fault=los:1"), HasSubstr("option 'fault': there is no fault 'los'"));
    EXPECT_THAT(error("udpin://127.0.0.1:1?out_fault=cut:0.1"), HasSubstr("'cut' is a fault of byte streams"));
    EXPECT_THAT(error("wsin://127.0.0.1:1?fault=cut:0.1"), HasSubstr("'cut' is a fault of byte streams"));
    EXPECT_THAT(error("shm://ring?fault=sik"), HasSubstr("does not take the option 'fault'"));
    for (const char* stream : {"tcpin://127.0.0.1:1", "tcpout://127.0.0.1:1", "serial:///dev/ttyACM0"})
        EXPECT_EQ(error((std::string(stream) + "?fault=cut:0.1").c_str()), "");
}

}  // namespace
}  // namespace mavloom::endpoint
