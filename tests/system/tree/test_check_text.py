# SPDX-License-Identifier: MIT
"""tools/check_text.py: each rule fires on a bad sample and is silent on a good one."""
import subprocess
import sys

import pytest

from harness import ROOT

sys.path.insert(0, str(ROOT / "tools"))
import check_text  # noqa: E402

LONG_WORDS = "words " * 21  # 126 characters
URL = "https://example.com/" + "x" * 120
COMMENT_OF = {"x.py": "# {}\n", "x.sh": "# {}\n", "CMakeLists.txt": "# {}\n", "x.cpp": "// {}\n", "x.md": "{}\n"}


def complaints(tmp_path, name, text):
    path = tmp_path / name
    path.write_text(text)
    return [line.removeprefix(f"{path}:") for line in check_text.check(path, str(path))]


@pytest.mark.parametrize("name", COMMENT_OF)
def test_a_line_has_at_most_120_characters(tmp_path, name):
    fits = COMMENT_OF[name].format("é" * 58 + " " + "é" * 58)  # more than 120 bytes
    assert complaints(tmp_path, name, fits) == []
    assert complaints(tmp_path, name, "\n" + COMMENT_OF[name].format(LONG_WORDS + "end"))[0].startswith("2: 1")


@pytest.mark.parametrize("name, text", [
    ("x.py", f"LINK = (\n    '{URL}')\n"), ("x.sh", f"link=\\\n{URL}\n"), ("x.md", f"- {URL}\n"[2:]),
    ("x.md", f"- [a link of some words]({URL}).\n"), ("x.md", f"| {LONG_WORDS} | {LONG_WORDS} |\n"),
    ("x.md", f"```\n{LONG_WORDS}\n```\n"), ("x.md", f"Text:\n\n    {LONG_WORDS}\n"), ("x.cpp", f"f({LONG_WORDS});\n"),
    ("x.txt", LONG_WORDS + "\n"),
])
def test_lines_that_cannot_break_or_are_checked_elsewhere_may_be_longer(tmp_path, name, text):
    assert complaints(tmp_path, name, text) == []


@pytest.mark.parametrize("name, text", [
    ("x.py", f"LINK = f('{LONG_WORDS}')\n"), ("x.sh", f"echo {LONG_WORDS}\n"), ("x.md", f"See {URL}\n"),
    ("x.md", f"```\ncode\n```\n{LONG_WORDS}end\n"), ("x.md", f"- item\n\n    {LONG_WORDS}end\n"),
    ("x.cpp", f"f({LONG_WORDS}); // {LONG_WORDS}\n"),
])
def test_lines_that_can_break_may_not_be_longer(tmp_path, name, text):
    assert len(complaints(tmp_path, name, text)) == 1


@pytest.mark.parametrize("bad", [
    "It tells its reader.", "The user is told.", "The file says so.", "It takes away the socket.",
    "A peer gives way.", "It holds up others.", "It goes on.", "It comes to its end.", "He reads.", "It is his.",
    "It answers whoever asks.", "For who has no time.", "It is closed for want of room.", "This is seldom.",
    "The ring is made anew.", "It waits without end.", "See DESIGN.md.", "What is wrong is counted.",
    "Good. What is wrong is counted.", "A peer gives\nway.", "A writer. Who writes? A process.\nWho reads it.",
])
@pytest.mark.parametrize("name", COMMENT_OF)
def test_a_phrase_is_reported_with_its_line(tmp_path, name, bad):
    text = "\n" + "".join(COMMENT_OF[name].format(line) for line in bad.split("\n"))
    found = complaints(tmp_path, name, text)
    assert len(found) == 1
    expected_line = 3 if "\nWho" in bad else 2
    assert found[0].startswith(f"{expected_line}: ") and found[0].count(": ") == 2


@pytest.mark.parametrize("good", [
    "It reports errors.", "The essay is hers; the shell theory holds.", "It removes the socket.", "What is a ring?",
    "Run `he tells` and `what` it prints.", "The error is \"it says no\".", "He1 and his2 are names.",
    "HEARTBEAT goes on every link.", "It can tell them apart.", "A queue holds up to ten frames.",
])
@pytest.mark.parametrize("name", COMMENT_OF)
def test_other_words_are_no_phrase(tmp_path, name, good):
    assert complaints(tmp_path, name, COMMENT_OF[name].format(good)) == []


@pytest.mark.parametrize("name, text", [
    ("x.py", 'def tells(says):\n    return "he goes on" + says  # good\n'), ("x.cpp", "int tells = says;\n"),
    ("x.cpp", 'auto url = "udpin://he tells";\n'), ("x.sh", 'echo "he tells"; echo $#\n'),
    ("x.md", "# What the router does\n\n| Who | What |\n|---|---|\n"), ("x.md", "```\nhe tells\n```\n"),
    ("x.py", '"""Good.\n\n    he tells(code)\n"""\n'),
])
def test_code_and_headings_are_not_prose(tmp_path, name, text):
    assert complaints(tmp_path, name, text) == []


@pytest.mark.parametrize("name, text", [
    ("x.py", "def test_a_router_tells_its_name():\n    pass\n"),
    ("x.py", "async def test_that_goes_on(): pass\n"),
    ("x.cpp", "TEST(Ring, AReaderIsToldHowMany) {\n"), ("x.cpp", "RC_GTEST_PROP(Ring, GoesOn, (int n)) {\n"),
])
def test_names_of_tests_use_the_same_words(tmp_path, name, text):
    assert [found.split(":")[0] for found in complaints(tmp_path, name, text)] == ["1"]


@pytest.mark.parametrize("text, line", [
    ('"""It tells."""\n', 1), ('"""Good.\n\nIt tells.\n"""\n', 3), ('def f():\n    """Good. It\n    tells."""\n', 3),
    ("x = 1  # it tells\n", 1),
])
def test_docstrings_and_trailing_comments_are_prose(tmp_path, text, line):
    assert [found.split(":")[0] for found in complaints(tmp_path, "x.py", text)] == [str(line)]


@pytest.mark.parametrize("first, kind", [("#!/usr/bin/env bash", 1), ("#!/bin/sh", 1), ("#!/usr/bin/env python3", 1),
                                         ("#!/usr/bin/awk -f", 0), ("# a list", 0)])
def test_a_script_without_a_suffix_is_known_by_its_first_line(tmp_path, first, kind):
    assert len(complaints(tmp_path, "run", f"{first}\n# it tells\n")) == kind


def test_the_status_is_1_if_something_is_printed(tmp_path):
    (tmp_path / "good.md").write_text("It reports.\n")
    (tmp_path / "bad.md").write_text("\nIt tells.\n")

    def run(*names):
        command = [sys.executable, ROOT / "tools" / "check_text.py", *(tmp_path / name for name in names)]
        done = subprocess.run(command, capture_output=True, text=True)
        return done.returncode, done.stdout, done.stderr
    assert run("good.md") == (0, "", "")
    said = f"{tmp_path}/bad.md:2: 'tells': reports, prints, logs, returns, notifies\n"
    assert run("good.md", "bad.md") == (1, said, "")


def test_without_arguments_it_checks_all_that_git_knows():
    """The tree itself is clean."""
    done = subprocess.run([sys.executable, ROOT / "tools" / "check_text.py"], capture_output=True, text=True, cwd="/")
    assert (done.returncode, done.stdout) == (0, "")
