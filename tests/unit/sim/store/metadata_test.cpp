// SPDX-License-Identifier: MIT
// Component metadata as a ground station reads it. Expected forms: the schemas in the MAVLink guide, "Component
// Metadata Protocol", and the files that PX4 1.17 served.
#include <gmock/gmock.h>
#include <lzma.h>

#include <nlohmann/json.hpp>
#include <set>

#include "flight/firmware/firmware.hpp"
#include "mavloom/wire/crc32.hpp"
#include "sim/metadata/event_catalog.hpp"
#include "sim/metadata/metadata.hpp"

namespace mavloom::sim::metadata_tests {
namespace {

using Json = nlohmann::json;

const Firmware& px4() { return Firmware::of(Autopilot::px4, Kind::quad); }

std::string decompress(ByteView xz) {
    std::string out(4'000'000, '\0');
    std::uint64_t max_memory = 1 << 24;  // a ground station has little
    std::size_t read = 0, written = 0;
    const auto status = lzma_stream_buffer_decode(&max_memory, 0, nullptr, xz.data(), &read, xz.size(),
                                                  reinterpret_cast<std::uint8_t*>(out.data()), &written, out.size());
    EXPECT_EQ(status, LZMA_OK);
    out.resize(written);
    return out;
}

std::string text_of(std::string_view name, const Firmware& firmware = px4()) {
    const auto paths = metadata_paths(firmware);
    for (std::size_t i = 0; i < paths.size(); ++i)
        if (paths[i].find(name) != std::string_view::npos) return decompress(metadata_file(firmware, i));
    ADD_FAILURE() << name;
    return "{}";
}

Json json_of(std::string_view name, const Firmware& firmware = px4()) { return Json::parse(text_of(name, firmware)); }

TEST(Metadata, GeneralFileListsTheOthersWithTheirChecksums) {
    const auto general = general_metadata(px4());
    ASSERT_TRUE(general);
    EXPECT_EQ(general->uri, "mftp://etc/extras/component_general.json.xz");
    const std::string text = text_of("component_general");
    EXPECT_EQ(general->file_crc, wire::crc32(0, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}));

    const Json json = Json::parse(text);
    EXPECT_EQ(json["version"], 1);
    std::set<int> types;
    for (const Json& entry : json["metadataTypes"]) {
        types.insert(entry["type"].get<int>());
        const std::string uri = entry["uri"];
        bool found = false;
        const auto paths = metadata_paths(px4());
        for (std::size_t i = 0; i < paths.size(); ++i) {
            if (uri != "mftp://" + std::string(paths[i])) continue;
            found = true;
            EXPECT_EQ(entry["fileCrc"].get<std::uint32_t>(), wire::crc32(0, metadata_file(px4(), i)));
        }
        EXPECT_TRUE(found) << uri;
    }
    EXPECT_EQ(types, (std::set<int>{1, 4, 5}));
}

TEST(Metadata, ArduPilotHasNone) {
    const Firmware& ardupilot = Firmware::of(Autopilot::ardupilot, Kind::quad);
    EXPECT_FALSE(general_metadata(ardupilot));
    EXPECT_TRUE(metadata_paths(ardupilot).empty());
    EXPECT_TRUE(metadata_file(ardupilot, 0).empty());
}

TEST(Metadata, DescribesEveryParameter) {
    const Json json = json_of("parameters");
    EXPECT_EQ(json["version"], 1);
    const std::set<std::string> types{"Int8", "Int16", "Int32", "Float"};
    const std::set<std::string> known{"name",      "type",           "default",       "category", "group",
                                      "shortDesc", "longDesc",       "min",           "max",      "units",
                                      "volatile",  "rebootRequired", "decimalPlaces", "values",   "bitmask"};
    std::set<std::string> names;
    for (const Json& entry : json["parameters"]) {
        names.insert(entry.at("name").get<std::string>());
        EXPECT_TRUE(types.contains(entry.at("type").get<std::string>()));
        EXPECT_TRUE(entry.at("default").is_number());
        EXPECT_FALSE(entry.at("group").get<std::string>().empty());
        EXPECT_FALSE(entry.at("shortDesc").get<std::string>().empty());
        for (const auto& [key, value] : entry.items()) EXPECT_TRUE(known.contains(key)) << key;
        EXPECT_TRUE(entry["type"] == "Float" || entry["default"].is_number_integer()) << entry;
    }
    EXPECT_EQ(names.size(), px4().parameters().size());
    EXPECT_TRUE(names.contains("MIS_TAKEOFF_ALT"));
}

TEST(Metadata, KindsOfVehiclesHaveFilesOfTheirOwn) {
    const Firmware& plane = Firmware::of(Autopilot::px4, Kind::plane);
    EXPECT_EQ(json_of("parameters", plane)["parameters"].size(), plane.parameters().size());
    EXPECT_EQ(metadata_file(px4(), 1).data(), metadata_file(px4(), 1).data()) << "made once";
    EXPECT_NE(metadata_file(px4(), 1).data(), metadata_file(plane, 1).data());
}

// QGroundControl needs these entries for its page of arming checks.
TEST(Metadata, EventsDescribeTheArmingChecks) {
    const Json json = json_of("all_events");
    EXPECT_EQ(json["version"], 2);
    const Json& autopilot = json["components"]["1"];
    EXPECT_EQ(autopilot["namespace"], "px4");
    EXPECT_EQ(autopilot["supported_protocols"], Json::array({"health_and_arming_check"}));
    const Json& arming = autopilot["event_groups"]["arming_check"]["events"]["11047904"];
    EXPECT_EQ(arming["type"], "summary");
    std::vector<std::string> names;
    for (const Json& argument : arming["arguments"]) names.push_back(argument["name"]);
    EXPECT_THAT(names, testing::ElementsAre("chunk_idx", "error", "warning", "can_arm", "can_run"));
    EXPECT_EQ(autopilot["event_groups"]["health"]["events"]["1914663"]["arguments"].size(), 4u);
    const Json& groups = autopilot["navigation_mode_groups"]["groups"];
    EXPECT_EQ(groups["4"], Json::array({50593792}));
    EXPECT_EQ(groups["14"], Json::array({393216}));
    for (const auto& [index, modes] : groups.items())
        for (const Json& mode : modes) EXPECT_NE(px4().find_mode(mode.get<std::uint32_t>()), nullptr) << index;
}

TEST(Metadata, EveryTypeOfAnArgumentIsKnown) {
    const Json json = json_of("all_events");
    const Json& autopilot = json["components"]["1"];
    const std::set<std::string> plain{"uint8_t", "uint16_t", "uint32_t", "int32_t", "float"};
    for (const auto& [group, content] : autopilot["event_groups"].items())
        for (const auto& [id, event] : content["events"].items())
            for (const Json& argument : event.value("arguments", Json::array())) {
                std::string type = argument["type"];
                if (type.starts_with("px4::")) type = type.substr(5);
                EXPECT_TRUE(plain.contains(type) || autopilot["enums"].contains(type)) << id << " " << type;
            }
}

TEST(Metadata, EventsOfTheCatalogAreUnique) {
    std::set<std::uint32_t> ids;
    for (const EventInfo& info : event_infos()) {
        EXPECT_TRUE(ids.insert(info.id).second) << info.id;
        EXPECT_EQ(info.id >> 24, 1u) << "the autopilot's component";
    }
    for (const EventText& text : event_texts()) EXPECT_TRUE(ids.contains(text.id)) << text.text;
}

const Json& entry_of(const Json& parameters, std::string_view name) {
    return *std::ranges::find_if(parameters, [&](const Json& entry) { return entry["name"] == name; });
}

// PX4 1.17 has names of values for 204 of a quad's parameters, and names of bits for 17.
TEST(Metadata, NamesValuesAndBits) {
    const Json parameters = json_of("parameters")["parameters"];
    EXPECT_EQ(std::ranges::count_if(parameters, [](const Json& entry) { return entry.contains("values"); }), 204);
    EXPECT_EQ(std::ranges::count_if(parameters, [](const Json& entry) { return entry.contains("bitmask"); }), 17);
    EXPECT_EQ(entry_of(parameters, "RC_MAP_KILL_SW")["values"][5], (Json{{"value", 5}, {"description", "Channel 5"}}));
    EXPECT_EQ(entry_of(parameters, "COM_RCL_EXCEPT")["bitmask"][2], (Json{{"index", 2}, {"description", "Offboard"}}));
}

TEST(Metadata, NumbersAreShortAndRangesMayBeOpen) {
    const Json parameters = json_of("parameters")["parameters"];
    EXPECT_EQ(entry_of(parameters, "BAT_LOW_THR")["default"].dump(), "0.15");
    const Json& distance = entry_of(parameters, "RTL_MIN_DIST");
    EXPECT_EQ(distance["min"], 0.5);
    EXPECT_FALSE(distance.contains("max"));
}

// The page of QGroundControl is empty without outputs, a geometry, and the parameters that these name.
TEST(Metadata, ActuatorsHaveOutputsAndAGeometry) {
    const Json json = json_of("actuators");
    EXPECT_EQ(json["version"], 1);
    EXPECT_EQ(json["functions_v1"]["101"]["label"], "Motor 1");
    EXPECT_EQ(json["functions_v1"]["201"]["label"], "Servo 1");
    const Json& outputs = json["outputs_v1"][0]["subgroups"][0];
    EXPECT_EQ(outputs["channels"].size(), 16u);
    EXPECT_EQ(outputs["channels"][15], (Json{{"label", "Channel 16"}, {"param-index", 16}}));
    const Json& geometry = json["mixer_v1"]["config"][0];
    EXPECT_EQ(geometry["option"], "CA_AIRFRAME==0");
    EXPECT_EQ(geometry["actuators"][0]["count"], "CA_ROTOR_COUNT");
    EXPECT_EQ(geometry["actuators"][0]["per-item-parameters"].size(), 7u);
}

void expect_parameters(const Json& list, std::string_view index, const Firmware& firmware) {
    const flight::Parameters parameters(firmware.parameters());
    for (const Json& item : list) {
        if (!item.contains("name")) continue;
        std::string name = item["name"];
        if (const auto at = name.find("${i}"); at != std::string::npos) name.replace(at, 4, index);
        EXPECT_TRUE(parameters.find(name)) << name;
    }
}

TEST(Metadata, ActuatorsNameOnlyParametersThatTheVehicleHas) {
    for (const Kind kind : {Kind::quad, Kind::plane, Kind::rover}) {
        const Firmware& firmware = Firmware::of(Autopilot::px4, kind);
        const Json json = json_of("actuators", firmware);
        expect_parameters(json["outputs_v1"][0]["subgroups"][0]["per-channel-parameters"], "16", firmware);
        for (const Json& type : json["mixer_v1"]["actuator-types"])
            expect_parameters(type.value("per-item-parameters", Json::array()), "0", firmware);
        ASSERT_EQ(json["mixer_v1"]["config"].size(), 1u);
        for (const Json& actuator : json["mixer_v1"]["config"][0]["actuators"]) {
            EXPECT_TRUE(actuator["count"].is_number() ||
                        flight::Parameters(firmware.parameters()).find(actuator["count"].get<std::string>()));
            expect_parameters(actuator["per-item-parameters"], "0", firmware);
        }
        EXPECT_FALSE(json["mixer_v1"]["config"][0]["actuators"].empty());
    }
}

}  // namespace
}  // namespace mavloom::sim::metadata_tests
