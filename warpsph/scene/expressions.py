"""Formulas in a scene: arithmetic in the coordinates x, y, z [m] and the time t [s]."""

from __future__ import annotations

import ast
import math
from collections.abc import Mapping
from typing import Annotated

import numexpr
import numpy as np
from pydantic import AfterValidator, Field

from warpsph.scene.types import Real

VARIABLES = frozenset("xyzt")
CONSTANTS: Mapping[str, float] = {"pi": math.pi}
FUNCTIONS = frozenset(
    {"abs", "arccos", "arcsin", "arctan", "arctan2", "ceil", "cos", "cosh", "exp", "expm1", "floor"}
    | {"log", "log10", "log1p", "sin", "sinh", "sqrt", "tan", "tanh", "where"}
)
_OPERATORS = (ast.Add, ast.Sub, ast.Mult, ast.Div, ast.Mod, ast.Pow, ast.UAdd, ast.USub)
_LOGIC = (ast.Lt, ast.LtE, ast.Gt, ast.GtE, ast.Eq, ast.NotEq, ast.BitAnd, ast.BitOr, ast.Invert)
_GRAMMAR = (ast.Expression, ast.BinOp, ast.UnaryOp, ast.Compare, ast.Load, *_OPERATORS, *_LOGIC)
_MAX_LENGTH = 1000


def free_variables(expression: str) -> frozenset[str]:
    """Which of x, y, z, t the expression uses."""
    names = (node.id for node in ast.walk(_parse(expression)) if isinstance(node, ast.Name))
    return VARIABLES.intersection(names)


def evaluate(expression: str, variables: Mapping[str, np.ndarray | float]) -> np.ndarray:
    """Value of the expression in float64, for variables (x, y, z [m], t [s]) of shapes that broadcast.

    The result has the common shape of the variables, also where the expression is constant.
    """
    values = {name: np.asarray(value, dtype=np.float64) for name, value in variables.items()}
    shape = np.broadcast_shapes(*(value.shape for value in values.values()))
    formula = ast.unparse(_FloatLiterals().visit(_parse(expression)))
    result = numexpr.evaluate(formula, local_dict={**CONSTANTS, **values}, global_dict={})
    return np.array(np.broadcast_to(result, shape), dtype=np.float64)


class _FloatLiterals(ast.NodeTransformer):
    """Whole numbers become floats: numexpr folds constants, and 9**9**9 as integers never ends."""

    def visit_Constant(self, node: ast.Constant) -> ast.Constant:
        return ast.Constant(_finite(node.value))


def _finite(literal: object) -> float:
    if isinstance(literal, bool) or not isinstance(literal, int | float):
        raise ValueError(f"{literal!r} is not a number")
    try:
        value = float(literal)
    except OverflowError:
        value = math.inf
    if math.isinf(value):
        raise ValueError("it holds a number beyond the range of a float")
    return value


def _parse(expression: str) -> ast.Expression:
    try:
        return ast.parse(expression.strip(), mode="eval")
    except (SyntaxError, ValueError, MemoryError, RecursionError) as error:
        raise ValueError("it is not arithmetic in x, y, z, t") from error


def _refuse_foreign_syntax(node: ast.AST) -> None:
    children: list[ast.AST] = []
    if isinstance(node, ast.Call):
        if not isinstance(node.func, ast.Name) or node.func.id not in FUNCTIONS or node.keywords:
            known = ", ".join(sorted(FUNCTIONS))
            raise ValueError(f"{ast.unparse(node.func)} is not one of the functions {known}")
        children.extend(node.args)
    elif isinstance(node, ast.Name):
        if node.id not in VARIABLES | CONSTANTS.keys():
            raise ValueError(f"{node.id} is not one of x, y, z, t, pi")
    elif isinstance(node, ast.Constant):
        _finite(node.value)
    elif isinstance(node, _GRAMMAR):
        children.extend(ast.iter_child_nodes(node))
    else:
        raise ValueError("it holds something that is not arithmetic")
    for child in children:
        _refuse_foreign_syntax(child)


def _check(expression: str) -> str:
    """Refuse, with the reason, whatever is not arithmetic that can be evaluated."""
    if len(expression) > _MAX_LENGTH:
        raise ValueError(f"it has more than {_MAX_LENGTH} characters")
    _refuse_foreign_syntax(_parse(expression))
    try:
        evaluate(expression, dict.fromkeys(VARIABLES, np.ones(1)))
    except Exception as error:  # numexpr lets through whatever its own compiler met
        raise ValueError(f"it cannot be evaluated ({error})") from error
    return expression


Expression = Annotated[str, AfterValidator(_check)]
"""Arithmetic in x, y, z, t: + - * / % **, comparisons, where(condition, a, b), pi, common functions."""

VectorField = Annotated[tuple[Real | Expression, ...], Field(min_length=2, max_length=3)]
"""A vector whose components are numbers or expressions in x, y, z."""
