"""Where regularised paths begin: the path without constraints, a straight line, and paths drawn about these."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from satsym.solution import Solution
from satsym.solvers.collocation.scaling import two_point
from satsym.solvers.constrained.regularised.transcription import Point, Program
from satsym.solvers.constrained.regularised.units import control_unit

AMPLITUDE = 0.3
"""How far paths leave the one in their middle, relative to the sizes of states."""


def first(program: Program, relaxed: Solution) -> Point:
    """The path without constraints, or a straight line."""
    one, count = program.instance, program.intervals
    h = len(one.model.spec.path_constraints)
    tau = np.linspace(0.0, 1.0, count + 1)
    middles = (tau[1:] + tau[:-1]) / 2
    none, v = np.zeros((h, count)), np.zeros(len(program.given) + len(one.model.spec.multipliers))
    if relaxed.status.answered:
        lasting = float(relaxed.times[-1] - relaxed.times[0])
        share = (relaxed.times - relaxed.times[0]) / lasting
        x, u, y = (
            np.array([np.interp(places, share, row) for row in rows]).reshape(len(rows), -1)
            for rows, places in ((relaxed.x, tau), (relaxed.u, middles), (relaxed.lam, middles))
        )
        return Point(x, u, lasting, y, v, none, none)
    return straight(program)


def straight(program: Program) -> Point:
    """A straight line to the given end."""
    one, count = program.instance, program.intervals
    h, n, m = len(one.model.spec.path_constraints), len(one.initial), len(one.model.spec.controls)
    begin, given = np.array(one.initial), np.zeros(n, bool)
    given[program.given] = True
    end = np.where(given, program.target(program.guessed), begin)
    x = begin[:, None] + (end - begin)[:, None] * np.linspace(0.0, 1.0, count + 1)
    none, v = np.zeros((h, count)), np.zeros(len(program.given) + len(one.model.spec.multipliers))
    return Point(x, np.zeros((m, count)), program.guessed, np.zeros((n, count)), v, none, none)


def drawn(program: Program, about: Point, pairs: int, seed: int) -> list[Point]:
    """Pairs of paths to either side of another; controls are moved where constraints hold them."""
    rng, n = np.random.default_rng(seed), len(about.x)
    unit = two_point(program.instance, about.duration).scale.state[:, None]
    size = np.maximum(np.abs(about.x).max(axis=1, keepdims=True), unit)
    tau = np.linspace(0.0, 1.0, program.intervals + 1)
    bumps = [rng.normal(size=(n, 1)) * size * AMPLITUDE * np.sin(np.pi * tau) for _ in range(pairs)]
    pushes = [np.zeros_like(about.u)] * pairs
    if program.holding.any():
        reach = np.maximum(
            np.abs(about.u).max(axis=1, keepdims=True), control_unit(program, about, unit[:, 0])[:, None]
        )
        waves = [np.cos(np.pi * k * tau[1:]) for k in range(2)]
        pushes = [sum(rng.normal(size=reach.shape) * reach * AMPLITUDE * wave for wave in waves) for _ in range(pairs)]
    return [
        replace(about, x=about.x + side * bump, u=about.u + side * push, y=0.0 * about.y)
        for bump, push in zip(bumps, pushes, strict=True)
        for side in (1.0, -1.0)
    ]
