// SPDX-License-Identifier: MIT
// Arms, disarms and changes modes, by the firmware's rules. Private to flight; single owner.
#pragma once

#include "flight/navigation/navigator.hpp"
#include "flight/supervision/landed_detector.hpp"

namespace mavloom::flight {

class Commander {
public:
    Commander(FlightContext& context, const Inputs& inputs, Navigator& navigator, LandedDetector& detector);

    Outcome arm(bool force, OrderedBy by);
    Outcome disarm(bool force, OrderedBy by);
    Outcome set_mode(const ModeInfo& mode, OrderedBy by);
    // The firmware's mode for a behaviour; `unsupported` if it has none.
    Outcome enter(Behaviour behaviour, OrderedBy by);
    Outcome terminate();
    // Carries out the action of a fail-safe. If the current mode brings the vehicle down sooner, the vehicle stays in
    // that mode.
    void perform(FailsafeAction action);
    // Call it when the reason for the fail-safe is gone: the vehicle continues in the mode that the client asked for.
    void resume();
    // Call it 50 times a second. Completes the boot, and disarms a vehicle that has been standing for too long.
    void update();
    // Disarms a vehicle that hit the ground and broke.
    void on_crash();
    void reboot();
    void set_calibrating(bool calibrating) noexcept { is_calibrating_ = calibrating; }
    void require_reboot(Unready reason) noexcept { reboot_for_ |= reason; }
    // Sets home until the vehicle boots again. Without this call, each arming sets home to where the vehicle is.
    Outcome set_home(const std::optional<GeoPoint>& point, double yaw);

    [[nodiscard]] const ModeInfo& mode() const noexcept { return *mode_; }
    [[nodiscard]] const ModeInfo& intended_mode() const noexcept { return *intended_; }
    [[nodiscard]] std::uint32_t unready() const noexcept;  // bits of Unready
    [[nodiscard]] SystemStatus status() const noexcept;
    [[nodiscard]] bool has_failsafe() const noexcept { return has_failsafe_; }
    // True if nothing keeps the vehicle from doing this now.
    [[nodiscard]] bool can_run(Behaviour behaviour) const noexcept;
    [[nodiscard]] std::uint32_t flights() const noexcept { return flights_; }

private:
    [[nodiscard]] std::string_view refusal(std::uint32_t reasons) const noexcept;
    [[nodiscard]] std::string_view mode_refusal() const noexcept;
    [[nodiscard]] bool is_booted() const noexcept;
    [[nodiscard]] bool can_arm_in(Behaviour behaviour) const noexcept;
    [[nodiscard]] bool may_disarm() const noexcept;
    [[nodiscard]] Outcome refuse_mode(const ModeInfo& mode) const;
    [[nodiscard]] const ModeInfo& failsafe_mode(Behaviour wanted) const noexcept;
    void switch_to(const ModeInfo& mode);
    void put_home_here();
    void end_flight(std::string_view text);
    void disarm_if_standing();

    FlightContext& context_;
    const Inputs& inputs_;
    Navigator& navigator_;
    LandedDetector& detector_;
    const ModeInfo* mode_;
    const ModeInfo* intended_;
    std::uint32_t flights_ = 0;
    std::uint32_t reboot_for_ = 0;  // bits of Unready
    bool has_failsafe_ = false, has_flown_ = false, is_terminated_ = false, is_calibrating_ = false, keeps_home_ = false;
};

}  // namespace mavloom::flight
