"""A body moves around two circular obstacles in a plane with minimum effort; the constraints are not convex.

The side on which each obstacle is passed is not prescribed; each choice leads to a different local optimum.
"""

from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES = (
    Variable("x", "x", meaning="position in the direction of the target"),
    Variable("y", "y", meaning="position across that direction"),
    Variable("vx", "v_x", meaning="velocity in the direction of the target"),
    Variable("vy", "v_y", meaning="velocity across that direction"),
)
CONTROLS = (
    Variable("ux", "u_x", meaning="acceleration in the direction of the target"),
    Variable("uy", "u_y", meaning="acceleration across that direction"),
)
PARAMETERS = (
    Variable("x_1", "x_1", meaning="centre of the first disc, in the direction of the target", default=0.3),
    Variable("y_1", "y_1", meaning="centre of the first disc, across that direction", default=-0.05),
    Variable("radius_1", "R_1", meaning="radius of the first disc", default=0.2, positive=True),
    Variable("x_2", "x_2", meaning="centre of the second disc, in the direction of the target", default=0.7),
    Variable("y_2", "y_2", meaning="centre of the second disc, across that direction", default=0.1),
    Variable("radius_2", "R_2", meaning="radius of the second disc", default=0.15, positive=True),
)
x, y, vx, vy = symbols_of(STATES)
ux, uy = symbols_of(CONTROLS)
x_1, y_1, radius_1, x_2, y_2, radius_2 = symbols_of(PARAMETERS)

obstacle = Problem(
    name="obstacle",
    title="Minimum-effort path around two circular obstacles",
    model=FirstOrder(
        name="body_in_the_plane",
        title="Body moving in a plane",
        states=STATES,
        controls=CONTROLS,
        parameters=PARAMETERS,
        rates={x: vx, y: vy, vx: ux, vy: uy},
    ),
    running_cost=(ux**2 + uy**2) / 2,
    path_constraints={
        "first": radius_1**2 - (x - x_1) ** 2 - (y - y_1) ** 2,
        "second": radius_2**2 - (x - x_2) ** 2 - (y - y_2) ** 2,
    },
)

TRANSLATIONS = {
    "id": {
        "Minimum-effort path around two circular obstacles": (
            "Lintasan upaya minimum mengelilingi dua rintangan lingkaran"
        ),
        "Body moving in a plane": "Benda yang bergerak pada bidang",
        "position in the direction of the target": "posisi ke arah titik akhir",
        "position across that direction": "posisi melintang terhadap arah itu",
        "velocity in the direction of the target": "kecepatan ke arah titik akhir",
        "velocity across that direction": "kecepatan melintang terhadap arah itu",
        "acceleration in the direction of the target": "percepatan ke arah titik akhir",
        "acceleration across that direction": "percepatan melintang terhadap arah itu",
        "centre of the first disc, in the direction of the target": "pusat cakram pertama, ke arah titik akhir",
        "centre of the first disc, across that direction": "pusat cakram pertama, melintang terhadap arah itu",
        "radius of the first disc": "jari-jari cakram pertama",
        "centre of the second disc, in the direction of the target": "pusat cakram kedua, ke arah titik akhir",
        "centre of the second disc, across that direction": "pusat cakram kedua, melintang terhadap arah itu",
        "radius of the second disc": "jari-jari cakram kedua",
    },
}

PROBLEMS = (obstacle,)
