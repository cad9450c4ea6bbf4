# SPDX-License-Identifier: MIT
"""mavloom check: effective values with their origin, errors with file and line."""
import json
import re

import pytest

import harness

pytestmark = pytest.mark.short

GOOD = """\
[router]
dedup_ms = 5
[[endpoint]]
url = "udpin://0.0.0.0:14550?idle=2"
mtu = 0
"""


def values(done):
    return {(v["section"], v["endpoint"], v["key"]): v for v in map(json.loads, done.lines)}


def test_shows_values_and_where_they_came_from(run, tmp_path):
    path = tmp_path / "router.toml"
    path.write_text(GOOD)
    done = run("check", path, "--json", env={"MAVLOOM_ROUTER_ROUTE_TIMEOUT": "2m"})

    assert done.status == 0, done
    found = values(done)
    endpoint = "udpin://0.0.0.0:14550"
    assert found["router", None, "dedup_ms"] == {"section": "router", "endpoint": None, "key": "dedup_ms", "value": "5",
                                                 "origin": "file", "file": str(path), "line": 2, "variable": None}
    assert found["router", None, "route_timeout"] == {"section": "router", "endpoint": None, "key": "route_timeout",
                                                      "value": "2m", "origin": "environment", "file": None,
                                                      "line": None, "variable": "MAVLOOM_ROUTER_ROUTE_TIMEOUT"}
    assert (found["endpoint", endpoint, "idle"]["value"], found["endpoint", endpoint, "idle"]["line"]) == ("2", 4)
    assert (found["endpoint", endpoint, "mtu"]["value"], found["endpoint", endpoint, "mtu"]["line"]) == ("0", 5)
    assert (found["endpoint", endpoint, "max_peers"]["value"],
            found["endpoint", endpoint, "max_peers"]["origin"]) == ("256", "default")
    assert found["ring", None, "name"]["value"] is None


def test_text_names_file_and_line(run, tmp_path):
    path = tmp_path / "router.toml"
    path.write_text(GOOD)
    done = run("check", path)

    assert done.status == 0
    assert any(line.split() == ["dedup_ms", "=", "5", "#", f"{path}:2"] for line in done.lines)


@pytest.mark.parametrize("text, expected", [
    ("[rooter]\n", "{path}:1: there is no section 'rooter', did you mean 'router'?"),
    ("[router]\ndedup_msec = 1\n", "{path}:2: [router] has no key 'dedup_msec', did you mean 'dedup_ms'?"),
    ("[[endpoint]]\nurl = \"udp://:14540\"\n", "type udpin://0.0.0.0:14540 to listen"),
    ("[router\n", "{path}:1: "),
])
def test_a_bad_file_is_status_3(run, tmp_path, text, expected):
    path = tmp_path / "bad.toml"
    path.write_text(text)
    done = run("check", path)

    assert done.status == 3
    assert done.stdout == ""
    assert expected.format(path=path) in done.stderr


def test_misspelt_messages_are_status_3(run, tmp_path):
    path = tmp_path / "bad.toml"
    path.write_text('[[endpoint]]\nurl = "udpin://0.0.0.0:14550"\nin_allow = ["HEARTBEAT", "ATITUDE"]\n')
    done = run("check", path)

    assert done.status == 3 and done.stdout == ""
    assert f"{path}:3: in_allow: unknown message 'ATITUDE', did you mean 'ATTITUDE'?" in done.stderr


def test_key_files_that_cannot_be_read_are_status_3(run, tmp_path):
    path, key = tmp_path / "bad.toml", tmp_path / "link.key"
    path.write_text(f'[[endpoint]]\nurl = "udpin://0.0.0.0:14550"\nverify = "{key}"\n')
    missing = run("check", path)
    assert missing.status == 3 and missing.stdout == ""
    assert f"{path}:3: verify: " in missing.stderr and "link.key" in missing.stderr
    key.write_text("no key\n")
    key.chmod(0o600)
    assert run("check", path).status == 3
    key.write_text("07" * 32)
    assert run("check", path).status == 0


@pytest.mark.parametrize("command", [["check"], ["route", "--for", "0.1", "--config"]])
def test_two_endpoints_on_one_port_are_status_3(run, tmp_path, command):
    path = tmp_path / "bad.toml"
    path.write_text('[[endpoint]]\nurl = "udpin://0.0.0.0:14550"\n[[endpoint]]\nscheme = "udpin"\nhost = "127.0.0.1"\n'
                    'port = 14550\n')
    done = run(*command, path)
    assert done.status == 3 and done.stdout == ""
    assert (f"{path}:6: 'udpin://127.0.0.1:14550' binds UDP port 14550, which 'udpin://0.0.0.0:14550' in line 2 "
            "already uses") in done.stderr


@pytest.mark.parametrize("command", [["check"], ["route", "--for", "0.1", "--config"]], ids=["check", "route"])
@pytest.mark.parametrize("text, line, said", [
    ('[[endpoint]]\nname = "r"\nurl = "shm://px4"\n', 3,
     "r: a ring is not an endpoint of a router; --ring px4 writes every frame into it"),
    ('[[endpoint]]\nscheme = "shm"\nring = "px4"\n', 3, "shm://px4: a ring is not an endpoint of a router"),
    ('[ring]\ncapacity = "64k"\n', 1, "[ring] has no name"),
    ('# a comment\n[ring]\n', 2, "[ring] has no name"),
    ('[record]\nrotate_every = 60\n', 1, "[record] has no path"),
    ('[[endpoint]]\nurl = "udpmcast://239.1.2.3:14550?max_peers=3"\n', 2,
     "udpmcast://239.1.2.3:14550: all senders that are heard here share one link"),
    ('[[endpoint]]\nscheme = "udpout"\nhost = "127.0.0.1"\nport = 1\nbind = "[::1]:0"\n', 2,
     "udpout://127.0.0.1:1: bind=[::1]:0 and 127.0.0.1:1 are of different address families"),
    ('[[endpoint]]\nurl = "tlog://a.tlog?speed=3"\n', 2, "tlog://a.tlog: 'speed' applies to a recording that is read"),
    ('[[endpoint]]\nurl = "udpin://127.0.0.1:1?ttl=0"\n', 2,
     "udpin://127.0.0.1:1: ttl=0 keeps datagrams of a multicast group on this machine"),
    ('[[endpoint]]\nurl = "udpin://127.0.0.1:1?group=air&group_mode=best"\n[[endpoint]]\nurl = "udpin://127.0.0.1:2"\n'
     'group = "air"\ngroup_mode = "primary"\n', 6,
     "group 'air' has group_mode \"best\" in line 2, and \"primary\" here"),
    ('[[endpoint]]\nurl = "udpin://127.0.0.1:1"\nsign = "/nonexistent/key"\n', 3,
     "sign: cannot open key file /nonexistent/key"),
])
def test_check_refuses_what_route_refuses(run, tmp_path, udp_port, command, text, line, said):
    path = tmp_path / "bad.toml"
    path.write_text(text + f'[[endpoint]]\nurl = "udpin://127.0.0.1:{udp_port()}"\n')
    done = run(*command, path)

    assert done.status == 3 and done.stdout == ""
    assert f"{path}:{line}: {said}" in done.stderr, done


def test_the_command_line_may_name_the_ring_of_the_file(run, tmp_path, udp_port):
    path = tmp_path / "router.toml"
    path.write_text(f'[ring]\ncapacity = "64k"\n[[endpoint]]\nurl = "udpin://127.0.0.1:{udp_port()}"\n')
    named = run("route", "--config", path, "--ring", f"check-{path.parent.name}"[:60].replace("_", "-"), "--for", "0.1")
    assert named.status == 0, named


def test_messages_of_a_dialect_file_are_known(run, tmp_path):
    (tmp_path / "mine.xml").write_text('<mavlink><messages><message id="54321" name="MY_OWN">'
                                       '<field type="uint8_t" name="a">a</field></message></messages></mavlink>')
    path = tmp_path / "mine.toml"
    path.write_text('[[endpoint]]\nurl = "udpin://0.0.0.0:14550?max_rate=MY_OWN:10"\n')

    assert run("check", path).status == 3
    assert run("check", path, "--dialect", tmp_path / "mine.xml").status == 0


def test_a_rate_that_breaks_a_protocol_is_warned_of(run, tmp_path, udp_port):
    path = tmp_path / "router.toml"
    path.write_text(f'[[endpoint]]\nurl = "udpin://127.0.0.1:{udp_port()}"\nmax_rate = {{COMMAND_ACK = 1, "*" = 10}}\n')
    checked, routed = run("check", path), run("route", "--config", path, "--for", "0.1")

    harm = "max_rate=COMMAND_ACK:1 drops COMMAND_ACK frames over that rate: commands and their answers may get lost"
    assert (checked.status, routed.status) == (0, 0)
    assert f"{path}:3: {harm}" in checked.stderr
    assert f": {harm}" in routed.stderr


def test_variables_that_set_nothing(run, tmp_path):
    path = tmp_path / "router.toml"
    path.write_text(GOOD)
    near = run("check", path, env={"MAVLOOM_ROOTER_DEDUP_MS": "1"})
    far = run("check", path, env={"MAVLOOM_UNICORN": "1"})

    assert near.status == 3 and "did you mean 'MAVLOOM_ROUTER_DEDUP_MS'?" in near.stderr
    assert far.status == 0 and "MAVLOOM_UNICORN sets nothing" in far.stderr


def test_no_file_and_no_configuration(run, tmp_path, data):
    assert run("check", tmp_path / "none.toml").status == 3
    assert run("check", data / "px4_gcs_flight.tlog").status == 3
    assert run("check", "/dev/zero").status == 3
    assert run("check").status == 2


def rows(page):
    """The cells of the tables in a page of the guide, without back quotes."""
    lines = (harness.ROOT / "docs" / "guide" / page).read_text().splitlines()
    return [[cell.strip().replace("`", "") for cell in line.strip("|").split("|")]
            for line in lines if line.startswith("| `")]


def test_the_guide_names_every_option_and_key_with_its_default(run, tmp_path):
    urls = {"udpin": "udpin://127.0.0.1:1", "udpout": "udpout://127.0.0.1:2", "udpbcast": "udpbcast://10.0.0.255:3",
            "tcpin": "tcpin://127.0.0.1:4", "udpmcast": "udpmcast://239.255.145.50:5", "tcpout": "tcpout://127.0.0.1:6",
            "wsin": "wsin://127.0.0.1:7", "wsout": "wsout://127.0.0.1:8", "serial": "serial:///dev/ttyS0",
            "tlog": "tlog://x.tlog"}  # shm:// is no endpoint of a router
    path = tmp_path / "all.toml"
    path.write_text("".join(f'[[endpoint]]\nurl = "{url}"\n' for url in urls.values()))
    effective = [json.loads(line) for line in run("check", path, "--json").lines]

    def takes(schemes, scheme):
        if schemes.startswith("all"):
            return not (scheme == "tlog" and "but tlog" in schemes)
        return any(re.fullmatch(word.strip().replace("*", ".*"), scheme) for word in schemes.split(","))

    options = {(scheme, row[0]): row[2].removesuffix(" for udp*") for row in rows("endpoints.md") if len(row) == 4
               for scheme in urls if takes(row[1], scheme)}
    connections = ("tcpin", "tcpout", "wsin", "wsout")  # the guide states in words that `idle` has no default for these
    for scheme in connections:
        del options[scheme, "idle"]
    found = {(v["endpoint"].split(":")[0], v["key"]): v["value"] or "" for v in effective if v["section"] == "endpoint"
             and v["key"] != "url"}
    assert [found.pop((scheme, "idle")) for scheme in connections] == [""] * 4
    assert found == options

    keys = {(row[0], row[1]): row[2] for row in rows("configuration.md") if len(row) == 4}
    assert {(v["section"], v["key"]): v["value"] or "" for v in effective if v["section"] != "endpoint"} == keys


def test_a_key_of_very_many_parts_is_an_error(run, tmp_path):
    for text in (".".join(["a"] * 50_000) + " = 1", "[" + ".".join(["a"] * 50_000) + "]"):
        (tmp_path / "deep.toml").write_text(text)
        done = run("check", tmp_path / "deep.toml")

        assert done.status == 3
        assert "deep.toml:1:" in done.stderr
