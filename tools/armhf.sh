#!/usr/bin/env bash
# tools/armhf.sh BUILD [MODULE...]: checks that the library compiles for 32-bit Arm, without making object files. BUILD
# is a build folder of this machine, whose generated files are used. Needs packaging/build.list and armhf.list.
set -euo pipefail
build=$(realpath "$1")
shift
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.."

# Link only the third-party headers that are the same on every architecture: /usr/include also has headers of this one.
outside=$(mktemp -d)
trap 'rm -r "$outside"' EXIT
names=(boost eigen3/Eigen fmt lzma lzma.h nlohmann pugiconfig.hpp pugixml.hpp sodium sodium.h tl toml++)
ln -s "${names[@]/#//usr/include/}" "$outside"
flags=(-std=c++20 -fsyntax-only -Wall -Wextra -Wno-psabi -Wno-subobject-linkage -Wno-restrict -DFMT_HEADER_ONLY
       "-DMAVLOOM_PAGE_FOLDER=\"$build/generated/page\"" -Iinclude -Isrc "-I$build/generated/include"
       "-I$build/generated/version" -isystem "$outside")

check() { # SOURCE...; as one, which saves most of the time
  printf '#include "%s"\n' "$@" | arm-linux-gnueabihf-g++ "${flags[@]}" -I. -x c++ -
}

status=0
modules=("$@")
if [ $# = 0 ]; then mapfile -t modules < <(ls src); fi
for module in "${modules[@]}"; do
  echo "$module"
  mapfile -t sources < <(find "src/$module" -name '*.cpp' ! -path '*/minimal/*' | sort)
  for ((i = 0; i < ${#sources[@]}; i += 12)); do check "${sources[@]:i:12}" || status=1; done
done
exit "$status"
