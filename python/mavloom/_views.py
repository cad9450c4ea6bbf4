# SPDX-License-Identifier: MIT
"""The text and HTML forms of objects, for interpreters and notebooks."""
from __future__ import annotations

import html
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from ._errors import Error

if TYPE_CHECKING:
    from ._columns import Columns
    from ._core import Message
    from ._link import Link

ROWS_SHOWN = 10  # of columns, half of them from the end


def table(caption: str, rows: Iterable[Iterable[Any]], heads: Iterable[str] = ()) -> str:
    head = "".join(f"<th>{html.escape(str(cell))}</th>" for cell in heads)
    body = "".join("<tr>" + "".join(f"<td>{html.escape(str(cell))}</td>" for cell in row) + "</tr>" for row in rows)
    return f"<table><caption>{html.escape(caption)}</caption>{f'<tr>{head}</tr>' if head else ''}{body}</table>"


def enum_text(message: Message, field: str, value: Any) -> str:
    """The names of an enum's value, if the field has an enum."""
    name = message.fieldenums_by_name.get(field)
    if not name or isinstance(value, list):
        return ""
    kind = message.dialect.enum(name)
    try:
        member = kind(value)
    except ValueError:
        return ""
    return str(member.name or "")


def message_html(message: Message) -> str:
    head = f"{message.get_type()} from {message.sys}/{message.comp}, seq {message.header.seq}"
    units = message.fieldunits_by_name
    rows = [(name, message[name], units.get(name, ""), enum_text(message, name, message[name]))
            for name in message.get_fieldnames()]
    return table(head, rows, ("field", "value", "unit", "enum"))


def link_text(link: Link) -> str:
    try:
        stats = link.stats
    except Error:
        return f"<Link {link.name}, opened before a fork>"
    vehicle = f", vehicle {link.target_system}/{link.target_component}" if link.target_system else ""
    peers = f"{stats.peers} peer{'' if stats.peers == 1 else 's'}"
    frames = f"{stats.frames_in} frame{'' if stats.frames_in == 1 else 's'}"
    return f"<Link {link.name}: {peers}, {frames} in, {stats.frames_out} out{vehicle}>"


def link_html(link: Link) -> str:
    stats = link.stats
    counters = [(name, getattr(stats, name)) for name in ("peers", "frames_in", "frames_out", "lost", "missed",
                                                          "kernel_drop", "crc_error", "no_peer")]
    sources = [(s.link_name, f"{s.sys}/{s.comp}", s.received, s.lost) for s in stats.sources]
    return (table(f"Link {link.name}", counters)
            + table("sources", sources, ("link", "source", "received", "lost")))


def columns_html(columns: Columns) -> str:
    count = len(columns)
    half = ROWS_SHOWN // 2
    shown = list(range(count)) if count <= ROWS_SHOWN else [*range(half), *range(count - half, count)]
    names = list(columns)
    heads = [f"{name} [{columns.units[name]}]" if name in columns.units else name for name in names]
    return table(f"{columns.name}: {count} rows", [[columns[name][row] for name in names] for row in shown], heads)
