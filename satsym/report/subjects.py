"""Subjects that shipped models and instances are listed under, on terminals and in the gallery of the documentation."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

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
"""Subject -> names of instances, in the order in which they are listed."""

MODELS = {
    "Orbits": "polar_orbit polar_orbit_timed polar_orbit_ball return_above return_in_slot two_body",
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
"""Subject -> names of models."""


def by_subject(names: Iterable[str], subjects: Mapping[str, str]) -> dict[str, list[str]]:
    """Names under their subjects; what has none comes last, under :data:`OTHER`."""
    left = list(names)
    found = {subject: [name for name in listed.split() if name in left] for subject, listed in subjects.items()}
    listed = {name for group in found.values() for name in group}
    found[OTHER] = [name for name in left if name not in listed]
    return {subject: group for subject, group in found.items() if group}
