// SPDX-License-Identifier: MIT
// The outputs of a simulated PX4 and the geometry of its mixer, for the Actuators page of a ground station. Labels and
// parameters are those of PX4's simulation (SITL).
#include <algorithm>
#include <nlohmann/json.hpp>

#include "flight/firmware/firmware.hpp"
#include "mavloom/msg/enums/mav_type.hpp"
#include "sim/metadata/documents.hpp"

namespace mavloom::sim {

namespace {

using Json = nlohmann::json;

constexpr int outputs = 16;
constexpr int first_motor = 101, last_motor = 112, first_servo = 201, last_servo = 215;

// A parameter of an actuator, or of an output. `${i}` in the name stands for its number.
struct ItemParameter {
    std::string_view label, name;
    std::string_view function{};  // what the ground station draws by it
    bool is_advanced = false;
    std::string_view show_as{};
};

constexpr ItemParameter output_parameters[] = {{"Function", "PWM_MAIN_FUNC${i}", "function"},
                                               {"Rev Range\n(for Servos)", "PWM_MAIN_REV", {}, false, "bitset"}};
constexpr ItemParameter motor_parameters[] = {{"Bidirectional", "CA_R_REV", {}, true, "bitset"},
                                              {"Slew Rate", "CA_R${i}_SLEW", {}, true}};
constexpr ItemParameter servo_parameters[] = {{"Slew Rate", "CA_SV${i}_SLEW", {}, true}};
constexpr ItemParameter rotor_parameters[] = {
    {"Position X", "CA_ROTOR${i}_PX", "posx"},
    {"Position Y", "CA_ROTOR${i}_PY", "posy"},
    {"Position Z", "CA_ROTOR${i}_PZ", "posz", true},
    {"Direction CCW", "CA_ROTOR${i}_KM", "spin-dir", false, "true-if-positive"},
    {"Axis X", "CA_ROTOR${i}_AX", "axisx", true},
    {"Axis Y", "CA_ROTOR${i}_AY", "axisy", true},
    {"Axis Z", "CA_ROTOR${i}_AZ", "axisz", true}};
constexpr ItemParameter surface_parameters[] = {{"Type", "CA_SV_CS${i}_TYPE", "type"},
                                                {"Roll Torque", "CA_SV_CS${i}_TRQ_R"},
                                                {"Pitch Torque", "CA_SV_CS${i}_TRQ_P"},
                                                {"Yaw Torque", "CA_SV_CS${i}_TRQ_Y"},
                                                {"Trim", "CA_SV_CS${i}_TRIM"},
                                                {"Flaps Scale", "CA_SV_CS${i}_FLAP", {}, true},
                                                {"Spoiler Scale", "CA_SV_CS${i}_SPOIL", {}, true},
                                                {"Launch Lock", "CA_CS_LAUN_LK", {}, true, "bitset"}};

// Actuators count from 0 in names and bits, outputs from 1.
Json item_parameters(std::span<const ItemParameter> list, int first) {
    Json parameters = Json::array();
    for (const ItemParameter& parameter : list) {
        Json entry{{"label", parameter.label}, {"name", parameter.name}};
        if (!parameter.function.empty()) entry["function"] = parameter.function;
        if (parameter.is_advanced) entry["advanced"] = true;
        if (!parameter.show_as.empty()) entry["show-as"] = parameter.show_as;
        if (parameter.show_as == "bitset") entry["index-offset"] = -first;
        parameters.push_back(std::move(entry));
    }
    return parameters;
}

Json functions(const Firmware& firmware) {
    const auto parameters = firmware.parameters();
    const auto function = std::ranges::find(parameters, "PWM_MAIN_FUNC1", &ParamInfo::name);
    Json list = Json::object();
    if (function == parameters.end()) return list;
    for (const flight::ParamChoice& choice : function->choices)
        list[std::to_string(choice.value)] = {{"label", choice.name}};
    return list;
}

Json simulated_outputs() {
    Json channels = Json::array();
    for (int i = 1; i <= outputs; ++i)
        channels.push_back({{"label", "Channel " + std::to_string(i)}, {"param-index", i}});
    const Json subgroup{{"channels", std::move(channels)},
                        {"per-channel-parameters", item_parameters(output_parameters, 1)}};
    return Json{{"label", "SIM"}, {"subgroups", Json::array({subgroup})}};
}

Json actuator_type(int first, int last, const Json& values, std::span<const ItemParameter> parameters) {
    return {{"label-index-offset", 1},
            {"function-min", first},
            {"function-max", last},
            {"values", values},
            {"per-item-parameters", item_parameters(parameters, 0)}};
}

Json actuator_types() {
    const Json one_way{{"min", 0}, {"max", 1}, {"default-is-nan", true}};
    const Json both_ways{{"min", -1}, {"max", 1}, {"default", 0}};
    return {{"DEFAULT", {{"values", {{"min", -1}, {"max", 1}, {"default", -1}}}}},
            {"motor", actuator_type(first_motor, last_motor, one_way, motor_parameters)},
            {"servo", actuator_type(first_servo, last_servo, both_ways, servo_parameters)}};
}

// `count` is a number, or the parameter that holds it.
Json actuators(std::string_view type, std::string_view label, const Json& count, Json parameters) {
    return {{"actuator-type", type}, {"group-label", label},        {"count", count},
            {"required", true},      {"parameters", Json::array()}, {"per-item-parameters", std::move(parameters)}};
}

Json rotors(std::span<const ItemParameter> parameters) {
    return actuators("motor", "Motors", "CA_ROTOR_COUNT", item_parameters(parameters, 0));
}

// A rover's throttle and steering have fixed places.
Json fixed_actuator(std::string_view type, std::string_view group, std::string_view label, double x) {
    Json place = Json::array({{{"label", "Position X"}, {"function", "posx"}, {"value", Json::array({x})}},
                              {{"label", "Position Y"}, {"function", "posy"}, {"value", Json::array({0})}}});
    Json actuator = actuators(type, group, 1, std::move(place));
    actuator["item-label-prefix"] = Json::array({label});
    return actuator;
}

Json geometry(const Firmware& firmware) {
    switch (firmware.mav_type()) {
        case msg::MAV_TYPE_FIXED_WING:
            return {{"option", "CA_AIRFRAME==1"},
                    {"title", "Fixed Wing"},
                    {"actuators",
                     {rotors({}), actuators("servo", "Control Surfaces", "CA_SV_CS_COUNT",
                                            item_parameters(surface_parameters, 0))}}};
        case msg::MAV_TYPE_GROUND_ROVER:
            return {
                {"option", "CA_AIRFRAME==5"},
                {"title", "Rover (Ackermann)"},
                {"actuators",
                 {fixed_actuator("motor", "Motors", "Throttle", -1), fixed_actuator("servo", "Servos", "Steering", 1)}}};
        default:
            return {{"option", "CA_AIRFRAME==0"},
                    {"title", "Multirotor"},
                    {"type", "multirotor"},
                    {"actuators", Json::array({rotors(rotor_parameters)})}};
    }
}

}  // namespace

std::string actuator_document(const Firmware& firmware) {
    return Json{{"version", 1},
                {"functions_v1", functions(firmware)},
                {"outputs_v1", Json::array({simulated_outputs()})},
                {"mixer_v1", {{"actuator-types", actuator_types()}, {"config", Json::array({geometry(firmware)})}}}}
        .dump();
}

}  // namespace mavloom::sim
