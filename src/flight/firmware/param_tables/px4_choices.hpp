// SPDX-License-Identifier: MIT
// Values and bits of PX4's parameters, with their names. Private to flight and sim; constants.
//
// Values, bits and their names are those of PX4 1.17.
#pragma once

#include <iterator>
#include <span>

#include "flight/firmware/parameters.hpp"

namespace mavloom::flight {

inline constexpr ParamChoice aspd_do_checks_bits[] = {{0, "Data missing for 1 s"},
                                                      {1, "Data constant for 2 s"},
                                                      {2, "Innovation check (see ASPD_FS_INNOV)"},
                                                      {3, "Load factor"},
                                                      {4, "First principles"}};
inline constexpr ParamChoice aspd_fallback_values[] = {
    {0, "Other airspeed sensors"}, {1, "Ground speed minus wind"}, {2, "Thrust"}};
inline constexpr ParamChoice aspd_primary_values[] = {{0, "Groundspeed minus windspeed"},
                                                      {1, "First airspeed sensor"},
                                                      {2, "Second airspeed sensor"},
                                                      {3, "Third airspeed sensor"},
                                                      {4, "Thrust based airspeed"}};
inline constexpr ParamChoice aspd_scale_apply_values[] = {
    {0, "Do not apply"}, {1, "Apply the estimated scale after disarm"}, {2, "Apply the estimated scale in air"}};
inline constexpr ParamChoice bat_n_cells_values[] = {
    {0, "Unknown"},      {1, "1S Battery"},   {2, "2S Battery"},   {3, "3S Battery"},   {4, "4S Battery"},
    {5, "5S Battery"},   {6, "6S Battery"},   {7, "7S Battery"},   {8, "8S Battery"},   {9, "9S Battery"},
    {10, "10S Battery"}, {11, "11S Battery"}, {12, "12S Battery"}, {13, "13S Battery"}, {14, "14S Battery"},
    {15, "15S Battery"}, {16, "16S Battery"}};
inline constexpr ParamChoice bat_source_values[] = {
    {-1, "Disabled"}, {0, "Power Module / Analog"}, {1, "External"}, {2, "ESCs"}};
inline constexpr ParamChoice ca_airframe_values[] = {{0, "Multirotor"},
                                                     {1, "Fixed-wing"},
                                                     {2, "Standard VTOL"},
                                                     {3, "Tiltrotor VTOL"},
                                                     {4, "Tailsitter VTOL"},
                                                     {5, "Rover (Ackermann)"},
                                                     {6, "Rover (Differential)"},
                                                     {7, "Motors (6DOF)"},
                                                     {8, "Multirotor with Tilt"},
                                                     {9, "Custom"},
                                                     {10, "Helicopter (tail ESC)"},
                                                     {11, "Helicopter (tail Servo)"},
                                                     {12, "Helicopter (Coaxial)"},
                                                     {13, "Rover (Mecanum)"},
                                                     {14, "Spacecraft 2D"},
                                                     {15, "Spacecraft 3D"}};
inline constexpr ParamChoice ca_cs_laun_lk_bits[] = {
    {0, "Control Surface 1"}, {1, "Control Surface 2"}, {2, "Control Surface 3"}, {3, "Control Surface 4"},
    {4, "Control Surface 5"}, {5, "Control Surface 6"}, {6, "Control Surface 7"}, {7, "Control Surface 8"}};
inline constexpr ParamChoice ca_failure_mode_values[] = {
    {0, "Ignore"}, {1, "Stop the opposite motor"}, {2, "Reverse the opposite motor"}};
inline constexpr ParamChoice ca_method_values[] = {
    {0, "Output clipping"}, {1, "Sequential desaturation"}, {2, "Automatic"}};
inline constexpr ParamChoice ca_r_rev_bits[] = {{0, "Motor 1"}, {1, "Motor 2"},  {2, "Motor 3"},   {3, "Motor 4"},
                                                {4, "Motor 5"}, {5, "Motor 6"},  {6, "Motor 7"},   {7, "Motor 8"},
                                                {8, "Motor 9"}, {9, "Motor 10"}, {10, "Motor 11"}, {11, "Motor 12"}};
inline constexpr ParamChoice ca_rotor_count_values[] = {{0, "0"},   {1, "1"},   {2, "2"},  {3, "3"}, {4, "4"},
                                                        {5, "5"},   {6, "6"},   {7, "7"},  {8, "8"}, {9, "9"},
                                                        {10, "10"}, {11, "11"}, {12, "12"}};
inline constexpr ParamChoice ca_sv_cs_count_values[] = {{0, "0"}, {1, "1"}, {2, "2"}, {3, "3"}, {4, "4"},
                                                        {5, "5"}, {6, "6"}, {7, "7"}, {8, "8"}};
inline constexpr ParamChoice cal_air_cmodel_values[] = {
    {0, "Model with Pitot"}, {1, "Model without Pitot (1.5 mm tubes)"}, {2, "Tube Pressure Drop"}};
inline constexpr ParamChoice cal_mag_comp_typ_values[] = {
    {0, "Disabled"}, {1, "Throttle"}, {2, "Current of battery 0"}, {3, "Current of battery 1"}};
inline constexpr ParamChoice com_act_fail_act_values[] = {
    {0, "Warning only"}, {1, "Hold mode"}, {2, "Land mode"}, {3, "Return mode"}, {4, "Terminate"}};
inline constexpr ParamChoice com_arm_auth_met_values[] = {{0, "one arm"}, {1, "two step arm"}};
inline constexpr ParamChoice com_arm_mag_str_values[] = {{0, "Disabled"}, {1, "Deny arming"}, {2, "Warning only"}};
inline constexpr ParamChoice com_arm_odid_values[] = {{0, "Disabled"}, {1, "Warning only"}, {2, "Error only"},
                                                      {3, "Return"},   {4, "Land"},         {5, "Terminate"}};
inline constexpr ParamChoice com_arm_wo_gps_values[] = {
    {0, "Deny arming"}, {1, "Allow arming (with warning)"}, {2, "Allow arming (no warning)"}};
inline constexpr ParamChoice com_armable_values[] = {{0, "Disallow arming"}, {1, "Allow arming"}};
inline constexpr ParamChoice com_fltmode_boot_values[] = {
    {0, "Manual"},      {1, "Altitude"},      {2, "Position / Cruise"}, {3, "Mission"},
    {4, "Hold"},        {6, "Position Slow"}, {8, "Altitude Cruise"},   {10, "Acro"},
    {14, "Offboard"},   {15, "Stabilized"},   {17, "Takeoff"},          {23, "External 1"},
    {24, "External 2"}, {25, "External 3"},   {26, "External 4"},       {27, "External 5"},
    {28, "External 6"}, {29, "External 7"},   {30, "External 8"}};
inline constexpr ParamChoice com_fltt_low_act_values[] = {{0, "None"}, {1, "Warning"}, {3, "Return"}};
inline constexpr ParamChoice com_gnssloss_act_values[] = {{0, "Warning"}, {1, "Return"}, {2, "Land"}, {3, "Terminate"}};
inline constexpr ParamChoice com_low_bat_act_values[] = {{0, "Warning"},
                                                         {2, "Land mode"},
                                                         {3, "Return at critical level, land at emergency level"},
                                                         {4, "Return at critical level, terminate at emergency level"}};
inline constexpr ParamChoice com_obl_rc_act_values[] = {{0, "Position mode"}, {1, "Altitude mode"}, {2, "Stabilized"},
                                                        {3, "Return mode"},   {4, "Land mode"},     {5, "Hold mode"},
                                                        {6, "Terminate"},     {7, "Disarm"}};
inline constexpr ParamChoice com_pos_fs_act_values[] = {{0, "Descend mode"}, {1, "Terminate"}};
inline constexpr ParamChoice com_prearm_mode_values[] = {{0, "Disabled"}, {1, "Safety button"}, {2, "Always"}};
inline constexpr ParamChoice com_qc_act_values[] = {
    {-1, "Warning only"}, {0, "Return mode"}, {1, "Land mode"}, {2, "Hold mode"}};
inline constexpr ParamChoice com_rc_in_mode_values[] = {{0, "RC only"},
                                                        {1, "MAVLink only"},
                                                        {2, "RC or MAVLink with fallback"},
                                                        {3, "RC or MAVLink keep first"},
                                                        {4, "Disable manual control"},
                                                        {5, "Prio: RC > MAVL 1 > MAVL 2"},
                                                        {6, "Prio: MAVL 1 > MAVL 2 > RC"},
                                                        {7, "Prio: RC > MAVL 2 > MAVL 1"},
                                                        {8, "Prio: MAVL 2 > MAVL 1 > RC"}};
inline constexpr ParamChoice control_surfaces[] = {
    {0, "(Not set)"},       {1, "Left Aileron"},  {2, "Right Aileron"}, {3, "Elevator"},
    {4, "Rudder"},          {5, "Left Elevon"},   {6, "Right Elevon"},  {7, "Left V-Tail"},
    {8, "Right V-Tail"},    {9, "Left Flap"},     {10, "Right Flap"},   {11, "Airbrake"},
    {12, "Custom"},         {13, "Left A-tail"},  {14, "Right A-tail"}, {15, "Single Channel Aileron"},
    {16, "Steering Wheel"}, {17, "Left Spoiler"}, {18, "Right Spoiler"}};
inline constexpr ParamChoice ekf_decl_type_bits[] = {{0, "use geo_lookup declination"},
                                                     {1, "save EKF2_MAG_DECL on disarm"}};
inline constexpr ParamChoice ekf_ev_ctrl_bits[] = {
    {0, "Horizontal position"}, {1, "Vertical position"}, {2, "3D velocity"}, {3, "Yaw"}};
inline constexpr ParamChoice ekf_ev_noise_md_values[] = {{0, "Reported variance, not less than the parameters"},
                                                         {1, "Parameters"}};
inline constexpr ParamChoice ekf_gps_check_bits[] = {{0, "Sat count"},
                                                     {1, "PDOP"},
                                                     {2, "EPH"},
                                                     {3, "EPV"},
                                                     {4, "Speed accuracy"},
                                                     {5, "Horizontal position drift"},
                                                     {6, "Vertical position drift"},
                                                     {7, "Horizontal speed offset"},
                                                     {8, "Vertical speed offset"},
                                                     {9, "Spoofing"},
                                                     {10, "GPS fix type"},
                                                     {11, "Jamming"}};
inline constexpr ParamChoice ekf_gps_ctrl_bits[] = {
    {0, "Lon/lat"}, {1, "Altitude"}, {2, "3D velocity"}, {3, "Dual antenna heading"}};
inline constexpr ParamChoice ekf_gps_mode_values[] = {{0, "Automatic"}, {1, "Dead-reckoning"}};
inline constexpr ParamChoice ekf_hgt_ref_values[] = {
    {0, "Barometric pressure"}, {1, "GPS"}, {2, "Range sensor"}, {3, "Vision"}};
inline constexpr ParamChoice ekf_imu_ctrl_bits[] = {{0, "Gyro Bias"}, {1, "Accel Bias"}, {2, "Gravity vector fusion"}};
inline constexpr ParamChoice ekf_mag_check_bits[] = {{0, "Strength"}, {1, "Inclination"}, {2, "Wait for WMM"}};
inline constexpr ParamChoice ekf_mag_type_values[] = {
    {0, "Automatic"}, {1, "Magnetic heading"}, {5, "None"}, {6, "Init"}};
inline constexpr ParamChoice ekf_of_gyr_src_values[] = {{0, "Auto"}, {1, "Internal"}};
inline constexpr ParamChoice ekf_req_fix_values[] = {
    {0, "No fix required"}, {2, "2D fix"},    {3, "3D fix"},      {4, "RTCM code differential"},
    {5, "RTK float"},       {6, "RTK fixed"}, {8, "Extrapolated"}};
inline constexpr ParamChoice ekf_rng_ctrl_values[] = {
    {0, "Disable range fusion"}, {1, "Enabled (conditional mode)"}, {2, "Enabled"}};
inline constexpr ParamChoice ekf_rngbc_ctrl_values[] = {{0, "Disable ranging beacon fusion"},
                                                        {1, "Enable ranging beacon fusion"}};
inline constexpr ParamChoice ekf_sens_en_bits[] = {{0, "GNSS 0"},
                                                   {1, "GNSS 1"},
                                                   {2, "Optical flow"},
                                                   {3, "External vision"},
                                                   {4, "Aux global position 0"},
                                                   {5, "Aux global position 1"},
                                                   {6, "Aux global position 2"},
                                                   {7, "Aux global position 3"},
                                                   {8, "Barometer"},
                                                   {9, "Range finder"},
                                                   {10, "Magnetometer"},
                                                   {11, "Airspeed"},
                                                   {12, "Ranging beacon"}};
inline constexpr ParamChoice flw_tgt_alt_m_values[] = {{0, "2D: constant height above home"},
                                                       {1, "2D: constant height above the terrain"},
                                                       {2, "3D: the target's altitude"}};
inline constexpr ParamChoice fw_at_apply_values[] = {
    {0, "Do not apply"}, {1, "After disarming"}, {2, "Apply the new gains in air"}};
inline constexpr ParamChoice fw_at_axes_bits[] = {{0, "roll"}, {1, "pitch"}, {2, "yaw"}};
inline constexpr ParamChoice fw_at_man_aux_values[] = {{0, "Disable"}, {1, "Aux1"}, {2, "Aux2"}, {3, "Aux3"},
                                                       {4, "Aux4"},    {5, "Aux5"}, {6, "Aux6"}};
inline constexpr ParamChoice fw_at_sysid_type_values[] = {
    {0, "Step"}, {1, "Linear sine sweep"}, {2, "Logarithmic sine sweep"}};
inline constexpr ParamChoice fw_flaps_man_values[] = {{0, "Disabled"}, {1, "Aux1"}, {2, "Aux2"},         {3, "Aux3"},
                                                      {4, "Aux4"},     {5, "Aux5"}, {6, "Flaps channel"}};
inline constexpr ParamChoice fw_lnd_abort_bits[] = {{0, "Terrain not found"}, {1, "Terrain lost"}};
inline constexpr ParamChoice fw_lnd_nudge_values[] = {
    {0, "Disable nudging"}, {1, "Nudge approach angle"}, {2, "Nudge approach path"}};
inline constexpr ParamChoice fw_lnd_useter_values[] = {
    {0, "Disabled"}, {1, "For the flare"}, {2, "For flare and glide slope"}};
inline constexpr ParamChoice fw_pos_stk_conf_bits[] = {{0, "Height rate by throttle, airspeed by pitch"},
                                                       {1, "Airspeed by stick"}};
inline constexpr ParamChoice fw_spoilers_man_values[] = {
    {0, "Disabled"}, {1, "Flaps channel"}, {2, "Aux1"}, {3, "Aux2"}, {4, "Aux3"}, {5, "Aux4"}, {6, "Aux5"}};
inline constexpr ParamChoice gf_action_values[] = {{0, "None"},        {1, "Warning"},   {2, "Hold mode"},
                                                   {3, "Return mode"}, {4, "Terminate"}, {5, "Land mode"}};
inline constexpr ParamChoice gf_source_values[] = {{0, "GPOS"}, {1, "GPS"}};
inline constexpr ParamChoice hazard_actions[] = {
    {0, "Disabled"}, {1, "Warning"}, {2, "Error"}, {3, "Return"}, {4, "Land"}};
inline constexpr ParamChoice imu_gyro_dnf_en_bits[] = {{0, "ESC RPM"}, {1, "FFT"}};
inline constexpr ParamChoice imu_gyro_ratemax_values[] = {{100, "100 Hz"}, {250, "250 Hz"},   {400, "400 Hz"},
                                                          {800, "800 Hz"}, {1000, "1000 Hz"}, {2000, "2000 Hz"}};
inline constexpr ParamChoice imu_integ_rate_values[] = {
    {100, "100 Hz"}, {200, "200 Hz"}, {250, "250 Hz"}, {400, "400 Hz"}};
inline constexpr ParamChoice link_loss_exceptions[] = {
    {0, "Mission"}, {1, "Auto modes"}, {2, "Offboard"}, {3, "External Mode"}, {4, "Altitude Cruise"}};
inline constexpr ParamChoice mag_rotations[] = {{-1, "Internal"},
                                                {0, "No rotation"},
                                                {1, "Yaw 45"},
                                                {2, "Yaw 90"},
                                                {3, "Yaw 135"},
                                                {4, "Yaw 180"},
                                                {5, "Yaw 225"},
                                                {6, "Yaw 270"},
                                                {7, "Yaw 315"},
                                                {8, "Roll 180"},
                                                {9, "Roll 180, Yaw 45"},
                                                {10, "Roll 180, Yaw 90"},
                                                {11, "Roll 180, Yaw 135"},
                                                {12, "Pitch 180"},
                                                {13, "Roll 180, Yaw 225"},
                                                {14, "Roll 180, Yaw 270"},
                                                {15, "Roll 180, Yaw 315"},
                                                {16, "Roll 90"},
                                                {17, "Roll 90, Yaw 45"},
                                                {18, "Roll 90, Yaw 90"},
                                                {19, "Roll 90, Yaw 135"},
                                                {20, "Roll 270"},
                                                {21, "Roll 270, Yaw 45"},
                                                {22, "Roll 270, Yaw 90"},
                                                {23, "Roll 270, Yaw 135"},
                                                {24, "Pitch 90"},
                                                {25, "Pitch 270"},
                                                {26, "Pitch 180, Yaw 90"},
                                                {27, "Pitch 180, Yaw 270"},
                                                {28, "Roll 90, Pitch 90"},
                                                {29, "Roll 180, Pitch 90"},
                                                {30, "Roll 270, Pitch 90"},
                                                {31, "Roll 90, Pitch 180"},
                                                {32, "Roll 270, Pitch 180"},
                                                {33, "Roll 90, Pitch 270"},
                                                {34, "Roll 180, Pitch 270"},
                                                {35, "Roll 270, Pitch 270"},
                                                {36, "Roll 90, Pitch 180, Yaw 90"},
                                                {37, "Roll 90, Yaw 270"},
                                                {38, "Roll 90, Pitch 68, Yaw 293"},
                                                {39, "Pitch 315"},
                                                {40, "Roll 90, Pitch 315"},
                                                {100, "Custom Euler Angle"}};
inline constexpr ParamChoice mav_proto_ver_values[] = {{1, "Version 1 with auto-upgrade to v2 if detected"},
                                                       {2, "Version 2"}};
inline constexpr ParamChoice mav_type_values[] = {{0, "Generic micro air vehicle"},
                                                  {1, "Fixed wing aircraft"},
                                                  {2, "Quadrotor"},
                                                  {3, "Coaxial helicopter"},
                                                  {4, "Normal helicopter with tail rotor"},
                                                  {7, "Airship, controlled"},
                                                  {8, "Free balloon, uncontrolled"},
                                                  {10, "Ground rover"},
                                                  {11, "Surface vessel, boat, ship"},
                                                  {12, "Submarine"},
                                                  {13, "Hexarotor"},
                                                  {14, "Octorotor"},
                                                  {15, "Tricopter"},
                                                  {19, "VTOL Two-rotor Tailsitter"},
                                                  {20, "VTOL Quad-rotor Tailsitter"},
                                                  {21, "VTOL Tiltrotor"},
                                                  {22, "Standard VTOL"},
                                                  {23, "VTOL Tailsitter"}};
inline constexpr ParamChoice mc_airmode_values[] = {{0, "Disabled"}, {1, "Roll/Pitch"}, {2, "Roll/Pitch/Yaw"}};
inline constexpr ParamChoice mc_at_apply_values[] = {{0, "Do not apply"}, {1, "After disarming"}, {2, "In the air"}};
inline constexpr ParamChoice mc_orbit_yaw_mod_values[] = {{0, "Front to Circle Center"},
                                                          {1, "Hold Initial Heading"},
                                                          {2, "Uncontrolled"},
                                                          {3, "Hold Front Tangent to Circle"},
                                                          {4, "Manually (yaw stick) Controlled"}};
inline constexpr ParamChoice mc_slow_map_ptch_values[] = {
    {0, "No pitch rate input"}, {1, "AUX1"}, {2, "AUX2"}, {3, "AUX3"}, {4, "AUX4"}, {5, "AUX5"}, {6, "AUX6"}};
inline constexpr ParamChoice mis_mnt_yaw_ctl_values[] = {{0, "Disable"}, {1, "Enable"}};
inline constexpr ParamChoice mnt_mode_in_values[] = {
    {-1, "DISABLED"},         {0, "RC and gimbal protocol v2"}, {1, "RC"},
    {2, "ROI (protocol v1)"}, {3, "DO_MOUNT (protocol v1)"},    {4, "Gimbal protocol v2"},
    {5, "Fixed attitude"}};
inline constexpr ParamChoice mode_slots[] = {{-1, "Unassigned"},
                                             {0, "Manual"},
                                             {1, "Altitude"},
                                             {2, "Position / Cruise"},
                                             {3, "Mission"},
                                             {4, "Hold"},
                                             {5, "Return"},
                                             {6, "Acro"},
                                             {7, "Offboard"},
                                             {8, "Stabilized"},
                                             {9, "Position Slow"},
                                             {10, "Takeoff"},
                                             {11, "Land"},
                                             {12, "Follow Me"},
                                             {13, "Precision Land"},
                                             {16, "Altitude Cruise"},
                                             {100, "External Mode 1"},
                                             {101, "External Mode 2"},
                                             {102, "External Mode 3"},
                                             {103, "External Mode 4"},
                                             {104, "External Mode 5"},
                                             {105, "External Mode 6"},
                                             {106, "External Mode 7"},
                                             {107, "External Mode 8"}};
inline constexpr ParamChoice mpc_alt_mode_values[] = {
    {0, "Altitude following"}, {1, "Terrain following"}, {2, "Terrain hold"}};
inline constexpr ParamChoice mpc_auto_nudging_bits[] = {{0, "Yaw nudging"}, {1, "Landing nudging"}};
inline constexpr ParamChoice mpc_pos_mode_values[] = {{0, "Direct velocity"}, {4, "Acceleration based"}};
inline constexpr ParamChoice mpc_thr_curve_values[] = {
    {0, "Rescale to estimate"}, {1, "No rescale"}, {2, "Rescale to parameter"}};
inline constexpr ParamChoice mpc_yaw_mode_values[] = {{0, "towards waypoint"},
                                                      {1, "towards home"},
                                                      {2, "away from home"},
                                                      {3, "along trajectory"},
                                                      {4, "towards waypoint (yaw first)"},
                                                      {5, "yaw fixed"}};
inline constexpr ParamChoice nav_dll_act_values[] = {{0, "Disabled"},  {1, "Hold mode"}, {2, "Return mode"},
                                                     {3, "Land mode"}, {5, "Terminate"}, {6, "Disarm"}};
inline constexpr ParamChoice nav_rcl_act_values[] = {{1, "Hold mode"}, {2, "Return mode"},
                                                     {3, "Land mode"}, {5, "Terminate"},
                                                     {6, "Disarm"},    {7, "Hold mode (no failsafe)"}};
inline constexpr ParamChoice off_on[] = {{0, "Disabled"}, {1, "Enabled"}};
inline constexpr ParamChoice output_functions[] = {{0, "Disabled"},
                                                   {1, "Constant Min"},
                                                   {2, "Constant Max"},
                                                   {101, "Motor 1"},
                                                   {102, "Motor 2"},
                                                   {103, "Motor 3"},
                                                   {104, "Motor 4"},
                                                   {105, "Motor 5"},
                                                   {106, "Motor 6"},
                                                   {107, "Motor 7"},
                                                   {108, "Motor 8"},
                                                   {109, "Motor 9"},
                                                   {110, "Motor 10"},
                                                   {111, "Motor 11"},
                                                   {112, "Motor 12"},
                                                   {201, "Servo 1"},
                                                   {202, "Servo 2"},
                                                   {203, "Servo 3"},
                                                   {204, "Servo 4"},
                                                   {205, "Servo 5"},
                                                   {206, "Servo 6"},
                                                   {207, "Servo 7"},
                                                   {208, "Servo 8"},
                                                   {209, "Servo 9"},
                                                   {210, "Servo 10"},
                                                   {211, "Servo 11"},
                                                   {212, "Servo 12"},
                                                   {213, "Servo 13"},
                                                   {214, "Servo 14"},
                                                   {215, "Servo 15"},
                                                   {301, "Peripheral via Actuator Set 1"},
                                                   {302, "Peripheral via Actuator Set 2"},
                                                   {303, "Peripheral via Actuator Set 3"},
                                                   {304, "Peripheral via Actuator Set 4"},
                                                   {305, "Peripheral via Actuator Set 5"},
                                                   {306, "Peripheral via Actuator Set 6"},
                                                   {400, "Landing Gear"},
                                                   {401, "Parachute"},
                                                   {402, "RC Roll"},
                                                   {403, "RC Pitch"},
                                                   {404, "RC Throttle"},
                                                   {405, "RC Yaw"},
                                                   {406, "RC Flaps"},
                                                   {407, "RC AUX 1"},
                                                   {408, "RC AUX 2"},
                                                   {409, "RC AUX 3"},
                                                   {410, "RC AUX 4"},
                                                   {411, "RC AUX 5"},
                                                   {412, "RC AUX 6"},
                                                   {420, "Gimbal Roll"},
                                                   {421, "Gimbal Pitch"},
                                                   {422, "Gimbal Yaw"},
                                                   {430, "Gripper"},
                                                   {440, "Landing Gear Wheel"},
                                                   {450, "IC Engine Ignition"},
                                                   {451, "IC Engine Throttle"},
                                                   {452, "IC Engine Choke"},
                                                   {453, "IC Engine Starter"}};
inline constexpr ParamChoice pd_gripper_type_values[] = {{-1, "Undefined"}, {0, "Binary Grab/Release"}};
inline constexpr ParamChoice pwm_main_rev_bits[] = {
    {0, "SIM Channel 1"},   {1, "SIM Channel 2"},   {2, "SIM Channel 3"},   {3, "SIM Channel 4"},
    {4, "SIM Channel 5"},   {5, "SIM Channel 6"},   {6, "SIM Channel 7"},   {7, "SIM Channel 8"},
    {8, "SIM Channel 9"},   {9, "SIM Channel 10"},  {10, "SIM Channel 11"}, {11, "SIM Channel 12"},
    {12, "SIM Channel 13"}, {13, "SIM Channel 14"}, {14, "SIM Channel 15"}, {15, "SIM Channel 16"}};
inline constexpr ParamChoice rc_channels[] = {
    {0, "Unassigned"},  {1, "Channel 1"},   {2, "Channel 2"},   {3, "Channel 3"},   {4, "Channel 4"},
    {5, "Channel 5"},   {6, "Channel 6"},   {7, "Channel 7"},   {8, "Channel 8"},   {9, "Channel 9"},
    {10, "Channel 10"}, {11, "Channel 11"}, {12, "Channel 12"}, {13, "Channel 13"}, {14, "Channel 14"},
    {15, "Channel 15"}, {16, "Channel 16"}, {17, "Channel 17"}, {18, "Channel 18"}};
inline constexpr ParamChoice rc_map_fltm_btn_bits[] = {
    {0, "Mask Channel 1 as a mode button"},   {1, "Mask Channel 2 as a mode button"},
    {2, "Mask Channel 3 as a mode button"},   {3, "Mask Channel 4 as a mode button"},
    {4, "Mask Channel 5 as a mode button"},   {5, "Mask Channel 6 as a mode button"},
    {6, "Mask Channel 7 as a mode button"},   {7, "Mask Channel 8 as a mode button"},
    {8, "Mask Channel 9 as a mode button"},   {9, "Mask Channel 10 as a mode button"},
    {10, "Mask Channel 11 as a mode button"}, {11, "Mask Channel 12 as a mode button"},
    {12, "Mask Channel 13 as a mode button"}, {13, "Mask Channel 14 as a mode button"},
    {14, "Mask Channel 15 as a mode button"}, {15, "Mask Channel 16 as a mode button"},
    {16, "Mask Channel 17 as a mode button"}, {17, "Mask Channel 18 as a mode button"}};
inline constexpr ParamChoice rtl_cone_ang_values[] = {{0, "No cone"},     {25, "25 degrees"},
                                                      {45, "45 degrees"}, {65, "65 degrees"},
                                                      {80, "80 degrees"}, {90, "At least RTL_DESCEND_ALT"}};
inline constexpr ParamChoice rtl_pld_md_values[] = {
    {0, "No precision landing"}, {1, "Opportunistic precision landing"}, {2, "Required precision landing"}};
inline constexpr ParamChoice rtl_type_values[] = {{0, "Closest safe point, direct"},
                                                  {1, "Closest safe point but home, direct"},
                                                  {2, "Mission landing or back along the mission"},
                                                  {3, "Closest of home, mission landing, safe point"},
                                                  {4, "Mission landing or home, whichever is closer"},
                                                  {5, "Safe point, direct"}};
inline constexpr ParamChoice sdlog_backend_bits[] = {{0, "SD card logging"}, {1, "Mavlink logging"}};
inline constexpr ParamChoice sdlog_mission_values[] = {
    {0, "Disabled"}, {1, "All mission messages"}, {2, "Geotagging messages"}};
inline constexpr ParamChoice sdlog_mode_values[] = {{0, "While armed"},
                                                    {1, "From boot until disarmed"},
                                                    {2, "From boot until shut down"},
                                                    {3, "While AUX1 > 30%"},
                                                    {4, "From first arming until shut down"}};
inline constexpr ParamChoice sdlog_profile_bits[] = {{0, "Default set (general log analysis)"},
                                                     {1, "Estimator replay (EKF2)"},
                                                     {2, "Thermal calibration"},
                                                     {3, "System identification"},
                                                     {4, "High rate"},
                                                     {5, "Debug"},
                                                     {6, "Sensor comparison"},
                                                     {7, "Computer Vision and Avoidance"},
                                                     {8, "Raw FIFO high-rate IMU (Gyro)"},
                                                     {9, "Raw FIFO high-rate IMU (Accel)"},
                                                     {10, "Mavlink tunnel message logging"},
                                                     {11, "High rate sensors"}};
inline constexpr ParamChoice sens_board_rot_values[] = {{0, "No rotation"},
                                                        {1, "Yaw 45"},
                                                        {2, "Yaw 90"},
                                                        {3, "Yaw 135"},
                                                        {4, "Yaw 180"},
                                                        {5, "Yaw 225"},
                                                        {6, "Yaw 270"},
                                                        {7, "Yaw 315"},
                                                        {8, "Roll 180"},
                                                        {9, "Roll 180, Yaw 45"},
                                                        {10, "Roll 180, Yaw 90"},
                                                        {11, "Roll 180, Yaw 135"},
                                                        {12, "Pitch 180"},
                                                        {13, "Roll 180, Yaw 225"},
                                                        {14, "Roll 180, Yaw 270"},
                                                        {15, "Roll 180, Yaw 315"},
                                                        {16, "Roll 90"},
                                                        {17, "Roll 90, Yaw 45"},
                                                        {18, "Roll 90, Yaw 90"},
                                                        {19, "Roll 90, Yaw 135"},
                                                        {20, "Roll 270"},
                                                        {21, "Roll 270, Yaw 45"},
                                                        {22, "Roll 270, Yaw 90"},
                                                        {23, "Roll 270, Yaw 135"},
                                                        {24, "Pitch 90"},
                                                        {25, "Pitch 270"},
                                                        {26, "Pitch 180, Yaw 90"},
                                                        {27, "Pitch 180, Yaw 270"},
                                                        {28, "Roll 90, Pitch 90"},
                                                        {29, "Roll 180, Pitch 90"},
                                                        {30, "Roll 270, Pitch 90"},
                                                        {31, "Roll 90, Pitch 180"},
                                                        {32, "Roll 270, Pitch 180"},
                                                        {33, "Roll 90, Pitch 270"},
                                                        {34, "Roll 180, Pitch 270"},
                                                        {35, "Roll 270, Pitch 270"},
                                                        {36, "Roll 90, Pitch 180, Yaw 90"},
                                                        {37, "Roll 90, Yaw 270"},
                                                        {38, "Roll 90, Pitch 68, Yaw 293"},
                                                        {39, "Pitch 315"},
                                                        {40, "Roll 90, Pitch 315"}};
inline constexpr ParamChoice sens_gps_mask_bits[] = {
    {0, "use speed accuracy"}, {1, "use hpos accuracy"}, {2, "use vpos accuracy"}};
inline constexpr ParamChoice sens_imu_mode_values[] = {{0, "Disabled"}, {1, "Publish primary IMU selection"}};
inline constexpr ParamChoice sens_mag_mode_values[] = {{0, "Publish all magnetometers"},
                                                       {1, "Publish primary magnetometer"}};
inline constexpr ParamChoice sens_mag_sides_values[] = {
    {34, "Two side calibration"}, {38, "Three side calibration"}, {63, "Six side calibration"}};
inline constexpr ParamChoice sensor_priorities[] = {{-1, "Uninitialized"},    {0, "Disabled"}, {1, "Min"},  {25, "Low"},
                                                    {50, "Medium (Default)"}, {75, "High"},    {100, "Max"}};
// As `mag_rotations`, without the custom angle.
inline constexpr auto sensor_rotations = std::span(mag_rotations).first<std::size(mag_rotations) - 1>();
inline constexpr ParamChoice sih_vehicle_type_values[] = {{0, "Quadcopter"}, {1, "Fixed-Wing"},
                                                          {2, "Tailsitter"}, {3, "Standard VTOL"},
                                                          {4, "Hexacopter"}, {5, "Rover Ackermann"}};
inline constexpr ParamChoice slow_mode_inputs[] = {{0, "No rescaling"}, {1, "AUX1"}, {2, "AUX2"}, {3, "AUX3"},
                                                   {4, "AUX4"},         {5, "AUX5"}, {6, "AUX6"}};
inline constexpr ParamChoice sys_autoconfig_values[] = {{0, "Keep parameters"},
                                                        {1, "Reset parameters to airframe defaults"}};
inline constexpr ParamChoice sys_fac_cal_mode_values[] = {
    {0, "Disabled"}, {1, "All sensors"}, {2, "All sensors except mag"}};
inline constexpr ParamChoice sys_fail_gps_wrg_values[] = {
    {1, "Fix: None"}, {2, "Fix: 2D"}, {3, "Fix: 3D"}, {5, "Fix: RTK float"}, {6, "Fix: RTK fixed"}};
inline constexpr ParamChoice sys_fail_rc_mode_values[] = {{0, "Ok (no failure)"}, {1, "Off"},         {2, "Stuck"},
                                                          {3, "Garbage"},         {4, "Wrong"},       {5, "Slow"},
                                                          {6, "Delayed"},         {7, "Intermittent"}};
inline constexpr ParamChoice sys_fail_rc_src_values[] = {{0, "Disabled"}, {1, "AUX1"}, {2, "AUX2"}, {3, "AUX3"},
                                                         {4, "AUX4"},     {5, "AUX5"}, {6, "AUX6"}};
inline constexpr ParamChoice sys_fail_rc_unit_values[] = {{0, "Gyro"},     {1, "Accel"},     {2, "Mag"},
                                                          {3, "Baro"},     {4, "GPS"},       {7, "Distance sensor"},
                                                          {8, "Airspeed"}, {100, "Battery"}, {101, "Motor"}};
inline constexpr ParamChoice sys_hitl_values[] = {
    {-1, "external HITL"}, {0, "HITL and SIH disabled"}, {1, "HITL enabled"}, {2, "SIH enabled"}};
inline constexpr ParamChoice traffic_actions[] = {{0, "Disabled"},  {1, "Warn only"},          {2, "Return mode"},
                                                  {3, "Land mode"}, {4, "Position Hold mode"}, {5, "Terminate"}};
inline constexpr ParamChoice trig_interface_values[] = {{1, "GPIO"},
                                                        {2, "Seagull MAP2 (over PWM)"},
                                                        {3, "MAVLink (Camera Protocol v1)"},
                                                        {4, "Generic PWM (IR trigger, servo)"}};
inline constexpr ParamChoice trig_mode_values[] = {{0, "Disable"},
                                                   {1, "Time based, on command"},
                                                   {2, "Time based, always on"},
                                                   {3, "Distance based, always on"},
                                                   {4, "Distance based, on command"}};
inline constexpr ParamChoice warning_actions[] = {{0, "None"},   {1, "Warning"},   {2, "Hold"},
                                                  {3, "Return"}, {4, "Terminate"}, {5, "Land"}};

}  // namespace mavloom::flight
