# SPDX-License-Identifier: MIT
"""The pages whose Python examples are run and checked."""
import re

from places import ROOT

PAGES = [ROOT / "README.md", *(ROOT / "docs" / "guide" / name for name in ("python.md", "from-pymavlink.md"))]


def script_of(page):
    """All blocks of a page, one behind the other."""
    return "\n".join(re.findall(r"```python\n(.*?)```", page.read_text(), re.DOTALL))
