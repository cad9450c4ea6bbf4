#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""check_text.py [FILE...]: checks the text that clang-format does not see, in the files given or in all that git knows.

- Lines of Python, shell, CMake and Markdown, and C++ and TypeScript lines with a comment, have at most 120 characters.
  Exempt are lines without a space inside (a URL, hex data), and in Markdown tables, code blocks and lines that are one
  link.
- Comments, docstrings, Markdown prose and names of tests use the words of CONTRIBUTING.md, section "Plain English".
  Code in backquotes is not checked.

Prints `FILE:LINE: what is wrong: what to write`. Status: 0 nothing found, 1 something found.
"""
import ast
import bisect
import io
import pathlib
import re
import subprocess
import sys
import tokenize
from collections.abc import Iterator
from typing import NamedTuple

ROOT = pathlib.Path(__file__).resolve().parents[1]
COLUMNS = 120

# A pattern, matched case-insensitively as whole words, and what to write instead.
PHRASES = {
    r"tells|(is|are|was|were|be|been) told|told (of|so|by)": "reports, prints, logs, returns, notifies",
    r"says|(is|are|was|were|be|been) said": "reports, prints, states, documents",
    r"(takes?|took|taking) away|(is|are|was|were|be|been) taken away": "removes, is removed",
    r"(gives?|gave|giving) way": "is evicted, is dropped, waits",
    r"(holds?|held|holding) up(?! to\b)": "blocks, delays",
    r"(goes|go|went|going) on(?! (the|every|each|all|an?|one|its|this|both|other)\b)": "continues",
    r"comes? to (its|an|the) end": "ends",
    r"he|him|his|himself": "it or they, for programs, readers, writers and peers",
    r"whoever|nobody who": "the actor, as in 'a process that ...'",
    r"(at|by|for|from|of|to|with) who": "the actor, as in 'for callers that ...'",
    r"for want of": "for lack of, because there is no",
    r"seldom": "rarely",
    r"(made|makes|make|opened|begins?) anew": "created again, opened again, starts over",
    r"without end": "indefinitely",
    r"comes? thick": "arrives continuously",
    r"(shall|to) vouch": "to sign, to verify",
    r"DESIGN\.md": "a page of docs/ or the reason itself, as readers do not have this document",
}
PHRASE = re.compile("|".join(rf"\b(?P<p{i}>{pattern})\b" for i, pattern in enumerate(PHRASES)), re.IGNORECASE)
INSTEAD = list(PHRASES.values())

# A sentence whose subject is only a question word. Questions themselves are fine.
HEADLESS = re.compile(r"(?:^|(?<=[.!?:] ))\(?(?P<word>Who|What)\b(?:[^.!?]|[.!?](?=\S))*(?P<end>[.!?]?)")

TEST_NAME = re.compile(r"\s*(?:(?:async )?def test_|(?:TEST|TEST_[FP]|RC_GTEST_(?:FIXTURE_)?PROP)\(\w+, )(\w+)")
WORD_BOUNDARY = re.compile(r"_|(?<=[a-z0-9])(?=[A-Z])")

PYTHON_SHEBANG = re.compile(rb"#!.*\bpython3?\b")
SHELL_SHEBANG = re.compile(rb"#!.*\b(ba)?sh\b")
HASH_COMMENT = re.compile(r"(?:^|\s)#+(?: |$)(?P<text>.*)")
SLASH_COMMENT = re.compile(r"(?:^|\s)//+<?(?: |$)(?P<text>.*)")
LINK = re.compile(r"(?:[-*>]|\d+\.)?\s*!?\[[^\]]*\]\([^)]*\)[.,;:]?")
FENCE = re.compile(r"\s*(```|~~~)")
LIST_ITEM = re.compile(r"\s*([-*+]|\d+\.) ")


class Paragraph(NamedTuple):
    lines: list[tuple[int, str]]  # (number, text) of lines that make up sentences together
    prose: bool = True            # not a heading or the cell of a table, which need no verb


def kind_of(path: pathlib.Path) -> str | None:
    """Returns the kind of a file: python, shell, cmake, markdown or cpp, also for TypeScript; None if not checked."""
    by_suffix = {".py": "python", ".sh": "shell", ".md": "markdown", ".cpp": "cpp", ".hpp": "cpp", ".cmake": "cmake",
                 ".ts": "cpp", ".tsx": "cpp", ".mjs": "cpp"}
    if path.name == "CMakeLists.txt":
        return "cmake"
    if path.suffix:
        return by_suffix.get(path.suffix)
    with path.open("rb") as file:
        first = file.readline(100)
    return "python" if PYTHON_SHEBANG.match(first) else "shell" if SHELL_SHEBANG.match(first) else None


# ---- which lines are code or prose

def comment_paragraphs(lines: list[str], comment: re.Pattern[str]) -> Iterator[Paragraph]:
    """Yields comments: consecutive lines that are only a comment are joined; a comment after code stands alone."""
    joined: list[tuple[int, str]] = []
    for number, line in enumerate(lines, 1):
        found = comment.search(line)
        alone = found is not None and not line[:found.start()].strip()
        text = found["text"].strip() if found else ""
        if joined and not (alone and text):
            yield Paragraph(joined)
            joined = []
        if text and alone:
            joined.append((number, text))
        elif text:
            yield Paragraph([(number, text)])
    if joined:
        yield Paragraph(joined)


def docstrings(tree: ast.Module) -> Iterator[tuple[int, str]]:
    """Yields (first line, text) of each docstring."""
    for node in ast.walk(tree):
        if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)):
            text = ast.get_docstring(node, clean=False)
            if text is not None:
                yield node.body[0].lineno, text


def python_paragraphs(text: str) -> Iterator[Paragraph]:
    lines = [""] * (text.count("\n") + 1)
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT:
            before = token.line[:token.start[1]]
            lines[token.start[0] - 1] = ("x " if before.strip() else "") + token.string
    yield from comment_paragraphs(lines, HASH_COMMENT)
    for first, docstring in docstrings(ast.parse(text)):
        yield from markdown_paragraphs(docstring.split("\n"), first)


def markdown_code(lines: list[str]) -> list[bool]:
    """Returns, for each line, whether it belongs to a code block: fenced, or indented by four spaces after a blank."""
    code, fenced, indented, in_list = [], False, False, False
    for number, line in enumerate(lines):
        if FENCE.match(line):
            fenced = not fenced
            code.append(True)
            continue
        if line.strip():
            after_blank = number == 0 or not lines[number - 1].strip()
            indented = line.startswith("    ") and (indented or after_blank) and not in_list
            in_list = bool(LIST_ITEM.match(line)) or (in_list and line.startswith("  "))
        code.append(fenced or (indented and bool(line.strip())))
    return code


def markdown_paragraphs(lines: list[str], first: int = 1) -> Iterator[Paragraph]:
    """Yields paragraphs, list items, headings and table rows. `first` is the number of the first line."""
    joined: list[tuple[int, str]] = []
    for number, (line, code) in enumerate(zip(lines, markdown_code(lines)), first):
        text = line.strip()
        alone = text.startswith(("#", "|"))
        if joined and (not text or code or alone or LIST_ITEM.match(line)):
            yield Paragraph(joined)
            joined = []
        if not text or code:
            continue
        if alone:
            cells = text.lstrip("#").split("|")
            yield from (Paragraph([(number, cell.strip())], prose=False) for cell in cells if cell.strip())
        else:
            joined.append((number, LIST_ITEM.sub("", line, count=1).strip()))
    if joined:
        yield Paragraph(joined)


# ---- the rules

def too_long(kind: str, text: str) -> Iterator[tuple[int, str, str]]:
    lines = text.split("\n")
    code = markdown_code(lines) if kind == "markdown" else [False] * len(lines)
    for number, (line, is_code) in enumerate(zip(lines, code), 1):
        if len(line) <= COLUMNS or is_code or len(line.split()) == 1:
            continue
        if kind == "markdown" and (line.lstrip().startswith("|") or LINK.fullmatch(line.strip())):
            continue
        if kind == "cpp" and not SLASH_COMMENT.search(line):
            continue  # clang-format decides where C++ code breaks
        yield number, f"{len(line)} characters", f"at most {COLUMNS}"


def bad_phrases(paragraph: Paragraph) -> Iterator[tuple[int, str, str]]:
    starts, joined = [], ""
    for _, text in paragraph.lines:
        starts.append(len(joined))
        joined += text + " "
    # Code in backquotes and what is in double quotes keeps its length, so that offsets stay true.
    prose = re.sub(r"`[^`]*`|\"[^\"]*\"|https?://\S+", lambda found: "x" * len(found[0]), joined.rstrip())

    def line_at(offset: int) -> int:
        return paragraph.lines[bisect.bisect_right(starts, offset) - 1][0]

    for found in PHRASE.finditer(prose):
        which = next(i for i in range(len(INSTEAD)) if found[f"p{i}"])
        yield line_at(found.start()), f"'{found[0]}'", INSTEAD[which]
    for found in HEADLESS.finditer(prose) if paragraph.prose else ():
        if found["end"] != "?":
            yield (line_at(found.start("word")), f"a sentence that starts with '{found['word']}'",
                   "name the actor, then the verb, then the object")


def bad_names(lines: list[str]) -> Iterator[tuple[int, str, str]]:
    for number, line in enumerate(lines, 1):
        if found := TEST_NAME.match(line):
            yield from bad_phrases(Paragraph([(number, WORD_BOUNDARY.sub(" ", found[1]))], prose=False))


def check(path: pathlib.Path, name: str) -> list[str]:
    """Returns the complaints about a file, as lines to print."""
    kind = kind_of(path)
    if kind is None:
        return []
    text = path.read_text(encoding="utf-8")
    lines = text.split("\n")
    paragraphs = {"python": lambda: python_paragraphs(text), "markdown": lambda: markdown_paragraphs(lines),
                  "shell": lambda: comment_paragraphs(lines, HASH_COMMENT),
                  "cmake": lambda: comment_paragraphs(lines, HASH_COMMENT),
                  "cpp": lambda: comment_paragraphs(lines, SLASH_COMMENT)}
    found = [*too_long(kind, text), *(bad_names(lines) if kind in ("python", "cpp") else ())]
    for paragraph in paragraphs[kind]():
        found += bad_phrases(paragraph)
    return [f"{name}:{line}: {wrong}: {instead}" for line, wrong, instead in sorted(found)]


def files_of_git() -> list[str]:
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    return [name for name in listed.split("\0") if name and (ROOT / name).is_file()]


def main(names: list[str]) -> int:
    complaints = [line for name in names or files_of_git() for line in check(ROOT / name, name)]
    print("\n".join(complaints), end="\n" if complaints else "")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
