# SPDX-License-Identifier: MIT
"""The page of `mavloom web` in a browser, fed with pymavlink's frames."""
import functools
import gzip
import http.server
import json
import pathlib
import re
import signal
import threading
import urllib.error
import urllib.request

import frames
import harness
import pytest
import routers
from browser import HTML, Server, chromium
from frames import mavlink

AXE = pathlib.Path(__file__).resolve().parents[3] / "build/web/node_modules/axe-core/axe.min.js"
TIMEOUT_MS = 1000 * harness.DEFAULT_TIMEOUT_S
MANY = 200


@pytest.fixture(scope="module")
def browser():
    with chromium() as started:
        yield started


@pytest.fixture(scope="module")
def shared_server():
    with Server() as started:
        yield started


@pytest.fixture
def server(shared_server):
    """Its latest values are those of `send_vehicle`, and the alarm about its text is there."""
    shared_server.send_vehicle()
    return shared_server


@pytest.fixture
def page(browser):
    """A tab, in whose page no script has failed at the end."""
    context = browser.new_context(viewport={"width": 1280, "height": 800}, accept_downloads=True)
    opened, faults = context.new_page(), []
    opened.set_default_timeout(TIMEOUT_MS)
    opened.on("pageerror", lambda error: faults.append(str(error)))
    opened.on("console", lambda message: "Content Security" in message.text and faults.append(message.text))
    opened.add_init_script("window.hits = 0; window.hit = () => { window.hits += 1; };")
    yield opened
    context.close()
    assert not faults, faults


def fetch(server, path, **headers):
    request = urllib.request.Request(server.url() + path, headers={k.replace("_", "-"): v for k, v in headers.items()})
    return urllib.request.urlopen(request, timeout=harness.DEFAULT_TIMEOUT_S)


@pytest.mark.short
@pytest.mark.parametrize("path", ["", "app.js", "app.css", "licences.txt"])
def test_files_of_the_page_are_compressed_and_known_again(path, server):
    plain, packed = fetch(server, path), fetch(server, path, Accept_Encoding="br, gzip")
    kept = pathlib.Path(__file__).resolve().parents[3] / "web/dist" / (path or "index.html")
    assert plain.read() == gzip.decompress(packed.read()) == kept.read_bytes()
    assert packed.headers["Content-Encoding"] == "gzip" and packed.headers["Cache-Control"] == "no-cache"
    assert "default-src 'self'" in packed.headers["Content-Security-Policy"]
    assert plain.headers["ETag"] != packed.headers["ETag"] and plain.headers["Content-Encoding"] is None
    with pytest.raises(urllib.error.HTTPError) as known:
        fetch(server, path, Accept_Encoding="gzip", If_None_Match=packed.headers["ETag"])
    assert known.value.code == 304 and known.value.headers["ETag"] == packed.headers["ETag"]


def row(page, topic):
    name = topic.split("/", 3)[3]
    return page.get_by_role("button", name=name, exact=True)


def field(page, name):
    """(value, unit, meaning) of a field of the open message."""
    line = page.locator("aside tr", has=page.get_by_role("rowheader", name=name, exact=True))
    return [cell.strip() for cell in line.first.locator("td").all_inner_texts()]


def test_the_overview_shows_vehicles_and_their_state(page, server):
    page.goto(server.url("#overview"))
    panel = page.get_by_role("article")
    panel.get_by_text("1/1").wait_for()
    shown = panel.inner_text()
    assert all(part in shown for part in ("Quadrotor", "Hold", "ARMED", "3D", "PX4")), shown


def test_a_message_opens_to_its_fields_with_units_and_names(page, server):
    page.goto(server.url("#messages"))
    row(page, "/1/1/ATTITUDE").click()
    page.get_by_role("rowheader", name="roll", exact=True).wait_for()
    assert field(page, "roll") == ["0.50000", "rad", "28.65°"]
    row(page, "/1/1/BATTERY_STATUS/1").click()
    page.get_by_text("/1/1/BATTERY_STATUS/1").wait_for()
    page.get_by_role("rowheader", name="battery_remaining").wait_for()
    assert field(page, "battery_remaining") == ["40", "%", ""]
    assert field(page, "[1]") == ["4100", "mV", "4.100 V"]
    assert field(page, "[2]") == ["65535", "", "unknown"] and field(page, "temperature")[2] == "25.00 °C"
    row(page, "/1/1/HEARTBEAT").click()
    page.get_by_role("rowheader", name="autopilot").wait_for()
    assert field(page, "autopilot") == ["12", "", "PX4"]
    assert field(page, "base_mode")[2] == "CUSTOM_MODE_ENABLED, SAFETY_ARMED"


def test_what_is_not_known_has_no_unit(page):
    with Server() as alone:
        alone.send(mavlink.MAVLink_heartbeat_message(2, 12, 0x81, 50593792, 4, 3))
        alone.send(mavlink.MAVLink_sys_status_message(0, 0, 0, 0, 16200, -1, 90, 0, 0, 0, 0, 0, 0))
        page.goto(alone.url())
        figures = page.get_by_role("article").locator(".pair")
        figures.get_by_text("16.20").wait_for()
        shown = {name: value for name, value in (text.split("\n") for text in figures.all_inner_texts())}
    assert shown["Voltage"] == "16.20V" and shown["Current"] == "–" and shown["Latitude"] == "–", shown


def test_a_name_that_was_never_heard_is_stated(page, server):
    page.goto(server.url("#messages?open=/9/9/NOTHING"))
    page.locator("aside").get_by_text("Nothing with this name was heard.").wait_for()


@pytest.mark.parametrize("state", ["#overview", "#messages?open=/1/1/BATTERY_STATUS/0",
                                   "#plots?open=/1/1/ATTITUDE&plot=/1/1/ATTITUDE~roll"])
def test_a_phone_needs_no_sideways_scrolling(page, server, state):
    page.set_viewport_size({"width": 360, "height": 740})
    page.goto(server.url(state))
    page.locator("main :is(table, article)").first.wait_for()
    page.locator(".badge.warning, .badge.error").wait_for()
    assert page.evaluate("document.documentElement.scrollWidth") == 360


def test_a_phone_shows_names(page, server):
    page.set_viewport_size({"width": 360, "height": 740})
    page.goto(server.url("#messages?open=/1/1/GPS_RAW_INT"))
    page.get_by_role("rowheader", name="satellites_visible").wait_for()
    cut = "all => all.filter(one => one.scrollWidth > one.clientWidth).map(one => one.innerText)"
    assert page.locator("aside th[scope=row]").evaluate_all(cut) == []
    page.keyboard.press("c")
    page.get_by_role("columnheader", name="Since", exact=True).wait_for()
    page.locator("button.name:visible").first.wait_for()
    widths = page.locator("button.name:visible").evaluate_all("all => all.map(one => one.clientWidth)")
    assert min(widths) > 110, "15 letters"
    assert page.locator("aside th[scope=row]").evaluate_all(cut) == []
    assert page.evaluate("document.documentElement.scrollWidth") == 360
    page.keyboard.press("j")
    ring = page.locator("button.name:focus").evaluate(
        "one => { const its = getComputedStyle(one); return [its.outlineOffset, its.paddingLeft].map(parseFloat); }")
    assert ring[1] >= -ring[0], "the ring around the focus does not touch the name"


def test_a_phone_shows_the_state_of_each_of_many_vehicles(page):
    with Server() as alone:
        for number in range(1, 13):
            alone.send_vehicle((number, 1))
        page.set_viewport_size({"width": 360, "height": 740})
        page.goto(alone.url())
        page.get_by_role("table", name="Vehicles").get_by_role("button", name="7/1").click()
        panel = page.get_by_role("article")
        panel.get_by_text("ARMED").wait_for()
        shown = panel.inner_text()
    assert all(part in shown for part in ("7/1", "3D", "Satellites", "Latitude")), shown
    assert page.evaluate("document.documentElement.scrollWidth") == 360


@pytest.mark.parametrize("width", [360, 1280])
def test_a_wrong_formula_in_the_address_is_shown_inside_its_plot(page, server, width):
    page.set_viewport_size({"width": width, "height": 740})
    page.goto(server.url("#plots?plot=/1/1/ATTITUDE~foo("))
    alert = page.get_by_role("alert")
    alert.get_by_text("at 1: ").wait_for()
    assert alert.locator("mark").inner_text() == "f"
    card, text = page.locator(".plot").bounding_box(), alert.bounding_box()
    assert text["x"] + text["width"] <= card["x"] + card["width"] <= width


def test_the_menu_of_columns_closes(page, server):
    page.goto(server.url("#messages"))
    menu = page.locator("details.chooser")
    opener = menu.locator("summary")
    opener.click()
    page.keyboard.press("Escape")
    page.locator("details.chooser:not([open]) > summary:focus").wait_for()
    opener.click()
    menu.get_by_label("Bytes").check()
    assert menu.get_attribute("open") is not None
    page.locator("tbody").click()
    page.locator("details.chooser:not([open])").wait_for(state="attached")


def test_rows_of_two_links_show_them_and_add_up(page):
    with Server() as alone, routers.UdpEnd(("127.0.0.1", alone.source)) as second:
        alone.send_vehicle()
        page.goto(alone.url("#messages?open=/1/1/ATTITUDE"))
        row(page, "/1/1/ATTITUDE").wait_for()
        for _ in range(20):
            second.send(routers.make(mavlink.MAVLink_attitude_message(5000, 0, 0, 0, 0, 0, 0)))
        for end in (alone.end, second):
            page.locator("tr.open").get_by_text(re.compile(rf"^ATTITUDE.*:{end.port}$")).wait_for()
        page.locator("aside .about", has_text=re.compile(r"[1-9]\d*\.\d /s")).wait_for()


def test_a_page_that_reads_too_slowly_states_it(page, server):
    told = "this connection is too slow: 7 messages were not sent so far, the oldest first"
    routes = []

    def take(route):
        route.connect_to_server()
        routes.append(route)
    page.route_web_socket(re.compile(r"^ws://"), take)
    page.goto(server.url("#overview"))
    page.locator(".badge.live").wait_for()
    routes[0].send(json.dumps({"op": "status", "level": 1, "id": "drops", "message": told}))
    page.get_by_role("status").get_by_text(told).wait_for()


def test_text_from_outside_stays_text(page, server):
    page.goto(server.url("#messages?open=/1/1/STATUSTEXT"))
    page.locator("aside").get_by_text(HTML).wait_for()
    page.goto(server.url("#messages?open=/1/1/PARAM_VALUE"))
    page.locator("aside").get_by_text("<img onerror=1>").wait_for()
    page.goto(server.url("#overview"))
    page.get_by_text(HTML).first.wait_for()  # as an alarm
    page.goto(server.url("#messages?cols=link,name"))
    page.locator(".c-link").get_by_text(HTML).first.wait_for()
    assert page.locator("img").count() == 0 and page.evaluate("window.hits") == 0


# ---- five tasks by keyboard alone

def test_keys_find_and_open_a_message(page, server):
    page.goto(server.url())
    page.keyboard.press("2")
    row(page, "/1/1/ATTITUDE").wait_for()
    page.keyboard.press("/")
    page.locator("#search:focus").wait_for()
    page.keyboard.type("gps_raw")
    page.keyboard.press("Enter")
    page.locator("button:focus", has_text="GPS_RAW_INT").wait_for()
    page.keyboard.press("Enter")
    page.get_by_role("rowheader", name="fix_type").wait_for()
    assert "open=/1/1/GPS_RAW_INT" in page.url and "q=gps_raw" in page.url
    page.keyboard.press("Escape")
    page.get_by_role("rowheader", name="fix_type").wait_for(state="detached")
    page.keyboard.press("Enter")
    page.get_by_role("button", name="Close the message").press("Enter")
    page.locator("[data-row]:focus", has_text="GPS_RAW_INT").wait_for()


def test_keys_freeze_and_compare(page, server):
    page.goto(server.url("#messages?open=/1/1/ATTITUDE"))
    page.get_by_role("rowheader", name="roll", exact=True).wait_for()
    page.keyboard.press("f")
    page.get_by_text("· frozen").wait_for()
    server.send_vehicle(roll=0.75)
    page.keyboard.press("c")
    page.get_by_role("columnheader", name="Since", exact=True).wait_for()
    line = page.locator("aside tr", has=page.get_by_role("rowheader", name="roll", exact=True))
    line.get_by_text("0.75000").wait_for()
    assert line.locator(".changed").inner_text() == "0.50000"
    server.send_vehicle(source=(9, 1))
    page.locator("tr.new").first.wait_for()
    page.keyboard.press("f")
    page.get_by_role("columnheader", name="Since", exact=True).wait_for(state="detached")


def test_keys_plot_a_field_and_stop_the_plot(page, server):
    page.goto(server.url("#messages?open=/1/1/ATTITUDE"))
    page.get_by_role("button", name=re.compile("^Plot pitch,")).focus()
    page.keyboard.press("Enter")
    page.get_by_text("pitch added to plot 1").wait_for()
    page.keyboard.press("3")
    page.locator(".uplot canvas").wait_for()
    legend = page.get_by_role("table", name="Series of plot 1")
    server.send_vehicle()
    legend.get_by_text("-0.25").first.wait_for()
    page.keyboard.press(" ")
    page.get_by_text("0 new points").wait_for()
    server.send_vehicle()
    page.get_by_text("1 new points").wait_for()
    page.keyboard.press("0")
    page.get_by_text("new points").wait_for(state="detached")


def test_keys_type_a_formula(page, server):
    page.goto(server.url("#plots"))
    page.keyboard.press("a")
    page.locator("#formula:focus").wait_for()
    page.keyboard.type("voltages[0]")
    page.get_by_role("alert").get_by_text("choose a topic").wait_for()
    page.keyboard.press("Shift+Tab")
    page.keyboard.type("/1/1/BATTERY_STATUS/0")
    page.keyboard.press("Tab")
    page.keyboard.type("voltage[0] / 1000")
    page.get_by_role("alert").get_by_text("at 1: BATTERY_STATUS has no field voltage; is it voltages?").wait_for()
    page.keyboard.press("Control+A")
    page.keyboard.type("(voltages[0] + voltages[1]) / 1000")
    page.keyboard.press("Enter")
    page.get_by_role("table", name="Series of plot 1").get_by_text("8.3").first.wait_for()
    page.keyboard.press("Escape")


def test_a_formula_takes_several_topics(page, server):
    page.goto(server.url("#plots"))
    page.keyboard.press("a")
    page.locator("#formula:focus").wait_for()
    page.keyboard.type("deg(/1/1/ATTITUDE.roll) + /1/1/BATTERY_STATUS/1.battery_remaining")
    page.keyboard.press("Enter")
    legend = page.get_by_role("table", name="Series of plot 1")
    server.send_vehicle()
    legend.get_by_text("68.6").first.wait_for()  # 0.5 rad are 28.648 degrees
    server.send(mavlink.MAVLink_attitude_message(5000, 0, 0, 0, 0, 0, 0))
    legend.get_by_text("40.000").first.wait_for()


def test_what_is_not_known_is_a_gap_of_the_plot(page, server):
    page.goto(server.url("#plots?plot=/1/1/BATTERY_STATUS/0~voltages[1]!/1/1/BATTERY_STATUS/0~voltages[2]"))
    legend = page.get_by_role("table", name="Series of plot 1")
    legend.get_by_text("4100").first.wait_for()
    values = legend.locator("tr", has_text="voltages[2]").locator("td.number").all_inner_texts()
    assert values == ["–", "–", "–"], "UINT16_MAX: the battery has no third cell"


def test_keys_list_themselves_and_change_colours(page, server):
    page.goto(server.url())
    page.keyboard.press("?")
    page.get_by_role("dialog").get_by_text("freeze the table").wait_for()
    page.keyboard.press("Escape")
    page.get_by_role("dialog").wait_for(state="hidden")
    page.keyboard.press("t")
    assert page.evaluate("document.documentElement.dataset.theme") == "light"


# ---- the rest

def test_the_address_keeps_the_state(page, server):
    state = "#plots?q=att&sort=-hz&cols=name,hz&open=/1/1/ATTITUDE&span=30&plot=/1/1/ATTITUDE~deg(roll)~1~2~3"
    page.goto(server.url(state))
    page.get_by_role("table", name="Series of plot 1").get_by_text("60.2").first.wait_for()
    assert page.url.endswith(state)
    page.get_by_role("link", name="Messages").click()
    page.get_by_role("columnheader", name="Rate /s").wait_for()
    assert page.get_by_role("columnheader").all_inner_texts()[:3] == ["Message", "new or silent", "Rate /s"]
    page.go_back()
    page.locator(".uplot").wait_for()


def test_plots_have_the_same_room_for_numbers_as_long_as_it_is_needed(page, server):
    lefts = "all => all.map(each => each.getBoundingClientRect().left)"
    state = "#plots?plot=/1/1/ATTITUDE~roll"
    page.goto(server.url(state))
    page.locator(".u-over").wait_for()
    short = page.locator(".u-over").evaluate_all(lefts)
    page.goto(server.url(f"{state}&plot=/1/1/ATTITUDE~roll~0~-2000000"))
    harness.wait_for(lambda: (both := page.locator(".u-over").evaluate_all(lefts))[1:] and
                     both[0] == both[1] > short[0], what="two plots with room for long numbers")
    page.goto(server.url(state))
    harness.wait_for(lambda: page.locator(".u-over").evaluate_all(lefts) == short, what="the room of before")


def test_a_plot_is_saved_as_csv_and_png(page, server):
    page.goto(server.url("#plots?plot=/1/1/ATTITUDE~deg(roll)!/1/1/BATTERY_STATUS/0~voltages[0]~1~0.001"))
    page.get_by_role("table", name="Series of plot 1").get_by_text("4.2").first.wait_for()
    saved = {}
    for kind in ("CSV", "PNG"):
        with page.expect_download() as download:
            page.get_by_role("button", name=kind).click()
        saved[kind] = pathlib.Path(download.value.path()).read_bytes()
    lines = saved["CSV"].decode().splitlines()
    assert lines[0] == "time_s,/1/1/ATTITUDE deg(roll),/1/1/BATTERY_STATUS/0 voltages[0] * 0.001"
    assert {"4.2"} <= {line.split(",")[2] for line in lines[1:]}
    assert saved["PNG"].startswith(b"\x89PNG")


def test_a_field_is_dragged_into_a_plot(page, server):
    page.goto(server.url("#plots?open=/1/1/ATTITUDE&plot=/1/1/ATTITUDE~roll"))
    page.get_by_role("table", name="Series of plot 1").get_by_text("roll").first.wait_for()
    page.get_by_role("rowheader", name="pitch", exact=True).drag_to(page.locator(".chart"))
    page.get_by_role("table", name="Series of plot 1").get_by_text("pitch").first.wait_for()
    assert page.url.endswith("plot=/1/1/ATTITUDE~roll!/1/1/ATTITUDE~pitch")


def test_in_the_demo_a_vehicle_takes_off_and_climbs_in_a_plot(page, spawn, run):
    """As a person does it: open the page, see the vehicle, plot a number, take off."""
    demo = spawn("demo", "--ports", "free")
    url = demo.wait_output(r"open (http://\S+)")[1]
    page.goto(url)
    page.get_by_role("article").get_by_text("Hold").wait_for()
    for hop in ("vehicle", "router", "listener", "relay", "ground station"):
        page.get_by_role("listitem").filter(has_text=hop).get_by_text("nothing lost").first.wait_for()
    page.get_by_role("link", name="Messages").click()
    row(page, "/1/1/GLOBAL_POSITION_INT").click()
    page.get_by_role("button", name=re.compile("^Plot relative_alt,")).click()
    page.get_by_role("link", name="Plots").click()
    simulator = demo.wait_output(r"mavloom ctl (\S+) takeoff")[1]
    harness.wait_for(lambda: run("ctl", simulator, "takeoff", "5").status == 0, what="a vehicle that is healthy")
    legend = page.get_by_role("table", name="Series of plot 1")
    harness.wait_for(lambda: float(legend.locator("td.strong").inner_text() or 0) > 4000, what="4 m, in mm")


@pytest.mark.parametrize("scheme", ["dark", "light"])
def test_axe_finds_nothing_serious(page, server, scheme):
    if not AXE.is_file():
        pytest.skip(f"{AXE} is missing: ./run test installs it, if a registry can be reached")
    page.emulate_media(color_scheme=scheme)
    page.add_init_script(path=AXE)
    for state in ("#overview", "#messages?open=/1/1/BATTERY_STATUS/0",
                  "#plots?open=/1/1/ATTITUDE&plot=/1/1/ATTITUDE~roll"):
        page.goto("about:blank")
        page.goto(server.url(state))
        page.get_by_text("live").wait_for()
        page.locator("main :is(table, article)").first.wait_for()
        found = page.evaluate("axe.run().then((all) => all.violations.map(({id, impact, nodes}) => "
                              "[impact, id, nodes.map((node) => node.html.slice(0, 200) + node.failureSummary)]))")
        assert not [fault for fault in found if fault[0] in ("serious", "critical", "moderate")], f"{state}: {found}"


def test_a_lost_server_is_shown_and_found_again(page):
    with Server() as alone:
        alone.send_vehicle()
        page.goto(alone.url("#messages?open=/1/1/ATTITUDE&plot=/1/1/ATTITUDE~roll"))
        page.get_by_role("rowheader", name="roll", exact=True).wait_for()
        alone.stop()
        page.get_by_text("Connection lost").wait_for()
        assert field(page, "roll")[0] == "0.50000", "old values stay"
        assert page.locator("tr.silent").count() == 0, "nothing is known of the vehicle"
        alone.start()
        alone.send_vehicle(roll=0.75)
        page.get_by_text("Connection lost").wait_for(state="detached")
        page.locator("aside").get_by_text("0.75000").wait_for()
        row(page, "/1/1/HEARTBEAT").wait_for()
        alone.running[-1].process.send_signal(signal.SIGSTOP)  # as if a cable was out
        page.get_by_text("Connection lost").wait_for()
        alone.running[-1].process.send_signal(signal.SIGCONT)
        page.get_by_text("Connection lost").wait_for(state="detached")


def test_the_end_of_a_recording_is_no_fault(page, spawn):
    web = spawn("web", frames.FLIGHT, "--listen", "127.0.0.1:0")
    page.goto(web.wait_output(r"open (http://\S+),", stream="err")[1])
    page.locator(".links .ended").wait_for()
    assert page.locator(".links .down").count() == 0 and page.locator(".hop.down").count() == 0


def test_without_a_ring_the_page_states_how_to_see_messages(page, spawn, udp_port):
    name = f"page-{udp_port()}"
    router = spawn("route", f"udpin://127.0.0.1:{udp_port()}", "--name", name, "--web", "127.0.0.1:0")
    page.goto(router.wait_output(r"open (http://\S+)")[1])
    advice = f"{name} has no ring, so its messages are not shown: start it with --ring {name}"
    page.locator("section", has_text="Vehicles").get_by_text(advice).wait_for()
    assert page.get_by_text("HEARTBEAT").count() == 0, "it is not known whether there is a vehicle"
    page.get_by_role("link", name="Messages").click()
    page.locator("main").get_by_text(advice).wait_for()
    assert page.get_by_text("not reported").count() == 0


def test_a_full_list_of_alarms_counts_those_that_left(page):
    with Server() as noisy:
        for number in range(300):
            noisy.send(mavlink.MAVLink_statustext_message(3, f"fault {number}".encode()))
        page.goto(noisy.url())
        page.get_by_text("44 older ones have left the list").wait_for()


@pytest.fixture
def foreign_origin(tmp_path):
    """The origin of another server's page."""
    (tmp_path / "index.html").write_text("<title>of another program</title>")
    folder = functools.partial(http.server.SimpleHTTPRequestHandler, directory=tmp_path)
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), folder) as foreign:
        threading.Thread(target=foreign.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{foreign.server_port}"
        foreign.shutdown()


def test_pages_of_allowed_origins_read_answers(page, spawn, foreign_origin):
    def place_of(*options):
        web = spawn("web", frames.FLIGHT, "--listen", "127.0.0.1:0", *options)
        return web.wait_output(r"open (http://\S+),", stream="err")[1]

    def read(place):
        return page.evaluate("url => fetch(`${url}/api/v1/systems`).then(got => got.json(), () => 'refused')", place)
    allowing, other = place_of("--origin", foreign_origin), place_of()
    page.goto(foreign_origin)
    systems = harness.wait_for(lambda: read(allowing), what="the systems of the recording")
    assert {system["sys"] for system in systems} == {1, 255}
    assert read(other) == "refused"


def test_a_page_opened_with_the_token_reads_and_others_do_not(page, spawn, tmp_path):
    (tmp_path / "token").write_text("0123456789abcdef\n")
    (tmp_path / "token").chmod(0o600)
    web = spawn("web", frames.FLIGHT, "--listen", "127.0.0.1:0", "--token-file", tmp_path / "token")
    place = web.wait_output(r"open (http://[^/]+)/\?token=TOKEN,", stream="err")[1]
    assert page.goto(place).status == 401
    page.goto(f"{place}/?token=0123456789abcdef#messages?q=attitude")
    row(page, "/1/1/ATTITUDE").wait_for()
    page.goto(f"{place}/#overview")  # the browser has a cookie now
    page.get_by_role("heading", name=re.compile("^Vehicles")).wait_for()


def test_only_visible_rows_of_many_vehicles_are_in_the_document(page):
    with Server() as swarm:
        for system in range(1, MANY + 1):
            swarm.send_vehicle(source=(system, 1))
        page.goto(swarm.url("#overview"))
        page.get_by_role("heading", name=f"Vehicles {MANY}").wait_for()
        assert page.locator("tbody tr").count() < 60
        page.goto(swarm.url("#messages?q=attitude&sort=-source"))
        page.get_by_text(f"{MANY} of {7 * MANY:,} rows").wait_for()
        assert page.locator("tbody tr").count() < 60
        page.keyboard.press("j")
        page.keyboard.press("End")
        page.locator("tr:has(button:focus)").get_by_text("1/1", exact=True).wait_for()
