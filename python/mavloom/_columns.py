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
    """The rows of one message, in the order of the file, as numpy arrays.

    The arrays own their memory, are contiguous and writeable, and have native byte order. `len(cols)` is the number of
    rows. If the message does not occur, the arrays are empty and have the same types.

    - `cols["roll"]` has shape (rows,) and the field's own type (float32, uint16, ...).
    - An array field has shape (rows, elements). A char[N] field has the type S<N>.
    - `time_ns` is the recorded time (int64, Unix time in ns); `sys` and `comp` are uint8.
    - Trailing zeros that a sender left out are 0.
    """

    name: str
    junk_bytes: int  # bytes of the file that belong to no record: damaged, or cut off at the end

    def __init__(self, info: MessageInfo, arrays: dict[str, Array], junk_bytes: int) -> None:
        self.name = info.name
        self.junk_bytes = junk_bytes
        self._info = info
        self._arrays = arrays

    @functools.cached_property
    def units(self) -> dict[str, str]:
        """{field: "rad/s"} for the fields that have a unit."""
        return {field.name: field.units for field in self._info.fields if field.units}

    @functools.cached_property
    def enums(self) -> dict[str, str]:
        """{field: "MAV_TYPE"} for the fields that have an enum."""
        return {field.name: field.enum for field in self._info.fields if field.enum}

    def __getitem__(self, column: str) -> Array:
        """Returns a column. Raises KeyError if the message does not have it."""
        return self._arrays[column]

    def __len__(self) -> int:
        return len(self._arrays["time_ns"])

    def __contains__(self, column: object) -> bool:
        return column in self._arrays

    def __iter__(self) -> Iterator[str]:
        """Iterates over the column names: time_ns, sys, comp, then the fields in the order of the definition."""
        return iter(self._arrays)

    def keys(self) -> list[str]:
        """The names of the columns, in the order of iteration."""
        return list(self._arrays)

    def __repr__(self) -> str:
        return f"<{self.name}: {len(self)} rows of {', '.join(self._arrays)}>"

    def to_arrow(self) -> pyarrow.Table:
        """Converts the columns to a pyarrow table. Needs pyarrow: the extra [arrow].

        `time_ns` becomes timestamp[ns, UTC]. Text becomes UTF-8, with U+FFFD for invalid bytes. Array fields become
        lists of fixed size. Fields carry the metadata `unit` and `enum`. Parquet keeps all of it.
        """
        try:
            import pyarrow
        except ImportError as error:
            raise ImportError("to_arrow() needs pyarrow: pip install 'mavloom[arrow]'") from error
        arrays = [self._arrow_array(pyarrow, name) for name in self._arrays]
        fields = [pyarrow.field(name, array.type, metadata=self._metadata(name))
                  for name, array in zip(self._arrays, arrays)]
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
        """Converts the columns to a pandas data frame. Needs pandas: the extra [pandas].

        The times become the index (UTC, datetime64[ns]). An array field becomes one column for each element:
        `voltages[0]`, ... Text becomes str. `df.attrs` holds message, units and enums.
        """
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
    """Reads all messages `name` of a tlog as columns, in one pass in C++ and without an object for each message.

    `system`, `component` and `instance` select rows. `instance` is the value of the field that distinguishes several
    sensors in one message, such as BATTERY_STATUS.id or NAMED_VALUE_FLOAT.name.

    An unknown name, or `instance` for a message without such a field, raises UsageError (a ValueError). Damage in the
    file is skipped and counted in `junk_bytes`. Checksums of other messages are checked only after damage.

    The GIL is free during the read. At its peak, the call needs memory for the arrays and for all rows, with payloads
    of full length.
    """
    definitions = Dialect() if dialect is None else dialect
    info = definitions[name]
    parts, junk_bytes = read_columns(path, name, system, component, instance, definitions)
    return _made(info, parts, junk_bytes)


def tables(path: str | os.PathLike[str], type: MessageTypes | None = None, *, system: int | None = None,
           component: int | None = None, dialect: Dialect | None = None) -> dict[str, Columns]:
    """Reads several messages of a tlog as columns, in one pass: {"ATTITUDE": Columns, ...}, ordered by message id.

    Without `type`, returns all messages that occur in the file; with `type`, the messages that it names. Messages
    without a definition are left out. Otherwise it works like `columns`, but checks every checksum.
    """
    definitions = Dialect() if dialect is None else dialect
    made, junk_bytes = read_tables(path, type, system, component, definitions)
    return {name: _made(definitions[name], parts, junk_bytes) for name, parts in made.items()}


def _made(info: MessageInfo, parts: tuple[Array, Array, Array, dict[str, Array]], junk_bytes: int) -> Columns:
    time_ns, systems, components, fields = parts
    return Columns(info, {"time_ns": time_ns, "sys": systems, "comp": components, **fields}, junk_bytes)
