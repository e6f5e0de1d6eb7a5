"""A body on a line whose position is bounded (Bryson, Denham and Dreyfus 1963; Bryson and Ho, 3.11).

It moves from (0, 1) to (0, -1) in unit time with minimum effort and x <= l. In closed form, the minimum is J = 2 for l
>= 1/4, where the bound is not reached; 2 + 6 (1 - 4 l)^2 for 1/6 <= l <= 1/4, where it is touched; and 4/(9 l) for
smaller l, where the body stays at the bound for some time. The second problem is a clamped beam whose deflection is
bounded.
"""

from dataclasses import replace

from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES = (
    Variable("x", "x", meaning="position"),
    Variable("v", "v", meaning="velocity"),
)
CONTROLS = (Variable("u", "u", meaning="acceleration"),)
PARAMETERS = (Variable("l", r"\ell", meaning="position of the wall", default=1 / 9, positive=True),)
x, v = symbols_of(STATES)
(u,) = symbols_of(CONTROLS)
(l,) = symbols_of(PARAMETERS)  # noqa: E741 - as the authors call it

bryson_denham = Problem(
    name="bryson_denham",
    title="Bryson-Denham problem: minimum effort with a position limit",
    model=FirstOrder(
        name="body_before_a_wall",
        title="Body moving on a line",
        states=STATES,
        controls=CONTROLS,
        parameters=PARAMETERS,
        rates={x: v, v: u},
    ),
    running_cost=u**2 / 2,
    path_constraints={"wall": x - l},
)

beam = replace(
    bryson_denham,
    name="beam",
    title="Clamped beam with bounded deflection",
    model=FirstOrder(
        name="beam_under_a_ceiling",
        title="Slender beam",
        states=(
            Variable("x", "x", meaning="deflection at the distance t along the beam"),
            Variable("v", "v", meaning="slope of the beam"),
        ),
        controls=(Variable("u", "u", meaning="curvature of the beam"),),
        parameters=(replace(PARAMETERS[0], meaning="height of the ceiling"),),
        rates={x: v, v: u},
    ),
    running_cost=u**2,
)

TRANSLATIONS = {
    "id": {
        "Bryson-Denham problem: minimum effort with a position limit": (
            "Masalah Bryson-Denham: upaya minimum dengan batas posisi"
        ),
        "Clamped beam with bounded deflection": "Balok terjepit dengan lendutan terbatas",
        "Body moving on a line": "Benda yang bergerak pada garis lurus",
        "position": "posisi",
        "velocity": "kecepatan",
        "acceleration": "percepatan",
        "position of the wall": "posisi dinding",
        "Slender beam": "Balok langsing",
        "deflection at the distance t along the beam": "lendutan pada jarak t sepanjang balok",
        "slope of the beam": "kemiringan balok",
        "curvature of the beam": "kelengkungan balok",
        "height of the ceiling": "tinggi langit-langit",
    },
}

PROBLEMS = (bryson_denham, beam)
