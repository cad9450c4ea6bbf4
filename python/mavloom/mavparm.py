# SPDX-License-Identifier: MIT
"""pymavlink's own module mavparm, sets of parameters in files. It works on the connections of mavloom.mavutil."""
import sys
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    def __getattr__(name: str) -> Any: ...
else:
    try:
        from pymavlink import mavparm
    except ImportError as error:
        raise ImportError("mavloom.mavparm is the module of pymavlink, which is not installed or too old "
                          f"({error}): pip install --upgrade pymavlink", name="pymavlink.mavparm") from error
    sys.modules[__name__] = mavparm
