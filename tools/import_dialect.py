#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes dialects/*.xml: the facts of MAVLink's public message set, without its prose.

There are two sources. The Rust crate `mavlink` contains the upstream definitions, which are used unchanged. The
pymavlink wheel contains ArduPilot's copy. Messages, enums and enum entries that only this copy has, and that do not
collide with upstream, are added to the file of the same name.

- Kept: names, ids, values, types, units, display hints, parameter labels and bounds, dates and names of deprecation.
- Dropped: descriptions, comments, print formats, work-in-progress marks.

The output depends only on the two inputs.

    tools/import_dialect.py                                   fetch both (cargo, pip) into a temporary folder
    tools/import_dialect.py --upstream DIR --wheel FILE.whl   use these
    tools/import_dialect.py --check                           change nothing; exit 4 if dialects/ would change
"""

import argparse
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ET
import zipfile
from xml.sax.saxutils import escape, quoteattr

CRATE_VERSION = "0.21.0"
WHEEL_VERSION = "2.4.50"
TOP = "all.xml"
DEFINITIONS_IN_CRATE = "mavlink/message_definitions/v1.0"
DEFINITIONS_IN_WHEEL = "pymavlink/dialects/v20/"

# The attributes of each element that are kept, in the order in which they are written.
ATTRIBUTES = {
    "enum": ["name", "bitmask"],
    "entry": ["value", "name", "hasLocation", "isDestination", "hasAltitudeOnly"],
    "param": ["index", "label", "units", "multiplier", "enum", "minValue", "maxValue", "increment", "default",
              "reserved"],
    "message": ["id", "name"],
    "field": ["type", "name", "units", "multiplier", "enum", "display", "instance", "invalid", "default", "minValue",
              "maxValue", "increment"],
    "extensions": [],
    "deprecated": ["since", "replaced_by"],
    "superseded": ["since", "replaced_by"],
}
CHILDREN = {
    "enum": ["deprecated", "superseded", "entry"],
    "entry": ["deprecated", "superseded", "param"],
    "message": ["deprecated", "superseded", "field", "extensions"],
}


def number(text):
    """Parses the value of an entry in a form that the schema allows: decimal, 0x, 0b or 2**n."""
    if text.startswith("2**"):
        return 2 ** int(text[3:])
    return int(text, 0)


def fetch_upstream(folder):
    project = folder / "fetch"
    (project / "src").mkdir(parents=True)
    (project / "src/lib.rs").touch()
    (project / "Cargo.toml").write_text(
        '[package]\nname = "fetch"\nversion = "0.0.0"\nedition = "2021"\n[dependencies]\n'
        f'mavlink = "={CRATE_VERSION}"\n')
    vendor = folder / "vendor"
    subprocess.run(["cargo", "vendor", "--quiet", "--versioned-dirs", str(vendor)], cwd=project, check=True,
                   stdout=subprocess.DEVNULL)
    return vendor / f"mavlink-{CRATE_VERSION}" / DEFINITIONS_IN_CRATE


def fetch_wheel(folder):
    subprocess.run([sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--only-binary=:all:", "--dest",
                    str(folder), f"pymavlink=={WHEEL_VERSION}"], check=True)
    return next(folder.glob("pymavlink-*.whl"))


def read_folder(folder):
    return lambda name: ET.fromstring((folder / name).read_bytes())


def read_wheel(wheel):
    archive = zipfile.ZipFile(wheel)
    return lambda name: ET.fromstring(archive.read(DEFINITIONS_IN_WHEEL + name))


def closure(read):
    """Returns the top file and everything that it includes, breadth first, as {name: root}."""
    roots, queue = {}, [TOP]
    while queue:
        name = queue.pop(0)
        if name not in roots:
            roots[name] = read(name)
            queue += [include.text.strip() for include in roots[name].findall("include")]
    return roots


class Known:
    """Every id, name and value that the upstream set uses."""

    def __init__(self, roots):
        self.ids, self.messages, self.enums = set(), set(), {}
        for root in roots.values():
            for message in root.iterfind("messages/message"):
                self.ids.add(int(message.get("id")))
                self.messages.add(message.get("name"))
            for enum in root.iterfind("enums/enum"):
                entries = self.enums.setdefault(enum.get("name"), (set(), set()))
                for entry in enum.iterfind("entry"):
                    entries[0].add(entry.get("name"))
                    entries[1].add(number(entry.get("value")))


def part(root, tag):
    """Returns the <enums> or <messages> element of a file, and creates it if it is missing."""
    found = root.find(tag)
    return found if found is not None else ET.SubElement(root, tag)


def add_messages(root, extra, known, log):
    for message in extra.iterfind("messages/message"):
        if message.get("name") in known.messages:
            continue
        if int(message.get("id")) in known.ids:
            sys.exit(f"{message.get('name')}: only the wheel has it, and its id {message.get('id')} is another "
                     "message's upstream")
        part(root, "messages").append(message)
        log.append(f"message {message.get('name')}")


def add_enums(root, extra, known, log):
    for enum in extra.iterfind("enums/enum"):
        names, values = known.enums.get(enum.get("name"), (set(), set()))
        entries = [e for e in enum.iterfind("entry") if e.get("name") not in names
                   and number(e.get("value")) not in values]
        if not entries:
            continue
        target = root.find(f"enums/enum[@name='{enum.get('name')}']")
        if target is None:
            target = ET.SubElement(part(root, "enums"), "enum",
                                   {k: v for k, v in enum.attrib.items() if k in ATTRIBUTES["enum"]})
        for entry in entries:
            target.append(entry)
            log.append(f"entry {enum.get('name')}.{entry.get('name')}")


def add_from_wheel(roots, extras):
    known, log = Known(roots), []
    for name, extra in extras.items():
        if name not in roots:
            sys.exit(f"{name}: only the wheel has this file; decide by hand where its content belongs")
        add_enums(roots[name], extra, known, log)
        add_messages(roots[name], extra, known, log)
    return log


def element(node, depth):
    """Returns the lines of one element and of those of its children that are kept."""
    attributes = "".join(f" {key}={quoteattr(node.get(key))}" for key in ATTRIBUTES[node.tag]
                         if node.get(key) is not None)
    head, indent = f"<{node.tag}{attributes}", "  " * depth
    lines = [line for child in node if child.tag in CHILDREN.get(node.tag, []) for line in element(child, depth + 1)]
    return [f"{indent}{head}>", *lines, f"{indent}</{node.tag}>"] if lines else [f"{indent}{head}/>"]


def document(root):
    lines = ['<?xml version="1.0" encoding="UTF-8"?>', "<mavlink>"]
    for tag in ("include", "version", "dialect"):
        lines += [f"  <{tag}>{escape(node.text.strip())}</{tag}>" for node in root.findall(tag)]
    for group, tag in (("enums", "enum"), ("messages", "message")):
        body = [line for node in root.iterfind(f"{group}/{tag}") for line in element(node, 2)]
        if body:
            lines += [f"  <{group}>", *body, f"  </{group}>"]
    return "\n".join([*lines, "</mavlink>", ""])


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--upstream", type=pathlib.Path, help="folder with the upstream all.xml")
    parser.add_argument("--wheel", type=pathlib.Path, help="the pymavlink wheel, a file")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent / "dialects")
    parser.add_argument("--check", action="store_true", help="write nothing, only compare")
    return parser.parse_args()


def make(options, folder):
    roots = closure(read_folder(options.upstream or fetch_upstream(folder)))
    log = add_from_wheel(roots, closure(read_wheel(options.wheel or fetch_wheel(folder))))
    return {name: document(root) for name, root in roots.items()}, log


def compare(out, files):
    present = {path.name for path in out.glob("*.xml")}
    wrong = sorted(present ^ files.keys()) + sorted(n for n in present & files.keys()
                                                    if (out / n).read_text("utf-8") != files[n])
    for name in wrong:
        print(f"{out / name}: differs", file=sys.stderr)
    return 4 if wrong else 0


def write(out, files, log):
    for stale in out.glob("*.xml"):
        if stale.name not in files:
            stale.unlink()
    for name, text in files.items():
        (out / name).write_text(text, "utf-8")
    total = {tag: sum(text.count(f"<{tag} ") for text in files.values()) for tag in ("message", "field", "entry")}
    print(f"{len(files)} files, {total['message']} messages, {total['field']} fields, {total['entry']} enum entries")
    for line in log:
        print(f"only in the wheel: {line}")
    return 0


def main():
    options = arguments()
    with tempfile.TemporaryDirectory() as folder:
        files, log = make(options, pathlib.Path(folder))
    return compare(options.out, files) if options.check else write(options.out, files, log)


if __name__ == "__main__":
    sys.exit(main())
