#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""bench hil: `mavloom sim --hil px4` drives a real PX4 as fast as PX4 can run, in turns with a responder that computes
nothing (bench/hil/responder.cpp) and so is the upper bound. Both step at 250 Hz of flight.

--px4 names PX4's source folder, built as px4_sitl_default, or that build's folder. Without it, a program that computes
for --answer-us and then answers takes PX4's place (bench/hil/autopilot.cpp). If it answers at once, the cost of the
simulators remains. As root, PX4 runs as the user of --user, so that its threads have no real-time priority. At the end,
one run at real time shows how much of a core the simulator takes."""
import argparse
import contextlib
import json
import mmap
import os
import pathlib
import pwd
import re
import signal
import statistics
import struct
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
STEP_S = 0.004
BOOT_LIMIT_S = 60


def px4_build(folder):
    """The folder of PX4's build with bin/px4 and etc."""
    for build in (folder / "build" / "px4_sitl_default", folder):
        if (build / "bin" / "px4").is_file():
            return build
    raise SystemExit(f"{folder}: neither it nor its build/px4_sitl_default has bin/px4")


def cpu_seconds(pid):
    """CPU time of a process, in user mode and in the kernel. Both are sampled; their sum is exact."""
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    user, system = int(fields[11]), int(fields[12])
    tasks = pathlib.Path(f"/proc/{pid}/task").glob("*/schedstat")
    total = sum(int(task.read_text().split()[0]) for task in tasks) / 1e9
    share = user / max(1, user + system)
    return total * share, total * (1 - share)


def resident_mb(pid):
    return int(re.search(r"VmRSS:\s+(\d+)", pathlib.Path(f"/proc/{pid}/status").read_text())[1]) / 1024


def wait_for_answers(simulator, processes):
    deadline = time.monotonic() + BOOT_LIMIT_S
    while not simulator.answered():
        for process in processes:
            if process.poll() is not None:
                raise SystemExit(f"{process.args[0]} ended with {process.returncode}")
        if time.monotonic() > deadline:
            raise SystemExit(f"{simulator.name} got no answer in {BOOT_LIMIT_S} s")
        time.sleep(0.05)


def end(process):
    """Ends a process and what it started. PX4 must not outlive its simulator: it would take a whole core."""
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()


# ---- autopilots

class Px4:
    name = "PX4"

    def __init__(self, folder, user):
        self.build, self.user = px4_build(folder), user if os.geteuid() == 0 else None

    def start(self, port, folder):
        work = folder / "px4"
        work.mkdir()
        environment = {**os.environ, "PX4_SIM_MODEL": "none_iris", "PX4_SIM_SPEED_FACTOR": "10"}
        if self.user:
            owner = pwd.getpwnam(self.user)
            folder.chmod(0o755)
            os.chown(work, owner.pw_uid, owner.pw_gid)
            environment["HOME"] = str(work)
        command = [self.build / "bin" / "px4", "-d", "-i", str(port - 4560), "-w", work, self.build / "etc"]
        return subprocess.Popen(command, cwd=work, env=environment, user=self.user, start_new_session=True,
                                stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


class Echo:
    def __init__(self, tools, answer_us):
        self.program, self.answer_us = tools / "hil_autopilot", answer_us
        self.name = f"an autopilot that answers after {answer_us} us"

    def start(self, port, folder):
        return subprocess.Popen([self.program, str(port), str(self.answer_us)], start_new_session=True)


# ---- simulators

class Responder:
    name = "responder"

    def __init__(self, tools):
        self.program = tools / "hil_responder"

    def start(self, port, folder):
        path = folder / "answered"
        path.write_bytes(bytes(8))
        with path.open("r+b") as file:
            self.counter = mmap.mmap(file.fileno(), 8)
        return subprocess.Popen([self.program, str(port), path], start_new_session=True)

    def answered(self):
        return struct.unpack("<Q", self.counter[:8])[0]


class Mavloom:
    name = "mavloom"

    def __init__(self, program, speed="max"):
        self.program, self.speed, self.label = program, speed, f"bench-hil-{os.getpid()}"

    def start(self, port, folder):
        command = [self.program, "sim", "--quiet", "--hil", f"px4=tcpin://127.0.0.1:{port}", "--speed", self.speed,
                   "--name", self.label]
        return subprocess.Popen(command, start_new_session=True, stdout=subprocess.DEVNULL)

    def answered(self):
        done = subprocess.run([self.program, "ctl", self.label, "state", "--json"], capture_output=True, text=True)
        rows = [json.loads(line) for line in done.stdout.splitlines()]
        return sum(row["answered"] for row in rows if row.get("kind") == "hil")


def measure(simulator, autopilot, options):
    """One run: steps a second, and what they cost."""
    with tempfile.TemporaryDirectory() as folder, contextlib.ExitStack() as stack:
        folder = pathlib.Path(folder)
        ours = simulator.start(options.port, folder)
        stack.callback(end, ours)
        time.sleep(0.2)
        theirs = autopilot.start(options.port, folder)
        stack.callback(end, theirs)
        wait_for_answers(simulator, (ours, theirs))
        time.sleep(options.warm_up)
        began, steps = time.monotonic(), simulator.answered()
        before = [cpu_seconds(process.pid) for process in (ours, theirs)]
        time.sleep(options.seconds)
        took, steps = time.monotonic() - began, simulator.answered() - steps
        after = [cpu_seconds(process.pid) for process in (ours, theirs)]
        user, system = [1e6 * (b - a) / steps for a, b in zip(before[0], after[0])]
        return {"simulator": simulator.name, "autopilot": autopilot.name, "steps_s": steps / took,
                "times_real_time": steps * STEP_S / took, "user_us": user, "system_us": system,
                "resident_mb": resident_mb(ours.pid), "autopilot_us": 1e6 * (sum(after[1]) - sum(before[1])) / steps}


COLUMNS = (("simulator", "", "{}"), ("steps_s", "steps/s", "{:.0f}"), ("times_real_time", "x real time", "{:.2f}"),
           ("user_us", "user us/step", "{:.1f}"), ("system_us", "kernel us/step", "{:.1f}"),
           ("resident_mb", "resident MB", "{:.1f}"), ("autopilot_us", "autopilot us/step", "{:.0f}"))


def show(row, options):
    print(json.dumps(row) if options.json else
          "  ".join(form.format(row[key]).rjust(max(len(title), 9)) for key, title, form in COLUMNS), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/bin/mavloom")
    parser.add_argument("--tools", type=pathlib.Path, default=ROOT / "build/release/bench/bin")
    parser.add_argument("--px4", type=pathlib.Path, metavar="FOLDER", help="PX4's source or build folder")
    parser.add_argument("--user", default="nobody", help="as root: who runs PX4")
    parser.add_argument("--answer-us", type=int, default=0, help="without --px4: how long a step takes the autopilot")
    parser.add_argument("--port", type=int, default=4560, help="4560 + PX4's instance")
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--warm-up", type=float, default=5)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--quick", action="store_true", help="short turns: checks that it works, not how fast it is")
    parser.add_argument("--json", action="store_true", help="print one JSON object per line")
    options = parser.parse_args()
    if options.quick:
        options.seconds, options.warm_up, options.rounds = 2, 0.5, 1
    tools = options.tools.resolve()
    autopilot = Px4(options.px4.resolve(), options.user) if options.px4 else Echo(tools, options.answer_us)
    sides = [Mavloom(options.program.resolve()), Responder(tools)]
    if not options.json:
        print(f"{autopilot.name}, {options.rounds} pairs of {options.seconds:g} s, load {os.getloadavg()[0]:.1f}")
        print("  ".join(title.rjust(max(len(title), 9)) for _, title, _ in COLUMNS))
    rows = {side.name: [] for side in sides}
    for number in range(options.rounds):
        for side in sides[::1 if number % 2 else -1]:
            rows[side.name].append(measure(side, autopilot, options))
            show(rows[side.name][-1], options)
    ratios = [ours["steps_s"] / bare["steps_s"] for ours, bare in zip(*rows.values())]
    ratio = statistics.median(ratios)
    beyond = statistics.median(row["user_us"] for row in rows["mavloom"])
    paced = measure(Mavloom(options.program.resolve(), "1"), autopilot, options)
    core = (paced["user_us"] + paced["system_us"]) * paced["steps_s"] / 1e6
    if options.json:
        print(json.dumps({"bench": "hil speed", "value": ratio, "unit": "times", "user_us": beyond, "core": core}))
    else:
        show(paced, options)
        print(f"speed against the responder: median {ratio:.3f}, lowest {min(ratios):.3f}, highest {max(ratios):.3f}; "
              f"user CPU {beyond:.1f} us a step; {100 * core:.2f} % of a core at real time")
    return 0


if __name__ == "__main__":
    sys.exit(main())
