# SPDX-License-Identifier: MIT
"""A vehicle made with pymavlink that answers as an ArduPilot does: heartbeat, parameters, missions, commands.
A frame with a target goes to the sender that asked."""
import threading
import time

import frames  # noqa: F401  (MAVLink 2, before mavutil is loaded)
from frames import mavlink
from pymavlink import mavutil

SYSTEM, COMPONENT = 1, 1


def parameters(count=150):
    """{name: (value, type)}: whole and broken numbers, one with the longest name."""
    made = {f"TEST_{number:03d}": (float(number) + (0.5 if number % 3 == 0 else 0.0),
                                   mavlink.MAV_PARAM_TYPE_REAL32 if number % 3 == 0 else mavlink.MAV_PARAM_TYPE_INT32)
            for number in range(count - 1)}
    made["SIXTEEN_LETTERS_"] = (16.25, mavlink.MAV_PARAM_TYPE_REAL32)
    return made


class Vehicle:
    """Lives in a thread of its own from `with` to its end."""

    def __init__(self, url):
        self.connection = mavutil.mavlink_connection(url, source_system=SYSTEM, source_component=COMPONENT)
        self.parameters, self.mission, self.commands = parameters(), [], []
        self.heard = []  # (system, component) and name of all that came
        self._upload = None  # who, how many, the items so far
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._stop.set()
        self._thread.join(10)
        self.connection.close()

    @property
    def mav(self):
        return self.connection.mav

    def _run(self):
        due = 0.0
        while not self._stop.is_set():
            if time.monotonic() >= due:
                due = time.monotonic() + 0.2
                self.mav.heartbeat_send(mavlink.MAV_TYPE_QUADROTOR, mavlink.MAV_AUTOPILOT_ARDUPILOTMEGA,
                                        mavlink.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED, 0, mavlink.MAV_STATE_STANDBY)
            message = self.connection.recv_match(blocking=True, timeout=0.05)
            if message is None or message.get_type() == "BAD_DATA":
                continue
            self.heard.append(((message.get_srcSystem(), message.get_srcComponent()), message.get_type()))
            if getattr(message, "target_system", SYSTEM) not in (0, SYSTEM):
                continue
            handle = getattr(self, f"_on_{message.get_type().lower()}", None)
            if handle:
                handle(message, message.get_srcSystem(), message.get_srcComponent())

    # ---- parameters

    def _send_parameter(self, name):
        value, kind = self.parameters[name]
        self.mav.param_value_send(name.encode(), value, kind, len(self.parameters), list(self.parameters).index(name))

    def _on_param_request_list(self, *_):
        for number, name in enumerate(self.parameters):
            self._send_parameter(name)
            if number % 20 == 19:
                time.sleep(0.005)  # no autopilot sends them all at once

    def _on_param_request_read(self, message, *_):
        name = message.param_id if message.param_index < 0 else list(self.parameters)[message.param_index]
        if name in self.parameters:
            self._send_parameter(name)

    def _on_param_set(self, message, *_):
        if message.param_id in self.parameters:
            self.parameters[message.param_id] = (message.param_value, self.parameters[message.param_id][1])
            self._send_parameter(message.param_id)

    # ---- missions

    def _on_mission_count(self, message, system, component):
        if message.mission_type == 0:
            self._upload = (system, component, message.count, [])
            self._ask_next()

    def _ask_next(self):
        system, component, count, items = self._upload
        if len(items) < count:
            self.mav.mission_request_int_send(system, component, len(items), 0)
            return
        self.mission, self._upload = items, None
        self.mav.mission_ack_send(system, component, mavlink.MAV_MISSION_ACCEPTED, 0)

    def _on_mission_item_int(self, message, system, component):
        if self._upload and (system, component) == self._upload[:2] and message.seq == len(self._upload[3]):
            self._upload[3].append(message)
            self._ask_next()

    def _on_mission_request_list(self, message, system, component):
        self.mav.mission_count_send(system, component, len(self.mission) if message.mission_type == 0 else 0,
                                    message.mission_type)

    def _on_mission_request_int(self, message, system, component):
        if message.seq < len(self.mission):
            item = self.mission[message.seq]
            self.mav.mission_item_int_send(system, component, item.seq, item.frame, item.command, item.current,
                                           item.autocontinue, item.param1, item.param2, item.param3, item.param4,
                                           item.x, item.y, item.z, 0)

    _on_mission_request = _on_mission_request_int

    def _on_mission_clear_all(self, message, system, component):
        self.mission = []
        self.mav.mission_ack_send(system, component, mavlink.MAV_MISSION_ACCEPTED, message.mission_type)

    # ---- commands

    def _on_command_long(self, message, system, component):
        self.commands.append(message.command)
        known = (message.command in (mavlink.MAV_CMD_COMPONENT_ARM_DISARM,
                                     mavlink.MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES)
                 or (message.command == mavlink.MAV_CMD_REQUEST_MESSAGE
                     and message.param1 == mavlink.MAVLINK_MSG_ID_AUTOPILOT_VERSION))
        result = mavlink.MAV_RESULT_ACCEPTED if known else mavlink.MAV_RESULT_UNSUPPORTED
        self.mav.command_ack_send(message.command, result, 0, 0, system, component)
        if known and message.command != mavlink.MAV_CMD_COMPONENT_ARM_DISARM:
            capabilities = (mavlink.MAV_PROTOCOL_CAPABILITY_MISSION_INT | mavlink.MAV_PROTOCOL_CAPABILITY_PARAM_FLOAT
                            | mavlink.MAV_PROTOCOL_CAPABILITY_MAVLINK2)
            self.mav.autopilot_version_send(capabilities, 0x04060000, 0, 0, 0, [0] * 8, [0] * 8, [0] * 8, 0, 0, 42)
