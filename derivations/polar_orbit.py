"""A satellite in the plane of its orbit, in polar coordinates, thrusting radially and transversally.

All quantities are per unit mass. The reference is a circle of radius sigma with angular velocity omega. It is an orbit
only if mu = sigma^3 omega^2; this relation therefore defines mu.
"""

from dataclasses import replace

from sympy import Matrix, cos, sin

from satsym.symbolic import Definition, Newton, Problem, Variable, symbols_of, t

STATES = (
    Variable("r", "r", "km", "distance from the centre of force", positive=True),
    Variable("r_dot", r"\dot r", "km/s", "radial velocity"),
    Variable("theta", r"\theta", "rad", "polar angle in the inertial plane", kind="angle"),
    Variable("theta_dot", r"\dot\theta", "rad/s", "angular velocity"),
)
CONTROLS = (
    Variable("u1", "u_1", "km/s**2", "radial thrust per unit mass"),
    Variable("u2", "u_2", "km/s**2", "transverse thrust per unit mass"),
)
PARAMETERS = (
    Variable("sigma", r"\sigma", "km", "radius of the reference orbit", 1.0, positive=True),
    Variable("omega", r"\omega", "rad/s", "angular velocity of the reference orbit", 1.0, positive=True),
    Variable("c1", "c_1", "1", "weight of the radial thrust", 1.0, positive=True),
    Variable("c2", "c_2", "1", "weight of the transverse thrust", 1.0, positive=True),
    Variable("k1", "k_1", "1/s**3", "terminal weight of the distance", 0.0),
    Variable("k2", "k_2", "1/s", "terminal weight of the radial velocity", 0.0),
    Variable("k3", "k_3", "km**2/s**3", "terminal weight of the angle", 0.0),
    Variable("k4", "k_4", "km**2/s", "terminal weight of the angular velocity", 0.0),
)
ONE_WEIGHT = {"c1": replace(PARAMETERS[2], meaning="weight of the thrust")}
TIME_WEIGHT = Variable("c0", "c_0", "km**2/s**4", "weight of time", 0.0)
r, r_dot, theta, theta_dot = symbols_of(STATES)
u1, u2 = symbols_of(CONTROLS)
sigma, omega, c1, c2, k1, k2, k3, k4, c0 = symbols_of((*PARAMETERS, TIME_WEIGHT))

MU = Variable("mu", r"\mu", "km**3/s**2", "gravitational parameter", positive=True)
(mu,) = symbols_of((MU,))

e_r = Matrix([cos(theta), sin(theta)])
e_theta = Matrix([-sin(theta), cos(theta)])

orbit = Newton(
    name="polar_motion",
    title="Satellite motion in polar coordinates",
    states=STATES,
    controls=CONTROLS,
    parameters=PARAMETERS,
    definitions=(Definition(MU, sigma**3 * omega**2),),
    coordinates={r: r_dot, theta: theta_dot},
    directions={"e_r": e_r, "e_theta": e_theta},
    position=r * e_r,
    forces={"gravity": -mu / r**2 * e_r, "radial thrust": u1 * e_r, "transverse thrust": u2 * e_theta},
    reference={r: sigma, r_dot: 0, theta: omega * t, theta_dot: omega},
)

EFFORT = (c1 * u1**2 + c2 * u2**2) / 2
MISS = (k1 * (r - sigma) ** 2 + k2 * r_dot**2 + k3 * (theta - omega * t) ** 2 + k4 * (theta_dot - omega) ** 2) / 2

polar_orbit = Problem(
    name="polar_orbit",
    title="Minimum-effort satellite transfer in polar coordinates",
    model=orbit,
    running_cost=EFFORT,
    terminal_cost=MISS,
    control_set="box",
)

polar_orbit_timed = Problem(
    name="polar_orbit_timed",
    title="Satellite transfer in polar coordinates, trading time against effort",
    # Where the final time is free, effort alone has no minimum: longer is always cheaper.
    model=replace(orbit, parameters=(*PARAMETERS, TIME_WEIGHT)),
    running_cost=c0 + EFFORT,
    terminal_cost=MISS,
    control_set="box",
)

polar_orbit_ball = Problem(
    name="polar_orbit_ball",
    title="Minimum-effort satellite transfer with one steerable engine, in polar coordinates",
    # One engine pointed anywhere in the plane: its thrust is limited in norm and has one weight.
    model=replace(orbit, parameters=tuple(ONE_WEIGHT.get(v.symbol, v) for v in PARAMETERS if v.symbol != "c2")),
    running_cost=c1 * (u1**2 + u2**2) / 2,
    terminal_cost=MISS,
    control_set="ball",
)

TRANSLATIONS = {
    "id": {
        "Satellite motion in polar coordinates": "Gerak satelit dalam koordinat polar",
        "Minimum-effort satellite transfer in polar coordinates": (
            "Transfer satelit dengan upaya minimum dalam koordinat polar"
        ),
        "Satellite transfer in polar coordinates, trading time against effort": (
            "Transfer satelit dalam koordinat polar dengan bobot waktu dan upaya"
        ),
        "Minimum-effort satellite transfer with one steerable engine, in polar coordinates": (
            "Transfer satelit dengan upaya minimum dan satu mesin yang dapat diarahkan, dalam koordinat polar"
        ),
        "distance from the centre of force": "jarak dari pusat gaya",
        "radial velocity": "kecepatan radial",
        "polar angle in the inertial plane": "sudut polar pada bidang inersial",
        "angular velocity": "kecepatan sudut",
        "radial thrust per unit mass": "gaya dorong radial per satuan massa",
        "transverse thrust per unit mass": "gaya dorong transversal per satuan massa",
        "radius of the reference orbit": "jari-jari orbit acuan",
        "angular velocity of the reference orbit": "kecepatan sudut orbit acuan",
        "weight of the radial thrust": "bobot gaya dorong radial",
        "weight of the transverse thrust": "bobot gaya dorong transversal",
        "weight of the thrust": "bobot gaya dorong",
        "terminal weight of the distance": "bobot akhir jarak",
        "terminal weight of the radial velocity": "bobot akhir kecepatan radial",
        "terminal weight of the angle": "bobot akhir sudut",
        "terminal weight of the angular velocity": "bobot akhir kecepatan sudut",
        "weight of time": "bobot waktu",
        "gravitational parameter": "parameter gravitasi",
        "gravity": "gravitasi",
        "radial thrust": "dorong radial",
        "transverse thrust": "dorong transversal",
    },
}

PROBLEMS = (polar_orbit, polar_orbit_timed, polar_orbit_ball)
