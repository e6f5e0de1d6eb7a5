"""Hill's equations: a satellite near a circular orbit, in axes that rotate with the reference point.

The axes point outwards, ahead, and along the orbit normal. In the orbital plane the equations are those of
clohessy_wiltshire, which come from polar coordinates.
"""

from sympy import Matrix, cos, sin, sqrt

from satsym.symbolic import Definition, Linearised, Newton, Output, Variable, symbols_of, t

WAYS = ("in the radial direction", "along the track", "along the orbit normal")
ORIGINAL = tuple(Variable(q, q, "km", f"position {way}") for q, way in zip("xyz", WAYS, strict=True))
ORIGINAL += tuple(Variable(f"{q.symbol}_dot", rf"\dot {q.latex}", "km/s", f"rate of {q.symbol}") for q in ORIGINAL)
STATES = tuple(
    Variable(q, rf"\{q}", "km", f"deviation {way}") for q, way in zip(("xi", "eta", "zeta"), WAYS, strict=True)
)
STATES += tuple(Variable(f"{q.symbol}_dot", rf"\dot{q.latex}", "km/s", f"rate of {q.symbol}") for q in STATES)
CONTROLS = tuple(Variable(f"u{k}", f"u_{k}", "km/s**2", f"thrust per unit mass {way}") for k, way in enumerate(WAYS, 1))
PARAMETERS = (
    Variable("sigma", r"\sigma", "km", "radius of the reference orbit", 1.0, positive=True),
    Variable("omega", r"\omega", "rad/s", "angular velocity of the reference orbit", 1.0, positive=True),
)
MU = Variable("mu", r"\mu", "km**3/s**2", "gravitational parameter", positive=True)
DISTANCE = Variable("y1", "y_1", "km", "deviation of the distance from the centre of force")
HEIGHT = Variable("y2", "y_2", "km", "distance from the plane of the reference orbit")

x, y, z, x_dot, y_dot, z_dot = symbols_of(ORIGINAL)
sigma, omega, mu = symbols_of((*PARAMETERS, MU))

axes = Matrix([[cos(omega * t), -sin(omega * t), 0], [sin(omega * t), cos(omega * t), 0], [0, 0, 1]])
place = Matrix([x, y, z])
distance = sqrt(place.dot(place))

turning = Newton(
    name="two_body_turning",
    title="Two-body motion in rotating axes",
    states=ORIGINAL,
    controls=CONTROLS,
    parameters=PARAMETERS,
    definitions=(Definition(MU, sigma**3 * omega**2),),
    coordinates={x: x_dot, y: y_dot, z: z_dot},
    directions={f"e_{q}": axes[:, k] for k, q in enumerate("xyz")},
    position=axes * place,
    forces={"gravity": -mu / distance**3 * axes * place, "thrust": axes * Matrix(symbols_of(CONTROLS))},
)

about = {x: sigma, y: 0, z: 0, x_dot: 0, y_dot: 0, z_dot: 0}

hill = Linearised(
    name="hill",
    title="Hill's equations: three-dimensional motion near a circular orbit",
    of=turning,
    about=about,
    states=STATES,
    controls=CONTROLS,
    parameters=PARAMETERS,
    definitions=turning.definitions,
    deviations={new: old - value for new, (old, value) in zip(symbols_of(STATES), about.items(), strict=True)},
    outputs=(Output(DISTANCE, distance), Output(HEIGHT, z)),
)

TRANSLATIONS = {
    "id": {
        "Two-body motion in rotating axes": "Gerak dua benda pada sumbu yang berputar",
        "Hill's equations: three-dimensional motion near a circular orbit": (
            "Persamaan Hill: gerak tiga dimensi di dekat orbit lingkaran"
        ),
        "position in the radial direction": "posisi ke arah luar",
        "position along the track": "posisi ke arah depan",
        "position along the orbit normal": "posisi sepanjang normal bidang orbit",
        "rate of x": "laju perubahan x",
        "rate of y": "laju perubahan y",
        "rate of z": "laju perubahan z",
        "deviation in the radial direction": "simpangan ke arah luar",
        "deviation along the track": "simpangan ke arah depan",
        "deviation along the orbit normal": "simpangan sepanjang normal bidang orbit",
        "rate of xi": "laju perubahan xi",
        "rate of eta": "laju perubahan eta",
        "rate of zeta": "laju perubahan zeta",
        "thrust per unit mass in the radial direction": "gaya dorong per satuan massa ke arah luar",
        "thrust per unit mass along the track": "gaya dorong per satuan massa ke arah depan",
        "thrust per unit mass along the orbit normal": ("gaya dorong per satuan massa sepanjang normal bidang orbit"),
        "distance from the plane of the reference orbit": "jarak dari bidang orbit acuan",
        "radius of the reference orbit": "jari-jari orbit acuan",
        "angular velocity of the reference orbit": "kecepatan sudut orbit acuan",
        "gravitational parameter": "parameter gravitasi",
        "distance from the centre of force": "jarak dari pusat gaya",
        "deviation of the distance from the centre of force": "simpangan jarak dari pusat gaya",
        "gravity": "gravitasi",
        "thrust": "dorong",
    },
}

PROBLEMS = (hill,)
