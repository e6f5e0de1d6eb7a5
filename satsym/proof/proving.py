"""The proof, on one page, that an extremal near a solver's answer is a strict local minimum."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import partial

from flint import ctx

from satsym.instance import Instance
from satsym.proof import claims, inclusion, structure
from satsym.proof.balls.arithmetic import BeyondProof, NotProved
from satsym.proof.balls.taylor import Order
from satsym.proof.field import regular_field
from satsym.proof.global_minimum import convex, costs_nothing, final_state, waiting
from satsym.proof.identities import verify
from satsym.proof.inclusion import SPARE
from satsym.proof.lifting import Lifted, with_more_states
from satsym.proof.record import Hypothesis, Outcome, Proof
from satsym.proof.signs import hold, unique
from satsym.proof.statement import Statement, refuse, stated, walled
from satsym.solution import Solution


def prove(case: Instance, find: Callable[[], Solution], digits: int = 20) -> Proof:
    """Prove that near an answer there is one extremal, and that it is a strict strong local minimum.

    Parameters
    ----------
    case
        The problem as it was stated.
    find
        Function that solves the problem, so that the proof knows where to look; no claim of the solution is used. It
        is called only if a theorem covers the problem.
    digits
        Significant digits of the enclosures.

    Returns
    -------
    Proof
        The record of the proof; if nothing is proved, ``status`` and ``reason`` say why.
    """
    begun = time.perf_counter()
    record = _tried(Proof(case.model.spec.name, case.called, Outcome.NOT_PROVED, digits=digits), partial(_first, case))
    if not record.reason and record.status is Outcome.NOT_PROVED:
        found = find()
        begun = time.perf_counter()
        record = _tried(record, partial(_proved, case, found))
    return replace(record, wall_s=time.perf_counter() - begun)


def _tried(record: Proof, attempt: Callable[[Proof], Proof]) -> Proof:
    """Return the record after an attempt, with the reason if the attempt ends without a proof."""
    try:
        with _precision(record.digits):
            return attempt(record)
    except BeyondProof as error:
        return replace(record, status=Outcome.BEYOND, reason=str(error))
    except NotProved as error:
        return replace(record, reason=str(error))
    except _Stopped as stopped:
        return replace(stopped.record, reason=stopped.reason)
    except (ArithmeticError, ValueError) as error:
        return replace(record, reason=f"the motion is singular near the solution ({error})")


def _first(case: Instance, record: Proof) -> Proof:
    """Return what is known before solving: that a theorem covers the problem, or that zero control is optimal."""
    refuse(case)
    statement = stated(case)
    record = replace(record, numbers=dict(statement.source.stated))
    if walled(statement) and not convex(statement):
        raise BeyondProof("path constraints of a problem that is not convex")
    return _at_rest(statement, record) if costs_nothing(statement) else record


def _at_rest(statement: Statement, record: Proof) -> Proof:
    """Prove a problem for which zero control is optimal."""
    sizes = [max(abs(float(v.mid())), 1e-3) for v in statement.initial]
    order = Order(max(18, int(1.1 * (record.digits + SPARE))), 10.0 ** -(record.digits + SPARE))
    end, steps = final_state(statement, order, [*sizes, 1.0])
    return inclusion.at_rest(record, statement, end, steps)


class _Stopped(Exception):
    """The proof ended after some hypotheses were shown."""

    def __init__(self, record: Proof, reason: str) -> None:
        super().__init__(reason)
        self.record, self.reason = record, reason


@contextmanager
def _precision(digits: int) -> Iterator[None]:
    """Set arithmetic to enough bits; the setting is flint's own, for the whole process."""
    before = ctx.prec, ctx.cap
    ctx.prec = 90 + int(3.6 * digits)
    try:
        yield
    finally:
        ctx.prec, ctx.cap = before


def _proved(case: Instance, found: Solution, record: Proof) -> Proof:
    """Prove that near a solution there is one extremal, and that it is a strict strong local minimum."""
    if not found.status.answered:
        raise NotProved(f"there is no solution to start the proof from: {found.message}")
    statement = stated(case, found.instance.met, found.x[:, -1].tolist())
    record = replace(record, numbers=dict(statement.source.stated))
    if isinstance(statement.kernel, Lifted):
        found = with_more_states(statement.kernel, found, statement.p)
    shooting, place = structure.begun(statement, found, record.digits)
    for arc in shooting.arcs:
        verify(statement, arc.law, place.nodes, shooting.sizes)
    there = inclusion.enclosed(shooting, place, record.digits)
    record = inclusion.entered(record, shooting, there)
    passed, convexity = there.last.passed, convex(statement)
    steps: list[Callable[[], Hypothesis]] = [
        lambda: claims.of_signs(hold(shooting, passed)),
        lambda: claims.of_minimiser(unique(shooting, passed)),
        lambda: claims.of_ends(statement, passed.end),
    ]
    if walled(statement):
        steps.append(lambda: claims.of_jumps(inclusion.jumps(shooting, there)))
    else:
        steps.append(lambda: claims.of_field(regular_field(shooting, passed)))
    for one in steps:
        try:
            record = replace(record, hypotheses=(*record.hypotheses, one()))
        except NotProved as error:
            raise _Stopped(record, str(error)) from None
    laws = [arc.law for arc in shooting.arcs]
    theorem = claims.theorem(statement, laws, there.radius, convexity, waiting(statement))
    return replace(record, status=Outcome.PROVED, theorem=theorem, scope=claims.scope(statement))
