# SPDX-License-Identifier: MIT
"""Messages of recordings as numpy arrays."""
from __future__ import annotations

import datetime
import functools
import os
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, Union, overload

import numpy as np
import numpy.typing as npt

from . import _views
from ._core import Dialect, Message, MessageInfo, read_columns, read_tables
from ._errors import UsageError
from ._types import MessageTypes

if TYPE_CHECKING:
    import pandas
    import pyarrow

Array = npt.NDArray[Any]
Path = Union[str, "os.PathLike[str]"]
Paths = Union[Path, Iterable[Path]]
Name = Union[str, "type[Message]"]
Names = Union["list[str]", "list[type[Message]]", "tuple[Name, ...]", "set[Name]", "frozenset[Name]"]
# A point in time: Unix time in ns, an aware datetime, or anything that numpy.datetime64 takes.
Time = Union[int, datetime.datetime, np.datetime64]
HEADER = ("time_ns", "sys", "comp")
YEARS = 292  # before and after 1970: what a time in ns can hold


def flat(arrays: dict[str, Array]) -> dict[str, Array]:
    """Returns the one-dimensional columns: one for each element of an array field. They are views of the arrays."""
    columns: dict[str, Array] = {}
    for name, values in arrays.items():
        if values.ndim == 2:
            columns.update({f"{name}[{i}]": values[:, i] for i in range(values.shape[1])})
        else:
            columns[name] = values
    return columns


class Columns(dict[str, Array]):
    """The rows of one message, in the order of the file, as numpy arrays.

    Columns cannot be added, replaced or removed.

    The arrays own their memory, are contiguous and writeable, and have native byte order. `len(cols)` is the number of
    rows. If the message does not occur, the arrays are empty and have the same types.

    - `cols["roll"]` has shape (rows,) and the field's own type (float32, uint16, ...).
    - An array field has shape (rows, elements); `cols["voltages[0]"]` is one element of each row. A char[N] field has
      the type S<N>.
    - HEARTBEAT has a last column, `mode`: the name of the sender's flight mode as text (`<U24`), such as "Hold". It is
      empty for senders without modes, such as ground stations.
    - `time_ns` is the recorded time (int64, Unix time in ns); `sys` and `comp` are uint8.
    - Trailing zeros that a sender left out are 0.

    Columns can be copied and pickled. Other libraries take them as they are: `pandas.DataFrame(cols)`,
    `numpy.asarray(cols)`, `polars.DataFrame(cols)`. `to_pandas` and `to_arrow` also convert times and text. These
    libraries need one-dimensional columns, so `keys`, `values` and `items` list an array field as `voltages[0]`,
    `voltages[1]`, ...
    `json.dumps(dict(cols.items()), default=numpy.ndarray.tolist)` writes them. If `cols` has no rows,
    `json.dumps(cols, indent=1)` writes {}, because `len(cols)` is 0.
    """

    # A dict, because pandas.DataFrame takes columns only from a dict. The dict itself holds the one-dimensional
    # columns, because json and other compiled code read it without calling the methods below.

    name: str
    junk_bytes: int  # bytes of the file that belong to no record: damaged, or cut off at the end

    def __init__(self, dialect: Dialect, name: str, arrays: dict[str, Array], junk_bytes: int) -> None:
        super().__init__(flat(arrays))
        self.name = name
        self.junk_bytes = junk_bytes
        self._dialect = dialect
        self._arrays = arrays

    @property
    def _info(self) -> MessageInfo:
        return self._dialect[self.name]

    @functools.cached_property
    def units(self) -> dict[str, str]:
        """{field: "rad/s"} for the fields that have a unit."""
        return {field.name: field.units for field in self._info.fields if field.units}

    @functools.cached_property
    def enums(self) -> dict[str, str]:
        """{field: "MAV_TYPE"} for the fields that have an enum."""
        return {field.name: field.enum for field in self._info.fields if field.enum}

    def __getitem__(self, column: str) -> Array:
        """Returns a column. Raises KeyError, which lists the columns, if there is none of this name."""
        found: Array | None = self.get(column)
        if found is None:
            raise KeyError(f"{self.name} has no column {column!r}; it has {', '.join(self._arrays)}")
        return found

    def __len__(self) -> int:
        return len(self._arrays["time_ns"])

    def __contains__(self, column: object) -> bool:
        return column in self._arrays

    def __iter__(self) -> Iterator[str]:
        """Iterates over the column names: time_ns, sys, comp, then the fields in the order of the definition."""
        return iter(self._arrays)

    def __reversed__(self) -> Iterator[str]:
        return reversed(list(self._arrays))

    def get(self, column: object, default: Any = None) -> Any:
        """Returns a column, or `default` if there is none of this name."""
        try:
            return self._arrays[column] if column in self._arrays else super().get(column, default)  # type: ignore
        except TypeError:  # a list, for example
            return default

    def keys(self) -> list[str]:  # type: ignore[override]
        """The names of the one-dimensional columns."""
        return list(super().keys())

    def values(self) -> list[Array]:  # type: ignore[override]
        """The one-dimensional columns."""
        return list(super().values())

    def items(self) -> list[tuple[str, Array]]:  # type: ignore[override]
        """The one-dimensional columns with their names."""
        return list(super().items())

    def _ipython_key_completions_(self) -> list[str]:
        return list(self._arrays)

    def _refuse(self, *args: Any, **kwargs: Any) -> Any:
        raise TypeError(f"the columns of {self.name} cannot be changed; make a dict of them: dict(cols.items())")

    __setitem__ = __delitem__ = __ior__ = _refuse  # pyright: ignore
    clear = pop = popitem = setdefault = update = _refuse  # pyright: ignore

    def __or__(self, other: Any) -> dict[str, Any]:  # type: ignore[override]
        return {**dict(self.items()), **other}

    def __eq__(self, other: object) -> bool:
        return self is other

    def __ne__(self, other: object) -> bool:
        return self is not other

    __hash__ = object.__hash__  # type: ignore[assignment]

    def __copy__(self) -> Columns:
        return Columns(self._dialect, self.name, dict(self._arrays), self.junk_bytes)

    copy = __copy__

    def __deepcopy__(self, memo: dict[int, Any]) -> Columns:
        arrays = {name: values.copy() for name, values in self._arrays.items()}
        return Columns(self._dialect, self.name, arrays, self.junk_bytes)

    def __reduce__(self) -> tuple[Any, ...]:
        return Columns, (self._dialect, self.name, self._arrays, self.junk_bytes)

    def __repr__(self) -> str:
        return f"<{self.name}: {len(self)} rows of {', '.join(self._arrays)}>"

    def _repr_html_(self) -> str:
        return _views.columns_html(self)

    # ---- other libraries

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Array:
        """A structured array with one field for each column. Elements of array fields are `voltages[0]`, ..."""
        if copy is False:
            raise ValueError(f"the columns of {self.name} are separate arrays: one array of them is a copy")
        made = np.empty(len(self), [(name, values.dtype) for name, values in self.items()])
        for name, values in self.items():
            made[name] = values
        return made if dtype is None else made.astype(dtype)

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        """For libraries that take the Arrow C interface (polars, duckdb, pyarrow). Needs pyarrow."""
        return self.to_arrow().__arrow_c_stream__(requested_schema)

    def to_arrow(self) -> pyarrow.Table:
        """Converts the columns to a pyarrow table. Needs pyarrow.

        `time_ns` becomes timestamp[ns, UTC]. Text becomes UTF-8, with U+FFFD for invalid bytes. Array fields become
        lists of fixed size. Fields carry the metadata `unit` and `enum`. Parquet keeps all of it.
        """
        try:
            import pyarrow
        except ImportError as error:
            raise ImportError("to_arrow() needs pyarrow: pip install pyarrow") from error
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

    def to_pandas(self, *, enums: bool = False) -> pandas.DataFrame:
        """Converts the columns to a pandas data frame. Needs pandas.

        The times become the index (UTC, datetime64[ns]). An array field becomes one column for each element:
        `voltages[0]`, ... Text becomes str. With `enums`, values of an enum become categories with the names of its
        entries; flags stay numbers. `df.attrs` holds message, units and enums.
        """
        try:
            import pandas
        except ImportError as error:
            raise ImportError("to_pandas() needs pandas: pip install pandas") from error
        columns: dict[str, Any] = {}
        for name, values in self.items():
            if values.dtype.kind == "S":
                columns[name] = np.char.decode(values, "utf-8", "replace")
            elif enums and self._has_names(name):
                columns[name] = self._named(pandas, name, values)
            elif name != "time_ns":
                columns[name] = values
        index = pandas.to_datetime(self._arrays["time_ns"], unit="ns", utc=True)
        frame = pandas.DataFrame(columns, index=index.rename("time"))
        frame.attrs.update(message=self.name, units=self.units, enums=self.enums)
        return frame

    def _has_names(self, column: str) -> bool:
        """Whether the column has an enum whose values are not flags."""
        field = column.partition("[")[0]
        return field in self.enums and not any(one.bitmask for one in self._info.fields if one.name == field)

    def _named(self, pandas: Any, column: str, values: Array) -> Any:
        """The names of an enum's values; unknown values are shown as numbers."""
        entries = self._dialect.enum_entries(self.enums[column.partition("[")[0]])[1]
        names = {number: name for name, number in entries.items()}
        numbers, codes = np.unique(values, return_inverse=True)
        return pandas.Categorical.from_codes(codes, [names.get(int(number), str(number)) for number in numbers])


@overload
def columns(path: Paths, name: str | type[Message], *, system: int | None = None, component: int | None = None,
            instance: int | str | None = None, start: Time | None = None, end: Time | None = None,
            fields: Sequence[str] | None = None, dialect: Dialect | None = None, progress: bool = False) -> Columns: ...


@overload
def columns(path: Paths, name: Names, *,
            system: int | None = None, component: int | None = None, instance: int | str | None = None,
            start: Time | None = None, end: Time | None = None,
            fields: Sequence[str] | None = None, dialect: Dialect | None = None,
            progress: bool = False) -> dict[str, Columns]: ...


def columns(path: Paths, name: str | type[Message] | Names, *, system: int | None = None, component: int | None = None,
            instance: int | str | None = None, start: Time | None = None, end: Time | None = None,
            fields: Sequence[str] | None = None, dialect: Dialect | None = None,
            progress: bool = False) -> Columns | dict[str, Columns]:
    """Reads all messages `name` of a tlog as columns, in one pass in C++ and without an object for each message.

    `path` may be a list of files, whose rows follow each other. `name` is a name or a class of mavloom.messages. It may
    also be a list of these; the result is then {name: Columns}, like that of `tables`. A list of names with `instance`
    takes one pass for each name.

    - `system`, `component` and `instance` select rows. `instance` is the value of the field that distinguishes several
      sensors in one message, such as BATTERY_STATUS.id or NAMED_VALUE_FLOAT.name.
    - `start` and `end` select rows by their recorded time, from `start` up to but not including `end`. Each is a Unix
      time in ns, an aware datetime, a numpy.datetime64 or a pandas.Timestamp.
    - `fields` selects the columns; time_ns, sys and comp are always there.
    - With `progress=True`, a line on stderr shows how much of each file is read, if stderr is a terminal.

    An unknown name, a field that none of the messages has, or `instance` for a message without such a field, raises
    UsageError (a ValueError). Damage in the file is skipped and counted in `junk_bytes`. Checksums of other messages
    are checked only after damage.

    The call releases the GIL while it reads. At its peak, it needs the memory of all arrays plus that of the largest.
    """
    definitions = Dialect() if dialect is None else dialect
    files, begin, before = paths_of(path), time_ns_of("start", start), time_ns_of("end", end)
    wanted = None if fields is None else list_of_names("fields", fields)
    name = name_of(name)
    if not isinstance(name, str):
        names = list_of_names("name", map(name_of, name if isinstance(name, Iterable) else [name]))
        check_fields(definitions, names, wanted or [])
        if instance is None:
            found = tables(files, names, system=system, component=component, start=begin, end=before, fields=wanted,
                           dialect=definitions, progress=progress)
            return {one: found[one] for one in names}
        return {one: columns(files, one, system=system, component=component, instance=instance, start=begin, end=before,
                             fields=None if wanted is None else [f for f in wanted if has_field(definitions, one, f)],
                             dialect=definitions, progress=progress) for one in names}
    parts, junk_bytes = read_columns(files, name, system, component, instance, begin, before, wanted, definitions,
                                     progress)
    return _made(definitions, name, parts, junk_bytes)


def tables(path: Paths, type: MessageTypes | None = None, *, system: int | None = None, component: int | None = None,
           start: Time | None = None, end: Time | None = None, fields: str | Iterable[str] | None = None,
           dialect: Dialect | None = None, progress: bool = False) -> dict[str, Columns]:
    """Reads several messages of a tlog as columns, in one pass: {"ATTITUDE": Columns, ...}, ordered by message id.

    Without `type`, returns all messages that occur in the file; with `type`, the messages that it names. Messages
    without a definition are left out, and so are those that have none of `fields`, unless `type` names them. Otherwise,
    `tables` works like `columns`, but it checks every checksum.
    """
    definitions = Dialect() if dialect is None else dialect
    wanted = None if fields is None else list_of_names("fields", fields)
    made, junk_bytes = read_tables(paths_of(path), type, system, component, time_ns_of("start", start),
                                   time_ns_of("end", end), wanted, definitions, progress)
    return {name: _made(definitions, name, parts, junk_bytes) for name, parts in made.items()}


def paths_of(path: Paths) -> list[Path]:
    if isinstance(path, (str, bytes)) or hasattr(path, "__fspath__"):
        return [path]  # type: ignore[list-item]
    if not isinstance(path, Iterable):
        raise UsageError(f"a recording is given by its path, or several by a list of paths, not {path!r}")
    files = list(path)
    if not files:
        raise UsageError("an empty list of recordings")
    return files


def name_of(given: Any) -> Any:
    """Returns the name of a class of mavloom.messages. Returns anything else unchanged."""
    return given.__name__ if isinstance(given, type) else given


def list_of_names(what: str, given: Iterable[Any]) -> list[str]:
    if isinstance(given, str):
        return [given]
    names: list[Any] = list(given) if isinstance(given, Iterable) else [given]
    for one in names:
        if not isinstance(one, str):
            raise UsageError(f"{what}= takes a name or a list of names, not {one!r}")
    return names


def check_fields(dialect: Dialect, messages: list[str], fields: list[str]) -> None:
    """Raises UsageError for a field that none of the messages has."""
    for field in fields:
        if messages and not any(has_field(dialect, one, field) for one in messages):
            raise UsageError(f"fields: none of {', '.join(messages)} has a field {field!r}")


def has_field(dialect: Dialect, message: str, field: str) -> bool:
    return field == "mode" and message == "HEARTBEAT" or any(one.name == field for one in dialect[message].fields)


def time_ns_of(what: str, given: Time | None) -> int | None:
    """Unix time in ns."""
    if given is None or isinstance(given, int) and not isinstance(given, bool):
        return given
    if isinstance(given, np.integer):
        return int(given)
    if given != given:  # numpy's or pandas' NaT
        raise UsageError(f"{what}: {given} is not a time")
    if isinstance(given, datetime.datetime):
        if given.tzinfo is None:
            raise UsageError(f"{what}: {given} has no time zone; for example, datetime(..., tzinfo=timezone.utc)")
        nanoseconds = getattr(given, "value", None)  # of a pandas.Timestamp
        if isinstance(nanoseconds, int):
            return nanoseconds
        since = given - datetime.datetime(1970, 1, 1, tzinfo=datetime.timezone.utc)
        return (since.days * 86400 + since.seconds) * 10**9 + since.microseconds * 1000
    if isinstance(given, np.datetime64):
        if not -YEARS <= int(given.astype("datetime64[Y]").astype("int64")) < YEARS:
            raise UsageError(f"{what}: {given} is out of range, the years {1970 - YEARS} to {1969 + YEARS}")
        return int(given.astype("datetime64[ns]").astype("int64"))
    raise UsageError(f"{what}: a time is Unix time in ns, an aware datetime or a numpy.datetime64, not {given!r}")


def _made(dialect: Dialect, name: str, parts: tuple[Array, Array, Array, dict[str, Array]],
          junk_bytes: int) -> Columns:
    time_ns, systems, components, fields = parts
    if name == "HEARTBEAT" and "mode" in fields:
        fields["mode"] = fields["mode"].astype("U24")
    return Columns(dialect, name, {"time_ns": time_ns, "sys": systems, "comp": components, **fields}, junk_bytes)
