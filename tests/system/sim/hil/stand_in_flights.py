# SPDX-License-Identifier: MIT
"""The flights of the stand-in for PX4, phase by phase, with the outputs of PX4's airframes: controls 0 to 15 of
HIL_ACTUATOR_CONTROLS are its outputs MAIN1 to MAIN16."""
import dataclasses
import json
import math

from stand_in_pilot import Pilot, euler, wrapped
from stand_in_wheels import PlanePilot, RoverPilot


@dataclasses.dataclass
class State:
    place: tuple = (0.0, 0.0, 0.0)     # m north, east, up of the start
    velocity: tuple = (0.0, 0.0, 0.0)  # m/s north, east, up
    attitude: tuple = (1.0, 0.0, 0.0, 0.0)
    degrees: tuple = (0, 0, 0)         # latitude and longitude in 1e-7 degrees, mm above mean sea level
    airspeed: float = 0.0              # m/s

    @property
    def speed(self):
        return math.hypot(*self.velocity)


def tell(what, **more):
    print(json.dumps({"stand_in": what, **more}), flush=True)


class Flight:
    """Phases by the time since the first answer. It begins at rest, and ends with "landed"."""

    def __init__(self, options):
        self.options, self.phase, self.since, self.highest = options, "rest", 0.0, 0.0
        self.pilot = None

    @property
    def is_armed(self):
        return self.phase not in ("rest", "landed")

    def to(self, phase, at, state):
        self.phase, self.since = phase, at
        tell(phase, flight_s=round(at, 3), place=[round(value, 3) for value in state.place])

    def step(self, at, state):
        self.highest = max(self.highest, state.place[2])
        self.next_phase(at, state)

    def figures(self):
        """More for the report."""
        return {}

    def stop_when(self, at, is_still, state):
        """It has landed when it was still for a second."""
        if not is_still:
            self.since = at
        elif at - self.since > 1:
            self.to("landed", at, state)


class QuadFlight(Flight):
    """Climb, hold, descend. MAIN1 to MAIN4 are the motors."""

    def next_phase(self, at, state):
        up, options = state.place[2], self.options
        if self.phase == "rest" and at >= options.arm_at:
            self.pilot = Pilot(euler(state.attitude)[2])
            self.to("climb", at, state)
        elif self.phase == "climb" and abs(up - options.height) < 0.3 and abs(state.velocity[2]) < 0.3:
            self.to("hold", at, state)
        elif self.phase == "hold" and at - self.since >= options.hold:
            self.to("descend", at, state)
        elif self.phase == "descend":
            self.stop_when(at, up < 0.15 and abs(state.velocity[2]) < 0.1, state)

    def outputs(self, state, rates, dt):
        if not self.is_armed:
            return [0.0] * 4
        height = -5.0 if self.phase == "descend" else self.options.height
        return self.pilot.outputs(state, rates, height, dt)


class Turning(Flight):
    """A flight with a full turn to the right in it."""

    def __init__(self, options):
        super().__init__(options)
        self.turned, self.heading, self.fastest = 0.0, None, 0.0

    def step(self, at, state):
        heading = euler(state.attitude)[2]
        if self.phase == "turn":
            self.turned += wrapped(heading - self.heading)
        self.heading = heading
        self.fastest = max(self.fastest, state.speed)
        super().step(at, state)

    def figures(self):
        return {"turned_deg": math.degrees(self.turned), "fastest_m_s": self.fastest}


class PlaneFlight(Turning):
    """A run along its heading, climb, a full circle, straight and level, and a glide to the ground. The outputs are
    those of airframe 1030: MAIN5 motor, MAIN6 and MAIN7 left and right aileron, MAIN8 elevator, MAIN3 rudder."""

    def next_phase(self, at, state):
        if self.phase == "rest" and at >= self.options.arm_at:
            self.pilot = PlanePilot(self.heading, self.options.height)
            self.to("climb", at, state)
        elif self.phase == "climb" and state.place[2] > self.options.height:
            self.to("turn", at, state)
        elif self.phase == "turn" and self.turned > 2 * math.pi:
            self.pilot.heading = self.heading
            self.to("hold", at, state)
        elif self.phase == "hold" and at - self.since >= self.options.hold:
            self.to("descend", at, state)
        elif self.phase == "descend":
            self.stop_when(at, state.speed < 0.05, state)

    def outputs(self, state, rates, dt):
        values = [0.0] * 16
        if self.is_armed:
            roll, elevator, motor, rudder = self.pilot.outputs(self.phase, state, rates, dt)
            values[4], values[5], values[6], values[7], values[2] = motor, -roll, roll, elevator, rudder
        return values


class RoverFlight(Turning):
    """Straight on, a full circle to the right, straight on, stop. The outputs are those of airframe 1060: MAIN1 and
    MAIN2 steering, MAIN6 and MAIN7 motor."""

    def next_phase(self, at, state):
        if self.phase == "rest" and at >= self.options.arm_at:
            self.pilot = RoverPilot(self.heading)
            self.to("drive", at, state)
        elif self.phase == "drive" and math.hypot(*state.place[:2]) > 10:
            self.to("turn", at, state)
        elif self.phase == "turn" and self.turned > 2 * math.pi:
            self.to("hold", at, state)
        elif self.phase == "hold" and at - self.since >= self.options.hold:
            self.to("stop", at, state)
        elif self.phase == "stop":
            self.stop_when(at, state.speed < 0.05, state)

    def outputs(self, state, rates, dt):
        values = [0.0] * 16
        if self.is_armed:
            values[5], values[0] = self.pilot.outputs(self.phase, state, rates, dt)
            values[6], values[1] = values[5], values[0]
        return values


FLIGHTS = {"quad": QuadFlight, "plane": PlaneFlight, "rover": RoverFlight}
