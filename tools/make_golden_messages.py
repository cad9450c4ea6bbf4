#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes tests/golden/messages.tsv: a few frames for every message of dialects/all.xml, encoded by pymavlink.

Each line is one case: message, case, frame in hexadecimal (MAVLink 2), and the fields as our JSON form must print them.
Run it after a change of the definitions, with pymavlink installed: `build/venv/bin/python
tools/make_golden_messages.py`."""
import json
import pathlib
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests" / "support"))
import pymavlink_vectors as vectors  # noqa: E402

GOLDEN = ROOT / "tests" / "golden" / "messages.tsv"
CASES = ("typical", "infinite", "tiny")  # the others are compared live by tests/system/test_pymavlink_peer.py


def value_text(field, value) -> str:
    if field.is_text:
        return json.dumps(value.rstrip(b"\0").decode("utf-8", errors="replace"), ensure_ascii=False)
    if isinstance(value, list):
        return "[" + ",".join(vectors.number_text(field.type, element) for element in value) + "]"
    return vectors.number_text(field.type, value)


def main():
    with tempfile.TemporaryDirectory() as folder:
        peer = vectors.generate(pathlib.Path(folder), "2.0")
    mav = peer.MAVLink(None, srcSystem=1, srcComponent=1)
    lines = []
    for _, message_class in sorted(peer.mavlink_map.items()):
        for case in CASES:
            values = vectors.values_of(message_class, case)
            frame = vectors.message_of(message_class, values).pack(mav)
            fields = ",".join(f'"{f.name}":{value_text(f, values[f.name])}' for f in vectors.fields_of(message_class))
            lines.append(f"{message_class.msgname}\t{case}\t{bytes(frame).hex()}\t{fields}\n")
    GOLDEN.write_text("".join(lines), encoding="utf-8")
    print(f"{GOLDEN.relative_to(ROOT)}: {len(lines)} cases, {GOLDEN.stat().st_size} bytes")


if __name__ == "__main__":
    main()
