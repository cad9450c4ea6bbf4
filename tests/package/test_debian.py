# SPDX-License-Identifier: MIT
"""Checks the Debian packages that `./run package` builds. dpkg installs, upgrades and purges them in a clean root,
which debootstrap makes. With `.ci/run --full`, lintian reads them too."""
import os
import pathlib
import platform
import re
import shutil
import subprocess
import sysconfig

import pytest
from test_package import BUILD, EXPECTED, OUTSIDE, call, forwarding_router
from test_wheel import check_use, make_wheel

pytestmark = pytest.mark.timeout(1800)

LARGEST_KIB = 7812  # 8 MB, that mavloom.deb installs
NAMES = ("mavloom", "libmavloom-dev", "python3-mavloom")


def make_packages(build, folder, path=os.environ["PATH"]):
    """{name: path}"""
    call("env", f"PATH={path}", "cpack", "--config", build / "CPackConfig.cmake", "-B", folder)
    return {path.name.split("_")[0]: path for path in folder.glob("*.deb")}


def contents(package):
    """{path: listing} of a package."""
    lines = call("dpkg-deb", "--contents", package).splitlines()
    return {line.split(maxsplit=5)[5].split(" -> ")[0].removeprefix("."): line for line in lines}


def check_files(packages):
    assert set(packages) == set(NAMES)
    files = {name: contents(path) for name, path in packages.items()}
    for file in ("/usr/bin/mavloom", "/usr/lib/systemd/system/mavloom-router.service",
                 "/usr/share/man/man1/mavloom.1.gz", "/usr/share/man/man1/mavloom-route.1.gz",
                 "/usr/share/bash-completion/completions/mavloom",
                 "/usr/share/zsh/vendor-completions/_mavloom", "/usr/share/fish/vendor_completions.d/mavloom.fish",
                 "/usr/share/doc/mavloom/guide/route.md", "/usr/share/doc/mavloom/licences.txt"):
        assert file in files["mavloom"], file
    assert int(call("dpkg-deb", "--field", packages["mavloom"], "Installed-Size")) < LARGEST_KIB
    assert "/usr/include/mavloom/wire/frame.hpp" in files["libmavloom-dev"]
    for file in ("/usr/lib/python3/dist-packages/mavloom/__init__.py", "/usr/share/doc/mavloom/guide/python.md"):
        assert file in files["python3-mavloom"], file
    for name in NAMES:
        assert f"/usr/share/doc/{name}/copyright" in files[name]
        assert all(line.split()[1] == "root/root" for line in files[name].values())
    synopses = {call("dpkg-deb", "--field", path, "Description").splitlines()[0] for path in packages.values()}
    assert len(synopses) == len(NAMES) and all(len(synopsis) < 80 for synopsis in synopses), synopses
    assert not set.intersection(*({f for f in listed if not f.endswith("/")} for listed in files.values()))


def check_with_lintian(packages):
    done = subprocess.run(["lintian", "--allow-root", "--fail-on", "error", *packages.values()],
                          stdin=subprocess.DEVNULL, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout


def mirror():
    """(suite, URI) of this machine's release, from its sources; None: not a Debian with a mirror."""
    suite = platform.freedesktop_os_release().get("VERSION_CODENAME", "")
    for file in (pathlib.Path("/etc/apt/sources.list"), *pathlib.Path("/etc/apt/sources.list.d").glob("*")):
        for entry in file.read_text().split("\n\n") if file.is_file() else ():
            is_block = re.search(rf"^Suites:.*\b{suite}\b", entry, re.MULTILINE)
            form = r"^URIs: (\S+)" if is_block else rf"^deb (?:\[.*?\] )?(\S+) {suite} "
            if found := re.search(form, entry, re.MULTILINE):
                return suite, found[1]
    return None


def depends_of(package):
    return [re.split(r"[ (|]", one.strip())[0]
            for one in call("dpkg-deb", "--field", package, "Depends").split(",") if one.strip()]


def make_clean_root(root, packages, *programs):
    """A Debian with these programs, what the packages depend on, and nothing else."""
    suite, uri = mirror()
    wanted = {name for package in packages for name in depends_of(package)}
    call("debootstrap", "--variant=minbase", f"--include={','.join(sorted(wanted.union(programs)))}", suite, root, uri)
    for package in packages:
        shutil.copy(package, root / "tmp")


def files_of(root):
    """Of the folders where packages put files, without what dpkg keeps about them."""
    return {str(path.relative_to(root)) for top in ("etc", "usr", "lib", "var/lib") for path in (root / top).rglob("*")
            if "var/lib/dpkg" not in str(path) and "__pycache__" not in str(path) and "mavloom" in path.name}


def check_life(root, packages):
    """Installed, used, installed over a router that runs, as in an upgrade, and purged."""
    def inside(*command):
        return call("chroot", root, *command)

    def install():
        return inside("dpkg", "-i", *(f"/tmp/{packages[name].name}" for name in ("mavloom", "python3-mavloom")))
    install()
    assert inside("mavloom", "--version").startswith("mavloom ")
    assert inside("mavloom", "dialect", "show", "HEARTBEAT").startswith("HEARTBEAT")
    # Python keeps the compiled module, which the package must remove.
    assert inside("env", "-u", "PYTHONDONTWRITEBYTECODE", "python3", "-c",
                  "import mavloom; print(mavloom.messages.ATTITUDE.__name__)") == "ATTITUDE\n"
    assert re.search(r"^mavloom:", (root / "etc/passwd").read_text(), re.MULTILINE), "the router's user"
    (root / "etc/mavloom/router.toml").write_text('[[endpoint]]\nurl = "tcpin://0.0.0.0:5760"\n')  # as the guide does
    inside("mavloom", "check", "/etc/mavloom/router.toml")
    with forwarding_router("chroot", root, "mavloom") as (router, check):
        check(1)
        install()
        assert pathlib.Path(f"/proc/{router.pid}/exe").readlink().name == "mavloom (deleted)"
        check(2)
    assert {"etc/mavloom", "usr/bin/mavloom"} <= files_of(root)
    inside("dpkg", "--purge", "python3-mavloom", "mavloom")
    assert not files_of(root)


# The libraries of a wheel that a small Debian has, too: dpkg and its shell need them.
OF_EVERY_DEBIAN = {"libc6", "libgcc-s1", "liblzma5", "libncursesw6", "libstdc++6", "libtinfo6"}


def check_life_of_wheel(root, folder, packages):
    """Installed, used and removed where the libraries are missing that the program needs. Debian 12 leaves pip to
    python3-pip; this takes the tests' own."""
    def inside(*command):  # with /proc, from which the loader learns where the program's own libraries are
        return call("unshare", "--mount", "--pid", "--fork", "--root", root, "--mount-proc", *command)

    def pip(*arguments):
        inside("env", "PYTHONPATH=/tmp/pip", "python3", "-m", "pip", *arguments, "--break-system-packages")
    inside("dpkg", "--purge", "--force-depends", *sorted(set(depends_of(packages["mavloom"])) - OF_EVERY_DEBIAN))
    shutil.copytree(pathlib.Path(sysconfig.get_path("purelib"), "pip"), root / "tmp/pip/pip")
    wheel = pathlib.Path(shutil.copy(make_wheel(folder), root / "tmp"))
    pip("install", "--no-index", "--no-deps", f"/tmp/{wheel.name}")
    check_use(lambda *arguments: inside("python3", *arguments), lambda *arguments: inside("mavloom", *arguments))
    pip("uninstall", "--yes", "mavloom")
    assert not list((root / "usr/local").rglob("*mavloom*"))


def check_development(root, package):
    """An outside project compiles with libmavloom-dev, and its program runs."""
    def inside(*command):
        return call("chroot", root, *command)
    make_clean_root(root, [package], "cmake", "g++", "make")
    inside("dpkg", "-i", f"/tmp/{package.name}")
    shutil.copytree(OUTSIDE, root / "tmp/outside")
    inside("cmake", "-S", "/tmp/outside", "-B", "/tmp/build")
    inside("cmake", "--build", "/tmp/build")
    assert inside("/tmp/build/outside") == EXPECTED


def test_packages_install_run_and_go_without_a_trace(tmp_path):
    """One test, because making the packages takes most of its time."""
    if "CMAKE_BUILD_TYPE:STRING=Release" not in (BUILD / "CMakeCache.txt").read_text():
        pytest.skip("packages are made of a release build")
    packages = make_packages(BUILD, tmp_path / "packages")
    check_files(packages)
    if "MAVLOOM_FULL" in os.environ:
        check_with_lintian(packages)
    if not shutil.which("debootstrap"):
        pytest.skip("debootstrap is missing: ./run test installs it")
    if os.geteuid() != 0 or mirror() is None:
        pytest.skip("a clean root needs root and a Debian mirror in the machine's sources")
    make_clean_root(tmp_path / "root", [packages["mavloom"], packages["python3-mavloom"]], "systemd")
    check_life(tmp_path / "root", packages)
    if "MAVLOOM_FULL" in os.environ:
        check_life_of_wheel(tmp_path / "root", tmp_path / "wheels", packages)
        check_development(tmp_path / "development", packages["libmavloom-dev"])
        shutil.rmtree(tmp_path / "development")
    shutil.rmtree(tmp_path / "root")
