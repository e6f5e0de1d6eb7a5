"""satsym derives, solves, certifies and typesets satellite optimal control problems.

Importing it imports nothing else: the names below are loaded when they are first used. ::

    import satsym

    solution = satsym.solve(satsym.load("soft-return"))
    solution.objective, solution.x["r"](1.5), solution.u([0.0, 1.0, 2.0])
"""

from satsym.version import __version__ as __version__

__all__ = [
    "Angle",
    "Annulus",
    "Ball",
    "Box",
    "FirstOrder",
    "Free",
    "Instance",
    "Newton",
    "Problem",
    "Solution",
    "Variable",
    "analyse",
    "audit",
    "check",
    "derive",
    "export",
    "load",
    "lqr",
    "prove",
    "simulate",
    "solve",
    "study",
]

TYPE_CHECKING = False  # as of typing, which would be loaded for it
if TYPE_CHECKING:
    from satsym.front.analysing import analyse, lqr
    from satsym.front.auditing import audit, check
    from satsym.front.derivation import derive
    from satsym.front.instance import Instance, load
    from satsym.front.proving import prove
    from satsym.front.solution import Solution, export, simulate, solve
    from satsym.front.studies import study
    from satsym.spec import Variable
    from satsym.symbolic import Angle, Annulus, Ball, Box, FirstOrder, Free, Newton, Problem

_HOMES = {
    "front.analysing": ("analyse", "lqr"),
    "front.auditing": ("audit", "check"),
    "front.derivation": ("derive",),
    "front.instance": ("Instance", "load"),
    "front.proving": ("prove",),
    "front.solution": ("Solution", "export", "simulate", "solve"),
    "front.studies": ("study",),
    "spec": ("Variable",),
    "symbolic": ("Angle", "Annulus", "Ball", "Box", "FirstOrder", "Free", "Newton", "Problem"),
}


def __getattr__(name: str) -> object:
    home = next((home for home, names in _HOMES.items() if name in names), None)
    if home is None:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module

    value: object = getattr(import_module(f"{__name__}.{home}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*__all__, *(name for name in globals() if name.startswith("__"))})
