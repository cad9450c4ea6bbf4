#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""bench route: compares routers under load.

Each router runs as a process, in turns with the others, on the same sockets and with the same frames. Every frame that
arrives is compared with the frame that was sent. Ratios are to the bare loop of the same round. CPU is the user and
system time of the router's process per delivered frame. The exit status is 4 if mavloom lost frames in a round in which
the bare loop lost none, or delivered a frame that was not sent."""
import argparse
import json
import os
import pathlib
import statistics
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "bench" / "route"))
import peers as routers  # noqa: E402
from measure import Kit, Load, NoAnswer, measure  # noqa: E402

LOADS = [
    Load("10k", "1 to 1, 10,000 single-frame datagrams/s", 10_000, sink_rest_us=0),
    Load("100k", "1 to 1, 100,000 single-frame datagrams/s", 100_000),
    Load("8x300k", "1 to 1, 8 frames a datagram, 300,000 frames/s", 300_000, per_datagram=8),
    Load("8x1M", "1 to 1, 8 frames a datagram, 1,000,000 frames/s", 1_000_000, per_datagram=8, longest_s=5),
    Load("1to4", "1 to 4, 100,000 frames/s in", 100_000, outs=4),
    Load("1to16", "1 to 16, 100,000 frames/s in", 100_000, outs=16),
]
LINKS = Load("links", "250 systems of 5 components on 64 links, 1,000 frames/s in, each to the 63 other links", 1_000,
             outs=0, links=64, systems=250, components=5)
TAP = Load("tap", "1 to 1, 100,000 single-frame datagrams/s, every frame into a ring as well", 100_000)
HIGHEST = Load("highest", "1 to 1, highest rate of single-frame datagrams without loss", 50_000)
HIGHEST_CEILING, PROBES = 1_600_000, 14
BARE, GATHERING, OURS = "bare loop", "bare loop, gathering", "mavloom"

# Filters of each kind that every frame passes, so that both routers deliver the same frames.
FILTERS = ['in_block = "PARAM_VALUE,MISSION_ITEM_INT,FILE_TRANSFER_PROTOCOL,sys:251,sys:252,comp:200,comp:201"',
           'in_allow = "HEARTBEAT,ATTITUDE,ATTITUDE_QUATERNION,LOCAL_POSITION_NED,GLOBAL_POSITION_INT,'
           'SERVO_OUTPUT_RAW,ATTITUDE_TARGET,POSITION_TARGET_LOCAL_NED,ALTITUDE"',
           'out_block = "STATUSTEXT,LOG_DATA,sys:253,comp:202"',
           'out_allow = "comp:1,comp:2,comp:3,comp:4,comp:5"']


def link_routers(program):
    return [routers.MavloomConfigured(program, OURS, [], []),
            routers.MavloomConfigured(program, "mavloom, filters and dedup", ["dedup_ms = 500"], FILTERS)]


def taps(program):
    return [routers.Mavloom(program), routers.MavloomWithRing(program, "mavloom --ring"),
            routers.MavloomWithRing(program, "mavloom --ring, 3 readers", readers=3)]


# ---- the turns

class Bench:
    def __init__(self, kit, options):
        self.kit, self.seconds, self.rounds = kit, options.seconds, options.rounds
        self.as_json, self.failed = options.json, False

    def say(self, line):
        print(line, file=sys.stderr if self.as_json else sys.stdout, flush=True)

    def once(self, peer, load, rate=None):
        """Returns one measurement, or None if the router did not forward."""
        try:
            result = measure(self.kit, peer, load, self.seconds, rate)
        except NoAnswer as why:
            self.say(f"  {why}")
            return None
        if self.as_json:
            print(json.dumps(result), flush=True)
        return result

    def turns(self, load, peers):
        """Runs rounds of all peers and returns [{peer's name: result}]. Each round begins with another peer."""
        taken = []
        for number in range(self.rounds):
            shift = number % len(peers)
            results = {peer.name: self.once(peer, load) for peer in peers[shift:] + peers[:shift]}
            taken.append({name: result for name, result in results.items() if result})
        return taken

    def judge(self, taken):
        """Notes mavloom's own losses and wrong deliveries in rounds in which the bare loop had none."""
        for results in taken:
            ours, floor = results.get(OURS), results.get(BARE)
            wrong = ours and any(ours[what] for what in ("damaged", "duplicates", "echoes"))
            if not ours or wrong or (ours["lost"] and not (floor and floor["lost"])):
                self.failed = True


# ---- the tables

def median_of(taken, name, what):
    values = [results[name][what] for results in taken if name in results and results[name][what] is not None]
    return statistics.median(values) if values else None


def ratios_of(taken, name, base, what):
    return [results[name][what] / results[base][what] for results in taken
            if name in results and base in results and results[name][what] and results[base][what]]


def cell(value, form):
    return "-" if value is None else format(value, form)


def spread(ratios):
    return "-" if not ratios else f"{statistics.median(ratios):.2f} ({min(ratios):.2f}, {max(ratios):.2f})"


def wrongs(taken, name):
    """Lists unwanted arrivals and shortfalls of the load itself, over all rounds."""
    all_of = [results[name] for results in taken if name in results]
    words = [f"{what} {sum(result[what] for result in all_of)}"
             for what in ("damaged", "duplicates", "echoes", "reordered", "lost_at_sink")
             if any(result[what] for result in all_of)]
    slowest = min((result["rate"] / result["asked_rate"] for result in all_of), default=1)
    if slowest < 0.99:
        words.append(f"load reached {slowest:.0%}")
    return words


def table(say, taken, peers, base):
    say(f"  {'router':<28} {'CPU us/frame':>12} {'times ' + base + ' (lowest, highest)':>36} {'lost %':>9} "
        f"{'median us':>10} {'p99 us':>10} "
        f"{'RssAnon KiB, growth':>20}  notes")
    for peer in peers:
        if not any(peer.name in results for results in taken):
            say(f"  {peer.name:<28} gave no answer")
            continue
        notes = wrongs(taken, peer.name) + ([peer.note] if peer.note else [])
        early, late = (median_of(taken, peer.name, what) for what in ("rss_anon_kib_early", "rss_anon_kib"))
        say(f"  {peer.name:<28} {cell(median_of(taken, peer.name, 'cpu_us_per_frame'), '.3f'):>12} "
            f"{spread(ratios_of(taken, peer.name, base, 'cpu_us_per_frame')):>36} "
            f"{cell(median_of(taken, peer.name, 'loss_percent'), '.3f'):>9} "
            f"{cell(median_of(taken, peer.name, 'median_us'), ',.0f'):>10} "
            f"{cell(median_of(taken, peer.name, 'p99_us'), ',.0f'):>10} {late:>11,.0f}, "
            f"{late - early:>+7,.0f}  {'; '.join(notes)}")


def print_ratios(load, taken, peers, base):
    for peer in peers:
        for what in ("cpu_us_per_frame", "median_us", "p99_us"):
            if peer.name != base and (ratios := ratios_of(taken, peer.name, base, what)):
                print(json.dumps({"load": load.key, "peer": peer.name, "against": base, "of": what,
                                  "ratio": statistics.median(ratios), "lowest": min(ratios), "highest": max(ratios)}),
                      flush=True)


def run_table(bench, load, peers, base):
    bench.say(f"\n{load.title}; rounds: {bench.rounds}, of {min(bench.seconds, load.longest_s):g} s")
    taken = bench.turns(load, peers)
    table(bench.say, taken, peers, base)
    for peer, what in ((GATHERING, "that of the bare loop, gathering"), ("mavrouter", "mavrouter's")):
        if ratios := ratios_of(taken, OURS, peer, "cpu_us_per_frame"):
            bench.say(f"  mavloom's CPU for a frame is {spread(ratios)} times {what}")
    if bench.as_json:
        print_ratios(load, taken, peers, base)
    bench.judge(taken)


# ---- the highest rate

class Search:
    """Searches the highest rate at which a router loses nothing: doubles the rate, then halves the interval."""

    def __init__(self, peer, precision):
        self.peer, self.precision = peer, precision
        self.low, self.high, self.capped, self.dead = 0, None, False, False

    @property
    def next_rate(self):
        if not self.low:
            return HIGHEST.rate if self.high is None else self.high // 2
        return min(2 * self.low, HIGHEST_CEILING) if self.high is None else (self.low + self.high) // 2

    @property
    def done(self):
        found = self.low and self.high is not None and self.high <= self.low * self.precision
        return self.dead or self.capped or found or self.low >= HIGHEST_CEILING or self.next_rate < 500

    def learn(self, rate, result):
        if result is None:
            self.dead = True
        elif result["lost"]:
            self.high = rate
        elif result["rate"] < 0.98 * rate:
            self.low, self.capped = max(self.low, int(result["rate"])), True  # the load generator's own limit
        else:
            self.low = rate


def find_highest(bench, peers, precision):
    bench.say(f"\n{HIGHEST.title} over {bench.seconds:g} s, found within {100 * (precision - 1):.0f} %")
    searches = [Search(peer, precision) for peer in peers]
    for _ in range(PROBES):
        for search in searches:
            if not search.done:
                rate = search.next_rate
                search.learn(rate, bench.once(search.peer, HIGHEST, rate))
    floor = next((search.low for search in searches if search.peer.name == BARE), 0)
    for search in searches:
        ratio = f"{search.low / floor:6.2f} times the bare loop's" if floor else ""
        rate = f"{search.low:,}/s" if search.low else f"below {search.high:,}/s" if search.high else "gave no answer"
        bench.say(f"  {search.peer.name:<28} {rate:>16} {ratio}{'; no more could be sent' if search.capped else ''}")
        if bench.as_json:
            print(json.dumps({"load": HIGHEST.key, "peer": search.peer.name, "highest_rate": search.low,
                              "at_least": search.capped}), flush=True)


# ---- the command

def parse_options():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/bin/mavloom")
    parser.add_argument("--tools", type=pathlib.Path,
                        help="folder of route_generator and the other tools; default: beside the program's build")
    parser.add_argument("--peers", type=pathlib.Path, default=ROOT / "build/peers",
                        help="folder in which other routers are installed")
    parser.add_argument("--flight", type=pathlib.Path, default=ROOT / "tests/data/px4_gcs_flight.tlog")
    parser.add_argument("--quick", action="store_true",
                        help="2 s and 2 rounds, the highest rate within 10 %%: for a quick check, not for published "
                             "figures")
    parser.add_argument("--seconds", type=float, help="length of each load; default 10")
    parser.add_argument("--rounds", type=int, help="default 5")
    loads = ",".join(load.key for load in (*LOADS, LINKS, TAP, HIGHEST))
    parser.add_argument("--only", default="", help=f"only these loads: {loads}")
    parser.add_argument("--without", default="", help="peers to leave out: mavrouter,mavproxy")
    parser.add_argument("--nice", type=int, default=0,
                        help="nice value of load, routers and far side: use -10 (as root) "
                             "on a machine that also does other work")
    parser.add_argument("--json", action="store_true",
                        help="print one JSON object per line: each measurement, then ratios; the tables go to standard "
                             "error")
    options = parser.parse_args()
    options.program = options.program.resolve()  # routers run in a folder of their own
    options.tools = (options.tools or options.program.parent.parent / "bench" / "bin").resolve()
    options.seconds = options.seconds or (2 if options.quick else 10)
    options.rounds = options.rounds or (2 if options.quick else 5)
    keys = [load.key for load in (*LOADS, LINKS, TAP, HIGHEST)]
    options.only = [word for word in options.only.split(",") if word] or keys
    if unknown := set(options.only) - set(keys):
        parser.error(f"no load {', '.join(sorted(unknown))}; there are {', '.join(keys)}")
    return options


def main():
    options = parse_options()
    os.nice(options.nice)
    bench = Bench(Kit(options.tools, options.flight), options)
    without = options.without.lower().split(",")
    peers, missing = routers.at_hand(options.program, options.tools, options.peers.resolve(), without)
    for why in missing:
        bench.say(f"bench route: {why}")
    for load in LOADS:
        if load.key in options.only:
            run_table(bench, load, peers, BARE)
    if LINKS.key in options.only:
        run_table(bench, LINKS, link_routers(options.program), OURS)
    if TAP.key in options.only:
        run_table(bench, TAP, taps(options.program), OURS)
    if HIGHEST.key in options.only:
        find_highest(bench, peers, 1.1 if options.quick else 1.05)
    return 4 if bench.failed else 0


if __name__ == "__main__":
    sys.exit(main())
