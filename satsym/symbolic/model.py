"""Declarations of a derivation file: models with their physics, and problems with their costs."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar, Literal, TypeAlias

import sympy as sp

from satsym.spec import ControlSetKind, ModeGroup, Variable
from satsym.symbolic.sets import AdmissibleSet

if TYPE_CHECKING:
    from satsym.symbolic.derivation import Derivation, Step
    from satsym.symbolic.dimension_algebra import Dimension
    from satsym.symbolic.equilibria.rest import Rest
    from satsym.symbolic.motion.geometry import Picture

MaybeStep: TypeAlias = "Callable[[Derivation], Step | None]"
"""Function from a derivation to its next step; ``None`` if the step does not apply to the model."""

Requirement: TypeAlias = "Callable[..., Dimension | None]"
"""A function that checks the dimension of a described expression, if it is required, and returns it."""

Convention = Literal["minimum", "maximum"]
"""Form of Pontryagin's principle: H = lambda' f + L is minimised, or H = lambda' f - L is maximised."""

t = sp.Symbol("t", real=True)
"""Time. In a terminal cost it stands for the final time."""


def symbols_of(variables: Iterable[Variable]) -> tuple[sp.Symbol, ...]:
    """Return the symbols of declared variables: real, and positive where they are declared so."""
    return tuple(sp.Symbol(v.symbol, real=True, positive=True if v.positive else None) for v in variables)


@dataclass(frozen=True)
class Definition:
    """A constant with a name of its own, given by the parameters: ``variable = value``."""

    variable: Variable
    value: sp.Expr


@dataclass(frozen=True)
class Output:
    """A measured quantity: ``variable = value``, a function g(t, x, u, p)."""

    variable: Variable
    value: sp.Expr


@dataclass(frozen=True)
class Demand:
    """A condition on parameters: a weighted sum of them, the margin, must be non-negative or positive."""

    margin: sp.Expr
    reason: str
    strict: bool = False


@dataclass(frozen=True)
class Line:
    """An equation of a statement; its right-hand side may be a vector, that is a column.

    Steps that follow from it call it `thing`; `address` is its name among the declarations, unless they are merely
    counted; `left` is a symbol or LaTeX, with a word `index` as its subscript.
    """

    thing: str
    left: sp.Symbol | str
    right: sp.Expr | sp.Matrix
    address: str = ""
    index: str = ""

    @property
    def components(self) -> tuple[sp.Expr, ...]:
        """Return the entries of the right-hand side where it is a vector; none where it is a number or a matrix."""
        return tuple(self.right) if isinstance(self.right, sp.MatrixBase) and self.right.cols == 1 else ()

    @property
    def rows(self) -> tuple[tuple[sp.Expr, ...], ...]:
        """Return the rows of the right-hand side where it is a matrix; none where it is a number or a vector."""
        if not isinstance(self.right, sp.MatrixBase) or self.right.cols == 1:
            return ()
        return tuple(tuple(self.right.row(i)) for i in range(self.right.rows))


@dataclass(frozen=True)
class Paragraph:
    """A sentence of a statement: its key, the model that it names, and the equations it introduces."""

    sentence: str
    of: Model | None = None
    lines: tuple[Line, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Model:
    """The declarations that all kinds of models have.

    Parameters
    ----------
    name
        Name of the model where it is generated without a cost.
    title
        Title, on a single line.
    states, controls, parameters
        Declared variables; arrays everywhere follow this order.
    definitions
        Named constants used in the equations.
    reference
        State -> curve c(t, p); proved to satisfy the equations without control. May be empty.
    outputs
        What is measured. May be empty.
    demands
        What the parameters must obey together; instances that do not are refused. May be empty.
    translations
        Language -> titles, meanings and other words of this declaration, as they stand in it -> in that language. May
        be empty; a derivation file states them once for all, as ``TRANSLATIONS``, or ``NAME.id.toml`` beside it does.
    """

    name: str
    title: str
    states: tuple[Variable, ...]
    controls: tuple[Variable, ...]
    parameters: tuple[Variable, ...]
    definitions: tuple[Definition, ...] = ()
    reference: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    outputs: tuple[Output, ...] = ()
    demands: tuple[Demand, ...] = ()
    translations: Mapping[str, Mapping[str, str]] = field(default_factory=dict)

    plain_time: ClassVar[bool] = False
    """Whether time is a plain number even though other variables have units."""

    along_chain: ClassVar[bool] = False
    """Whether this kind can be derived from a motion whose rates are given by a chain of named parts, not in closed
    form."""

    # What a kind of model says of itself; each has a default, so that a kind states only what it has.

    def steps(self) -> tuple[MaybeStep, ...]:
        """List what is derived, in order, up to a linearisation.

        The steps ``first_order`` and ``linearisation`` must be among them.
        """
        return ()

    def motion_steps(self) -> tuple[MaybeStep, ...]:
        """List the steps up to the first-order form, which models derived from this one need.

        An empty list means that no other model can be derived from this one.
        """
        return ()

    def origin(self) -> Model | None:
        """Return the model from whose motion this one is derived."""
        return None

    def particle(self) -> Particle | None:
        """Return the model itself if it states how a particle moves; ``None`` otherwise."""
        return None

    def brings(self) -> tuple[Variable, ...]:
        """Return the variables that the model adds to the declared ones; a name that is declared is not added again."""
        return ()

    def replaced_states(self) -> tuple[Variable, ...]:
        """Return the states of the original model that states with other names replace in this model."""
        return ()

    def replaced_controls(self) -> tuple[Variable, ...]:
        """Return the controls of the original model that controls with other names replace in this model."""
        return ()

    def measured(self) -> tuple[Variable, ...]:
        """Return the variables of the motion on which outputs may depend."""
        return (*self.states, *self.controls)

    def carried(self) -> tuple[Output, ...]:
        """Return the quantities derived along the motion, to which a running cost may refer."""
        origin = self.origin()
        return origin.carried() if origin else ()

    def demanded(self) -> tuple[Demand, ...]:
        """Return the conditions that this model, or the model from which it is derived, imposes on its parameters."""
        origin, own = self.origin(), set(symbols_of(self.parameters))
        of_origin = origin.demanded() if origin else ()
        return (*self.demands, *(d for d in of_origin if d.margin.free_symbols <= own))

    def followed(self) -> str:
        """Return the name of the parameter that is varied to follow equilibrium attitudes; empty for other models."""
        return ""

    def direction_cosines(self) -> sp.Matrix | None:
        """Return the matrix of direction cosines, by the names that steps give them, or ``None`` if there are none."""
        return None

    def mode_groups(self) -> tuple[ModeGroup, ...]:
        """Return the names of the modes of small motions, by the states that have the largest part in them."""
        return ()

    def rest(self, derived: Derivation) -> Rest | None:
        """Return the torques on a body at rest in its orbit, taken from its derivation; ``None`` for other models."""
        return None

    def misfits(self) -> Iterable[str]:
        """Yield complaints about declarations that do not fit together; the first one is raised."""
        return ()

    def stated(self) -> Iterable[tuple[str, Iterable[Any], set[sp.Symbol]]]:
        """Yield what was stated: its name, its expressions, and the symbols that these may contain."""
        return ()

    def motion_stated(self) -> Iterable[Any]:
        """Return the expressions that state the motion, by its own states and controls."""
        return ()

    def names(self, problem: Problem | None) -> dict[str, str]:
        """Map the names of all quantities in the steps of this kind to LaTeX."""
        return {}

    def accelerations(self) -> tuple[str, ...]:
        """Return the names of second derivatives, which are printed before the controls."""
        return ()

    def unit_vectors(self) -> tuple[str, ...]:
        """Return the names of unit vectors, which are printed last in a product."""
        return ()

    def enter_dimensions(self, known: dict[str, Dimension | None], require: Requirement) -> None:
        """Enter the dimensions of quantities that the steps name, and refuse statements with other dimensions.

        The dimensions of variables, time, rates and initial values are known before.
        """

    def statement(self) -> tuple[Paragraph, ...]:
        """Return what a report says about the motion, in addition to variables, constants and outputs."""
        return ()

    def picture(self) -> Picture | None:
        """Return a picture of the declared geometry, or ``None`` if there is no geometry that can be drawn."""
        return None

    def declared(self) -> dict[str, sp.Expr | sp.Matrix]:
        """Return what ``model:declared.name`` addresses, except constants and costs; vectors are columns."""
        return {}

    def sentences(self) -> Mapping[str, Mapping[str, Mapping[str, str]]]:
        """Map language, table and key to the texts of this kind that the texts of reports do not contain."""
        return {}


@dataclass(frozen=True, kw_only=True)
class Particle(Model):
    """How a particle moves, all forces per unit mass.

    Parameters
    ----------
    coordinates
        Each generalised coordinate with the state that is its rate of change.
    position
        Position vector, inertial components, in terms of the coordinates.
    forces
        Name -> force vector per unit mass, inertial components.
    """

    coordinates: Mapping[sp.Symbol, sp.Symbol]
    position: sp.Matrix
    forces: Mapping[str, sp.Matrix]

    def particle(self) -> Particle:
        """Return the model itself, which states how a particle moves."""
        return self


@dataclass(frozen=True, kw_only=True)
class Problem:
    """An optimal control problem: a model, a cost, and the kind of control set.

    Parameters
    ----------
    name
        Name of the problem in instances, and of the generated files.
    title
        Title, on a single line.
    model
        The motion.
    running_cost
        Integrand L(t, x, u, p) (Lagrange term); zero by default.
    terminal_cost
        Function S(x, t, p), evaluated at the final time (Mayer term).
    terminal_constraints
        Expressions psi(x, t, p) that must vanish at the final time.
    terminal_inequalities
        Expressions psi(x, t, p) by name, none of which may be positive at the final time: ``{"above": r_min - r}``.
    path_constraints
        Expressions g(x, u, t, p) by name, none of which may ever be positive: ``{"ceiling": h - h_max}``.
    interior
        Waypoints by name, in their order, each with the expressions N(x, t, p) that vanish there: ``{"flyby": (x - a, y
        - b)}``. The times at which they are passed are free.
    control_set
        ``"free"``, ``"box"`` (each control between its bounds) or ``"ball"`` (a bound on the norm);
        the instance gives the bounds.
    control_sets
        Used in place of `control_set`: the sets whose product is the control set, by name: ``{"thrust": Ball("ux",
        "uy"), "steering": Angle("beta")}``. Each control is in one of them.
    convention
        The convention of Pontryagin's principle in the typeset derivation: ``"minimum"`` or ``"maximum"``. The controls
        are the same in both; the costates differ in sign, and kernels always use those of the minimum convention.
    maximise
        Whether the objective, the integral of `running_cost` plus `terminal_cost`, is maximised. The derivation and the
        kernels minimise its negative; the costates are those of the negative. Reports show the objective.
    unit
        Unit of the objective, such as ``"km"``; a unit that does not agree with the terms of the objective is rejected.
    """

    name: str
    title: str
    model: Model
    running_cost: sp.Expr = sp.Integer(0)
    terminal_cost: sp.Expr = sp.Integer(0)
    terminal_constraints: tuple[sp.Expr, ...] = ()
    terminal_inequalities: Mapping[str, sp.Expr] = field(default_factory=dict)
    path_constraints: Mapping[str, sp.Expr] = field(default_factory=dict)
    interior: Mapping[str, tuple[sp.Expr, ...]] = field(default_factory=dict)
    control_set: ControlSetKind = "free"
    control_sets: Mapping[str, AdmissibleSet] = field(default_factory=dict)
    convention: Convention = "minimum"
    maximise: bool = False
    unit: str = ""

    @property
    def end_conditions(self) -> tuple[sp.Expr, ...]:
        """Return all psi with multipliers: the terminal constraints, then the terminal inequalities."""
        return (*self.terminal_constraints, *self.terminal_inequalities.values())


def variables_of(model: Model) -> tuple[Variable, ...]:
    """Return every variable that a model declares, replaces and brings, each once."""
    found = [*model.states, *model.controls, *model.parameters, *(d.variable for d in model.definitions)]
    found += [o.variable for o in model.outputs]
    found += [*model.replaced_states(), *model.replaced_controls()]
    kept = {v.symbol for v in found}
    found += [v for v in model.brings() if v.symbol not in kept]
    return tuple(found)


def with_origins(model: Model) -> tuple[Model, ...]:
    """Yield a model, the one from whose motion it is derived, and so on."""
    origin = model.origin()
    return (model, *(with_origins(origin) if origin else ()))


def translated(model: Model, language: str) -> dict[str, str]:
    """Return the words of a model and of its origins in a language; its own words take precedence."""
    return {k: text for one in with_origins(model)[::-1] for k, text in one.translations.get(language, {}).items()}
