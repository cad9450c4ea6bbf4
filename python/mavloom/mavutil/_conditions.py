# SPDX-License-Identifier: MIT
"""Text conditions, such as "ATTITUDE.roll > 0.1 and MAV.flightmode == 'AUTO'", without eval().

An expression may have names of messages, their fields, numbers, text, comparisons, `and`, `or`, `not`, `in`,
arithmetic, `a if b else c`, indexes, tuples and lists, and calls of the functions of FUNCTIONS. Nothing else is
accepted: no calls of other methods than METHODS, no attributes that begin with an underscore, no assignments. So a
condition can read messages and nothing more.
"""
from __future__ import annotations

import ast
import functools
import math
import operator
from collections.abc import Callable, Mapping
from typing import Any

from .._errors import UsageError
from ._messages import MAVLink_message

Names = Mapping[str, Any]
Evaluator = Callable[[Names], Any]

LARGEST_POWER = 64  # of an exponent, so that no number gets too long to compute


def rounded(value: Any, digits: int | None = None) -> Any:
    if isinstance(digits, int) and abs(digits) > LARGEST_POWER:  # Python computes 10 ** -digits
        raise UsageError(f"round() to {digits} digits is too long for a condition")
    return round(value, digits)


FUNCTIONS: dict[str, Callable[..., Any]] = {
    **{name: getattr(math, name) for name in
       ("sqrt", "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "degrees", "radians", "floor", "ceil", "exp",
        "log", "log10", "fabs", "fmod", "hypot", "isnan", "isinf", "isfinite")},
    "abs": abs, "min": min, "max": max, "len": len, "int": int, "float": float, "bool": bool, "round": rounded,
    "pow": math.pow, "str": str, "sum": sum, "any": any, "all": all, "ord": ord, "chr": chr,
}
METHODS: dict[str, type] = {
    "get_srcSystem": MAVLink_message, "get_srcComponent": MAVLink_message, "get_type": MAVLink_message,
    "get_msgId": MAVLink_message, "get_seq": MAVLink_message, "startswith": str, "endswith": str,
}
CONSTANTS = {"pi": math.pi, "e": math.e, "inf": math.inf, "nan": math.nan}
LONGEST = 10_000  # characters of an expression


def power(base: Any, exponent: Any) -> Any:
    if abs(exponent) > LARGEST_POWER or abs(base) > 1e9 and isinstance(base, int):
        raise UsageError(f"{base} ** {exponent} is too large for a condition")
    return base ** exponent


def times(left: Any, right: Any) -> Any:
    if isinstance(left, (str, bytes, list, tuple)) or isinstance(right, (str, bytes, list, tuple)):
        raise UsageError("a condition cannot multiply text or lists")
    return left * right


def shift(left: Any, right: Any) -> Any:
    if right > LARGEST_POWER:
        raise UsageError(f"{left} << {right} is too large for a condition")
    return left << right


def modulo(left: Any, right: Any) -> Any:
    if isinstance(left, (str, bytes)):
        raise UsageError("a condition cannot format text")
    return left % right


BINARY: dict[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: times, ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv, ast.Mod: modulo, ast.Pow: power, ast.BitAnd: operator.and_,
    ast.BitOr: operator.or_, ast.BitXor: operator.xor, ast.LShift: shift, ast.RShift: operator.rshift,
}
UNARY: dict[type[ast.unaryop], Callable[[Any], Any]] = {
    ast.Not: operator.not_, ast.USub: operator.neg, ast.UAdd: operator.pos, ast.Invert: operator.invert,
}
COMPARISONS: dict[type[ast.cmpop], Callable[[Any, Any], Any]] = {
    ast.Eq: operator.eq, ast.NotEq: operator.ne, ast.Lt: operator.lt, ast.LtE: operator.le, ast.Gt: operator.gt,
    ast.GtE: operator.ge, ast.Is: operator.is_, ast.IsNot: operator.is_not,
    ast.In: lambda left, right: left in right, ast.NotIn: lambda left, right: left not in right,
}


class Unknown(Exception):
    """A message that was not received, or a field that it does not have."""


@functools.lru_cache(maxsize=256)
def compiled(expression: str) -> Evaluator:
    """Checks an expression. Raises UsageError with the place of what is not accepted."""
    try:
        tree = ast.parse(expression.strip(), mode="eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        column = getattr(error, "offset", None) or len(expression) + 1  # 0 is the end
        raise UsageError(f"condition {shown(expression)}: not an expression: {getattr(error, 'msg', error)} "
                         f"(at character {column})") from None
    try:
        return Builder(expression).make(tree.body)
    except RecursionError:
        raise UsageError(f"condition {shown(expression)}: nested too deeply") from None


def shown(expression: str) -> str:
    return repr(expression if len(expression) <= 80 else expression[:77] + "...")


class Builder:
    """Makes a function of each part of an expression."""

    def __init__(self, expression: str) -> None:
        self._expression = expression

    def refuse(self, node: ast.AST, what: str) -> UsageError:
        column = getattr(node, "col_offset", 0) + 1
        return UsageError(f"condition {shown(self._expression)}: {what} is not possible (at character {column})")

    def make(self, node: ast.expr) -> Evaluator:
        method = getattr(self, f"make_{type(node).__name__.lower()}", None)
        if method is None:
            raise self.refuse(node, f"{type(node).__name__}")
        made: Evaluator = method(node)
        return made

    def make_constant(self, node: ast.Constant) -> Evaluator:
        value = node.value
        return lambda names: value

    def make_name(self, node: ast.Name) -> Evaluator:
        name = node.id

        def get(names: Names) -> Any:
            if name in names:
                return names[name]
            if name in CONSTANTS:
                return CONSTANTS[name]
            raise Unknown(name)
        return get

    def make_attribute(self, node: ast.Attribute) -> Evaluator:
        value, name = self.make(node.value), node.attr
        if name.startswith("_") and name not in ("_timestamp", "_link"):
            raise self.refuse(node, f"reading {name}")

        def get(names: Names) -> Any:
            found = getattr(value(names), name)
            if callable(found):
                raise UsageError(f"condition {shown(self._expression)}: {name} is not a field")
            return found
        return get

    def make_subscript(self, node: ast.Subscript) -> Evaluator:
        if isinstance(node.slice, ast.Slice):
            raise self.refuse(node, "a slice")
        value, index = self.make(node.value), self.make(node.slice)
        return lambda names: value(names)[index(names)]

    def make_call(self, node: ast.Call) -> Evaluator:
        if isinstance(node.func, ast.Attribute) and node.func.attr in METHODS and not node.keywords:
            return self.make_method(node, node.func)
        if not isinstance(node.func, ast.Name) or node.func.id not in FUNCTIONS or node.keywords:
            raise self.refuse(node, "this call (there are " + ", ".join(sorted({*FUNCTIONS, *METHODS})) + ")")
        function, arguments = FUNCTIONS[node.func.id], [self.make(one) for one in node.args]
        return lambda names: function(*(one(names) for one in arguments))

    def make_method(self, node: ast.Call, called: ast.Attribute) -> Evaluator:
        value, name, arguments = self.make(called.value), called.attr, [self.make(one) for one in node.args]

        def call(names: Names) -> Any:
            found = value(names)
            if not isinstance(found, METHODS[name]):
                raise UsageError(f"condition {shown(self._expression)}: {type(found).__name__} has no {name}()")
            return getattr(found, name)(*(one(names) for one in arguments))
        return call

    def make_binop(self, node: ast.BinOp) -> Evaluator:
        if type(node.op) not in BINARY:
            raise self.refuse(node, type(node.op).__name__)
        function, left, right = BINARY[type(node.op)], self.make(node.left), self.make(node.right)
        return lambda names: function(left(names), right(names))

    def make_unaryop(self, node: ast.UnaryOp) -> Evaluator:
        function, value = UNARY[type(node.op)], self.make(node.operand)
        return lambda names: function(value(names))

    def make_boolop(self, node: ast.BoolOp) -> Evaluator:
        values = [self.make(one) for one in node.values]
        stops_at = isinstance(node.op, ast.Or)

        def run(names: Names) -> Any:
            found: Any = None
            for value in values:
                found = value(names)
                if bool(found) is stops_at:
                    break
            return found
        return run

    def make_compare(self, node: ast.Compare) -> Evaluator:
        values = [self.make(one) for one in (node.left, *node.comparators)]
        functions = [COMPARISONS[type(one)] for one in node.ops]

        def run(names: Names) -> Any:
            left = values[0](names)
            found: Any = True
            for function, value in zip(functions, values[1:]):
                right = value(names)
                found = function(left, right)
                if not found:
                    break
                left = right
            return found
        return run

    def make_ifexp(self, node: ast.IfExp) -> Evaluator:
        test, yes, no = self.make(node.test), self.make(node.body), self.make(node.orelse)
        return lambda names: yes(names) if test(names) else no(names)

    def make_tuple(self, node: ast.Tuple) -> Evaluator:
        values = [self.make(one) for one in node.elts]
        return lambda names: tuple(value(names) for value in values)

    def make_list(self, node: ast.List) -> Evaluator:
        values = [self.make(one) for one in node.elts]
        return lambda names: [value(names) for value in values]

    make_set = make_list


def evaluate_expression(expression: str, vars: Names, nocondition: bool = False) -> Any:
    """Returns the value of an expression over `vars`, which maps the names of messages to messages.

    With a condition in braces, `ATTITUDE.roll{MAV.armed}`, the value is None while that is false. The value is also
    None if the expression names a message that is not in `vars`, or an instance that has not arrived, or divides by
    zero. Raises UsageError, which states the place, for text that is not an expression or does what a condition must
    not do.
    """
    if not isinstance(expression, str):
        raise UsageError(f"a condition is text, such as 'ATTITUDE.roll > 0.1', not {expression!r:.60}; the recv_match "
                         "of mavloom.Link takes functions")
    if len(expression) > LONGEST:
        raise UsageError(f"a condition of {len(expression)} characters is too long")
    value, brace, condition = expression.rstrip().removesuffix("}").rpartition("{")
    if brace and not nocondition and expression.rstrip().endswith("}"):
        return evaluate_expression(value, vars, True) if evaluate_expression(condition, vars, True) else None
    evaluator = compiled(expression)
    try:
        return evaluator(vars)
    except (Unknown, ZeroDivisionError, IndexError):
        return None
    except (AttributeError, KeyError, OverflowError, TypeError, ValueError) as error:
        if isinstance(error, UsageError):
            raise
        raise UsageError(f"condition {shown(expression)}: {error}") from error
    except RecursionError:
        raise UsageError(f"condition {shown(expression)}: nested too deeply") from None


def evaluate_condition(condition: str | None, vars: Names) -> bool:
    """Whether a condition is true; None is true. See evaluate_expression."""
    return True if condition is None else bool(evaluate_expression(condition, vars))
