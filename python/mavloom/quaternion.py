# SPDX-License-Identifier: MIT
"""Attitudes as quaternions, with the interface of pymavlink's quaternion.

    from mavloom.quaternion import QuaternionBase
    link.mav.set_attitude_target_send(..., QuaternionBase([roll, pitch, yaw]), ...)

A quaternion (w, x, y, z) rotates vectors from the body frame to the earth frame. Euler angles are roll, pitch and yaw
in radians, applied in the order yaw, pitch, roll.
"""
from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


class QuaternionBase:
    """An attitude, given as 4 elements of a quaternion, 3 Euler angles, a 3x3 rotation matrix or a Quaternion."""

    def __init__(self, attitude: Any = (1, 0, 0, 0)) -> None:
        if isinstance(attitude, QuaternionBase):
            self.q = attitude.q.copy()
            return
        given = np.array(attitude)
        if given.shape == (3, 3):
            self.dcm = given
        elif given.shape == (4,):
            self.q = given
        elif given.shape == (3,):
            self.euler = given
        else:
            raise TypeError("an attitude is a quaternion (4 numbers), Euler angles (3), or a 3x3 matrix, "
                            f"not {attitude!r}")

    @property
    def q(self) -> Array:
        """The elements w, x, y, z."""
        return self._q

    @q.setter
    def q(self, q: Any) -> None:
        self._q = np.array(q)

    def __getitem__(self, index: int) -> Any:
        return self._q[index]

    def __len__(self) -> int:
        return 4

    @property
    def euler(self) -> Array:
        """Roll, pitch and yaw in radians."""
        m = self.dcm
        return np.array([math.atan2(m[2][1], m[2][2]), math.asin(max(-1.0, min(1.0, -m[2][0]))),
                         math.atan2(m[1][0], m[0][0])])

    @euler.setter
    def euler(self, euler: Any) -> None:
        (sr, sp, sy), (cr, cp, cy) = np.sin(np.array(euler) / 2), np.cos(np.array(euler) / 2)
        self._q = np.array([cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy,
                            cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy])

    @property
    def dcm(self) -> Array:
        """The rotation matrix from body to earth."""
        w, x, y, z = self._q / self.norm
        return np.array([[w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
                         [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
                         [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z]])

    @dcm.setter
    def dcm(self, dcm: Any) -> None:
        m = np.array(dcm, dtype=float)
        # `squares` holds each element of the quaternion squared, times 4. A row of `products` is the quaternion times
        # one of its elements, times 4. The row of the largest element gives the most exact result.
        squares = np.array([1 + m[0, 0] + m[1, 1] + m[2, 2], 1 + m[0, 0] - m[1, 1] - m[2, 2],
                            1 - m[0, 0] + m[1, 1] - m[2, 2], 1 - m[0, 0] - m[1, 1] + m[2, 2]])
        products = np.array([[squares[0], m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]],
                             [m[2, 1] - m[1, 2], squares[1], m[1, 0] + m[0, 1], m[0, 2] + m[2, 0]],
                             [m[0, 2] - m[2, 0], m[1, 0] + m[0, 1], squares[2], m[2, 1] + m[1, 2]],
                             [m[1, 0] - m[0, 1], m[0, 2] + m[2, 0], m[2, 1] + m[1, 2], squares[3]]])
        largest = int(np.argmax(squares))
        q = products[largest] / (2 * math.sqrt(squares[largest]))
        self._q = q if q[0] >= 0 else -q

    @property
    def norm(self) -> float:
        return float(np.sqrt(np.dot(self._q, self._q)))

    def normalize(self) -> None:
        """Makes the norm 1."""
        self._q = self._q / self.norm

    @property
    def inversed(self) -> QuaternionBase:
        """The rotation in the opposite direction."""
        return type(self)(self._q * np.array([1, -1, -1, -1]) / np.dot(self._q, self._q))

    def transform(self, v: Any) -> Array:
        """Converts the vector `v` from the body frame to the earth frame."""
        turned: Array = self.dcm @ np.array([v.x, v.y, v.z] if hasattr(v, "x") else v)
        return turned

    def __mul__(self, other: Any) -> Any:
        """For a quaternion: the rotation `other`, then this one. For a vector: the same as `transform`."""
        if not isinstance(other, QuaternionBase):
            return self.transform(other)
        (a, b, c, d), (w, x, y, z) = self._q, other._q
        return type(self)(np.array([a * w - b * x - c * y - d * z, a * x + b * w + c * z - d * y,
                                    a * y - b * z + c * w + d * x, a * z + b * y - c * x + d * w]))

    def __truediv__(self, other: QuaternionBase) -> Any:
        return self * other.inversed

    def __eq__(self, other: object) -> bool:
        """Whether both are the same attitude, up to rounding."""
        return isinstance(other, QuaternionBase) and self.close(other)

    __hash__ = None  # type: ignore[assignment]

    def close(self, other: QuaternionBase) -> bool:
        return bool(np.allclose(self._q, other._q) or np.allclose(self._q, -other._q))

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self._q.tolist()})"

    def __str__(self) -> str:
        return str(self._q)


class Quaternion(QuaternionBase):
    """Same as QuaternionBase. In pymavlink, this class has its own vector and matrix types; here, it uses numpy's."""
