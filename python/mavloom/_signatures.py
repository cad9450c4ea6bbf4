# SPDX-License-Identifier: MIT
"""Signatures of functions, for the module inspect. nanobind keeps the signature of each compiled function as text."""
from __future__ import annotations

import keyword
from typing import TYPE_CHECKING, Any

from . import _core, _errors

if TYPE_CHECKING:
    import inspect


def parameter_name(field: str) -> str:
    """The name of a field as a parameter. A name that Python does not allow for parameters gets an underscore."""
    if keyword.iskeyword(field) or field == "self":
        return field + "_"
    return field if field.isidentifier() else "_" + field


def signature_of(function: Any) -> inspect.Signature:
    """The signature of a compiled function. Annotations are text."""
    return parsed(function.__nb_signature__[0][0])


def parsed(text: str) -> inspect.Signature:
    """The signature in the first line of a definition, such as "def f(x: int = 3) -> str"."""
    import ast
    import inspect
    tree = ast.parse(f"{text}: ...").body[0]
    assert isinstance(tree, ast.FunctionDef)
    given, made = tree.args, []

    def add(argument: ast.arg, kind: Any, default: ast.expr | None = None) -> None:
        made.append(inspect.Parameter(
            argument.arg, kind, default=inspect.Parameter.empty if default is None else ast.literal_eval(default),
            annotation=inspect.Parameter.empty if argument.annotation is None else ast.unparse(argument.annotation)))
    before = len(given.posonlyargs)
    places = [*given.posonlyargs, *given.args]
    defaults = [None] * (len(places) - len(given.defaults)) + list(given.defaults)
    for place, (argument, default) in enumerate(zip(places, defaults)):
        add(argument, inspect.Parameter.POSITIONAL_ONLY if place < before else
            inspect.Parameter.POSITIONAL_OR_KEYWORD, default)
    if given.vararg is not None:
        add(given.vararg, inspect.Parameter.VAR_POSITIONAL)
    for argument, default in zip(given.kwonlyargs, given.kw_defaults):
        add(argument, inspect.Parameter.KEYWORD_ONLY, default)
    if given.kwarg is not None:
        add(given.kwarg, inspect.Parameter.VAR_KEYWORD)
    returns = inspect.Signature.empty if tree.returns is None else ast.unparse(tree.returns)
    return inspect.Signature(made, return_annotation=returns)


def without_self(signature: inspect.Signature) -> inspect.Signature:
    return signature.replace(parameters=list(signature.parameters.values())[1:])


class OfClass:
    """`__signature__` of a compiled class or an error. A class that cannot be called has no parameters."""

    def __get__(self, instance: object, owner: type[Any]) -> inspect.Signature:
        function: Any = owner.__init__
        if instance is not None or hasattr(function, "__code__"):  # a subclass in Python has a signature of its own
            raise AttributeError("__signature__")
        import inspect
        if issubclass(owner, BaseException):
            return parsed("def f(*args: object)")
        if not hasattr(function, "__nb_signature__"):
            return inspect.Signature()
        return without_self(signature_of(function)).replace(return_annotation=inspect.Signature.empty)


def install() -> None:
    """Lets inspect.signature read every function and class of the compiled module, and its errors."""
    method = _core.Dialect.encode
    for kind in (type(_core.version), type(method)):
        _core.set_signature(kind, property(signature_of))
    _core.set_signature(type(_core.Dialect().encode),
                        property(lambda bound: without_self(signature_of(bound.__func__))))
    for value in [*vars(_core).values(), _errors.Error]:
        if isinstance(value, type):
            setattr(value, "__signature__", OfClass())
