"""Problems as pages state them: what is minimised, subject to what, and what the symbols mean."""

from __future__ import annotations

import ast
import json
import re
from collections.abc import Iterator
from dataclasses import dataclass
from math import isfinite
from pathlib import Path
from typing import Any

WHOLE = 104
"""Signs beyond which an equation is left to the derivation, a macro counting as one; a page has room for these."""
EQUATIONS = 12
"""Equations of motion beyond which all are left to the derivation."""
SIGNS = re.compile(r"\\(?:[a-zA-Z]+|.)|[{}^_\s]+")
"""Macros, and what LaTeX needs besides the signs of a formula."""
LONG = "The equations are long; they are in the derivation below.\n\n"
REGULATOR = (
    r"The regulator is the feedback $\mathbf{u} = -K \mathbf{x}$ that minimises the integral of "
    r"$\mathbf{x}^{\mathsf{T}} Q \mathbf{x} + \mathbf{u}^{\mathsf{T}} R \mathbf{u}$, with the weights that the "
    "instance gives. "
)
WEIGHT = "terminal weight"
"""What the meaning of a parameter begins with that weights a part of the terminal cost."""
TYPESET = {
    "radius sigma with angular velocity omega": r"radius $\sigma$ with angular velocity $\omega$",
    "mu = sigma^3 omega^2": r"$\mu = \sigma^3 \omega^2$",
    "defines mu": r"defines $\mu$",
    "and mu is the sum": r"and $\mu$ is the sum",
    "x = a (phi - sin phi)": r"$x = a (\varphi - \sin \varphi)$",
    "y = 10 - a (1 - cos phi)": r"$y = 10 - a (1 - \cos \varphi)$",
    "t = phi sqrt(a / g)": r"$t = \varphi \sqrt{a/g}$",
    "g = 9.80665 m/s^2": r"$g$ = 9.80665 m/s²",
    "and x <= l": r"and $x \le \ell$",
    "J = 2 for l >= 1/4": r"$J = 2$ for $\ell \ge 1/4$",
    "2 + 6 (1 - 4 l)^2 for 1/6 <= l <= 1/4": r"$2 + 6 (1 - 4 \ell)^2$ for $1/6 \le \ell \le 1/4$",
    "4/(9 l) for smaller l": r"$4/(9 \ell)$ for smaller $\ell$",
    "y = c cosh((x - m) / c) + d": r"$y = c \cosh((x - m)/c) + d$",
    "x' = -x^3 + u": r"$\dot x = -x^3 + u$",
    "exp(t)": "$e^t$",
    "u in [-0.75, 1]": r"$u \in [-0.75, 1]$",
    "u + x1/6 <= 0": r"$u + x_1/6 \le 0$",
    "(3.66, -1.86) h": "$(3.66, -1.86)\\,h$",
    "-V y / h": "$-V y/h$",
    "I_x, I_y and I_z": "$I_x$, $I_y$ and $I_z$",
    "I_y is": "$I_y$ is",
}
"""Formulas in docstrings of derivation files, which are plain text there, and how pages typeset them."""


def about(source: Path) -> str:
    """What a derivation file says of itself, as Markdown."""
    said = ast.get_docstring(ast.parse(source.read_text("utf-8"))) or ""
    text = re.sub(r"(?<!\n)\n(?!\n)", " ", said)
    found = re.split("(" + "|".join(map(re.escape, TYPESET)) + ")", text)
    return "".join(TYPESET.get(part) or re.sub(r"([*_<\[\]])", r"\\\1", part) for part in found)


@dataclass(frozen=True)
class Stated:
    """What the derivation of a model states, as LaTeX, without what follows from it."""

    rates: list[str]
    declared: dict[str, str]
    constants: dict[str, dict[str, str]]
    """Names with their LaTeX and their meaning; their formulas are declared."""

    @classmethod
    def by(cls, model: str, generated: Path) -> Stated:
        """Read the files of a model; forces, directions, references and outputs are left out."""
        text = (generated / f"{model}.tex").read_text("utf-8")
        known = json.loads((generated / f"{model}.derivation.json").read_text("utf-8"))
        constants = {name: known["names"][name] for name in known["definitions"]}
        label = rf"\\label\{{{model}:(first_order|declared)\.([\w.]+)\}}"
        rates, declared = list[str](), dict[str, str]()
        for written, step, name in re.findall(rf"^\s*(.*?) {label}", text, re.MULTILINE):
            tex = written.replace("&", "").strip()
            if step == "first_order":
                rates.append(tex)
            elif name in ("J", "L", "S", "control_set", *constants) or tex.startswith((r"\Gamma", "N_")):
                declared[name] = tex
        return cls(rates, declared, constants)

    @property
    def short(self) -> bool:
        """Whether a page has room for all of it; what ends a split formula is not all of that formula."""
        every = [*self.rates, *self.declared.values()]
        whole = all(len(SIGNS.sub(".", tex)) <= WHOLE and "split" not in tex for tex in every)
        return whole and 0 < len(self.rates) <= EQUATIONS

    def beginning(self, *beginnings: str) -> list[str]:
        """The declared formulas that begin in one of these ways."""
        return [tex for tex in self.declared.values() if tex.startswith(beginnings)]

    def explained(self, used: list[str]) -> list[str]:
        """The constants that formulas contain, each with its own formula."""
        return [
            f"${self.declared[name]}$ is the {one['meaning']}"
            for name, one in self.constants.items()
            if any(re.search(rf"{re.escape(one['latex'])}(?![a-zA-Z])", tex) for tex in used)
        ]


def statement(case: Any, command: str, generated: Path) -> str:
    """The problem of an instance in words and formulas, as Markdown."""
    name = case.model.spec.name
    stated = Stated.by(name, generated) if (generated / f"{name}.tex").is_file() else None
    if stated is None or not stated.short or len(stated.rates) != len(case.model.spec.states):
        return LONG
    if "J" in stated.declared:
        return "".join(_minimised(case, stated))
    parts = ["The equations of motion are\n\n", _displayed(stated.rates)]
    known = stated.explained(stated.rates)
    parts.append(f"where {' and '.join(known)}. " if known else "")
    return "".join([*parts, "The table explains the symbols. ", REGULATOR if command == "lqr" else "", "\n\n"])


def _minimised(case: Any, stated: Stated) -> Iterator[str]:
    """A problem with a cost, piece by piece: what is minimised, each kind of condition, and the symbols."""
    cost, running, final = (stated.declared.get(name, "") for name in "JLS")
    spec = case.model.spec
    weights = [w for v, w in zip(spec.parameters, case.parameters, strict=True) if v.meaning.startswith(WEIGHT)]
    unweighted = bool(final and weights and not any(weights))
    if unweighted:
        cost, final = re.sub(r"S\\bigl\(.*?\\bigr\) \+ ", "", cost), ""
    if running == "L = 0":
        cost, running = re.sub(r" [+-] \\int.*", "", cost), ""
    yield f"{'Maximise' if cost.startswith('J = -') else 'Minimise'}\n\n{_displayed([cost])}"
    costs = [(name, tex) for name, tex in (("running", running), ("terminal", final)) if tex]
    names = " and ".join(f"the {name} cost" for name, _ in costs)
    yield f"with {names}\n\n{_displayed([tex for _, tex in costs])}"

    bounded = any(map(isfinite, (case.max_norm, *case.lower, *case.upper)))
    walls, points = stated.beginning(r"\Gamma"), stated.beginning("N_")
    conditions = [
        ("the equations of motion", stated.rates),
        ("the bounds of the controls", [stated.declared["control_set"]] if bounded else []),
        ("the path constraints" if len(walls) > 1 else "the path constraint", walls),
        ("the conditions of the waypoint, at a free time $t_1$", points),
    ]
    given = [(name, formulas) for name, formulas in conditions if formulas]
    for k, (name, formulas) in enumerate(given):
        yield f"{'and' if k else 'subject to'} {name}\n\n{_displayed(formulas)}"

    used = [cost, running, final, *(tex for _, formulas in given for tex in formulas)]
    known = [*stated.explained(used), "$t_0$ is the initial time and $t_f$ the final time"]
    yield f"where {', and '.join(known)}. The table explains the other symbols. "
    yield "The instance gives the initial and the final conditions" + (", and the bounds. " if bounded else ". ")
    if running == "L = 1":
        yield "Because the running cost is one, the cost is the duration. "
    if unweighted:
        yield "The model also has a terminal cost; its weights are zero in this instance. "
    yield "\n\n"


def _displayed(formulas: list[str]) -> str:
    return "".join(f"$$\n{tex}\n$$\n\n" for tex in formulas)
