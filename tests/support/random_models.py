"""Random problems of all kinds that have a control law: quadratic, convex, linear and mixed, free and bounded.

What they are made of is drawn by :mod:`tests.support.random_parts`.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import replace

from tests.support.random_parts import Draw
from tests.support.statements import Declared, Statement


def _weighed(d: Draw, controls: list[str], equal: bool = False, varied: bool = True) -> list[str]:
    """Positive weights of squares."""
    factors = [d.coefficient() for _ in controls]
    factors = [factors[0]] * len(controls) if equal else factors
    bent = f"(1 + ({d.bounded(0)})**2)*" if varied and d.rng.random() < 0.15 else ""
    half = d.rng.choice(("", "/2"))
    return [
        f"{c}*{bent if equal else bent if k == 0 else ''}{u}**2{half}"
        for k, (c, u) in enumerate(zip(factors, controls, strict=True))
    ]


def _controls(of: Statement) -> list[str]:
    return [one.name for one in of.controls]


def free(d: Draw) -> Statement:
    """H quadratic in free controls."""
    found = d.driven(d.begin("free"))
    us = _controls(found)
    cost = _weighed(d, us) + d.cost()
    if d.rng.random() < 0.3:
        cost.append(f"{d.signed(d.function())}*{d.rng.choice(us)}")
    if len(us) > 1 and d.rng.random() < 0.3:
        cost.append(f"{d.coefficient()}*({us[0]} - {d.coefficient()}*{us[1]})**2")
    return d.ended(found, cost)


def box(d: Draw) -> Statement:
    """H quadratic in controls between bounds."""
    found = d.driven(d.begin("box"))
    cost = _weighed(d, _controls(found)) + d.cost()
    if d.rng.random() < 0.3:
        cost.append(f"{d.signed(d.function())}*u1")
    return d.ended(found, cost, control_set='"box"')


def ball(d: Draw) -> Statement:
    """H quadratic in controls whose norm is bounded."""
    found = d.driven(d.begin("ball"))
    return d.ended(found, _weighed(d, _controls(found), equal=True) + d.cost(), control_set='"ball"')


def directed(d: Draw) -> Statement:
    """H linear in a vector in a ball."""
    found = d.driven(d.begin("directed", controls=d.rng.choice((2, 3))))
    return d.ended(found, d.cost() or ["1"], control_set='"ball"')


def convex(d: Draw) -> Statement:
    """H convex in controls in a box, neither linear nor quadratic."""
    found = d.driven(d.begin("convex", controls=d.rng.choice((1, 1, 2))))
    cost = []
    for u in _controls(found):
        c, e, f = d.coefficient(), d.coefficient(-2, 2), d.coefficient(-1, 1)
        forms = (
            f"{c}*sqrt({f} + {u}**2)",
            f"{c}*exp({f}*{u})",
            f"{c}*{u}**4 + {e}*{u}**2",
            f"{c}*cosh({f}*{u})",
            f"{c}*{u}**4",
        )
        cost.append(d.rng.choice(forms))
    return d.ended(found, cost + d.cost(), control_set='"box"')


def switching(d: Draw) -> Statement:
    """H linear in controls in a box, and at times in their magnitudes; singular arcs."""
    found = d.driven(d.begin("switching", most=4))
    cost = d.cost()
    for u in _controls(found):
        chance = d.rng.random()
        cost += (
            [f"{d.coefficient()}*Abs({u})"] if chance < 0.15 else [f"{d.coefficient()}*{u}"] if chance < 0.35 else []
        )
    return d.ended(found, cost or ["1"], control_set='"box"')


def products(d: Draw) -> Statement:
    """A product of sets, in each of which H is quadratic, linear, or turned by an angle."""
    found = d.begin("product", controls=3)
    kind = d.rng.choice(("ball and box", "boxes", "ball and switch", "free and box", "angle", "heading", "throttled"))
    cost = d.cost()
    if kind == "angle":
        found = d.driven(
            replace(found, controls=(Declared("u1"), Declared("b", ', kind="angle"'))), ["u1", "cos(b)", "sin(b)"]
        )
        return d.ended(found, _weighed(d, ["u1"]) + cost, control_sets='{"push": Box("u1"), "course": Angle("b")}')
    if kind == "heading":
        found = d.driven(
            replace(found, controls=(Declared("F"), Declared("b", ', kind="angle"'))), ["F*cos(b)", "F*sin(b)"]
        )
        cost += d.rng.choice((_weighed(d, ["F"]), [f"{d.coefficient()}*F"]))
        return d.ended(found, cost, control_sets='{"throttle": Box("F"), "course": Angle("b")}')
    if kind == "throttled":
        found = d.driven(replace(found, controls=found.controls[:2]))
        cost.append(f"{d.coefficient()}*sqrt(u1**2 + u2**2)")
        return d.ended(found, cost, control_sets='{"engine": Ball("u1", "u2")}')
    found = d.driven(found)
    if kind == "boxes":
        return d.ended(
            found, _weighed(d, ["u1", "u2", "u3"]) + cost, control_sets='{"a": Box("u1"), "b": Box("u2", "u3")}'
        )
    if kind == "free and box":
        cost += _weighed(d, ["u1", "u2", "u3"])
        return d.ended(found, cost, control_sets='{"a": Free("u1", "u2"), "b": Box("u3")}')
    cost += _weighed(d, ["u1", "u2"], equal=True) + (_weighed(d, ["u3"]) if kind == "ball and box" else [])
    return d.ended(found, cost, control_sets='{"a": Ball("u1", "u2"), "b": Box("u3")}')


def constrained(d: Draw) -> Statement:
    """Path constraints of order zero, one and two."""
    found = d.begin("constrained", least=2, most=5, controls=d.rng.choice((1, 1, 2)))
    order, us = d.rng.choice((0, 1, 2)), _controls(found)
    rates = dict(found.rates)
    plain = [s for s in found.states if not s.more]
    first, second = (plain[0].name, plain[-1].name) if len(plain) > 1 else ("x1", "x2")
    if order == 2:
        rates[first] = (second,)
        rates[second] = (*(term for term in rates[second] if "*" in term), f"{d.coefficient(-2, 2)}*{us[0]}")
    else:
        rates[first] = (*rates[first], f"{d.coefficient(-2, 2)}*{us[0]}")
    found = replace(found, rates=rates)
    if len(us) > 1:
        left = replace(found, rates={x: terms for x, terms in rates.items() if x not in (first, second)})
        found = replace(found, rates={**rates, **d.driven(left, us[1:]).rates}) if left.rates else found
        if not left.rates:
            found = replace(found, rates={**rates, second: (*rates[second], us[1])})
    limit = d.coefficient(-1, 1)
    if order == 0:
        g = d.rng.choice((f"{us[0]} - {limit}", f"{d.coefficient(-2, 2)}*{us[0]} + {d.signed(d.function())} - {limit}"))
    else:
        g = d.rng.choice(
            (
                f"{first} - {limit}",
                f"{first} - {limit}",
                f"{first} + {d.coefficient(-2, 1)}*{first}**3 - {limit}",
                f"-{first} - {limit}",
            )
        )
    cost = _weighed(d, us, varied=False) + d.cost()
    sets = {"control_set": '"box"'} if d.rng.random() < 0.4 else {}
    return d.ended(found, cost, path_constraints=f'{{"wall": {g}}}', **sets)


def kept(d: Draw) -> Statement:
    """A path constraint of order one where H is linear in the control."""
    found = d.begin("kept", least=2, most=3, controls=1)
    rates = dict(found.rates)
    rates["x1"] = (*rates["x1"], f"{d.coefficient(-2, 2)}*u1")
    cost = d.cost() or ["1"]
    return d.ended(
        replace(found, rates=rates),
        cost,
        path_constraints=f'{{"wall": x1 - {d.coefficient(-1, 1)}}}',
        control_set='"box"',
    )


def passing(d: Draw) -> Statement:
    """A point on the way."""
    found = d.driven(d.begin("passing", least=2, most=5))
    cost = _weighed(d, _controls(found), varied=False) + d.cost()
    sets = {"control_set": '"box"'} if d.rng.random() < 0.4 else {}
    at = f"x1 - {d.coefficient(-1, 1)}" if d.rng.random() < 0.6 else f"{d.function()} - {d.coefficient(-1, 1)}"
    return d.ended(found, cost, interior=f'{{"point": ({at},)}}', **sets)


def orbit(d: Draw) -> Statement:
    """A particle in a plane by Newton's law."""
    states = (Declared("r", ", positive=True"), Declared("v"), Declared("phi", ', kind="angle"'), Declared("w"))
    d.smooth, d.above = ["r", "v", "w", "sin(phi)", "cos(phi)", "r"], ["r"]
    mu = d.coefficient()
    along, across = [f"-{mu}/r**2"], []
    if d.rng.random() < 0.6:
        along += d.terms(1, 1)
        across += d.terms(0, 1)
    controls = (Declared("u1"), Declared("u2"))
    found = Statement(
        d.name, "orbit", states, controls, rates={"along": (*along, "u1"), "across": (*across, "u2")}, newton=True
    )
    kind = d.rng.choice(("free", "box", "ball"))
    cost = _weighed(d, ["u1", "u2"], equal=kind == "ball", varied=False) + d.cost()
    return replace(d.ended(found, cost, control_set=f'"{kind}"'), outputs=())


def motion(d: Draw) -> Statement:
    """A motion without a cost."""
    return replace(d.ended(d.driven(d.begin("motion", most=4)), []), more={}, terminal=())


KINDS: dict[Callable[[Draw], Statement], int] = {
    free: 16,
    box: 16,
    ball: 10,
    directed: 6,
    convex: 8,
    switching: 14,
    products: 12,
    constrained: 8,
    kept: 2,
    passing: 3,
    orbit: 3,
    motion: 2,
}
"""What is drawn, and how often."""


def random_model(seed: int) -> Statement:
    """The model of that number, always the same."""
    rng = random.Random(f"random model {seed}")
    make = rng.choices(list(KINDS), list(KINDS.values()))[0]
    return make(Draw(rng, f"model{seed}"))
