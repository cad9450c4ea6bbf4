# SPDX-License-Identifier: MIT
"""Simple pilots for vehicles on wheels: a plane and a rover. They know little of the vehicle, as stand_in_pilot.py."""
import math

from stand_in_pilot import clip, euler, wrapped

CRUISE, APPROACH = 15.0, 12.0  # m/s, airspeed
LIFT_OFF = 11.0                # m/s
BANK = math.radians(25)        # of the circle


class PlanePilot:
    """Attitude by ailerons and elevator, airspeed by the motor, height by pitch; when it glides, airspeed by pitch."""

    def __init__(self, heading, height):
        self.heading, self._height, self._trim = heading, height, 0.0

    def outputs(self, phase, state, rates, dt):
        """Roll, elevator, motor and rudder."""
        roll, pitch, yaw = euler(state.attitude)
        off = wrapped(self.heading - yaw)
        wanted = self._pitch(phase, state)
        self._trim = clip(self._trim + 1.5 * (wanted - pitch) * dt, 0.5)
        bank = BANK if phase == "turn" else clip(0.8 * off, BANK) if state.place[2] > 5 else 0.0
        return (clip(0.9 * (bank - roll) - 0.1 * rates[0], 1),
                clip(2 * (wanted - pitch) + self._trim - 0.1 * rates[1], 1),
                self._motor(phase, state),
                clip(off - 0.3 * rates[2], 1) if state.place[2] < 0.3 else 0.0)

    def _motor(self, phase, state):
        return {"climb": 1.0, "descend": 0.0}.get(phase, clip(0.55 + 0.1 * (CRUISE - state.airspeed), 1, 0))

    def _pitch(self, phase, state):
        up, climb = state.place[2], state.velocity[2]
        if phase == "climb":
            return math.radians(10) if state.airspeed > LIFT_OFF or up > 0.3 else 0.0
        if phase == "descend" and up < 4:  # flare
            return clip(0.1 + 0.12 * (-0.3 - 0.3 * max(up, 0.0) - climb), 0.2, -0.05)
        if phase == "descend":
            return clip(-0.07 + 0.03 * (state.airspeed - APPROACH), 0.15, -0.2)
        return clip(0.05 + 0.03 * (self._height - up) - 0.05 * climb, 0.3)


class RoverPilot:
    """Holds a heading and a speed."""

    def __init__(self, heading, speed=3.0):
        self._heading, self._speed = heading, speed

    def outputs(self, phase, state, rates, dt):
        """Drive and steering."""
        yaw = euler(state.attitude)[2]
        along = math.cos(yaw) * state.velocity[0] + math.sin(yaw) * state.velocity[1]
        steering = 0.3 if phase == "turn" else clip(wrapped(self._heading - yaw), 0.5)
        return clip(0.4 * ((0.0 if phase == "stop" else self._speed) - along) + 0.05 * along, 1), steering
