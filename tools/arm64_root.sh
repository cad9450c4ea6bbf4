#!/usr/bin/env bash
# tools/arm64_root.sh FOLDER: gathers in FOLDER what a build for 64-bit Arm needs from Debian: headers and libraries of
# packaging/build.list and of the tests, and dpkg's records of them, from which the dependencies of the packages follow.
# Nothing is installed on this machine. With cmake/toolchains/arm64.cmake, CMake finds it all.
set -euo pipefail
mkdir -p "$1"
root=$(realpath "$1")
lists=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../packaging
records=$root/var/lib/dpkg

# Of the packages that a build needs, those that depend on the architecture, and headers. Test libraries come last.
mapfile -t packages < <(grep -hE '^(lib|nlohmann)' "$lists/build.list"
                        grep -hE '^lib(gtest|gmock|rapidcheck)' "$lists/test.list")
packages+=(libc6-dev libstdc++-12-dev)

wanted=$(printf '%s\n' "${packages[@]}" | sort)
if [ "$(cat "$root/packages" 2>/dev/null)" = "$wanted" ]; then exit 0; fi
rm -rf "$root"
mkdir -p "$records/info" "$root/apt/lists/partial" "$root/apt/archives/partial" "$root/usr/lib" "$root/usr/bin"
ln -s usr/lib usr/bin "$root"  # as on every Debian machine
: >"$records/status"
echo 1 >"$records/info/format"  # names of files have the architecture

# apt with records of its own, in which nothing is installed.
apt=(apt-get -q -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o APT::Sandbox::User="$(id -un)"
     -o Dir::State::lists="$root/apt/lists" -o Dir::State::status="$records/status"
     -o Dir::State::extended_states="$root/apt/extended" -o Dir::Cache::archives="$root/apt/archives"
     -o Dir::Cache::pkgcache= -o Dir::Cache::srcpkgcache=)
"${apt[@]}" update >&2
"${apt[@]}" install --yes --no-install-recommends --download-only "${packages[@]}" >&2

# dpkg-shlibdeps asks which package a library is of, by the path that it found.
record() { # PACKAGE FILE
  local name file control=$root/control
  name=$(dpkg-deb --field "$1" Package)
  if [ "$(dpkg-deb --field "$1" Multi-Arch)" = same ]; then name+=:$(dpkg-deb --field "$1" Architecture); fi
  rm -rf "$control"
  dpkg-deb --control "$1" "$control"
  tar --list -f "$2" | sed -n "s|^\./lib/|$root/usr/lib/|p; s|^\./usr/|$root/usr/|p" >"$records/info/$name.list"
  for file in symbols shlibs; do
    if [ -e "$control/$file" ]; then cp "$control/$file" "$records/info/$name.$file"; fi
  done
  sed '/^Package:/a Status: install ok installed' "$control/control" >>"$records/status"
  echo >>"$records/status"
}

for package in "$root"/apt/archives/*.deb; do
  dpkg-deb --fsys-tarfile "$package" >"$root/files.tar"
  tar --extract --keep-directory-symlink -f "$root/files.tar" -C "$root"
  record "$package" "$root/files.tar"
done
rm -rf "$root/apt" "$root/control" "$root/files.tar"

# Links such as libtinfo.so -> /lib/.../libtinfo.so.6 would lead out of the folder, and the linker would use libtinfo.a.
find "$root/usr" -type l -lname '/*' -printf '%p %l\n' | while read -r link target; do
  ln -sfn "$root$target" "$link"
done

# CPack calls it without options.
mkdir -p "$root/tools"
cat >"$root/tools/dpkg-shlibdeps" <<TEXT
#!/bin/sh
exec $(command -v dpkg-shlibdeps) --admindir="$records" "\$@"
TEXT
chmod +x "$root/tools/dpkg-shlibdeps"
echo "$wanted" >"$root/packages"
