"""A satellite approaches another and passes an inspection point at a free time."""

from dataclasses import replace
from pathlib import Path

from satsym.symbolic import Linearised, Problem, Variable, symbols_of
from satsym.symbolic.loader import find, load

near = next(m for m in load(find("clohessy_wiltshire", Path(__file__).parent)) if isinstance(m, Linearised))

POINT = (
    Variable("above", "a", "km", "height of the point above the orbit"),
    Variable("ahead", "b", "km", "distance of the point ahead, along the orbit"),
)
x1, x2, x3, x4 = symbols_of(near.states)
u1, u2 = symbols_of(near.controls)
above, ahead = symbols_of(POINT)

inspection = Problem(
    name="inspection",
    title="Rendezvous via an inspection point",
    model=replace(near, parameters=(*near.parameters, *POINT)),
    running_cost=(u1**2 + u2**2) / 2,
    interior={"viewpoint": (x1 - above, x3 - ahead)},
    control_set="box",
)

TRANSLATIONS = {
    "id": {
        "Rendezvous via an inspection point": "Pertemuan melalui titik inspeksi",
        "height of the point above the orbit": "ketinggian titik di atas orbit",
        "distance of the point ahead, along the orbit": "jarak titik di depan, sepanjang orbit",
    },
}

PROBLEMS = (inspection,)
