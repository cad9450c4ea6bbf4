#!/usr/bin/env bash
# Connects a vehicle and a ground station through a ring in shared memory, in both directions:
#
#   vehicle ──udp──▶ python -m mavloom.hear ──ring px4──▶ mavloom relay ──udp──▶ ground station
#           ◀──udp──                        ◀──px4.in───               ◀──udp──
#
#   examples/pipeline/run.sh                 a vehicle that sends to port 5058 of this machine, until Ctrl-C
#   examples/pipeline/run.sh FLIGHT.tlog     a recorded flight at its own pace, to its end; SPEED=10 is faster
#
# Frames from the ground station return to the vehicle through the ring's inlet (px4.in), so parameters, missions and
# commands work. Set LISTEN, TO and RING to change the source, the destination and the name of the ring. The script
# ends both programs together. If you start them by hand, you can stop and restart each of them separately. Other
# programs, in C++ or Python, can read the ring at any time (docs/guide/python.md, docs/guide/shm.md).
set -euo pipefail

here=$(cd "$(dirname "$(readlink -f "$0")")/../.." && pwd)
mavloom=${MAVLOOM_PROGRAM:-$here/build/release/bin/mavloom}
python=${PYTHON:-$here/build/venv/bin/python}
listen=${LISTEN:-udpin://127.0.0.1:5058} to=${TO:-udpout://127.0.0.1:14550} ring=${RING:-px4}

if ! [ -x "$mavloom" ] || ! [ -x "$python" ]; then
  echo "type ./run build first: $mavloom or $python is not there" >&2
  exit 1
fi
log=$(mktemp)

# Ctrl-C reaches every process of the script. This subshell ignores it, so that it still prints the last messages of
# mavloom.hear.
"$python" -m mavloom.hear "$listen" --ring "$ring" 2> >(trap '' INT TERM HUP && exec tee "$log" >&2) &
hear=$!
"$mavloom" relay "shm://$ring?from=oldest" --to "$to" &
relay=$!
# Ends both programs. The relay first sends what the ring still holds.
end() {
  trap '' INT TERM
  trap - EXIT
  kill -TERM "$hear" 2>/dev/null || true
  wait "$hear" || true
  kill -TERM "$relay" 2>/dev/null || true
  wait "$relay" || true
  rm -f "$log"
}
trap end EXIT
trap 'end; exit 130' INT
trap 'end; exit 143' TERM

if [ $# -gt 0 ]; then
  until grep -q "writing to ring" "$log"; do
    kill -0 "$hear" 2>/dev/null || exit 1 # hear has printed the reason
    sleep 0.1
  done
  "$mavloom" replay "$1" --to "${listen/udpin/udpout}" --speed "${SPEED:-1}"
else
  wait -n "$hear" "$relay" # both normally run until a signal
fi
