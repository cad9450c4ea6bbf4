# SPDX-License-Identifier: MIT
from ...mavutil import mavlink as ASLUAV
from ...mavutil import mavlink as AVSSUAS
from ...mavutil import mavlink as all
from ...mavutil import mavlink as ardupilotmega
from ...mavutil import mavlink as autoquad
from ...mavutil import mavlink as common
from ...mavutil import mavlink as csAirLink
from ...mavutil import mavlink as cubepilot
from ...mavutil import mavlink as development
from ...mavutil import mavlink as icarous
from ...mavutil import mavlink as loweheiser
from ...mavutil import mavlink as marsh
from ...mavutil import mavlink as matrixpilot
from ...mavutil import mavlink as minimal
from ...mavutil import mavlink as paparazzi
from ...mavutil import mavlink as standard
from ...mavutil import mavlink as stemstudios
from ...mavutil import mavlink as storm32
from ...mavutil import mavlink as test
from ...mavutil import mavlink as uAvionix
from ...mavutil import mavlink as ualberta

__all__ = [
    "ASLUAV", "AVSSUAS", "all", "ardupilotmega", "autoquad", "common", "csAirLink", "cubepilot", "development",
    "icarous", "loweheiser", "marsh", "matrixpilot", "minimal", "paparazzi", "standard", "stemstudios", "storm32",
    "test", "uAvionix", "ualberta",
]
