# SPDX-License-Identifier: MIT
"""A simple pilot for a quad in X form with PX4's motor order: loops for position, velocity, attitude and rates.
It knows the hover thrust only roughly, so it flies every body of the simulator."""
import math

GRAVITY = 9.80665
# Forward, right, and 1 for a counter-clockwise rotor (PX4's airframe 4001: CA_ROTORn_PX, _PY, the sign of _KM).
ROTORS = ((1, 1, 1), (-1, -1, 1), (1, -1, -1), (-1, 1, -1))


def clip(value, limit, low=None):
    return max(-limit if low is None else low, min(limit, value))


def euler(q):
    """Roll, pitch and yaw of a quaternion w, x, y, z from the body to north, east, down."""
    w, x, y, z = q
    return (math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)), math.asin(clip(2 * (w * y - z * x), 1)),
            math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)))


def wrapped(angle):
    return math.remainder(angle, 2 * math.pi)


class Pilot:
    """Holds a place and a heading, and climbs or descends to `height`."""

    def __init__(self, heading):
        self._heading, self._trim = heading, 0.5

    def outputs(self, state, rates, height, dt, fastest=3.0):
        """`state`: place (north, east, up), velocity (north, east, up), attitude. Returns the four motors' outputs."""
        roll, pitch, yaw = euler(state.attitude)
        wanted = (*self._tilt(state, yaw), self._heading)
        errors = [wrapped(a - b) for a, b in zip(wanted, (roll, pitch, yaw))]
        turn = [clip(gain * (clip(5 * error, 3) - rate), 0.2)
                for gain, error, rate in zip((0.08, 0.08, 0.15), errors, rates)]
        thrust = self._thrust(state, height, dt, fastest) / max(0.7, math.cos(roll) * math.cos(pitch))
        return [clip(thrust - turn[0] * right + turn[1] * forward + turn[2] * ccw, 1, 0)
                for forward, right, ccw in ROTORS]

    @staticmethod
    def _tilt(state, yaw):
        """Roll and pitch that lead back to the place above the start."""
        push = [clip(1.5 * (clip(-0.8 * at, 3) - speed), 2.5) for at, speed in zip(state.place[:2], state.velocity[:2])]
        forward = math.cos(yaw) * push[0] + math.sin(yaw) * push[1]
        right = -math.sin(yaw) * push[0] + math.cos(yaw) * push[1]
        return math.atan(right / GRAVITY), -math.atan(forward / GRAVITY)

    def _thrust(self, state, height, dt, fastest):
        error = clip(1.2 * (height - state.place[2]), fastest, -1.0) - state.velocity[2]
        self._trim = clip(self._trim + 0.1 * error * dt, 0.9, 0.1)
        return clip(self._trim + 0.08 * error, 0.95, 0.05)
