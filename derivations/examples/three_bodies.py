"""The circular restricted three-body problem: a spacecraft near two bodies on circular orbits about each other.

The axes rotate with the two bodies about their centre of mass: the first body is at x = -mu R, the second at x = (1 -
mu) R. The potential V includes that of the centrifugal force; its sign is such that its gradient is a force.
"""

from sympy import Matrix, cos, sin, sqrt

from satsym.symbolic import Definition, Newton, Output, Variable, symbols_of, t

AXES = ("along the line of the two bodies", "in their plane, across that line", "along the normal of their plane")
STATES = tuple(Variable(q, q, "km", f"position {way}") for q, way in zip("xyz", AXES, strict=True))
STATES += tuple(Variable(f"{q.symbol}_dot", rf"\dot {q.latex}", "km/s", f"rate of {q.symbol}") for q in STATES)
PARAMETERS = (
    Variable("n", "n", "rad/s", "angular velocity of the two bodies", 1.0, positive=True),
    Variable("R", "R", "km", "distance between the two bodies", 1.0, positive=True),
    Variable("mu", r"\mu", "1", "mass of the second body as a fraction of the total mass", 0.01215, positive=True),
)
AHEAD = Variable("x1", "x_1", "km", "position of the first body on the line of the two bodies")
BEYOND = Variable("x2", "x_2", "km", "position of the second body on the line of the two bodies", positive=True)
MU_1 = Variable("mu1", r"\mu_1", "km**3/s**2", "gravitational parameter of the first body", positive=True)
MU_2 = Variable("mu2", r"\mu_2", "km**3/s**2", "gravitational parameter of the second body", positive=True)
R1 = Variable("r1", "r_1", "km", "distance from the first body", positive=True)
R2 = Variable("r2", "r_2", "km", "distance from the second body", positive=True)
U = Variable("U", "U", "km**2/s**2", "gravitational potential of both bodies")
V = Variable("V", "V", "km**2/s**2", "potential including the centrifugal part")

x, y, z, x_dot, y_dot, z_dot = symbols_of(STATES)
n, R, mu = symbols_of(PARAMETERS)
x1, x2, mu1, mu2 = symbols_of((AHEAD, BEYOND, MU_1, MU_2))

axes = Matrix([[cos(n * t), -sin(n * t), 0], [sin(n * t), cos(n * t), 0], [0, 0, 1]])
place = Matrix([x, y, z])
from_first, from_second = place - Matrix([x1, 0, 0]), place - Matrix([x2, 0, 0])
r1, r2 = sqrt(from_first.dot(from_first)), sqrt(from_second.dot(from_second))
u = mu1 / r1 + mu2 / r2

three_bodies = Newton(
    name="three_bodies",
    title="Circular restricted three-body problem",
    states=STATES,
    controls=(),
    parameters=PARAMETERS,
    definitions=(
        Definition(AHEAD, -mu * R),
        Definition(BEYOND, (1 - mu) * R),
        Definition(MU_1, (1 - mu) * n**2 * R**3),
        Definition(MU_2, mu * n**2 * R**3),
    ),
    coordinates={x: x_dot, y: y_dot, z: z_dot},
    directions={f"e_{q}": axes[:, k] for k, q in enumerate("xyz")},
    position=axes * place,
    forces={
        "first body": -mu1 / r1**3 * axes * from_first,
        "second body": -mu2 / r2**3 * axes * from_second,
    },
    outputs=(Output(R1, r1), Output(R2, r2), Output(U, u), Output(V, u + n**2 * (x**2 + y**2) / 2)),
)

PROBLEMS = (three_bodies,)

TRANSLATIONS = {
    "id": {
        "Circular restricted three-body problem": "Masalah tiga benda terbatas melingkar",
        "position along the line of the two bodies": "posisi sepanjang garis kedua benda",
        "position in their plane, across that line": "posisi pada bidang kedua benda, tegak lurus garis itu",
        "position along the normal of their plane": "posisi sepanjang normal bidang kedua benda",
        "gravitational parameter of the first body": "parameter gravitasi benda pertama",
        "gravitational parameter of the second body": "parameter gravitasi benda kedua",
        "mass of the second body as a fraction of the total mass": "massa benda kedua dibagi massa keduanya",
        "distance between the two bodies": "jarak kedua benda",
        "angular velocity of the two bodies": "kecepatan sudut kedua benda",
        "position of the first body on the line of the two bodies": "posisi benda pertama pada garis keduanya",
        "position of the second body on the line of the two bodies": "posisi benda kedua pada garis keduanya",
        "distance from the first body": "jarak dari benda pertama",
        "distance from the second body": "jarak dari benda kedua",
        "gravitational potential of both bodies": "potensial tarikan kedua benda",
        "potential including the centrifugal part": "potensial dengan putaran sumbu",
        "first body": "benda pertama",
        "second body": "benda kedua",
    }
}
