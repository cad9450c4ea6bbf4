# SPDX-License-Identifier: MIT
"""pymavlink's dialects, for scripts that import them: mavloom.dialects.v10 and v20."""
