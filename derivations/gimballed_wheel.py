"""A satellite in a circular orbit: a rigid body, a momentum wheel in two sprung gimbals, and flexible panels.

The x axis points forward, the y axis opposite to the orbit normal, and the z axis towards the Earth; the orbital motion
and the spin of the wheel are rotations about -y. The wheel is mounted in an inner gimbal, which turns about its own x
axis. The inner gimbal is mounted in an outer gimbal, which turns about the z axis of the body. The gimbals have no
inertia. The panels have one flexible mode about each axis of the body; a part of the moment of inertia about that axis
belongs to it. I_x, I_y and I_z are the moments of inertia of the whole satellite, whose centre of mass stays in the
orbit. Numbers that the paper lapan_pitch does not print, such as those of the gimbals and the panels, are typical
values.
"""

from typing import Any, TypeAlias

from sympy import Matrix, Symbol, cos, sin, tan
from sympy.physics.mechanics import Point, ReferenceFrame, RigidBody, cross, inertia, outer

from satsym.symbolic import CLOCK, AboutRest, Demand, ModeGroup, Multibody, Problem, Variable, moving, symbols_of

Variables: TypeAlias = "tuple[Variable, ...]"
Load: TypeAlias = "tuple[Any, Any]"
Mechanics: TypeAlias = "tuple[ReferenceFrame, list[RigidBody], list[Load]]"

ATTITUDE = (
    Variable("phi", r"\phi", "rad", "roll angle, about x, after yaw", kind="angle"),
    Variable("psi", r"\psi", "rad", "yaw angle, about z, the first of the three", kind="angle"),
    Variable("theta", r"\theta", "rad", "pitch angle, about y, the last of the three", kind="angle"),
)
RATES = (
    Variable("w_x", r"\omega_x", "rad/s", "inertial angular velocity about the body's x"),
    Variable("w_y", r"\omega_y", "rad/s", "inertial angular velocity about the body's y"),
    Variable("w_z", r"\omega_z", "rad/s", "inertial angular velocity about the body's z"),
)
PITCH = ("theta", "w_y", "eta_y", "eta_y_dot", "wheel_speed")
GIMBALS = (
    Variable("g_x", r"\gamma_x", "rad", "angle of the inner gimbal, about x"),
    Variable("g_z", r"\gamma_z", "rad", "angle of the outer gimbal, about z"),
)
GIMBAL_RATES = (
    Variable("g_x_dot", r"\dot\gamma_x", "rad/s", "angular velocity of the inner gimbal"),
    Variable("g_z_dot", r"\dot\gamma_z", "rad/s", "angular velocity of the outer gimbal"),
)
MODES = tuple(Variable(f"eta_{a}", rf"\eta_{a}", "rad", f"deflection of the mode about {a}") for a in "xyz")
MODE_RATES = tuple(Variable(f"eta_{a}_dot", rf"\dot\eta_{a}", "rad/s", f"rate of deflection about {a}") for a in "xyz")
SPEED = (Variable("wheel_speed", r"\Omega", "rad/s", "deviation of the wheel speed from its nominal value"),)
CONTROLS = (
    Variable("T_cx", "T_{cx}", "N*m", "torque of the actuator on the inner gimbal"),
    Variable("T_cz", "T_{cz}", "N*m", "torque of the actuator on the outer gimbal"),
    Variable("motor_torque", "T_m", "N*m", "torque of the motor between wheel and inner gimbal"),
)
TORQUES = (
    Variable("torque_x", "T_x", "N*m", "torque on the body in roll"),
    Variable("torque_z", "T_z", "N*m", "torque on the body in yaw"),
)
BODY = (
    Variable("I_x", "I_x", "kg*m**2", "moment of inertia of the satellite in roll", 1356.0, positive=True),
    Variable("I_y", "I_y", "kg*m**2", "moment of inertia of the satellite in pitch", 678.0, positive=True),
    Variable("I_z", "I_z", "kg*m**2", "moment of inertia of the satellite in yaw", 1356.0, positive=True),
    Variable("w0", r"\omega_0", "rad/s", "orbital angular velocity", 7.26e-5, positive=True),
)
WHEEL = (
    Variable("I_wx", "I_{wx}", "kg*m**2", "transverse moment of inertia of the wheel", 0.05, positive=True),
    Variable("I_wy", "I_{wy}", "kg*m**2", "moment of inertia of the wheel about its axis", 0.09, positive=True),
    Variable("nominal_speed", r"\Omega_n", "rad/s", "nominal speed of the wheel", 104.71976, positive=True),
    Variable("K_x", "K_x", "N*m/rad", "stiffness of the spring on the inner gimbal", 0.9, positive=True),
    Variable("K_z", "K_z", "N*m/rad", "stiffness of the spring on the outer gimbal", 0.9, positive=True),
    Variable("D_x", "D_x", "N*m*s/rad", "damping on the inner gimbal", 9.0),
    Variable("D_z", "D_z", "N*m*s/rad", "damping on the outer gimbal", 9.0),
)
PANELS = (
    Variable("J_x", "J_x", "kg*m**2", "elastic part of the moment of inertia in roll", 200.0, positive=True),
    Variable("J_y", "J_y", "kg*m**2", "elastic part of the moment of inertia in pitch", 200.0, positive=True),
    Variable("J_z", "J_z", "kg*m**2", "elastic part of the moment of inertia in yaw", 200.0, positive=True),
    Variable("freq_x", r"\nu_x", "rad/s", "frequency of the mode about x, with the body fixed", 0.6, positive=True),
    Variable("freq_y", r"\nu_y", "rad/s", "frequency of the mode about y, with the body fixed", 0.9, positive=True),
    Variable("freq_z", r"\nu_z", "rad/s", "frequency of the mode about z, with the body fixed", 0.7, positive=True),
    Variable("zeta_x", r"\zeta_x", "1", "damping ratio of the mode about x", 0.005),
    Variable("zeta_y", r"\zeta_y", "1", "damping ratio of the mode about y", 0.005),
    Variable("zeta_z", r"\zeta_z", "1", "damping ratio of the mode about z", 0.005),
)
# what small motions are called: with the orbital rate, those in which the momentum stays put in space become slow
NAMES = (
    ModeGroup("nutation", ("phi", "psi", "w_x", "w_z"), vanishing="w0", slow="orbit-rate mode"),
    ModeGroup("pitch libration", ("theta", "w_y"), neutral="pitch drift"),
    ModeGroup("gimbal mode", tuple(v.symbol for v in (*GIMBALS, *GIMBAL_RATES))),
    *(ModeGroup(f"flexible mode about {a}", (f"eta_{a}", f"eta_{a}_dot")) for a in "xyz"),
    ModeGroup("speed of the wheel", ("wheel_speed",)),
)
phi, psi, theta = symbols_of(ATTITUDE)
I_x, I_y, I_z, w0, I_wx, I_wy, nominal_speed, K_x, K_z, D_x, D_z = symbols_of((*BODY, *WHEEL))
w_x, w_y, w_z = symbols_of(RATES)

# orbital axes along the body's: yaw, then roll, then pitch
COSINES = Matrix(3, 3, [Symbol(f"a_{i}{k}", real=True) for i in "xyz" for k in "xyz"])
first, second, third = (
    Matrix([[cos(psi), sin(psi), 0], [-sin(psi), cos(psi), 0], [0, 0, 1]]),
    Matrix([[1, 0, 0], [0, cos(phi), sin(phi)], [0, -sin(phi), cos(phi)]]),
    Matrix([[cos(theta), 0, -sin(theta)], [0, 1, 0], [sin(theta), 0, cos(theta)]]),
)
NAMED = dict(zip(COSINES, (third * second * first).T, strict=True))
# angular velocity relative to the orbit, and the rates of the angles that it makes
p, q, r = (w + w0 * a for w, a in zip((w_x, w_y, w_z), COSINES.row(1), strict=True))
KINEMATICS = {
    phi: p * cos(theta) + r * sin(theta),
    psi: (r * cos(theta) - p * sin(theta)) / cos(phi),
    theta: q + tan(phi) * (p * sin(theta) - r * cos(theta)),
}


def satellite() -> tuple[Any, Any, Any, Any]:
    """Frames of inertial space, orbit and body, and the centre of mass."""
    space, orbit, body = (ReferenceFrame(name) for name in ("space", "orbit", "body"))
    orbit.orient_axis(space, space.y, -w0 * CLOCK)
    body.orient_explicit(orbit, Matrix(3, 3, moving(COSINES)))
    turn = moving(RATES)
    body.set_ang_vel(space, turn[0] * body.x + turn[1] * body.y + turn[2] * body.z)
    centre = Point("centre")
    centre.set_vel(space, 0)
    return space, orbit, body, centre


def rigid(name: str, frame: Any, centre: Any, dyadic: Any) -> RigidBody:
    """A rigid body whose centre of mass is that of the whole satellite; its mass has no effect."""
    return RigidBody(name, centre, frame, 0, (dyadic, centre))


def gravity_gradient(body: RigidBody, orbit: Any) -> Load:
    """The gravity-gradient torque 3 w0^2 n x (I n) on a body, where n is the unit vector towards the Earth."""
    return body.frame, 3 * w0**2 * cross(orbit.z, body.central_inertia.dot(orbit.z))


def between(torque: Any, frame: Any, other: Any) -> tuple[Load, Load]:
    """A torque on one frame, and the opposite torque on another."""
    return (frame, torque), (other, -torque)


def full() -> Mechanics:
    """The rigid bodies (body, wheel and modes) and the loads on them."""
    space, orbit, body, centre = satellite()
    outer_gimbal, inner_gimbal, spinning = (ReferenceFrame(name) for name in ("outer", "inner", "wheel"))
    (g_x, g_z), (g_x_dot, g_z_dot), (speed,) = moving(GIMBALS), moving(GIMBAL_RATES), moving(SPEED)
    outer_gimbal.orient_axis(body, body.z, g_z)
    outer_gimbal.set_ang_vel(body, g_z_dot * body.z)
    inner_gimbal.orient_axis(outer_gimbal, outer_gimbal.x, g_x)
    inner_gimbal.set_ang_vel(outer_gimbal, g_x_dot * outer_gimbal.x)
    spinning.set_ang_vel(inner_gimbal, -(nominal_speed + speed) * inner_gimbal.y)
    elastic = symbols_of(PANELS[:3])
    rest = (moment - part for moment, part in zip((I_x - I_wx, I_y - I_wy, I_z - I_wx), elastic, strict=True))
    bodies = [
        rigid("body", body, centre, inertia(body, *rest)),
        rigid("wheel", spinning, centre, inertia(inner_gimbal, I_wx, I_wy, I_wx)),
    ]
    T_cx, T_cz, motor_torque = symbols_of(CONTROLS)
    loads = [
        *between((T_cx - K_x * g_x - D_x * g_x_dot) * outer_gimbal.x, inner_gimbal, outer_gimbal),
        *between((T_cz - K_z * g_z - D_z * g_z_dot) * body.z, outer_gimbal, body),
        *between(-motor_torque * inner_gimbal.y, spinning, inner_gimbal),
    ]
    numbers = (symbols_of(PANELS[k : k + 3]) for k in (0, 3, 6))
    for axis, angle, rate, J, frequency, zeta in zip(body, moving(MODES), moving(MODE_RATES), *numbers, strict=True):
        panel = ReferenceFrame(f"mode_{J}")
        panel.set_ang_vel(body, rate * axis)
        bodies.append(rigid(f"mode {str(J)[-1]}", panel, centre, J * outer(axis, axis)))
        loads += between(-J * (frequency**2 * angle + 2 * zeta * frequency * rate) * axis, panel, body)
    return space, bodies, [*loads, *(gravity_gradient(each, orbit) for each in bodies)]


def locked(momentum: tuple[Any, ...]) -> Mechanics:
    """The rigid bodies and loads of a rigid satellite whose wheel has a constant momentum relative to the body."""
    space, orbit, body, centre = satellite()
    whole = rigid("body", body, centre, inertia(body, I_x, I_y, I_z))
    h = sum((c * e for c, e in zip(momentum, body, strict=True)), 0 * body.x)
    gyroscopic = body, -cross(body.ang_vel_in(space), h)
    torque_x, torque_z = symbols_of(TORQUES)
    return space, [whole], [gravity_gradient(whole, orbit), gyroscopic, (body, torque_x * body.x + torque_z * body.z)]


def triangle(what: str, moments: tuple[Any, ...]) -> tuple[Demand, ...]:
    """The demand that no moment of inertia of a body exceeds the sum of the other two."""
    total = sum(moments)
    reason = f"one moment of inertia of {what} exceeds the sum of the other two, which is impossible for a rigid body"
    return tuple(Demand(total - 2 * moment, reason) for moment in dict.fromkeys(moments))


WHOLE = triangle("the satellite", (I_x, I_y, I_z))


def demands() -> tuple[Demand, ...]:
    """The demands on the moments of inertia: of the satellite, the wheel, and the body without wheel and modes."""
    J_x, J_y, J_z = symbols_of(PANELS[:3])
    parts = ((I_x, I_wx, J_x), (I_y, I_wy, J_y), (I_z, I_wx, J_z))
    heavy = "the wheel and the elastic part together have at least as much inertia as the whole satellite"
    wheel = triangle("the wheel", (I_wx, I_wy, I_wx))
    return (*WHOLE, *wheel, *(Demand(i - w - j, heavy, strict=True) for i, w, j in parts))


def model(
    name: str,
    title: str,
    more_coordinates: Variables,
    more_speeds: Variables,
    controls: Variables,
    parameters: Variables,
    mechanics: Mechanics,
    demanded: tuple[Demand, ...],
    varied: str = "",
) -> Multibody:
    """A model of the satellite with some of its bodies and loads."""
    space, bodies, loads = mechanics
    states = (*ATTITUDE, *more_coordinates, *RATES, *more_speeds)
    rates = dict(zip(symbols_of(more_coordinates), symbols_of(more_speeds), strict=False))
    return Multibody(
        name=name,
        title=title,
        states=states,
        controls=controls,
        parameters=parameters,
        inertial=space,
        coordinates=KINEMATICS | rates,
        bodies=tuple(bodies),
        loads=tuple(loads),
        named=NAMED,
        attitude=COSINES,
        vanishing=tuple(s for s in symbols_of(states) if s.name not in PITCH),
        demands=demanded,
        varied=varied,
        modes=tuple(group for group in NAMES if {*group.states} <= {v.symbol for v in states}),
        reference=dict.fromkeys(symbols_of(states), 0) | {w_y: -w0},
    )


gimballed_wheel = model(
    "gimballed_wheel",
    "Satellite with a double-gimballed momentum wheel and a flexible mode about each axis",
    (*GIMBALS, *MODES),
    (*GIMBAL_RATES, *MODE_RATES, *SPEED),
    CONTROLS,
    (*BODY, *WHEEL, *PANELS),
    full(),
    demands(),
)

h = Variable("h", "h", "N*m*s", "angular momentum of the wheel relative to the body, along -y", 9.4247784)
gyrostat = model(
    "gyrostat",
    "Satellite in a circular orbit with constant wheel momentum along -y",
    (),
    (),
    TORQUES,
    (*BODY, h),
    locked((0, -symbols_of((h,))[0], 0)),
    WHOLE,
    varied=h.symbol,
)

ANGLE_RATES = (
    Variable("phi_dot", r"\dot\phi", "rad/s", "rate of the roll angle"),
    Variable("psi_dot", r"\dot\psi", "rad/s", "rate of the yaw angle"),
    Variable("theta_dot", r"\dot\theta", "rad/s", "rate of the pitch angle"),
)


def about_rest(
    name: str,
    title: str,
    of: Multibody,
    coordinates: Variables,
    velocities: Variables,
    more: Variables = (),
    controls: Variables = (),
) -> AboutRest:
    """The model linearised about the attitude in which the satellite points to the Earth."""
    return AboutRest(
        name=name,
        title=title,
        of=of,
        states=(*coordinates, *velocities, *more),
        controls=controls,
        parameters=of.parameters,
        velocities=dict(zip(symbols_of(coordinates), symbols_of(velocities), strict=True)),
    )


gyrostat_linear = about_rest(
    "gyrostat_linear",
    "Earth-pointing gyrostat, linearised about rest",
    gyrostat,
    ATTITUDE,
    ANGLE_RATES,
    controls=TORQUES,
)
gimballed_linear = about_rest(
    "gimballed_linear",
    "Satellite with a gimballed wheel and flexible modes, linearised about rest",
    gimballed_wheel,
    (*ATTITUDE, *GIMBALS, *MODES),
    (*ANGLE_RATES, *GIMBAL_RATES, *MODE_RATES),
    SPEED,
    CONTROLS,
)
roll_yaw = about_rest(
    "roll_yaw",
    "Roll and yaw of a satellite with a gimballed wheel and flexible modes, linearised about rest",
    gimballed_wheel,
    (*ATTITUDE[:2], *GIMBALS, *MODES[::2]),
    (*ANGLE_RATES[:2], *GIMBAL_RATES, *MODE_RATES[::2]),
    controls=CONTROLS[:2],
)

# with the gimbals locked, thrusters turn the body in roll and yaw
roll_yaw_locked = about_rest(
    "roll_yaw_locked",
    "Roll and yaw of a gyrostat, linearised about rest",
    gyrostat,
    ATTITUDE[:2],
    ANGLE_RATES[:2],
    controls=TORQUES,
)
roll_yaw_manoeuvre = Problem(
    name="roll_yaw_manoeuvre",
    title="Roll and yaw manoeuvre of a gyrostat with minimum integral of squared torques",
    model=roll_yaw_locked,
    running_cost=sum(torque**2 for torque in symbols_of(TORQUES)) / 2,
    control_set="box",
)

TRANSLATIONS = {
    "id": {
        "Satellite with a double-gimballed momentum wheel and a flexible mode about each axis": (
            "Satelit dengan roda momentum bergimbal ganda dan satu modus lentur pada setiap sumbu"
        ),
        "Satellite with a gimballed wheel and flexible modes, linearised about rest": (
            "Satelit dengan roda bergimbal dan modus lentur, linearisasi di sekitar keadaan diam"
        ),
        "Roll and yaw of a satellite with a gimballed wheel and flexible modes, linearised about rest": (
            "Guling dan geleng satelit dengan roda bergimbal dan modus lentur, linearisasi di sekitar keadaan diam"
        ),
        "Satellite in a circular orbit with constant wheel momentum along -y": (
            "Satelit pada orbit lingkaran dengan momentum roda konstan sepanjang sumbu -y"
        ),
        "Earth-pointing gyrostat, linearised about rest": (
            "Girostat yang mengarah ke Bumi, linearisasi di sekitar keadaan diam"
        ),
        "Roll and yaw of a gyrostat, linearised about rest": (
            "Guling dan geleng girostat, linearisasi di sekitar keadaan diam"
        ),
        "Roll and yaw manoeuvre of a gyrostat with minimum integral of squared torques": (
            "Manuver guling dan geleng girostat dengan integral kuadrat torsi yang minimum"
        ),
        "roll angle, about x, after yaw": "sudut guling, terhadap sumbu x, sesudah geleng",
        "yaw angle, about z, the first of the three": "sudut geleng, terhadap sumbu z, yang pertama dari ketiganya",
        "pitch angle, about y, the last of the three": "sudut angguk, terhadap sumbu y, yang terakhir dari ketiganya",
        "angle of the inner gimbal, about x": "sudut gimbal dalam, terhadap sumbu x",
        "angle of the outer gimbal, about z": "sudut gimbal luar, terhadap sumbu z",
        "deflection of the mode about x": "lendutan modus terhadap sumbu x",
        "deflection of the mode about y": "lendutan modus terhadap sumbu y",
        "deflection of the mode about z": "lendutan modus terhadap sumbu z",
        "inertial angular velocity about the body's x": "kecepatan sudut inersial pada sumbu x benda",
        "inertial angular velocity about the body's y": "kecepatan sudut inersial pada sumbu y benda",
        "inertial angular velocity about the body's z": "kecepatan sudut inersial pada sumbu z benda",
        "angular velocity of the inner gimbal": "kecepatan sudut gimbal dalam",
        "angular velocity of the outer gimbal": "kecepatan sudut gimbal luar",
        "rate of deflection about x": "laju lendutan modus terhadap sumbu x",
        "rate of deflection about y": "laju lendutan modus terhadap sumbu y",
        "rate of deflection about z": "laju lendutan modus terhadap sumbu z",
        "rate of the roll angle": "laju perubahan sudut guling",
        "rate of the yaw angle": "laju perubahan sudut geleng",
        "rate of the pitch angle": "laju perubahan sudut angguk",
        "deviation of the wheel speed from its nominal value": "simpangan kecepatan sudut roda dari nominalnya",
        "torque of the actuator on the inner gimbal": "torsi aktuator pada gimbal dalam",
        "torque of the actuator on the outer gimbal": "torsi aktuator pada gimbal luar",
        "torque of the motor between wheel and inner gimbal": "torsi motor antara roda dan gimbal dalam",
        "torque on the body in roll": "torsi guling pada benda",
        "torque on the body in yaw": "torsi geleng pada benda",
        "angular momentum of the wheel relative to the body, along -y": (
            "momentum sudut roda relatif terhadap benda, sepanjang sumbu -y"
        ),
        "moment of inertia of the satellite in roll": "momen inersia guling satelit",
        "moment of inertia of the satellite in pitch": "momen inersia angguk satelit",
        "moment of inertia of the satellite in yaw": "momen inersia geleng satelit",
        "transverse moment of inertia of the wheel": "momen inersia melintang roda",
        "moment of inertia of the wheel about its axis": "momen inersia roda terhadap sumbunya",
        "orbital angular velocity": "kecepatan sudut orbit",
        "nominal speed of the wheel": "kecepatan sudut nominal roda",
        "stiffness of the spring on the inner gimbal": "kekakuan pegas pada gimbal dalam",
        "stiffness of the spring on the outer gimbal": "kekakuan pegas pada gimbal luar",
        "damping on the inner gimbal": "redaman pada gimbal dalam",
        "damping on the outer gimbal": "redaman pada gimbal luar",
        "elastic part of the moment of inertia in roll": "bagian elastis momen inersia guling",
        "elastic part of the moment of inertia in pitch": "bagian elastis momen inersia angguk",
        "elastic part of the moment of inertia in yaw": "bagian elastis momen inersia geleng",
        "body": "benda",
        "wheel": "roda",
        "mode": "modus",
        "frequency of the mode about x, with the body fixed": (
            "frekuensi modus terhadap sumbu x, dengan benda dijepit"
        ),
        "frequency of the mode about y, with the body fixed": (
            "frekuensi modus terhadap sumbu y, dengan benda dijepit"
        ),
        "frequency of the mode about z, with the body fixed": (
            "frekuensi modus terhadap sumbu z, dengan benda dijepit"
        ),
        "damping ratio of the mode about x": "rasio redaman modus terhadap sumbu x",
        "damping ratio of the mode about y": "rasio redaman modus terhadap sumbu y",
        "damping ratio of the mode about z": "rasio redaman modus terhadap sumbu z",
    },
}

PROBLEMS = (gimballed_wheel, gyrostat, gyrostat_linear, gimballed_linear, roll_yaw, roll_yaw_manoeuvre)
