"""Satellites return to their orbit under path constraints: a minimum radius, an angular slot, and an approach cone.

The motion is that of polar_orbit or, linearised, that of clohessy_wiltshire.
"""

from dataclasses import replace
from pathlib import Path

from satsym.symbolic import Linearised, Problem, Variable, symbols_of, t
from satsym.symbolic.loader import find, load

HERE = Path(__file__).parent
given = next(p for p in load(find("polar_orbit", HERE)) if isinstance(p, Problem))
orbit = replace(given.model, parameters=tuple(v for v in given.model.parameters if not v.symbol.startswith("k")))
near = next(m for m in load(find("clohessy_wiltshire", HERE)) if isinstance(m, Linearised))

FLOOR = Variable("r_min", r"r_{\min}", "km", "minimum distance from the centre of force", positive=True)
SLOT = Variable("slot", r"\Delta", "rad", "angular half-width of the slot", positive=True)
CONE = (
    Variable("slope", "k", "1", "slope of the approach cone", 0.5, positive=True),
    Variable("mouth", "d", "km", "half-width of the cone at the target", 0.001, positive=True),
)
r, r_dot, theta, theta_dot = symbols_of(orbit.states)
x1, x2, x3, x4 = symbols_of(near.states)
u1, u2 = symbols_of(orbit.controls)
(r_min,), (slot,), (slope, mouth) = symbols_of((FLOOR,)), symbols_of((SLOT,)), symbols_of(CONE)
omega = next(s for s in symbols_of(orbit.parameters) if s.name == "omega")

return_above = Problem(
    name="return_above",
    title="Return to the orbit with a minimum radius",
    model=replace(orbit, parameters=(*orbit.parameters, FLOOR)),
    running_cost=given.running_cost,
    path_constraints={"floor": r_min - r},
)

return_in_slot = Problem(
    name="return_in_slot",
    title="Return to the orbit within an angular slot about the reference",
    model=replace(orbit, parameters=(*orbit.parameters, SLOT)),
    running_cost=given.running_cost,
    path_constraints={"ahead": theta - omega * t - slot, "behind": omega * t - theta - slot},
)

approach_cone = Problem(
    name="approach_cone",
    title="Rendezvous from behind inside an approach cone",
    model=replace(near, parameters=(*near.parameters, *CONE)),
    running_cost=(u1**2 + u2**2) / 2,
    path_constraints={"above": x1 + slope * x3 - mouth, "below": -x1 + slope * x3 - mouth},
)

TRANSLATIONS = {
    "id": {
        "Return to the orbit with a minimum radius": "Kembali ke orbit dengan batas bawah jari-jari",
        "Return to the orbit within an angular slot about the reference": (
            "Kembali ke orbit dalam selang sudut di sekitar acuan"
        ),
        "Rendezvous from behind inside an approach cone": "Pertemuan dari belakang dalam kerucut pendekatan",
        "minimum distance from the centre of force": "jarak minimum dari pusat gaya",
        "angular half-width of the slot": "setengah lebar selang, sebagai sudut",
        "slope of the approach cone": "kemiringan kerucut pendekatan",
        "half-width of the cone at the target": "setengah lebar kerucut di ujungnya",
    },
}

PROBLEMS = (return_above, return_in_slot, approach_cone)
