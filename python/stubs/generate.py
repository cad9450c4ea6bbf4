# SPDX-License-Identifier: MIT
"""generate.py PACKAGE: writes messages.pyi and enums.pyi into the built package.

They describe the built-in definitions to type checkers and editors.
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(sys.argv[1]).parent))
import mavloom  # noqa: E402

HEAD = "# SPDX-License-Identifier: MIT\n# Made by python/stubs/generate.py.\n"


def python_type(field):
    if field.type == "char":
        return "str"
    number = "float" if field.type in ("float", "double") else "int"
    return f"list[{number}]" if field.array_length else number


def class_of(info):
    # A field with the name of an attribute of Message is an item only.
    fields = [field for field in info.fields if not hasattr(mavloom.Message, field.name)]
    lines = [f"    @property\n    def {field.name}(self) -> {python_type(field)}: ..." for field in fields]
    return "\n".join([f"class {info.name}(Message):", *(lines or ["    ..."])])


def messages(dialect):
    classes = [class_of(dialect[name]) for name in dialect.message_names]
    return "\n\n".join([HEAD + "from mavloom._core import Message", *classes]) + "\n"


def enums(dialect):
    classes = []
    for name in dialect.enum_names:
        kind = dialect.enum(name)
        entries = [f"    {entry} = {int(member)}" for entry, member in kind.__members__.items()]
        classes.append("\n".join([f"class {name}({kind.__base__.__name__}):", *(entries or ["    ..."])]))
    return "\n\n".join([HEAD + "from enum import IntEnum, IntFlag", *classes]) + "\n"


def main():
    folder, dialect = pathlib.Path(sys.argv[1]), mavloom.Dialect()
    (folder / "messages.pyi").write_text(messages(dialect))
    (folder / "enums.pyi").write_text(enums(dialect))


if __name__ == "__main__":
    main()
