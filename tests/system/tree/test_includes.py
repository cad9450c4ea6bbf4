# SPDX-License-Identifier: MIT
"""Every #include agrees with the module table of docs/design/modules.md, and so does the link graph."""
import pathlib
import re

import pytest

from harness import ROOT

INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]', re.MULTILINE)

# Where a library shows itself in an #include, and the name it has in the table.
LIBRARIES = {
    "CLI/": "CLI11", "spdlog/": "spdlog", "pugi": "pugixml", "sodium": "libsodium", "toml": "toml++",
    "nlohmann/": "nlohmann-json", "Eigen/": "Eigen", "GeographicLib/": "GeographicLib", "boost/": "Boost",
    "lzma.h": "liblzma", "qrencode.h": "libqrencode",
    "ncurses": "ncurses", "nats/": "NATS", "sys/socket.h": "sockets", "sys/epoll.h": "sockets", "sys/un.h": "sockets",
    "netinet/": "sockets", "netdb.h": "sockets",
    "nanobind/": "nanobind", "arpa/": "sockets", "ifaddrs.h": "sockets", "net/": "sockets", "termios.h": "sockets",
}

# Users of Mavloom's headers have these: the system's own.
PUBLIC_LIBRARIES = {"sockets"}

# A module, and another whose private headers it may include.
SHARED_PRIVATELY = {("sim", "flight"), ("hil", "flight"), ("router", "control"), ("simserve", "control")}

# Typed structs are generated into the build folder: they are part of module `message`.
FOLDER_OF_MODULE = {"msg": "message"}


def names(cell: str) -> set:
    return {name.strip() for name in cell.split(",") if name.strip()}


def module_table() -> dict:
    """{module: (modules it may use, libraries it may use)} from the document."""
    rows = re.findall(r"^\| `(\w+)` \|[^|]*\|([^|]*)\|([^|]*)\|$", (ROOT / "docs/design/modules.md").read_text(),
                      re.MULTILINE)
    return {module: (names(uses), names(libraries)) for module, uses, libraries in rows}


def module_of(path: pathlib.PurePath) -> str:
    parts = path.parts
    return {"include": lambda: parts[2], "src": lambda: parts[1], "apps": lambda: "apps",
            "python": lambda: "python"}[parts[0]]()


def is_of_python(name: str) -> bool:
    """Folders of the Python module are named like the modules whose objects they show."""
    return (ROOT / "python/src" / name).exists()


def complaints_about(path: pathlib.PurePath, text: str, table: dict) -> list:
    module = module_of(path)
    if module not in table:
        return [f"{path}: module `{module}` has no row in docs/design/modules.md"]
    uses, libraries = table[module]
    public = path.parts[0] == "include"
    complaints = []
    for match in INCLUDE.finditer(text):
        where = f"{path}:{text.count(chr(10), 0, match.start()) + 1}: \"{match[2]}\""
        parts = match[2].split("/")
        if parts[0] == "mavloom":
            target = FOLDER_OF_MODULE.get(parts[1], parts[1])
            if target != module and target not in uses:
                complaints.append(f"{where}: `{module}` may not include `{target}`, only "
                                  f"{', '.join(sorted(uses)) or 'nothing'}")
        elif module == "python" and is_of_python(match[2]):
            pass
        elif not public and (module, parts[0]) in SHARED_PRIVATELY:
            pass
        elif match[1] == '"' and len(parts) > 1 and parts[0] in table and (public or parts[0] != module):
            complaints.append(f"{where}: private headers of `{parts[0]}` are its own")
        elif match[1] == '"' and ".." in parts:
            complaints.append(f"{where}: no include climbs out of its folder")
        else:
            library = next((name for prefix, name in LIBRARIES.items() if match[2].startswith(prefix)), None)
            if library and library not in libraries:
                complaints.append(f"{where}: `{module}` may not include {library}")
            elif library and public and library not in PUBLIC_LIBRARIES:
                complaints.append(f"{where}: a public header may not include {library}")
    return complaints


def sources() -> list:
    return sorted(path.relative_to(ROOT) for top in ("include", "src", "apps", "python/src")
                  for pattern in ("*.hpp", "*.cpp", "*.inc")
                  for path in (ROOT / top).rglob(pattern))


def test_table_is_read():
    table = module_table()
    assert table["base"] == (set(), {"fmt", "tl::expected"})
    assert table["edit"][0] == {"base", "wire", "dialect", "message"}
    assert all(uses <= set(table) for uses, _ in table.values())


def test_includes_follow_the_module_table():
    table = module_table()
    found = sources()
    assert len(found) > 10

    complaints = [line for path in found for line in complaints_about(path, (ROOT / path).read_text(), table)]

    assert not complaints, "\n" + "\n".join(complaints)


@pytest.mark.parametrize("path, line, reason", [
    ("src/net/udp.cpp", '#include "mavloom/wire/frame.hpp"', "`net` may not include `wire`, only base"),
    ("include/mavloom/wire/x.hpp", '#include "mavloom/dialect/dialect.hpp"',
     "`wire` may not include `dialect`, only base"),
    ("src/record/x.cpp", "#  include <mavloom/link/links.hpp>", "`record` may not include `link`, only base, wire"),
    ("src/control/x.cpp", '#include "mavloom/router/router.hpp"',
     "`control` may not include `router`, only base, endpoint, fault, http, link, net"),
    ("src/wire/x.cpp", '#include "mavloom/msg/attitude.hpp"', "`wire` may not include `message`, only base"),
    ("apps/mavloom/x.cpp", '#include "net/socket_options.hpp"', "private headers of `net` are its own"),
    ("include/mavloom/wire/x.hpp", '#include "wire/sha.hpp"', "private headers of `wire` are its own"),
    ("src/wire/x.cpp", '#include "../base/x.hpp"', "no include climbs out of its folder"),
    ("src/edit/x.cpp", "#include <sys/socket.h>", "`edit` may not include sockets"),
    ("include/mavloom/wire/x.hpp", "#include <sodium.h>", "a public header may not include libsodium"),
    ("python/src/x.cpp", '#include "wire/crc_tables.hpp"', "private headers of `wire` are its own"),
    ("src/wire/x.cpp", "#include <nanobind/nanobind.h>", "`wire` may not include nanobind"),
    ("src/simserve/x.cpp", '#include "flight/flight.hpp"', "private headers of `flight` are its own"),
    ("include/mavloom/sim/x.hpp", '#include "flight/flight.hpp"', "private headers of `flight` are its own"),
    ("src/novel/x.cpp", "", "module `novel` has no row in docs/design/modules.md"),
])
def test_forbidden_include_is_found(path, line, reason):
    complaints = complaints_about(pathlib.PurePath(path), f"#pragma once\n{line}\n", module_table())

    assert len(complaints) == 1 and complaints[0].endswith(reason)


@pytest.mark.parametrize("path, line", [
    ("src/net/udp.cpp", "#include <sys/socket.h>"),
    ("src/wire/parser.cpp", '#include "wire/crc_tables.hpp"'),
    ("src/edit/edit.cpp", '#include "mavloom/base/ids.hpp"'),
    ("include/mavloom/base/result.hpp", "#include <tl/expected.hpp>"),
    ("apps/mavloom/listen.cpp", '#include "mavloom/msg/attitude.hpp"'),
    ("src/sim/parts.hpp", '#include "flight/flight.hpp"'),
    ("src/router/x.cpp", '#include "control/json_lines.hpp"'),
    ("python/src/link/port.cpp", '#include "link/subscription.hpp"'),
])
def test_allowed_include_passes(path, line):
    assert complaints_about(pathlib.PurePath(path), line, module_table()) == []


def test_link_graph_follows_the_module_table():
    table = module_table()
    keyword = "LINK|PRIVATE_LINK|COLD|NO_SOURCES"
    declared = re.findall(rf"^mavloom_module\((\w+)(?: DEPENDS ([\w\s]*?))?(?=\)|\s+(?:{keyword}))",
                          (ROOT / "CMakeLists.txt").read_text(), re.MULTILINE)
    direct = {module: set(depends.split()) for module, depends in declared}
    assert set(direct) == set(table) - {"apps", "python"}
    for module in direct:
        assert direct[module] <= table[module][0], (f"CMakeLists.txt links `{module}` with more than "
                                                    "docs/design/modules.md allows")
