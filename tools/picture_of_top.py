#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes docs/pictures/top.png: two screens of `mavloom top` on three simulated vehicles that fly. Takes 80 s.

    build/venv/bin/python tools/picture_of_top.py docs/pictures/top.png

It needs the release build, tmux, Debian's chromium, and playwright, which ./run setup installs."""
import html
import pathlib
import re
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests" / "system"))
import routers  # noqa: E402
import terminals  # noqa: E402
from playwright import sync_api  # noqa: E402

PROGRAM = ROOT / "build/release/bin/mavloom"
COLUMNS, LINES, FLIES_S = 100, 22, 65
ORDERS = {8: "takeoff 20", 20: "goto 47.3982 8.5456 30", 32: "goto 47.3978 8.5461 15", 44: "goto 47.3974 8.5456 35",
          56: "goto 47.3978 8.5451 20"}
# Colours of the terminal, by the numbers of SGR 30 to 37.
COLOURS = ["#555", "#e06c6c", "#63cf63", "#e5c452", "#6b9bd8", "#c678dd", "#5fcfcf", "#d4d4d4"]
PAGE = """<meta charset="utf-8"><style>
body { margin: 0; background: #16171d; color: #d4d4d4; font: 14px "DejaVu Sans Mono", "DejaVu Sans"; }
#all { display: inline-block; padding: 10px; }
div.screen { margin-bottom: 16px; } div.screen:last-child { margin-bottom: 0; }
div.line { height: 18px; white-space: nowrap; }
i { display: inline-block; width: 8.43px; height: 18px; line-height: 18px; font-style: normal; white-space: pre;
    overflow: visible; vertical-align: top; }
</style><div id="all">"""


def style_of(codes):
    """The style of a character, of the SGR codes since the last reset."""
    style = {"color": COLOURS[7], "background": "transparent"}
    for code in codes:
        if code == "1":
            style["font-weight"] = "bold"
            style["color"] = "#fff" if style["color"] == COLOURS[7] else style["color"]
        elif code == "2":
            style["color"] = "#888"
        elif 30 <= int(code) <= 37:
            style["color"] = COLOURS[int(code) - 30]
        elif code == "39":
            style["color"] = COLOURS[7]
        elif code == "90":
            style["color"] = "#888"
    if "7" in codes:
        style |= {"background": "#d4d4d4", "color": "#16171d"}
    return ";".join(f"{key}:{value}" for key, value in style.items())


def html_of(screen):
    """Each character has a cell of its own, because other fonts may lend it."""
    text, codes = '<div class="screen">', []
    for line in screen.splitlines():
        text += '<div class="line">'
        for sgr, character in re.findall(r"\x1b\[([\d;]*)m|(.)", line):
            if character:
                text += f'<i style="{style_of(codes)}">{html.escape(character)}</i>'
            for code in [] if character else (sgr or "0").split(";"):
                codes = [] if code in ("", "0") else codes + [code]
        text += "</div>"
    return text + "</div>"


def screens():
    """The messages of a vehicle, then an open one."""
    port = routers.udp_port()
    orders = "".join(f'[[event]]\nat = "{at}s"\ndo = "{order}"\n' for at, order in ORDERS.items())
    with tempfile.TemporaryDirectory() as name, terminals.opened(pathlib.Path(name), PROGRAM, "top") as start:
        scenario = pathlib.Path(name, "flight.toml")
        scenario.write_text(f"[[vehicle]]\ncount = 3\n{orders}")
        sim = subprocess.Popen([PROGRAM, "sim", scenario, "--to", f"udpout://127.0.0.1:{port}", "--name", "picture"])
        try:
            terminal = start(f"udpin://127.0.0.1:{port}", columns=COLUMNS, lines=LINES, env=[("LC_ALL", "C.UTF-8"),
                                                                                            ("TERM", "screen")])
            terminal.wait_for(r"LOCAL_POSITION_NED +\d")
            terminal.type("-l", "/local_position")
            terminal.type("Enter")
            terminal.type("Enter")
            for _ in "xyz":  # from the time to the height
                terminal.type("Down")
            time.sleep(FLIES_S)
            opened = terminal.call("capture-pane", "-p", "-e")
            terminal.type("Escape")
            terminal.type("Escape")
            time.sleep(1)
            return [terminal.call("capture-pane", "-p", "-e"), opened]
        finally:
            sim.terminate()
            sim.wait()


def main():
    text = PAGE + "".join(map(html_of, screens())) + "</div>"
    with sync_api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path="/usr/bin/chromium", args=["--no-sandbox"])
        page = browser.new_page()
        page.set_content(text)
        page.locator("#all").screenshot(path=sys.argv[1])
        browser.close()


if __name__ == "__main__":
    main()
