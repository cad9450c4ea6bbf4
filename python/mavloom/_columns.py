# SPDX-License-Identifier: MIT
"""One message of a recording as numpy arrays."""
from __future__ import annotations

import functools
import os
from typing import TYPE_CHECKING, Any, Iterator

import numpy as np
import numpy.typing as npt

from ._core import Dialect, MessageInfo, read_columns, read_tables
from ._types import MessageTypes

if TYPE_CHECKING:
    import pandas
    import pyarrow

Array = npt.NDArray[Any]


class Columns:
    """The rows of one message, in the order of the file, as arrays that own their memory: contiguous, native byte order, writeable.

    `cols["roll"]` has shape (rows,) and the field's own type (float32, uint16, ...); an array field (rows, elements); char[N] is the type S<N>. Beside the
    fields there are `time_ns` (int64, Unix time in ns, the recorded one), `sys` and `comp` (uint8). What a sender cut off is 0. `len(cols)` is the number
    of rows. A message that does not occur gives empty arrays of the same types.
    """

    name: str
    junk_bytes: int  # of the file that belong to no record: damaged, or cut at the end

    def __init__(self, info: MessageInfo, arrays: dict[str, Array], junk_bytes: int) -> None:
        self.name = info.name
        self.junk_bytes = junk_bytes
        self._info = info
        self._arrays = arrays

    @functools.cached_property
    def units(self) -> dict[str, str]:
        """{field: "rad/s"} where there is one."""
        return {field.name: field.units for field in self._info.fields if field.units}

    @functools.cached_property
    def enums(self) -> dict[str, str]:
        """{field: "MAV_TYPE"} where there is one."""
        return {field.name: field.enum for field in self._info.fields if field.enum}

    def __getitem__(self, column: str) -> Array:
        """Raises KeyError for a column that the message does not have."""
        return self._arrays[column]

    def __len__(self) -> int:
        return len(self._arrays["time_ns"])

    def __contains__(self, column: object) -> bool:
        return column in self._arrays

    def __iter__(self) -> Iterator[str]:
        """The columns' names: time_ns, sys, comp, then the fields in the order of the definition."""
        return iter(self._arrays)

    def keys(self) -> list[str]:
        """As iteration gives them."""
        return list(self._arrays)

    def __repr__(self) -> str:
        return f"<{self.name}: {len(self)} rows of {', '.join(self._arrays)}>"

    def to_arrow(self) -> pyarrow.Table:
        """A table whose fields carry the metadata `unit` and `enum`; `time_ns` is timestamp[ns, UTC], text is UTF-8 (what is none becomes U+FFFD), array fields are
        lists of fixed size. Parquet keeps all of it. Needs pyarrow: the extra [arrow]."""
        try:
            import pyarrow
        except ImportError as error:
            raise ImportError("to_arrow() needs pyarrow: pip install 'mavloom[arrow]'") from error
        arrays = [self._arrow_array(pyarrow, name) for name in self._arrays]
        fields = [pyarrow.field(name, array.type, metadata=self._metadata(name)) for name, array in zip(self._arrays, arrays)]
        return pyarrow.Table.from_arrays(arrays, schema=pyarrow.schema(fields, metadata={"message": self.name}))

    def _metadata(self, name: str) -> dict[str, str]:
        found = {"unit": self.units.get(name), "enum": self.enums.get(name)}
        return {key: value for key, value in found.items() if value}

    def _arrow_array(self, pyarrow: Any, name: str) -> Any:
        values = self._arrays[name]
        if name == "time_ns":
            return pyarrow.array(values, pyarrow.timestamp("ns", tz="UTC"))
        if values.dtype.kind == "S":
            return pyarrow.array(np.char.decode(values, "utf-8", "replace"), pyarrow.string())
        if values.ndim == 2:
            return pyarrow.FixedSizeListArray.from_arrays(pyarrow.array(values.reshape(-1)), values.shape[1])
        return pyarrow.array(values)

    def to_pandas(self) -> pandas.DataFrame:
        """A frame with the times as its index (UTC, datetime64[ns]); an array field becomes a column for each element, `voltages[0]`, ...; text is str. `df.attrs`
        holds message, units and enums. Needs pandas: the extra [pandas]."""
        try:
            import pandas
        except ImportError as error:
            raise ImportError("to_pandas() needs pandas: pip install 'mavloom[pandas]'") from error
        columns: dict[str, Array] = {}
        for name, values in self._arrays.items():
            if values.dtype.kind == "S":
                columns[name] = np.char.decode(values, "utf-8", "replace")
            elif values.ndim == 2:
                columns.update({f"{name}[{i}]": values[:, i] for i in range(values.shape[1])})
            elif name != "time_ns":
                columns[name] = values
        index = pandas.to_datetime(self._arrays["time_ns"], unit="ns", utc=True)
        frame = pandas.DataFrame(columns, index=index.rename("time"))
        frame.attrs.update(message=self.name, units=self.units, enums=self.enums)
        return frame


def columns(path: str | os.PathLike[str], name: str, *, system: int | None = None, component: int | None = None,
            instance: int | str | None = None, dialect: Dialect | None = None) -> Columns:
    """All messages `name` of a tlog as columns, read in one pass in C++ without an object for each message; the GIL is free meanwhile.

    `system`, `component` and `instance` (the value of the field that tells several sensors of one message apart, as BATTERY_STATUS.id or
    NAMED_VALUE_FLOAT.name) keep the rows that agree. An unknown name, or `instance` for a message without such a field, is a UsageError (a ValueError);
    damage in the file is skipped and counted in `junk_bytes` (checksums of other messages are not looked at while record joins record). Peak memory: the
    rows as they were sent, and the arrays."""
    definitions = Dialect() if dialect is None else dialect
    info = definitions[name]
    parts, junk_bytes = read_columns(path, name, system, component, instance, definitions)
    return _made(info, parts, junk_bytes)


def tables(path: str | os.PathLike[str], type: MessageTypes | None = None, *, system: int | None = None, component: int | None = None,
           dialect: Dialect | None = None) -> dict[str, Columns]:
    """Every message of a tlog as columns, {"ATTITUDE": Columns, ...} by rising id, read in one pass: those that occur, or those that `type` names. As `columns`,
    but every checksum is looked at. Messages without definition are left out."""
    definitions = Dialect() if dialect is None else dialect
    made, junk_bytes = read_tables(path, type, system, component, definitions)
    return {name: _made(definitions[name], parts, junk_bytes) for name, parts in made.items()}


def _made(info: MessageInfo, parts: tuple[Array, Array, Array, dict[str, Array]], junk_bytes: int) -> Columns:
    time_ns, systems, components, fields = parts
    return Columns(info, {"time_ns": time_ns, "sys": systems, "comp": components, **fields}, junk_bytes)
