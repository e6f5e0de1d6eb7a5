"""Descriptions of models and problems as plain data: no sympy, no numbers of an instance.

Derivation files declare them, generated modules carry them as literals, and all numeric code reads them: one
description of names, units, defaults and kinds for all parts.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields
from functools import cached_property
from itertools import accumulate
from math import inf, isfinite
from typing import Any, Literal

from satsym.control_part import SWITCHED, ControlPart

FORMAT = 1
"""Version of the literal that generated modules carry as ``MODEL``."""

MOST_LETTERS = 24
"""Largest number of letters of an exact analysis, times the number of states; larger results fill pages."""

ControlSetKind = Literal["free", "box", "ball"]
NAMES = "a lower-case letter, followed by lower-case letters, digits and underscores"
"""The form of names of models and problems."""
_MODEL = re.compile(r"[a-z][a-z0-9_]{0,99}\Z")
PRODUCT: Literal["product"] = "product"
"""The kind of a control set that is stated set by set."""
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*\Z")
_OF_VARIABLES = (
    *("states", "controls", "parameters", "invariants", "position", "multipliers", "outputs"),
    *("quantities", "balances"),
)
_UNLESS_DEFAULT = (
    *("outputs", "linear", "keplerian", "switching", "coordinates", "velocities", "quantities", "balances"),
    *("switching_curve", "conditions", "equilibria", "mode_groups", "control_parts", "maximise", "objective_unit"),
    *("chattering", "moving_magnitudes", "path_constraints", "linear_quadratic", "terminal_inequalities", "interior"),
)


@dataclass(frozen=True)
class Variable:
    """A named quantity: a state, a control, a parameter, an output or a defined constant.

    Parameters
    ----------
    symbol
        Name used in instances, results and generated code (a Python identifier).
    latex
        LaTeX of the symbol.
    unit
        Unit of the values, as pint reads it; ``"1"`` if there is none.
    meaning
        Meaning of the quantity, in a few words.
    default
        Value that is used if an instance gives none (parameters only).
    kind
        ``"real"``, or ``"angle"`` if values that differ by a full turn are equivalent.
    positive
        Whether only positive values are meaningful; for a state, this defines its domain.
    typical
        Lower and upper end of the range of usual values, in the unit of the quantity. Random points for checks are
        drawn from this range; without it, they are of order one, where roots and steep functions may not be defined.
    """

    symbol: str
    latex: str
    unit: str = "1"
    meaning: str = ""
    default: float | None = None
    kind: Literal["real", "angle"] = "real"
    positive: bool = False
    typical: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        for field in ("symbol", "latex", "unit", "meaning"):
            if not isinstance(value := getattr(self, field), str):
                raise ValueError(f"variable {self.symbol!r}: got {value!r} for {field}; write text in quotes")
        if self.kind not in ("real", "angle"):
            raise ValueError(f'variable {self.symbol!r}: got the kind {self.kind!r}; write "real" or "angle"')
        if not _NAME.match(self.symbol) or "__" in self.symbol:
            raise ValueError(f"variable {self.symbol!r}: use a letter, then letters, digits and single underscores")
        if not self.latex.strip() or not _closed(self.latex):
            raise ValueError(f"variable {self.symbol!r}: latex is {self.latex!r}; write its LaTeX with matching braces")
        if self.default is not None and not (isinstance(self.default, int | float) and isfinite(self.default)):
            raise ValueError(f"variable {self.symbol!r}: got the default {self.default!r}; give a finite number")
        if self.typical is not None:
            low, high = self.typical if len(self.typical) == 2 else (inf, inf)
            if not (isfinite(low) and isfinite(high) and low < high) or (self.positive and low <= 0):
                wanted = "0 < low < high" if self.positive else "low < high"
                raise ValueError(
                    f"variable {self.symbol!r}: got the typical range {self.typical!r}; give two numbers, {wanted}"
                )


def _closed(latex: str) -> bool:
    """Tell whether grouping braces are balanced; those after a backslash are printed ones."""
    depth = 0
    for brace in re.findall(r"\\.|[{}]", latex):
        depth += {"{": 1, "}": -1}.get(brace, 0)
        if depth < 0:
            return False
    return depth == 0


@dataclass(frozen=True)
class Condition:
    """A condition on parameters: a weighted sum is not negative, or is positive where `strict`.

    Attributes
    ----------
    terms
        Names with their weights.
    strict
        Whether zero is excluded.
    reason
        Why, in a few words.
    """

    terms: tuple[tuple[str, float], ...]
    strict: bool
    reason: str


@dataclass(frozen=True)
class ModeGroup:
    """The name of the modes of small motions in which certain states have the largest part.

    Attributes
    ----------
    name
        Name of these modes, unless one of the following names applies.
    states
        Names of the states.
    vanishing, slow
        A parameter, and the name of modes that become infinitely slow as it vanishes; empty if there is no such name.
    neutral
        Name of modes with the eigenvalue 0; empty if these have no name of their own.
    """

    name: str
    states: tuple[str, ...]
    vanishing: str = ""
    slow: str = ""
    neutral: str = ""


@dataclass(frozen=True)
class PathConstraint:
    """An inequality that must hold along the whole trajectory.

    Attributes
    ----------
    name
        As the model states it.
    order
        How often it is differentiated until a control appears: 1 or 2, or 0 where it holds one itself.
    """

    name: str
    order: int


@dataclass(frozen=True)
class InteriorPoint:
    """A point on the way, which is passed at a free time.

    Attributes
    ----------
    name
        As the model states it.
    conditions
        How many there are.
    """

    name: str
    conditions: int


@dataclass(frozen=True)
class ProblemSpec:
    """The names, units and kinds of one generated model or optimal control problem.

    Attributes
    ----------
    name, title, source
        Name in instances, one line for people, and the derivation file it came from.
    states, controls, parameters
        States, controls and parameters in the model's order, which arrays and JSON objects follow.
    control_set
        Kind of the control set; ``None`` for a model without a cost.
    has_cost, has_terminal_cost, has_reference, autonomous
        Which of the generated functions mean something.
    invariants, position, multipliers
        Names of the conserved quantities of the uncontrolled motion, of the components of the position vector, and
        of the multipliers of terminal constraints (each empty where there are none).
    outputs
        Outputs of a linear model; empty if there are none, or if the model is not linear.
    linear
        Names of the functions that only linear models have; empty where the model is not linear.
    keplerian
        Whether the uncontrolled motion was proved to be Kepler's: acceleration -mu r/|r|^3 with a constant mu.
    switching
        Whether every control enters the Hamiltonian affinely (apart from its magnitude), within a box.
    coordinates, velocities
        States q and v of a motion that is separable, see :attr:`separable`; empty where it is not.
    quantities
        Further quantities that are computed along a motion, such as the power of a motor.
    balances
        Quantities that change only by external influences, whatever the controls do, such as an angular momentum.
    switching_curve
        Names of position and rate where the control of least time follows from the side of a curve on which they lie;
        empty where there is no such curve in closed form.
    conditions
        Conditions that several parameters must satisfy together.
    equilibria
        The parameter over which equilibria are followed, for models of the attitude in orbit; else empty.
    control_parts
        The sets whose product is the control set, if it was stated set by set; else empty.
    mode_groups
        Names of modes by the states that have the largest part in them. May be empty.
    maximise
        Whether the author's objective is maximised; generated functions are those of its negative, the cost.
    objective_unit
        Unit of the objective, if it is stated; else empty.
    chattering
        Names of controls whose singular arcs, within their bounds, are met and left by infinitely many switches only.
    moving_magnitudes
        Names of controls whose magnitudes stand in the motion.
    path_constraints
        Inequalities on the state along the way. May be empty.
    linear_quadratic
        Whether, with such constraints, all is linear or quadratic so that signs of matrices tell whether it is convex.
    terminal_inequalities
        Names of the last of `multipliers`, which belong to inequalities at the end.
    interior
        Points on the way, in order. May be empty.
    """

    name: str
    title: str
    source: str
    states: tuple[Variable, ...]
    controls: tuple[Variable, ...]
    parameters: tuple[Variable, ...]
    control_set: ControlSetKind | Literal["product"] | None
    has_cost: bool
    has_terminal_cost: bool
    has_reference: bool
    autonomous: bool
    invariants: tuple[Variable, ...] = ()
    position: tuple[Variable, ...] = ()
    multipliers: tuple[Variable, ...] = ()
    outputs: tuple[Variable, ...] = ()
    linear: tuple[str, ...] = ()
    keplerian: bool = False
    switching: bool = False
    coordinates: tuple[str, ...] = ()
    velocities: tuple[str, ...] = ()
    quantities: tuple[Variable, ...] = ()
    balances: tuple[Variable, ...] = ()
    switching_curve: tuple[str, ...] = ()
    conditions: tuple[Condition, ...] = ()
    equilibria: str = ""
    mode_groups: tuple[ModeGroup, ...] = ()
    control_parts: tuple[ControlPart, ...] = ()
    maximise: bool = False
    objective_unit: str = ""
    chattering: tuple[str, ...] = ()
    moving_magnitudes: tuple[str, ...] = ()
    path_constraints: tuple[PathConstraint, ...] = ()
    linear_quadratic: bool = False
    terminal_inequalities: tuple[str, ...] = ()
    interior: tuple[InteriorPoint, ...] = ()

    def objective(self, cost: float) -> float:
        """Convert the cost to the author's objective, or the objective to the cost."""
        return -cost if self.maximise else cost

    @property
    def in_arcs(self) -> bool:
        """Tell whether extremals consist of arcs between boundaries of path constraints, or points on the way."""
        return bool(self.path_constraints or self.interior)

    @cached_property
    def directional(self) -> bool:
        """Tell whether some controls are directions, which are undetermined where H does not depend on them."""
        return any(part.directed for part in self.control_parts)

    @cached_property
    def stationary(self) -> bool:
        """Tell whether H depends on some controls neither linearly nor quadratically."""
        return any(part.branch == "stationary" for part in self.control_parts)

    @cached_property
    def throttled(self) -> bool:
        """Tell whether norms of directions, or single controls in a product of sets, switch between two levels."""
        return any(part.branch in SWITCHED for part in self.control_parts)

    @cached_property
    def regularising(self) -> int:
        """Return how many numbers at the end of the argument ``bounds`` state the regularisation."""
        balls = sum(part.branch == "throttled" and part.kind == "ball" for part in self.control_parts)
        return 2 * self.switching + self.directional + self.throttled + balls

    @property
    def lower_bounds(self) -> frozenset[int]:
        """Return the places in the argument ``bounds`` of lower bounds, which may be negative."""
        if self.control_set == "box":
            return frozenset(range(len(self.controls)))
        boxes = [(at, part) for at, part in self._placed if part.kind == "box" and not part.turned_by]
        return frozenset(at + i for at, part in boxes for i in range(len(part.controls)))

    @property
    def rings(self) -> tuple[tuple[int, int], ...]:
        """Return the places in the argument ``bounds`` of minimum norms, each with that of the maximum norm."""
        balls = [at for at, part in self._placed if part.kind == "ball" and part.branch == "throttled"]
        after = sum(part.bounds for part in self.control_parts) + self.regularising - len(balls)
        found = [(at, at + 1) for at, part in self._placed if part.kind == "annulus" or part.turned_by]
        return (*found, *((after + k, at) for k, at in enumerate(balls)))

    @property
    def _placed(self) -> list[tuple[int, ControlPart]]:
        """Return the sets of a product, each with the place of its first number in ``bounds``."""
        places = accumulate((part.bounds for part in self.control_parts), initial=0)
        return list(zip(places, self.control_parts, strict=False))

    @property
    def separable(self) -> bool:
        """Tell whether the uncontrolled motion is q' = v, v' = a(q) with a potential, for a symplectic loop."""
        return bool(self.coordinates)

    @property
    def state_names(self) -> tuple[str, ...]:
        return names(self.states)

    @property
    def control_names(self) -> tuple[str, ...]:
        return names(self.controls)

    @property
    def parameter_names(self) -> tuple[str, ...]:
        return names(self.parameters)

    def to_literal(self) -> dict[str, Any]:
        """Return the literal that a generated module carries.

        Fields of variables with default values are left out, and so are the fields of linear models for other models.
        """
        return {"format": FORMAT} | {
            f.name: tuple(map(_stated, value)) if isinstance(value := getattr(self, f.name), tuple) else value
            for f in fields(self)
            if f.name not in _UNLESS_DEFAULT or getattr(self, f.name)
        }

    @classmethod
    def from_literal(cls, literal: Mapping[str, Any]) -> ProblemSpec:
        """Read the literal of a generated module.

        Raises
        ------
        ValueError
            If it was written in another format or has other fields.
        """
        stated = dict(literal)
        if stated.pop("format", None) != FORMAT:
            raise ValueError(f"is not written in the format {FORMAT}")
        try:
            for key in _OF_VARIABLES:
                entries = stated[key] if key not in _UNLESS_DEFAULT else stated.get(key, ())
                stated[key] = tuple(Variable(**entry) for entry in entries)
            stated["conditions"] = tuple(Condition(**entry) for entry in stated.get("conditions", ()))
            stated["mode_groups"] = tuple(ModeGroup(**entry) for entry in stated.get("mode_groups", ()))
            stated["control_parts"] = tuple(ControlPart(**entry) for entry in stated.get("control_parts", ()))
            stated["path_constraints"] = tuple(PathConstraint(**entry) for entry in stated.get("path_constraints", ()))
            stated["interior"] = tuple(InteriorPoint(**entry) for entry in stated.get("interior", ()))
            return cls(**stated)
        except (KeyError, TypeError) as error:
            raise ValueError(f"its MODEL has fields that this version of satsym does not support ({error})") from None


def is_name(name: object) -> bool:
    """Tell whether a text can be the name of a model."""
    return isinstance(name, str) and _MODEL.match(name) is not None


def names(variables: Iterable[Variable]) -> tuple[str, ...]:
    """Return the names of the variables, in order."""
    return tuple(v.symbol for v in variables)


def _stated(
    variable: Variable | Condition | ModeGroup | ControlPart | PathConstraint | InteriorPoint | str,
) -> dict[str, Any] | str:
    """Return the fields that differ from their defaults; for a name, the name itself."""
    if isinstance(variable, str):
        return variable
    return {f.name: value for f in fields(variable) if (value := getattr(variable, f.name)) != f.default}
