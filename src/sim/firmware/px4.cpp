// SPDX-License-Identifier: MIT
#include "sim/firmware/firmware.hpp"

namespace mavloom::sim {

namespace {

constexpr std::array modes_table{
    ModeInfo{.name = "Hold", .custom_mode = 0x03040000, .behaviour = Behaviour::hold, .base_mode = 29},
};
constexpr std::array parameters_table{
    ParamInfo{.name = "MAV_SYS_ID", .type = ParamType::int32, .initial = 1},
};
constexpr Texts texts_table{.armed = "Armed by external command\t"};

class Px4 final : public Firmware {
public:
    explicit Px4(Kind kind) noexcept : kind_(kind) {}
    Autopilot autopilot() const noexcept override { return Autopilot::px4; }
    std::uint8_t mav_autopilot() const noexcept override { return 12; }
    std::uint8_t mav_type() const noexcept override { return kind_ == Kind::quad ? 2 : kind_ == Kind::plane ? 1 : 10; }
    std::uint64_t capabilities(const VehicleOptions& /*options*/) const noexcept override { return 0xe8ff; }
    const VersionInfo& version() const noexcept override {
        static constexpr VersionInfo version{};
        return version;
    }
    const Texts& texts() const noexcept override { return texts_table; }
    std::span<const ModeInfo> modes() const noexcept override { return modes_table; }
    const ModeInfo& boot_mode() const noexcept override { return modes_table[0]; }
    const ModeInfo* mode_for(Behaviour /*behaviour*/) const noexcept override { return &modes_table[0]; }
    const ModeInfo* requested_mode(std::uint8_t, std::uint32_t, std::uint32_t) const noexcept override { return nullptr; }
    std::span<const ParamInfo> parameters() const noexcept override { return parameters_table; }
    bool is_bytewise() const noexcept override { return true; }
    Tuning tuning(const Parameters& /*parameters*/) const override { return {}; }
    bool has_home_in_mission() const noexcept override { return false; }

private:
    Kind kind_;
};

}  // namespace

const Firmware& Firmware::of(Autopilot /*autopilot*/, Kind kind) {
    static const Px4 quad(Kind::quad), plane(Kind::plane), rover(Kind::rover);
    return kind == Kind::quad ? quad : kind == Kind::plane ? plane : rover;
}

}  // namespace mavloom::sim
