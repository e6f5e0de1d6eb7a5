"""A proof as plain text."""

from __future__ import annotations

from satsym.proof.record import Enclosure, Outcome, Proof
from satsym.report.said import each, message, say
from satsym.report.terminal.table import joined, table, wrapped

_COLOURS = {Outcome.PROVED: 32, Outcome.NOT_PROVED: 31, Outcome.BEYOND: 33}


def proof_text(proof: Proof, colour: bool = False) -> str:
    """Summarise a proof."""
    status = message(proof.status.value)
    if colour:
        status = f"\x1b[{_COLOURS[proof.status]}m{status}\x1b[0m"
    heading = say("<name>, model <model>", name=proof.instance, model=proof.model)
    known = ((say("cost J"), proof.objective), (say("final time"), proof.t_final))
    facts = [(name, _shown(value)) for name, value in known if value is not None]
    facts += [(say("change of law"), _shown(t)) for t in proof.switching_times]
    costates = [(name, _shown(value)) for name, value in proof.costate_initial.items()]
    steps = [
        (f"{k}.", f"{message(h.name)}: {message(h.shown)} ({message(h.value)})")
        for k, h in enumerate(proof.hypotheses, 1)
    ]
    blocks = [
        [f"{heading}: {status}"],
        wrapped(message(proof.reason)) if proof.reason else [],
        table([("", ""), *facts])[1:] if facts else [],
        table([each("costate at t0", "enclosure"), *costates]) if costates else [],
        [f"  {say('shown:')}", *(line for number, text in steps for line in wrapped(f"{number} {text}", "     "))]
        if steps
        else [],
    ]
    if proof.theorem is not None:
        blocks += [
            [line for claim in proof.theorem.claims for line in wrapped(message(claim))],
            wrapped(say("Theorem: <name> (<source>).", name=message(proof.theorem.name), source=proof.theorem.source)),
            wrapped(message(proof.scope)),
            wrapped(", ".join(f"{name} = {number}" for name, number in proof.numbers.items())),
        ]
    return joined(blocks)


def _shown(value: Enclosure) -> str:
    return value.text
