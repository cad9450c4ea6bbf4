# SPDX-License-Identifier: MIT
"""MAVProxy as a person uses it: commands typed, answers read."""
import os
import re
import subprocess
import sys

import harness

# Lines that report a fault, as MAVProxy writes them.
COMPLAINTS = re.compile(r"Traceback|Exception|link \d+ down|no link|time has wrapped|Got COMMAND_ACK.*(FAILED|DENIED)|"
                        r"Unable|No waypoints|timeout|error", re.IGNORECASE)


class Mavproxy:
    def __init__(self, folder, port, kind="udpout", modules="param,wp,arm,mode,cmdlong,link,fence,rally,ftp,misc,rc,"
                 "signing", system=253):
        program = os.path.join(os.path.dirname(sys.executable), "mavproxy.py")
        folder.mkdir(exist_ok=True)
        self.process = harness.Running(
            [sys.executable, "-u", program, f"--master={kind}:127.0.0.1:{port}", f"--default-modules={modules}",
             f"--state-basedir={folder}", f"--source-system={system}"],
            stdin=subprocess.PIPE, cwd=folder, env={**os.environ, "HOME": str(folder), "TERM": "dumb"})
        self._read = 0

    def type(self, text):
        self._read = len(self.process.stdout)
        self.process.process.stdin.write(text.encode() + b"\n")
        self.process.process.stdin.flush()

    def says(self, pattern, timeout=harness.DEFAULT_TIMEOUT_S):
        """The match in what it wrote since the last command."""
        def look():
            return re.search(pattern, self.process.stdout[self._read:])
        try:
            return harness.wait_for(look, timeout, f"{pattern!r}")
        except AssertionError as error:
            raise AssertionError(f"{error}; MAVProxy wrote:\n{self.process.stdout[-3000:]}") from None

    def repeats(self, text, pattern, timeout=harness.DEFAULT_TIMEOUT_S):
        """Types it until the answer comes."""
        def look():
            self.type(text)
            return harness.wait_for(lambda: re.search(pattern, self.process.stdout[self._read:]), 2, pattern)
        from contextlib import suppress

        def tried():
            with suppress(AssertionError):
                return look()
        return harness.wait_for(tried, timeout, f"{pattern!r} after {text!r}")

    @property
    def complaints(self):
        return [line for line in self.process.stdout.splitlines() + self.process.stderr.splitlines()
                if COMPLAINTS.search(line)]

    def close(self):
        self.process.kill()


def write_waypoints(path, items):
    """MISSION_ITEM_INT messages in the text form of MAVProxy and Mission Planner."""
    lines = ["QGC WPL 110"]
    for m in items:
        lines.append("\t".join(str(v) for v in (m.seq, m.current, m.frame, m.command, m.param1, m.param2, m.param3,
                                                0 if m.param4 != m.param4 else m.param4, f"{m.x / 1e7:.8f}",
                                                f"{m.y / 1e7:.8f}", m.z, m.autocontinue)))
    path.write_text("\n".join(lines) + "\n")
    return path
