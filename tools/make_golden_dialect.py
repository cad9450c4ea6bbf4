#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes tests/golden/dialect_all.tsv: the result of pymavlink's generator for dialects/all.xml, to compare
our reader with it.

pymavlink is an independent implementation: it computes the wire order, lengths, CRC_EXTRA, offsets and merged enums in
the output. Run this script again after tools/import_dialect.py:

    python3 -m venv /tmp/golden && /tmp/golden/bin/pip install pymavlink==2.4.50
    /tmp/golden/bin/python tools/make_golden_dialect.py

Lines: M id name crc_extra min_length max_length target_system_offset target_component_offset (255: none)
       F name type array_length wire_offset extension instance bitmask_display units enum  (of M, in wire order)
       E name bitmask                                                                      (enums by name)
       V name value                                                                        (of E, by rising value)
"""

import contextlib
import io
import os
import pathlib

from pymavlink.generator import mavparse

ROOT = pathlib.Path(__file__).resolve().parent.parent
NO_TARGET = 255


def parse_closure(top):
    """Parses the file and everything that it includes, breadth first, like mavgen's expand_includes."""
    parsed, queue, seen = [], [top], set()
    while queue:
        path = os.path.abspath(queue.pop(0))
        if path in seen:
            continue
        seen.add(path)
        xml = mavparse.MAVXML(path, mavparse.PROTOCOL_2_0)
        parsed.append(xml)
        queue += [os.path.join(os.path.dirname(path), include) for include in xml.include]
    return parsed


def message_lines(message):
    system = message.target_system_ofs if message.message_flags & mavparse.FLAG_HAVE_TARGET_SYSTEM else NO_TARGET
    component = (message.target_component_ofs if message.message_flags & mavparse.FLAG_HAVE_TARGET_COMPONENT
                 else NO_TARGET)
    yield ["M", message.id, message.name, message.crc_extra, message.wire_min_length, message.wire_length, system,
           component]
    for place, field in enumerate(message.ordered_fields):
        yield ["F", field.name, field.type, field.array_length, field.wire_offset, int(place >= message.base_fields()),
               int(field.instance == "true"), int(field.display == "bitmask"), field.units.strip("[]"), field.enum]


def enum_lines(enum):
    yield ["E", enum.name, int(enum.bitmask)]
    for entry in enum.entry:
        if not entry.end_marker:
            yield ["V", entry.name, entry.value]


def main():
    with contextlib.redirect_stdout(io.StringIO()) as talk:
        parsed = parse_closure(ROOT / "dialects" / "all.xml")
        if mavparse.check_duplicates(parsed):
            raise SystemExit(talk.getvalue())
    messages = sorted((m for xml in parsed for m in xml.message), key=lambda m: m.id)
    enums = sorted((e for xml in parsed for e in xml.enum), key=lambda e: e.name)
    lines = [line for m in messages for line in message_lines(m)] + [line for e in enums for line in enum_lines(e)]
    out = ROOT / "tests" / "golden" / "dialect_all.tsv"
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text("".join("\t".join(map(str, line)) + "\n" for line in lines), "utf-8")
    print(f"{out.relative_to(ROOT)}: {len(messages)} messages, {len(enums)} enums")


if __name__ == "__main__":
    main()
