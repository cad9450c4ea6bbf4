# SPDX-License-Identifier: MIT
"""pymavlink's own module mavftp, the client of MAVLink FTP. It works on the connections of mavloom.mavutil."""
import sys
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    def __getattr__(name: str) -> Any: ...
else:
    try:
        from pymavlink import mavftp
    except ImportError as error:
        raise ImportError("mavloom.mavftp is the module of pymavlink, which is not installed or too old "
                          f"({error}): pip install --upgrade pymavlink", name="pymavlink.mavftp") from error
    sys.modules[__name__] = mavftp
