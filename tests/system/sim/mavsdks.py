# SPDX-License-Identifier: MIT
"""MAVSDK as a client, in a process of its own (its library is native, and keeps threads): it runs the steps of
mavsdk_steps.py and prints their answers as lines of JSON."""
import contextlib
import json
import pathlib
import select
import subprocess
import sys
import tempfile
import time

import pytest

import harness

STEPS = pathlib.Path(__file__).with_name("mavsdk_steps.py")
ANSWER_TIMEOUT_S = 100


class Client:
    def __init__(self, url, step, arguments):
        self._errors = tempfile.TemporaryFile("w+")
        self.process = subprocess.Popen([sys.executable, "-u", str(STEPS), url, step, json.dumps(arguments)],
                                        stdout=subprocess.PIPE, stdin=subprocess.PIPE, stderr=self._errors, text=True,
                                        env=harness.environment())

    def answer(self, timeout=ANSWER_TIMEOUT_S):
        """The next answer. MAVSDK's own log lines go to stdout, too: they are no JSON objects."""
        deadline, kept = time.monotonic() + timeout, []
        while True:
            left = deadline - time.monotonic()
            assert left > 0, f"MAVSDK did not answer within {timeout} s: {kept[-20:]}{self.errors()}"
            if not select.select([self.process.stdout], [], [], left)[0]:
                continue
            line = self.process.stdout.readline()
            assert line, f"MAVSDK ended with {self.process.wait()}: {kept[-20:]}{self.errors()}"
            if line.startswith("{"):
                answer = json.loads(line)
                if "cannot" in answer:
                    pytest.skip(f"MAVSDK's library does not load here: {answer['cannot']}")
                return answer
            kept.append(line)

    def proceed(self):
        """Lets a waiting step continue."""
        self.process.stdin.write("\n")
        self.process.stdin.flush()

    def errors(self):
        self._errors.seek(0)
        return self._errors.read()[-4000:]

    def end(self):
        self.process.kill()
        self.process.wait()
        self.process.stdout.close()
        with contextlib.suppress(BrokenPipeError):
            self.process.stdin.close()
        self._errors.close()


@contextlib.contextmanager
def started(port, step, *arguments, url="udpout://127.0.0.1:{}"):
    client = Client(url.format(port), step, arguments)
    try:
        yield client
    finally:
        client.end()


def run(port, step, *arguments, **options):
    """The one answer of a step."""
    with started(port, step, *arguments, **options) as client:
        return client.answer()
