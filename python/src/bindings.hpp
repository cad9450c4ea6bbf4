// SPDX-License-Identifier: MIT
// One function for each source file that adds its classes and functions to the module mavloom._core.
#pragma once

#include <nanobind/nanobind.h>

namespace mavloom::python {

void bind_modes(nanobind::module_& module);
void bind_parser(nanobind::module_& module);
void bind_recording(nanobind::module_& module);
void bind_recording_summary(nanobind::module_& module);
void bind_recording_writer(nanobind::module_& module);
void bind_link(nanobind::module_& module);
void bind_subscription(nanobind::module_& module);
void bind_columns(nanobind::module_& module);
void bind_mavutil_message(nanobind::module_& module);
void bind_mavutil_state(nanobind::module_& module);
void bind_mavutil_log(nanobind::module_& module);
void bind_mavutil_parser(nanobind::module_& module);
void bind_ring_options(nanobind::module_& module);
void bind_ring_writer(nanobind::module_& module);
void bind_ring_reader(nanobind::module_& module);

}  // namespace mavloom::python
