#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""bench decode: decodes a recorded flight to structs, to JSON lines and to text, and compares the speed with pymavlink.

pymavlink's mavgen generates its decoder from our definitions. Both decode the same bytes, in turns. Before the
measurement, both must return the same messages with the same values. Ratios are of messages per second."""
import argparse
import json
import math
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests" / "support"))
import pymavlink_vectors as vectors  # noqa: E402

CHUNK_BYTES = 4096


def frames_of(path):
    """The frames of a tlog of whole MAVLink 2 records, without their times."""
    data, at, frames = path.read_bytes(), 0, []
    while at < len(data):
        start = at + 8
        assert data[start] == 0xFD, f"{path}: no MAVLink 2 record at {at}"
        at = start + 12 + data[start + 1] + (13 if data[start + 2] & 1 else 0)
        frames.append(data[start:at])
    return b"".join(frames)


def peer_messages(module, frames):
    mav = module.MAVLink(None)
    mav.robust_parsing = True
    for at in range(0, len(frames), CHUNK_BYTES):
        yield from mav.parse_buffer(frames[at:at + CHUNK_BYTES]) or ()


# ---- the answers

def plain(value):
    """Converts a value of pymavlink to its JSON form."""
    if isinstance(value, float):
        return "NaN" if math.isnan(value) else ("Infinity" if value > 0
                                                else "-Infinity") if math.isinf(value) else value
    return [plain(element) for element in value] if isinstance(value, (list, tuple)) else value


def same(ours, theirs):
    if isinstance(theirs, list):
        return len(ours) == len(theirs) and all(map(same, ours, theirs))
    if isinstance(theirs, float) and not isinstance(ours, str):
        return vectors.as_float32(ours) == vectors.as_float32(theirs)
    return ours == theirs or ours == str(theirs)


def check_answers(program, flight, module, frames):
    """Ends the program if the two decoders return different messages or values."""
    lines = subprocess.run([program, "listen", str(flight), "--json", "-q"], stdout=subprocess.PIPE,
                           check=True).stdout.splitlines()
    theirs = list(peer_messages(module, frames))
    if len(lines) != len(theirs):
        sys.exit(f"bench decode: {len(lines)} messages by us, {len(theirs)} by pymavlink")
    for number, (line, message) in enumerate(zip(lines, theirs)):
        ours = json.loads(line)
        message_class = type(message)
        if ours["name"] != message.get_type() or ours["seq"] != message.get_seq():
            sys.exit(f"bench decode: message {number}: {line} against {message}")
        for field in vectors.fields_of(message_class):
            if field.is_text:
                value = getattr(message, f"_{field.name}_raw").rstrip(b"\0").decode("utf-8", "replace")
            else:
                value = plain(getattr(message, field.name))
            our_value = ours["fields"][field.name]
            if not same(our_value, value):
                sys.exit(f"bench decode: message {number}: {field.name}: {our_value!r} against {value!r}")
    return len(lines)


# ---- the clock

def rate_of(count, work):
    begin = time.perf_counter()
    work()
    return count / (time.perf_counter() - begin)


def peer_rates(module, frames, count):
    def objects():
        for _ in peer_messages(module, frames):
            pass

    def json_lines():
        for message in peer_messages(module, frames):
            message.to_json()

    def text():
        for message in peer_messages(module, frames):
            str(message)
    return {"structs": rate_of(count, objects), "json": rate_of(count, json_lines), "text": rate_of(count, text)}


def our_rates(program, structs, flight):
    """Runs each program once, briefly, and returns its median of a few turns, so that both sides alternate within
    seconds."""
    rates = {}
    for command in ([structs, str(flight), "5"], [program, "bench", "decode", str(flight), "--json", "--turns", "5",
                                                 "--chunk", str(CHUNK_BYTES)]):
        for line in subprocess.run([str(part) for part in command], stdout=subprocess.PIPE,
                                   check=True).stdout.splitlines():
            result = json.loads(line)
            rates[result["bench"].removeprefix("decode ")] = result["per_second"]
    return rates


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/bin/mavloom")
    parser.add_argument("--structs", type=pathlib.Path, help="decode_bench; default beside the program's build")
    parser.add_argument("--flight", type=pathlib.Path, default=ROOT / "tests/data/px4_gcs_flight.tlog")
    parser.add_argument("--turns", type=int, default=5)
    parser.add_argument("--json", action="store_true", help="print one JSON object per line")
    options = parser.parse_args()
    structs = options.structs or options.program.parent.parent / "bench" / "bin" / "decode_bench"

    frames = frames_of(options.flight)
    with tempfile.TemporaryDirectory() as folder:
        module = vectors.generate(pathlib.Path(folder), "2.0")
    count = check_answers(options.program, options.flight, module, frames)
    print(f"decode {count} messages of {options.flight.name}, {len(frames)} bytes, {options.turns} turns; "
          "both gave the same values", file=sys.stderr, flush=True)

    ours, theirs = [], []
    for _ in range(options.turns):
        ours.append(our_rates(options.program, structs, options.flight))
        theirs.append(peer_rates(module, frames, count))
    for form in ("structs", "json", "text"):
        ratios = [a[form] / b[form] for a, b in zip(ours, theirs)]
        us, them = statistics.median(a[form] for a in ours), statistics.median(b[form] for b in theirs)
        if options.json:
            print(json.dumps({"bench": f"decode {form}", "mavloom_per_s": round(us), "pymavlink_per_s": round(them),
                              "ratio": statistics.median(ratios), "lowest": min(ratios), "highest": max(ratios)}))
        else:
            print(f"  {form:<8} mavloom {us:12,.0f}/s   pymavlink {them:9,.0f}/s   "
                  f"ratio {statistics.median(ratios):7.1f} (lowest {min(ratios):.1f}, highest {max(ratios):.1f})")


if __name__ == "__main__":
    main()
