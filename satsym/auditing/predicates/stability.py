"""Claims about stability: what definitions say, what pictures show, what eigenvalues leave open."""

from __future__ import annotations

import math

import numpy as np

from satsym import kernels
from satsym.auditing.predicates import Finding, predicate
from satsym.auditing.predicates.flows import expm, well_conditioned
from satsym.auditing.predicates.linear import analysis, numeric
from satsym.auditing.predicates.linear_rules import BLOCKS
from satsym.status import BadInput
from satsym.wording import shown

_SEED = 11
_TRIES = 20
_LATE = (0.0, 1.0, 5.0, 20.0, 60.0)
_TWIN = np.array([[0.0, 1.0], [-1.0, 0.0]])
"""The oscillator x1' = x2, x2' = -x1: it swings for ever, and is stable."""


@predicate
def stability_definition(of: str) -> Finding:
    """Whether a definition, read as it is printed, sorts linear systems as their e^(At) does.

    ``stable``: for each epsilon there is a delta such that motions from within delta stay within epsilon; epsilon
    divided by the largest norm of e^(At) is one, if that norm is finite. ``asymptotically stable``: moreover
    motions die out. ``unstable``, as printed: for each epsilon there are a delta and a start within it from which
    the motion is farther away than epsilon; three epsilon and a start at two epsilon are tried.
    """
    agree, fooled = 0, []
    for name, (entries, behaviour) in BLOCKS.items():
        a = np.array(entries)
        norms = [float(np.linalg.norm(expm(t * a), 2)) for t in _LATE]
        bounded, dies = max(norms[-2:]) <= 1.5 * max(norms[:-1]), norms[-1] < 1e-3
        if of == "stable":
            agree += bounded == (behaviour != "grows")
        elif of == "asymptotically stable":
            agree += (bounded and dies) == (behaviour == "decays")
        elif of == "unstable":
            start = np.zeros(len(a))
            start[0] = 2.0
            met = any(float(np.linalg.norm(expm(t * a) @ start)) > 1.0 for t in _LATE)
            agree += met == (behaviour == "grows")
            fooled += [name] if met and behaviour != "grows" else []
        else:
            raise BadInput(f"stability_definition: no {shown(of)}; write stable, asymptotically stable or unstable")
    remark = ""
    if fooled:
        remark = (
            "x' = 0, which is stable, meets it with delta = 3 epsilon and a start at 2 epsilon; the negation of "
            "stability is: for some epsilon there is, for every delta, a start within delta from which the motion "
            "leaves epsilon"
        )
    return Finding(
        agree == len(BLOCKS),
        f"it agrees with e^(At) for {agree} of {len(BLOCKS)} kinds of systems",
        {"kinds": len(BLOCKS), "agree": agree, "wrongly called so": ", ".join(fooled) or "none"},
        remark=remark,
    )


@predicate
def real_part_rule(sign: str) -> Finding:
    """Whether all motions die out where all real parts are negative, or some grow where one is positive."""
    if sign not in ("negative", "positive"):
        raise BadInput(f"real_part_rule: no sign {shown(sign)}; write negative or positive")
    rng, agree = np.random.default_rng(_SEED), 0
    for _ in range(_TRIES):
        basis = well_conditioned(rng, 3)
        roots = -rng.uniform(0.2, 1.0, 3)
        roots[0] *= -1.0 if sign == "positive" else 1.0
        late = expm(60.0 * (basis @ np.diag(roots) @ np.linalg.inv(basis)))
        size = float(np.abs(late @ (basis @ np.ones(3))).max())
        agree += size > 1e3 if sign == "positive" else size < 1e-3
    return Finding(agree == _TRIES, f"so in {agree} of {_TRIES} systems", {"systems": _TRIES, "agree": agree})


@predicate
def stable(model: str) -> Finding:
    """Whether a linear system is stable, asymptotically or not."""
    found = analysis(model).stability
    return Finding(found.verdict != "unstable", f"{found.verdict}: {found.reason}", {}, f"satsym analyse {model}")


@predicate
def not_asymptotically_stable(model: str) -> Finding:
    """Whether some disturbances do not die out, because a real part is not negative."""
    parts = [e.value.as_real_imag()[0] for e in analysis(model).eigenvalues]
    return Finding(
        any(part.is_nonnegative for part in parts),
        f"real parts {', '.join(map(str, parts))}",
        {},
        f"satsym analyse {model}",
    )


@predicate
def undecided_by_eigenvalues(model: str) -> Finding:
    """Whether there is a stable and an unstable system with these eigenvalues, so that they alone decide nothing."""
    found = analysis(model)
    parts = [e.value.as_real_imag()[0] for e in found.eigenvalues]
    on_axis = [e for e, part in zip(found.eigenvalues, parts, strict=True) if part == 0]
    open_ = not any(part.is_positive for part in parts) and any(e.algebraic > 1 for e in on_axis)
    vectors = ", ".join(f"{e.geometric} of {e.algebraic} for {e.value}" for e in on_axis if e.algebraic > 1)
    return Finding(
        open_,
        f"with all their eigenvectors such a system is stable, with fewer unstable; here there are {vectors}: "
        f"{found.stability.verdict}",
        {"eigenvectors": vectors},
        f"satsym analyse {model}",
    )


@predicate
def stability_open(model: str) -> Finding:
    """Whether the type of stability cannot be known."""
    found = analysis(model).stability
    decided = found.verdict in ("unstable", "marginally stable", "asymptotically stable")
    return Finding(
        not decided,
        f"it is known, {found.verdict}: {found.reason}",
        {"largest Jordan block on the axis": found.block},
        f"satsym analyse {model}",
    )


@predicate
def swinging_is_unstable(model: str) -> Finding:
    """Whether a system is unstable, and whether that follows from motions that swing and do not come back."""
    found = analysis(model).stability
    norms = [float(np.linalg.norm(expm(t * _TWIN), 2)) for t in _LATE]
    # a counterexample to the reason: a system that swings for ever, and whose motions stay as near as they began
    swings = all(abs(root.imag) > 0.0 and abs(root.real) < 1e-12 for root in np.linalg.eigvals(_TWIN))
    return Finding(
        found.verdict == "unstable",
        f"{found.verdict}: {found.reason}",
        {"largest norm of e^(At) of the oscillator": max(norms)},
        f"satsym analyse {model}",
        sound=not (swings and max(norms) < 2.0 * norms[0]),
        remark="the oscillator x1' = x2, x2' = -x1 swings and does not come to rest, and is stable; it is the "
        "deviation of the angle, growing without bound, that shows it",
    )


@predicate
def field_points(model: str, way: str) -> Finding:
    """Whether the directions of a system in the plane point away from the equilibrium, or towards it, everywhere.

    What is concluded from it, that the system is unstable or stable, is judged by its eigenvalues.
    """
    if way not in ("away", "towards"):
        raise BadInput(f"field_points: no way {shown(way)}; write away or towards")
    found, turns = analysis(model), np.linspace(0.0, 2.0 * math.pi, 3600, endpoint=False)
    a, x = numeric(found.system.a, {}), np.array([np.cos(turns), np.sin(turns)])
    outwards = (x * (a @ x)).sum(axis=0) > 0.0
    share = float(np.mean(outwards if way == "away" else ~outwards))
    concluded = "unstable" if way == "away" else "asymptotically stable"
    return Finding(
        found.stability.verdict == concluded,
        f"{found.stability.verdict}; {100.0 * share:.0f} % of the directions point {way}",
        {f"share that points {way}": share},
        f"satsym analyse {model}",
        sound=share == 1.0,
        remark=""
        if share == 1.0
        else "near one axis they point the other way; unstable it is because some motions leave",
    )


@predicate
def first_order_close(model: str) -> Finding:
    """Whether the linear equations miss those of the deviations by terms of second order.

    Half the deviation must leave a quarter of the difference.
    """
    from satsym.symbolic.lookup.library import derivation

    whole, linear = (derivation(model).step(name).equations for name in ("deviation_equations", "first_order"))
    names = {s.name for e in (*whole, *linear) for s in e.rhs.free_symbols}
    rng = np.random.default_rng(_SEED)
    values = dict.fromkeys(names, 1.0) | {"sigma": 1.3, "omega": 0.8, "mu": 1.3**3 * 0.8**2}
    small = {name: float(rng.uniform(0.5, 1.0)) for name in sorted(names) if name[0] in "xu"}
    gaps = []
    for size in (1e-3, 5e-4):
        at = values | {name: size * value for name, value in small.items()}
        gaps.append(
            max(
                abs(float((one.rhs - other.rhs).xreplace({s: at[s.name] for s in (one.rhs - other.rhs).free_symbols})))
                for one, other in zip(whole, linear, strict=True)
            )
        )
    ratio = gaps[0] / gaps[1]
    return Finding(
        abs(ratio - 4.0) < 0.1, f"half the deviation leaves 1/{ratio:.2f} of the difference", {"ratio": ratio}
    )


@predicate
def output_first_order_close(model: str, linear: str) -> Finding:
    """Whether C z misses the deviation of the output by terms of second order, along the motion linearised about."""
    from satsym.symbolic.lookup.library import derivation

    (outcome,) = derivation(model).model.outputs
    about, time = derivation(linear), 0.9
    names = [v.symbol for v in derivation(model).model.states]
    rows = {e.name: e.rhs for e in about.step("output_matrix").equations if e.name.startswith("C_")}
    reference = [_value(about.equation(f"reference.{name}").rhs, [], [], time) for name in names]
    gaps = []
    for size in (1e-3, 5e-4):
        shift = size * np.array([0.7, -1.1])
        found = [_value(outcome.value, names, point, time) for point in (reference, reference + shift)]
        along = sum(_value(entry, [], [], time) * z for entry, z in zip(rows.values(), shift, strict=True))
        gaps.append(abs(found[1] - found[0] - along))
    ratio = gaps[0] / gaps[1]
    return Finding(
        abs(ratio - 4.0) < 0.1, f"half the deviation leaves 1/{ratio:.2f} of the difference", {"ratio": ratio}
    )


@predicate
def superposes(model: str) -> Finding:
    """Whether the equations of a model are linear: rates midway between two states are midway between the rates."""
    system = kernels.load(model)
    rng = np.random.default_rng(_SEED)
    p, u = (1.0,) * len(system.spec.parameters), (0.0,) * len(system.spec.controls)
    one, other = (rng.uniform(0.5, 2.0, len(system.spec.states)) for _ in range(2))
    rates = [np.array(system.dynamics(0.0, tuple(x), u, p)) for x in (one, other, 0.5 * (one + other))]
    gap = float(np.abs(rates[2] - 0.5 * (rates[0] + rates[1])).max())
    return Finding(
        gap < 1e-9,
        f"between two states the rates are off the mean by {gap:.2g}: the equations of motion are not linear",
        {"difference from the mean": gap},
        f"satsym derive {model}",
        remark="linear are only the equations of the deviations",
    )


def _value(expression: object, names: list[str], state: object, time: float) -> float:
    values = dict(zip(names, np.asarray(state, dtype=float), strict=True)) | {"t": time}
    found = expression.xreplace({s: values[s.name] for s in expression.free_symbols})  # type: ignore[attr-defined]
    return float(found)
