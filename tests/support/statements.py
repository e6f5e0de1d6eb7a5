"""A model as the text of a derivation file, kept term by term, so that one that fails can be made smaller."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

HEAD = """from sympy import Abs, Rational, atan, cos, cosh, exp, log, sin, sqrt, tanh
from satsym.symbolic import Angle, Ball, Box, FirstOrder, Free, Newton, Output, Problem, Variable, symbols_of, t
"""
_WORD = re.compile(r"[A-Za-z_]\w*")


@dataclass(frozen=True)
class Declared:
    """A variable as it is written; what follows its unit is Python."""

    name: str
    more: str = ""

    def __str__(self) -> str:
        letters = self.name.rstrip("0123456789")
        number = self.name[len(letters) :]
        return f'Variable("{self.name}", "{letters}{f"_{{{number}}}" if number else ""}", "1"{self.more}),'


@dataclass(frozen=True)
class Statement:
    """A problem, or a motion alone, as text in parts.

    Attributes
    ----------
    shared
        Name -> expression, of which terms are made.
    rates
        State -> terms; for Newton's law the components of a force.
    cost, terminal
        Terms of the running cost, none of a motion alone, and of the terminal one.
    more
        Fields of the problem as they are written.
    """

    name: str
    kind: str
    states: tuple[Declared, ...]
    controls: tuple[Declared, ...]
    parameters: tuple[Declared, ...] = ()
    shared: dict[str, str] = field(default_factory=dict)
    rates: dict[str, tuple[str, ...]] = field(default_factory=dict)
    cost: tuple[str, ...] = ()
    terminal: tuple[str, ...] = ()
    more: dict[str, str] = field(default_factory=dict)
    outputs: tuple[str, ...] = ()
    newton: bool = False

    def text(self) -> str:
        """The derivation file."""
        shared, parameters = self._used()
        lines = [HEAD]
        for group, found in (("STATES", self.states), ("CONTROLS", self.controls), ("PARAMETERS", parameters)):
            lines += [f"{group} = (", *(f"    {one}" for one in found), ")"]
            names = ", ".join(one.name for one in found)
            lines += [f"({names},) = symbols_of({group})"] if found else []
        lines += [f"{name} = {value}" for name, value in shared.items()]
        lines += ["", *self._model(), "", *self._problem(), ""]
        return "\n".join(lines)

    def _used(self) -> tuple[dict[str, str], tuple[Declared, ...]]:
        """The shared parts and the parameters that something has in it."""
        texts = [*(e for terms in self.rates.values() for e in terms), *self.cost, *self.terminal, *self.outputs]
        words = set(_WORD.findall(" ".join([*texts, *self.more.values()])))
        shared: dict[str, str] = {}
        for name, value in reversed(self.shared.items()):
            if name in words:
                shared[name] = value
                words |= set(_WORD.findall(value))
        return dict(reversed(shared.items())), tuple(p for p in self.parameters if p.name in words)

    def _model(self) -> list[str]:
        outputs = ", ".join(f'Output(Variable("y{k}", "y_{{{k}}}", "1"), {e})' for k, e in enumerate(self.outputs))
        outputs += "," * bool(outputs)
        common = (
            'name="motion", title="A motion", states=STATES, controls=CONTROLS, parameters=PARAMETERS, '
            f"outputs=({outputs}),"
        )
        summed = {x: " + ".join(terms) or "0" for x, terms in self.rates.items()}
        if not self.newton:
            return [
                *("model = FirstOrder(", f"    {common}", "    rates={"),
                *(f"        {x}: {e}," for x, e in summed.items()),
                *("    },", ")"),
            ]
        r, v, phi, w = (one.name for one in self.states[:4])
        return [
            "from sympy import Matrix",
            f"along, across = Matrix([cos({phi}), sin({phi})]), Matrix([-sin({phi}), cos({phi})])",
            *("model = Newton(", f"    {common}", f"    coordinates={{{r}: {v}, {phi}: {w}}},"),
            f"    position=({r}*along), directions={{'along': along, 'across': across}},",
            f"    forces={{'outwards': ({summed['along']})*along, 'onwards': ({summed['across']})*across}},",
            ")",
        ]

    def _problem(self) -> list[str]:
        if not self.cost:
            return ["PROBLEMS = (model,)"]
        fields = {"running_cost": " + ".join(self.cost), **self.more}
        if self.terminal:
            fields["terminal_cost"] = " + ".join(self.terminal)
        return [
            *("PROBLEMS = (", "    Problem(", f'        name="{self.name}", title="A random problem", model=model,'),
            *(f"        {key}={value}," for key, value in fields.items()),
            *("    ),", ")"),
        ]

    @property
    def written(self) -> str:
        """Name of what is derived."""
        return self.name if self.cost else "motion"
