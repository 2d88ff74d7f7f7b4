"""Expressions of a scene file, in the syntax of muParser."""

import re

import numpy as np


class NotUnderstood(Exception):
    """An expression that this program does not know how to evaluate."""


def _logical(f):
    return lambda *arguments: np.where(f(*arguments), 1., 0.)


FUNCTIONS = {
    "sin": np.sin, "cos": np.cos, "tan": np.tan, "asin": np.arcsin, "acos": np.arccos,
    "atan": np.arctan, "atan2": np.arctan2, "sinh": np.sinh, "cosh": np.cosh,
    "tanh": np.tanh, "exp": np.exp, "log": np.log, "ln": np.log, "log2": np.log2,
    "log10": np.log10, "sqrt": np.sqrt, "abs": np.abs, "sign": np.sign,
    "pow": np.power, "floor": np.floor, "ceil": np.ceil, "rint": np.rint,
    "if": lambda c, a, b: np.where(np.rint(c) != 0, a, b),
    "min": lambda *a: np.min(np.broadcast_arrays(*a), axis=0),
    "max": lambda *a: np.max(np.broadcast_arrays(*a), axis=0),
    "sum": lambda *a: sum(a),
}
OPERATORS = [
    {"||": _logical(lambda a, b: (a != 0) | (b != 0))},
    {"&&": _logical(lambda a, b: (a != 0) & (b != 0))},
    {"<=": _logical(np.less_equal), ">=": _logical(np.greater_equal),
     "!=": _logical(np.not_equal), "==": _logical(np.equal), "<": _logical(np.less),
     ">": _logical(np.greater)},
    {"+": np.add, "-": np.subtract},
    {"*": np.multiply, "/": np.divide},
]
TOKEN = re.compile(r"\s*(?:(\d+\.?\d*(?:[eE][-+]?\d+)?|\.\d+(?:[eE][-+]?\d+)?)"
                   r"|([A-Za-z_]\w*)|(\|\||&&|<=|>=|!=|==|[-+*/^()<>,?:]))")


class Expression:
    """Evaluated while it is read: the argument of every operator is a number or an
    array of one number per point."""

    def __init__(self, text, names):
        """names: of numbers and arrays, and of texts that are to be evaluated."""
        self.text, self.names, self.tokens, position = text, names, [], 0
        text = text.rstrip()
        while position < len(text):
            match = TOKEN.match(text, position)
            if not match:
                raise NotUnderstood(self.text)
            self.tokens.append(match.groups())
            position = match.end()
        self.tokens.append((None, None, None))
        self.at = 0

    def value(self):
        with np.errstate(all="ignore"):
            result = self._condition()
        if self.at != len(self.tokens) - 1:
            raise NotUnderstood(self.text)
        return result

    def _next_is(self, *symbols):
        symbol = self.tokens[self.at][2]
        if symbol in symbols:
            self.at += 1
            return symbol
        return None

    def _demand(self, symbol):
        if not self._next_is(symbol):
            raise NotUnderstood(self.text)

    def _condition(self):
        value = self._binary(0)
        if self._next_is("?"):
            first = self._condition()
            self._demand(":")
            return np.where(value != 0, first, self._condition())
        return value

    def _binary(self, strength):
        if strength == len(OPERATORS):
            return self._signed()
        value = self._binary(strength + 1)
        while True:
            symbol = self._next_is(*OPERATORS[strength])
            if not symbol:
                return value
            value = OPERATORS[strength][symbol](value, self._binary(strength + 1))

    def _signed(self):
        if self._next_is("-"):
            return -self._signed()
        if self._next_is("+"):
            return self._signed()
        base = self._operand()
        if self._next_is("^"):
            return np.power(base, self._signed())
        return base

    def _operand(self):
        number, name, _ = self.tokens[self.at]
        if self._next_is("("):
            value = self._condition()
            self._demand(")")
            return value
        self.at += 1
        if number is not None:
            return np.float64(number)
        if name in FUNCTIONS and self._next_is("("):
            arguments = [self._condition()]
            while self._next_is(","):
                arguments.append(self._condition())
            self._demand(")")
            return FUNCTIONS[name](*arguments)
        if name not in self.names:
            raise NotUnderstood(self.text)
        value = self.names[name]
        if isinstance(value, str):
            return Expression(value, self.names).value()
        return value


def split(text, separator):
    """At a character that is not inside parentheses; without empty parts."""
    parts, depth = [""], 0
    for c in text:
        depth += (c == "(") - (c == ")")
        if c == separator and depth == 0:
            parts.append("")
        else:
            parts[-1] += c
    return [part.strip() for part in parts if part.strip()]
