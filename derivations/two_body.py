"""A body attracted by a fixed centre, in Cartesian coordinates along inertial axes, with thrust in any direction.

All quantities are per unit mass. The centre is at rest: either the mass of the body is negligible, or the position is
relative to a second body and mu is the sum of the gravitational parameters of both.
"""

from sympy import Matrix, eye

from satsym.symbolic import Newton, Variable, symbols_of

STATES = (
    Variable("x", "x", "km", "first component of the position"),
    Variable("y", "y", "km", "second component of the position"),
    Variable("z", "z", "km", "third component of the position"),
    Variable("v_x", "v_x", "km/s", "first component of the velocity"),
    Variable("v_y", "v_y", "km/s", "second component of the velocity"),
    Variable("v_z", "v_z", "km/s", "third component of the velocity"),
)
CONTROLS = tuple(Variable(f"a_{q}", f"a_{q}", "km/s**2", f"thrust per unit mass along {q}") for q in "xyz")
MU = Variable("mu", r"\mu", "km**3/s**2", "gravitational parameter of the central body", 1.0, positive=True)

x, y, z, v_x, v_y, v_z = symbols_of(STATES)
(mu,) = symbols_of((MU,))

r = Matrix([x, y, z])
thrust = Matrix(symbols_of(CONTROLS))

two_body = Newton(
    name="two_body",
    title="Two-body motion in Cartesian coordinates",
    states=STATES,
    controls=CONTROLS,
    parameters=(MU,),
    coordinates={x: v_x, y: v_y, z: v_z},
    directions={f"e_{q}": eye(3)[:, k] for k, q in enumerate("xyz")},
    position=r,
    forces={"gravity": -mu * r / r.norm() ** 3, "thrust": thrust},
)

TRANSLATIONS = {
    "id": {
        "Two-body motion in Cartesian coordinates": "Gerak dua benda dalam koordinat Kartesius",
        "first component of the position": "komponen pertama posisi",
        "second component of the position": "komponen kedua posisi",
        "third component of the position": "komponen ketiga posisi",
        "first component of the velocity": "komponen pertama kecepatan",
        "second component of the velocity": "komponen kedua kecepatan",
        "third component of the velocity": "komponen ketiga kecepatan",
        "thrust per unit mass along x": "gaya dorong per satuan massa sepanjang sumbu x",
        "thrust per unit mass along y": "gaya dorong per satuan massa sepanjang sumbu y",
        "thrust per unit mass along z": "gaya dorong per satuan massa sepanjang sumbu z",
        "gravitational parameter of the central body": "parameter gravitasi benda pusat",
        "gravity": "gravitasi",
        "thrust": "dorong",
    },
}

PROBLEMS = (two_body,)
