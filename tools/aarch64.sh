#!/usr/bin/env bash
# tools/aarch64.sh FOLDER [GTEST OPTION...]: compiles the module shm and its unit tests into FOLDER for 64-bit Arm,
# whose memory orders are weaker than x86's, and runs them under qemu. Needs the packages of ./run test, and these:
#   apt-get install --no-install-recommends g++-aarch64-linux-gnu qemu-user
set -euo pipefail
folder=$(realpath -m "$1")
shift
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.."

# Link only the third-party headers that are the same on every architecture: /usr/include also has headers of this one.
mkdir -p "$folder/outside"
for name in fmt tl; do ln -sfn "/usr/include/$name" "$folder/outside/$name"; done
readonly google=/usr/src/googletest
flags=(-std=c++20 -O1 -g1 -Wall -Wextra -DFMT_HEADER_ONLY -Iinclude -Isrc -Itests -isystem "$folder/outside"
       -isystem $google/googletest/include -isystem $google/googlemock/include
       -I$google/googletest -I$google/googlemock)

object_of() { echo "$folder/$(tr / _ <<<"${1#/}").o"; }
compile() { # SOURCE
  local object
  object=$(object_of "$1")
  [ "$object" -nt "$1" ] || aarch64-linux-gnu-g++ "${flags[@]}" -c "$1" -o "$object"
}

sources=(src/base/result.cpp src/base/shown.cpp src/base/suggest.cpp src/shm/*.cpp tests/unit/shm/*_test.cpp
         $google/googletest/src/gtest-all.cc $google/googlemock/src/gmock-all.cc $google/googlemock/src/gmock_main.cc)
for source in "${sources[@]}"; do
  while [ "$(jobs -r | wc -l)" -ge "$(nproc)" ]; do wait -n; done
  compile "$source" &
done
while [ "$(jobs | wc -l)" != 0 ]; do wait -n; done
mapfile -t objects < <(for source in "${sources[@]}"; do object_of "$source"; done)
aarch64-linux-gnu-g++ "${objects[@]}" -o "$folder/shm_test" -pthread -latomic
exec qemu-aarch64 -L /usr/aarch64-linux-gnu "$folder/shm_test" "$@"
