#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""bench page: what the page of `mavloom web` costs in Debian's Chromium, and how soon it shows something.

demo: from the start of `mavloom demo` to the first message of the vehicle at a WebSocket client.
first: from the navigation to the first live value, with 6 vehicles.
many: processor time of all of the browser's processes less those of an empty tab, the TaskDuration of the page
(DevTools protocol), and tasks of more than 100 ms, while 200 vehicles send.
heap: how much the page's heap has grown after --minutes, each time after a garbage collection.

Each line has the load of the machine, which is that of other programs too."""
import argparse
import asyncio
import contextlib
import json
import os
import pathlib
import re
import statistics
import subprocess
import sys
import time

import websockets
from playwright.sync_api import sync_playwright
from web import ROOT, Server, frames_of

CASES = ["demo", "first", "many", "heap"]
MESSAGE = "#messages?open=/1/1/ATTITUDE"
VIEWS = {"overview": ("#overview", "article .mode strong"), "messages": (MESSAGE, "aside button.value")}
# Notes when an element is there for the first time, in ms since the navigation.
WATCH = """new MutationObserver(() => {
    if (window.first === undefined && document.querySelector(%s)) window.first = performance.now();
}).observe(document, {subtree: true, childList: true});"""
WATCH_TASKS = """() => { window.tasks = []; new PerformanceObserver((list) => {
    window.tasks.push(...list.getEntries().map((task) => Math.round(task.duration)));
}).observe({entryTypes: ["longtask"]}); }"""


def report(options, **values):
    values["load"] = round(os.getloadavg()[0], 1)
    print(json.dumps(values) if options.json else
          "  ".join(f"{key} {value}" for key, value in values.items()), flush=True)


@contextlib.contextmanager
def vehicles(options, count):
    """A server, and vehicles that send to it. With more than 100, each sends 13 messages/s."""
    profile = ["--profile", "lite"] if count > 100 else []
    with Server(options.program) as server:
        sim = subprocess.Popen([options.program, "sim", *server.sim_options, "--vehicles", str(count), *profile,
                                "--name", f"bench-{server.port}"],
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(5)
        try:
            yield server
        finally:
            sim.terminate()
            sim.wait()


@contextlib.contextmanager
def chromium():
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path="/usr/bin/chromium", args=["--no-sandbox"])
        yield browser
        browser.close()


def open_page(browser):
    return browser.new_context(viewport={"width": 1400, "height": 900}).new_page()


async def first_message(url):
    async with websockets.connect(f"ws://{url}", subprotocols=["foxglove.websocket.v1"], max_size=None) as client:
        async for got in client:
            if isinstance(got, bytes):
                return
            for channel in json.loads(got).get("channels", []):
                if channel["topic"] == "/1/1/ATTITUDE":
                    await client.send(json.dumps(
                        {"op": "subscribe", "subscriptions": [{"id": 1, "channelId": channel["id"]}]}))


def demo(options):
    took = []
    for _ in range(10):
        begin = time.monotonic()
        command = [options.program, "demo", "--ports", "free", "--python", sys.executable]
        with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as running:
            line = next(text for text in running.stderr if "open http" in text)
            asyncio.run(first_message(re.search(r"http://(\S+)", line)[1]))
            took.append(time.monotonic() - begin)
            running.terminate()
    report(options, case="demo", median_s=round(statistics.median(took), 2), longest_s=round(max(took), 2))


def first(options):
    with vehicles(options, 6) as server, chromium() as browser:
        for name, (state, selector) in VIEWS.items():
            took = []
            for _ in range(11):
                page = open_page(browser)
                page.add_init_script(WATCH % json.dumps(selector))
                page.goto(f"http://127.0.0.1:{server.port}/{state}")
                page.locator(selector).first.wait_for()
                took.append(page.evaluate("window.first"))
                page.context.close()
            report(options, case="first", view=name, median_ms=round(statistics.median(took)),
                   longest_ms=round(max(took)))


def cpu_of_browsers():
    """Of all Chromium processes below this one, in seconds."""
    parents, used = {}, {}
    for stat in pathlib.Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError):
            name, fields = stat.read_text().split("(", 1)[1].rsplit(") ", 1)
            fields = fields.split()
            parents[int(stat.parent.name)] = int(fields[1])
            used[int(stat.parent.name)] = (int(fields[11]) + int(fields[12])) * name.startswith("chrom")

    def is_below(process):
        return process == os.getpid() or (process in parents and is_below(parents[process]))
    return sum(ticks for process, ticks in used.items() if is_below(process)) / os.sysconf("SC_CLK_TCK")


def share(options, browser, url):
    """(percent of a core of the browser, TaskDuration in percent, long tasks) of one tab."""
    page = open_page(browser)
    page.goto(url)
    time.sleep(5)
    page.evaluate(WATCH_TASKS)
    devtools = page.context.new_cdp_session(page)
    devtools.send("Performance.enable")

    def tasks():
        metrics = devtools.send("Performance.getMetrics")["metrics"]
        return next(metric["value"] for metric in metrics if metric["name"] == "TaskDuration")
    cpu, task, begin = cpu_of_browsers(), tasks(), time.monotonic()
    time.sleep(options.seconds)
    took = (time.monotonic() - begin) / 100
    result = (cpu_of_browsers() - cpu) / took, (tasks() - task) / took, page.evaluate("window.tasks")
    page.context.close()
    return result


def many(options):
    with vehicles(options, 200) as server, chromium() as browser:
        empty = share(options, browser, "about:blank")[0]
        for name, (state, _) in VIEWS.items():
            before, begin = frames_of(server)[1], time.monotonic()
            cpu, task, long = share(options, browser, f"http://127.0.0.1:{server.port}/{state}")
            rate = (frames_of(server)[1] - before) / (time.monotonic() - begin)
            report(options, case="many", view=name, messages_per_s=round(rate), browser_percent=round(cpu - empty, 1),
                   empty_tab_percent=round(empty, 1), task_percent=round(task, 1),
                   tasks_over_100_ms=[ms for ms in long if ms > 100])


def heap(options):
    with vehicles(options, 6) as server, chromium() as browser:
        page = open_page(browser)
        page.goto(f"http://127.0.0.1:{server.port}/{MESSAGE}&plot=/1/1/ATTITUDE~deg(roll)")
        devtools = page.context.new_cdp_session(page)

        def used_mb():
            devtools.send("HeapProfiler.collectGarbage")
            return devtools.send("Runtime.getHeapUsage")["usedSize"] / 1e6
        page.wait_for_timeout(20_000)
        begin = used_mb()
        for minute in range(1, options.minutes + 1):
            page.wait_for_timeout(60_000)
            now = used_mb()
            report(options, case="heap", minute=minute, heap_mb=round(now, 2), grown_mb=round(now - begin, 2))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/bin/mavloom")
    parser.add_argument("--seconds", type=float, default=30, help="for many")
    parser.add_argument("--minutes", type=int, default=3, help="for heap")
    parser.add_argument("--case", action="append", choices=CASES, help="default: all; may be repeated")
    parser.add_argument("--json", action="store_true", help="print one JSON object per line")
    options = parser.parse_args()
    options.program = options.program.resolve()
    for case in options.case or CASES:
        {"demo": demo, "first": first, "many": many, "heap": heap}[case](options)


if __name__ == "__main__":
    sys.exit(main())
