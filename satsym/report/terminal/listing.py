"""Lists of models and instances, and one model in full, as plain text."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from satsym.report.results.objects import bounded
from satsym.report.said import each, say
from satsym.report.terminal.table import GAP, SENTENCE, WIDEST, figure, fitting, room, table, wrapped
from satsym.spec import ProblemSpec, Variable

if TYPE_CHECKING:
    from satsym.instance import Instance


COLUMNS = 80
"""Width of a list, in characters, if output is not a terminal."""
MOST_NAMES = 4
"""Largest number of a model's names in its line; `satsym models MODEL` lists all of them."""


def models_text(specs: Sequence[ProblemSpec], whole: bool = False) -> str:
    """List models by subject, a line for each; if whole, in one table with states and controls."""
    if not whole:
        return _by_subject({spec.name: say(spec.title) for spec in specs}, MODELS)
    header = each("model", "states", "controls", "title")
    rows = [(s.name, _few(s.state_names), _few(s.control_names), say(s.title)) for s in specs]
    return "\n".join(table([header, *rows], indent=""))


def _by_subject(titles: Mapping[str, str], subjects: Mapping[str, str]) -> str:
    """List names with titles under each subject, as wide as the terminal, or else :data:`COLUMNS`."""
    name_width, blocks = max(map(len, titles), default=0), []
    left = max(SENTENCE, min(WIDEST, room() or COLUMNS) - name_width - 2 * len(GAP))
    for subject, names in by_subject(titles, subjects).items():
        lines = [say(subject)]
        for name in names:
            first, *others = textwrap.wrap(titles[name], left) or [""]
            lines += [f"{GAP}{name.ljust(name_width)}{GAP}{first}".rstrip()]
            lines += [" " * (name_width + 2 * len(GAP)) + part for part in others]
        blocks.append("\n".join(lines))
    return "\n\n".join(blocks)


def _few(names: Sequence[str]) -> str:
    if len(names) <= MOST_NAMES:
        return ", ".join(names)
    return say("<names> ... <number> in all", names=", ".join(names[: MOST_NAMES - 1]), number=len(names))


def instances_text(instances: Sequence[Instance], whole: bool = False) -> str:
    """List instances by subject, a line for each; if whole, in one table with what each optimises."""
    if not whole:
        return _by_subject({one.name: say(one.title) for one in instances}, INSTANCES)
    header = each("instance", "model", "type", "final time", "bounded", "title")
    rows = [
        (
            one.name,
            one.model.spec.name,
            str(one.boundary_type),
            say("free") if one.tf is None else figure(one.tf),
            say("yes" if bounded(one) else "no"),
            say(one.title),
        )
        for one in instances
    ]
    return "\n".join(table([header, *rows], right=(2, 3), indent=""))


def model_text(spec: ProblemSpec) -> str:
    """Describe everything in a model that an instance can name."""
    blocks = [
        [
            say(spec.title),
            say("<name>, from <file>: <set>", name=spec.name, file=spec.source, set=_control_set(spec)),
        ],
        _variables(say("state"), spec.states),
        _variables(say("control"), spec.controls),
        _variables(say("parameter"), spec.parameters),
    ]
    if spec.has_reference:
        blocks.append(
            wrapped(say('The model has a reference: in [final], any state can be given the value "reference".'))
        )
    return "\n\n".join("\n".join(part for line in block for part in fitting(line)) for block in blocks if block)


def _control_set(spec: ProblemSpec) -> str:
    """Describe the limits of the controls in words."""
    kinds = dict(
        zip(
            ("free", "box", "ball", "annulus", "angle"),
            each(
                "any control", "each control between its bounds", "bounded norm", "norm between its bounds", "any angle"
            ),
            strict=True,
        )
    )
    if spec.control_parts:
        return "; ".join(f"{part.name} ({', '.join(part.controls)}): {kinds[part.kind]}" for part in spec.control_parts)
    return kinds[spec.control_set] if spec.control_set else say("no cost")


def _variables(word: str, variables: Iterable[Variable]) -> list[str]:
    rows = [
        (v.symbol, "" if v.default is None else figure(v.default), "" if v.unit == "1" else v.unit, say(v.meaning))
        for v in variables
    ]
    return table([(word, *each("default", "unit", "meaning")), *rows], right=(1,)) if rows else []


OTHER = "Other"

INSTANCES = {
    "Orbits": (
        "return-to-orbit return-to-orbit-006 return-to-orbit-005 return-to-orbit-ball soft-return return-above "
        "return-in-slot return-to-geo return-to-geo-wide return-to-geo-window soft-return-geo geo-lqr molniya "
        "ends-1-given ends-2-given-state ends-3-given-time ends-4-rendezvous ends-5-free"
    ),
    "Rendezvous": "inspection approach-cone",
    "Low-thrust transfers": "transfer-fuel transfer-time",
    "Attitude": "reorientation gravity-gradient gyrostat-equilibria",
    "Ascent and entry": "goddard goddard-pressure shuttle shuttle-heating",
    "Benchmarks": (
        "double-integrator-energy double-integrator-time double-integrator-fuel brachistochrone zermelo "
        "linear-tangent bryson-denham breakwell beam obstacle cart-pole hypersensitive hypersensitive-10000 fuller "
        "van-der-pol-boxed rayleigh rayleigh-mixed catalyst chain"
    ),
    "Documents": (
        "its-thesis its-thesis-10-50 its-thesis-50-10 its-thesis-50-50 its-thesis-return its-thesis-return-two-sided "
        "uny-lqr uny-lqr-both lapan-classical lapan-minimum-time lapan-minimum-time-100s lapan-minimum-energy "
        "lapan-coupling lapan-roll-yaw lapan-roll-yaw-lqr itb-earth itb-earth-kicked itb-earth-escape"
    ),
}
"""Subject -> names of its instances, in the order of the list."""

MODELS = {
    "Orbits": (
        "polar_orbit polar_orbit_timed polar_orbit_ball return_above return_in_slot two_body three_bodies "
        "velocity_frame"
    ),
    "Rendezvous": "clohessy_wiltshire hill inspection approach_cone",
    "Low-thrust transfers": "transfer_fuel transfer_time",
    "Attitude": (
        "pitch_wheel pitch_classical pitch_minimum_time pitch_minimum_energy pitch_scaled pitch_scaled_time "
        "pitch_scaled_energy reorientation gyrostat gyrostat_linear roll_yaw roll_yaw_manoeuvre gimballed_wheel "
        "gimballed_linear"
    ),
    "Ascent and entry": "goddard goddard_pressure shuttle shuttle_heating",
    "Benchmarks": (
        "double_integrator_energy double_integrator_time double_integrator_fuel brachistochrone zermelo "
        "linear_tangent bryson_denham beam obstacle cart_pole hypersensitive fuller van_der_pol_boxed rayleigh "
        "rayleigh_mixed catalyst chain"
    ),
    "Small systems": "saddle stable_node three_modes explicit_time time_varying singular_regulator van_der_pol",
}
"""Subject -> names of its models."""


def by_subject(names: Iterable[str], subjects: Mapping[str, str]) -> dict[str, list[str]]:
    """Group names by subject; those without a subject come last, under :data:`OTHER`."""
    left = list(names)
    found = {subject: [name for name in listed.split() if name in left] for subject, listed in subjects.items()}
    listed = {name for group in found.values() for name in group}
    found[OTHER] = [name for name in left if name not in listed]
    return {subject: group for subject, group in found.items() if group}
