#!/usr/bin/env bash
# Flies PX4 on Mavloom's physics: starts the simulator, a router and PX4, and ends all three on Ctrl-C.
#
#   examples/px4-hil.sh PX4_FOLDER [OPTION OF mavloom sim ...]
#   PX4_SIM_SPEED_FACTOR=5 examples/px4-hil.sh ~/PX4-Autopilot --wind 4,270
#
#   simulator :4560 <---> PX4 :18570 <---> :5057 router <---> ground station :14550
#                                              router <---> :5760 SDKs: tcpout://127.0.0.1:5760 (MAVSDK),
#                                                                       tcp:127.0.0.1:5760 (pymavlink, MAVProxy)
#
# PX4_FOLDER is PX4's source folder with a finished px4_sitl_default, or that build's own folder. These variables change
# what the script starts (docs/guide/hil.md):
#
#   PX4_INSTANCE=1           second vehicle: ports 4561, 18571, 5058, 14551 and 5761, system id 2; its simulator is sim1
#   PX4_SIM_MODEL=none_iris  PX4's airframe
#   PX4_SIM_SPEED_FACTOR=5   speed of the flight, for PX4's time-outs too
#   PX4_WORK=FOLDER          keeps PX4's parameters and logs there; without it, they are removed at the end
#   GCS=HOST:PORT            the ground station
set -euo pipefail

here=$(cd "$(dirname "$(readlink -f "$0")")/.." && pwd)
mavloom=${MAVLOOM_PROGRAM:-$here/build/release/bin/mavloom}
unset MAVLOOM_PROGRAM # the program would take it for one of its settings
[ -x "$mavloom" ] || mavloom=$(command -v mavloom) || {
  echo "there is no mavloom: type ./run build first" >&2
  exit 1
}
[ $# -gt 0 ] || { echo "usage: $0 PX4_FOLDER [OPTION OF mavloom sim ...]" >&2; exit 2; }
build=$1/build/px4_sitl_default
[ -x "$build/bin/px4" ] || build=$1
[ -x "$build/bin/px4" ] || { echo "$1: neither bin/px4 nor build/px4_sitl_default/bin/px4 is there" >&2; exit 1; }
build=$(cd "$build" && pwd)
shift
if [ "$(id -u)" = 0 ]; then
  echo "PX4 takes real-time priority when root runs it. An ordinary user is safer." >&2
fi

case ${PX4_INSTANCE:-0} in
  *[!0-9]*) echo "PX4_INSTANCE=$PX4_INSTANCE is not a number, as in PX4_INSTANCE=1" >&2; exit 2 ;;
esac
number=${PX4_INSTANCE:-0} name=sim${PX4_INSTANCE:-} gcs=${GCS:-127.0.0.1:$((14550 + ${PX4_INSTANCE:-0}))}
export PX4_SIM_MODEL=${PX4_SIM_MODEL:-none_iris}
work=${PX4_WORK:-$(mktemp -d)}
mkdir -p "$work"
work=$(cd "$work" && pwd)

stop() { # PID: asks it to end, and ends it after a second
  kill -TERM "$1" 2>/dev/null || return 0
  for _ in {1..20}; do
    kill -0 "$1" 2>/dev/null || return 0
    sleep 0.05
  done
  kill -KILL "$1" 2>/dev/null || true
}
# PX4 goes first, and for certain: without its simulator it would take a whole core.
end() {
  trap '' INT TERM
  trap - EXIT
  for pid in "${px4:-}" "${router:-}" "${simulator:-}"; do
    [ -z "$pid" ] || stop "$pid"
  done
  wait || true
  [ -n "${PX4_WORK:-}" ] || rm -rf "$work"
}
trap end EXIT
trap 'end; exit 130' INT
trap 'end; exit 143' TERM

"$mavloom" sim --name "$name" --hil "px4=tcpin://127.0.0.1:$((4560 + number))" --system $((1 + number)) "$@" &
simulator=$!
# PX4 starts once the simulator answers. If an option is wrong, the simulator has ended, and its message stands alone.
for _ in {1..100}; do
  kill -0 "$simulator" 2>/dev/null || { wait "$simulator"; exit; }
  if "$mavloom" ctl "$name" state >/dev/null 2>&1; then break; fi
  sleep 0.05
done
# The router's heartbeat is the first frame that PX4 hears, so PX4 answers the router from then on.
"$mavloom" route --name "px4-$number" --heartbeat 255/191 \
  "udpout://127.0.0.1:$((18570 + number))?name=px4&bind=127.0.0.1:$((5057 + number))" \
  "udpout://$gcs?name=gcs&heartbeat=false" "tcpin://127.0.0.1:$((5760 + number))?name=sdk" &
router=$!
(cd "$work" && exec "$build/bin/px4" -d -i "$number" -w "$work" "$build/etc") &
px4=$!
wait -n # all three normally run until a signal
