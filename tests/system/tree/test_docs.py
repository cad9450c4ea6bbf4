# SPDX-License-Identifier: MIT
"""Every command that README, the guides and --help show is run: as written, but for ports (the kernel's choice), a
bound on its time, and files of the examples' names in a temporary folder."""
import contextlib
import os
import re
import shlex
import shutil

import pytest

import frames
import harness

pytestmark = pytest.mark.short

PAGES = [harness.ROOT / "README.md", *sorted((harness.ROOT / "docs").rglob("*.md"))]
COMMANDS = ("listen", "relay", "record", "replay", "route", "dialect", "check", "bench", "key", "shm", "sim", "web",
            "demo", "info", "top", "doctor")
ASKING = ("ctl", "stat")  # these need a router that runs
LIVE = ("listen", "relay", "record", "replay", "route", "sim", "web", "demo", "top", "doctor")


def shell_lines(text):
    """Lines of ```sh blocks, and the examples in the README's table of commands."""
    for block in re.findall(r"```sh\n(.*?)```", text, re.DOTALL):
        yield from block.splitlines()
    yield from re.findall(r"\| `(mavloom [^`]*)` \|$", text, re.MULTILINE)


def page_examples():
    for page in PAGES:
        for line in shell_lines(page.read_text()):
            line = line.split("  #")[0].strip()
            if re.match(r"(build/release/bin/)?mavloom (%s)\b" % "|".join(COMMANDS + ASKING),
                        line) and "|" not in line and "FILE" not in line:
                yield pytest.param(line, id=f"{page.name}: {line}")


def runnable(line):
    words = shlex.split(line.removesuffix("&"))[1:]
    def port(match):  # a router wants a port that others can know
        return match[1] + (str(harness.free_port(harness.socket.SOCK_STREAM)) if words[0] == "route" else "0")
    words = [re.sub(r"((?:udpin|tcpin):(?://)?[^?]*:)\d+", port, word) for word in words]
    words = [re.sub(r"^127\.0\.0\.1:9090$", "127.0.0.1:0", word) for word in words]
    if words[0] in ("route", "sim") and "--name" not in words:
        words += ["--name", f"docs-{os.getpid()}-{harness.free_port()}"]
    if words[:2] == ["check", "--convert"] and ">" in words:
        words = words[:words.index(">")]
    if "<" in words:
        words = words[:words.index("<")]
    if words[0] in LIVE and "--for" not in words:
        words += ["--for", "300ms"]
    if words[0] == "web":
        words = [word.replace(":8088", ":0") for word in words]
        words += [] if "--listen" in words else ["--listen", "127.0.0.1:0"]
    if "--for" in words:
        words[words.index("--for") + 1] = "300ms"
    if words[0] in ("web", "top"):
        words = [word.replace("shm://px4", "flight.tlog").replace("shm://telemetry", "flight.tlog") for word in words]
    if words[0] == "demo" and "--ports" not in words:
        words += ["--ports", "free"]
    if words[0] == "shm":
        words = [f"docs-{os.getpid()}" if word == "px4" else word for word in words]
    if "--hil" in words:
        words[words.index("--hil") + 1] = f"px4=tcpin://127.0.0.1:{harness.free_port(harness.socket.SOCK_STREAM)}"
    if words[0] in ("route", "sim"):
        words = [f"docs-{os.getpid()}-{harness.free_port()}" if word == "px4" else word for word in words]
    if words[0] == "replay" and "--no-wait" not in words:
        words.append("--no-wait")
    return words


def copy_examples(folder):
    """The configurations of examples/ with free ports in the place of theirs."""
    folder.mkdir()
    for path in (harness.ROOT / "examples").glob("*.toml"):
        (folder / path.name).write_text(re.sub(r"(?<=:)\d{4,5}(?=\")",
                                               lambda _: str(harness.free_port(harness.socket.SOCK_STREAM)),
                                               path.read_text()))


@pytest.fixture
def folder(tmp_path, run):
    copy_examples(tmp_path / "examples")
    for name in ("flight.tlog", "before.tlog", "after.tlog", "session.tlog"):
        shutil.copy(frames.FLIGHT, tmp_path / name)
    (tmp_path / "main.conf").write_text("[UdpEndpoint ground]\nMode = Normal\nAddress = 127.0.0.1\nPort = 14550\n")
    (tmp_path / "mine.xml").write_text('<?xml version="1.0"?><mavlink><messages><message id="42000" name="MY_STATE">'
                                       '<field type="uint16_t" name="count">n</field></message></messages></mavlink>')
    (tmp_path / "scenario.toml").write_text("[sim]\n")
    for name in ("mavloom.toml", "router.toml"):
        (tmp_path / name).write_text(f'[[endpoint]]\nurl = "udpin://127.0.0.1:{harness.free_port()}"\n')
    assert run("shm", "write", f"docs-{os.getpid()}", "--capacity", "64k", input="one\n").status == 0
    for name in ("key", "key.hex", "keys.hex", "vehicle.key", "link.key", "token"):
        (tmp_path / name).write_text("07" * 32)
        (tmp_path / name).chmod(0o600)
    yield tmp_path
    with contextlib.suppress(OSError):
        os.unlink(f"/dev/shm/mavloom.docs-{os.getpid()}")


def make_way(folder, words):
    """`key new` and recordings refuse a file that exists."""
    if words[:2] == ["key", "new"]:
        (folder / words[2]).unlink(missing_ok=True)
    for option, file in zip(words, words[1:]):
        if option in ("--record", "--record-input"):
            (folder / file).unlink(missing_ok=True)


def is_good(done, words):
    """Status 4: nobody listens here where the example sends to, and that is all that was lost. Or `doctor` finds that
    nobody sends."""
    refused = re.search("refused: no program listens there|there was no peer", done.stderr)
    alone = words[0] in ("relay", "replay") and refused
    if words[0] == "doctor":
        return done.status in (0, 4) and done.stdout
    return done.status == 0 or (done.status == 4 and alone and "dropped" not in done.stderr)


@pytest.fixture
def router_name(spawn):
    name = f"docs-{os.getpid()}-{harness.free_port()}"
    router = spawn("route", f"udpout://127.0.0.1:{harness.free_port()}?name=tablet", "--ring", name)
    router.wait_output("tablet: up")
    yield name
    router.process.terminate()
    router.wait()


@pytest.fixture
def simulator_name(spawn, run):
    name = f"docs-{os.getpid()}-{harness.free_port()}"
    spawn("sim", "--to", f"udpout://127.0.0.1:{harness.free_port()}", "--name", name)
    harness.wait_for(lambda: '"ready":true' in run("ctl", name, "state").stdout, what="a vehicle that is ready")
    return name


@pytest.mark.parametrize("line", list(page_examples()))
def test_example_of_a_page(run, folder, request, line):
    words = runnable(line)
    if words[0] in ASKING and {"sim", "demo-sim"} & set(words):
        words = [request.getfixturevalue("simulator_name") if word in ("sim", "demo-sim") else word for word in words]
    elif words[0] in ASKING:
        words = [request.getfixturevalue("router_name") if word in ("router", "px4")
                 else word.replace("=tablet", "=other") for word in words]
    make_way(folder, words)
    done = run(*words, cwd=folder)

    assert is_good(done, words), done


@pytest.mark.parametrize("command", COMMANDS)
def test_examples_of_help(run, folder, command):
    text = run(command, "--help").stdout
    examples = re.findall(r"^\s*(?:Example: )?(mavloom %s [^[].*)$" % command, text, re.MULTILINE)

    assert examples, text
    for line in examples:
        words = runnable(line)
        make_way(folder, words)
        done = run(*words, cwd=folder)
        assert is_good(done, words), done


@pytest.mark.parametrize("command, part", [("dialect", "list"), ("dialect", "show"), ("dialect", "check"),
                                           ("bench", "parse"), ("bench", "decode"), ("bench", "sim"),
                                           ("shm", "list"), ("shm", "stat"), ("shm", "write"), ("shm", "read"),
                                           ("shm", "remove")])
def test_examples_of_the_help_of_a_part(run, folder, command, part):
    text = run(command, part, "--help").stdout
    examples = re.findall(r"(mavloom %s %s(?: [^[].*)?)$" % (command, part), text, re.MULTILINE)

    assert examples, text
    for line in examples:
        words = runnable(line)
        done = run(*words, cwd=folder)
        assert is_good(done, words), done


def page_configurations():
    for page in PAGES:
        for text in re.findall(r"```toml\n(.*?)```", page.read_text(), re.DOTALL):
            yield pytest.param(text, id=f"{page.name}: {text.splitlines()[0]}")


@pytest.mark.parametrize("text", list(page_configurations()))
def test_a_configuration_of_a_page_is_good(run, tmp_path, text):
    (tmp_path / "page.toml").write_text(text)
    done = run("check", tmp_path / "page.toml")

    assert done.status == 0, done


def headings_of(page):
    """(level, text) of the headings, without those in code."""
    text = re.sub(r"```.*?```", "", page.read_text(), flags=re.DOTALL)
    return [(len(marks), words) for marks, words in re.findall(r"^(#+) (.*)$", text, re.MULTILINE)]


def anchors_of(page):
    """As GitHub makes them: small letters, without punctuation, with hyphens for blanks."""
    return {re.sub(r"[^\w -]", "", words.lower()).replace(" ", "-") for _, words in headings_of(page)}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page):
    text = re.sub(r"```.*?```", "", page.read_text(), flags=re.DOTALL)
    for target, anchor in re.findall(r"\]\(([^)#:\s]*)(?:#([^)\s]+))?\)", text):
        there = (page.parent / target).resolve() if target else page
        assert there.exists(), target
        assert not anchor or there.suffix != ".md" or anchor in anchors_of(there), f"{target}#{anchor}"


# The questions of new users, with the words of a heading that answers each.
QUESTIONS = {
    "Nothing arrives. Why?": "nothing arrives",
    "QGroundControl shows a loss of 78 %. Is that true?": "high loss, but nothing is lost",
    "The parameters stay incomplete. What can I do?": "parameters stay incomplete",
    "Bytes arrive on the serial port, but no messages. Is the baud rate wrong?": "wrong baud rate",
    "Two vehicles, or two programs, have the same id. What happens?": "two senders with one id",
    "How do I install it without a compiler?": "without a compiler",
    "How do I connect two ground stations?": "two ground stations",
    "How do I record a flight and replay it?": "record a flight and replay it",
    "How do I use it from Python?": "the python package",
    "How do I see the telemetry in a browser?": "in browsers",
}


def pages_linked_from(page):
    targets = re.findall(r"\]\(([^)#:\s]+\.md)(?:#[^)]*)?\)", page.read_text())
    return {(page.parent / target).resolve() for target in targets}


def section_of(page, heading):
    """The text below a heading, up to the next one of its level or above."""
    level = next(level for level, words in headings_of(page) if words == heading)
    text = page.read_text().split(f"{'#' * level} {heading}\n", 1)[1]
    return re.split(rf"^#{{1,{level}}} ", re.sub(r"^# .*$", "", text, flags=re.MULTILINE) if level > 1 else text, 1,
                    re.MULTILINE)[0]


@pytest.mark.parametrize("words", QUESTIONS.values(), ids=QUESTIONS)
def test_ten_questions_of_new_users_are_answered_one_click_from_the_first_page(words):
    answers = [(page, heading) for page in pages_linked_from(harness.ROOT / "README.md")
               for _, heading in headings_of(page) if words in heading.lower()]
    assert answers, f"no heading has the words {words!r}"
    for page, heading in answers:
        section = section_of(page, heading)
        assert len(section.split()) > 40 and re.search(r"mavloom \w+|import mavloom|pip install", section), heading


def test_the_first_page_is_short_and_shows_pictures_before_commands():
    text = (harness.ROOT / "README.md").read_text()
    assert len(text.split()) <= 920, "half of what it had in version 0.1"
    page, top, commands = (text.index(part) for part in ("page-overview.png", "top.png", "```sh"))
    assert page < commands and top < commands
    assert len(re.findall(r"^\./run ", text[commands:].split("```")[1], re.MULTILINE)) == 2
