"""Published constants, each with its source, that rows with numbers may use besides the document's own values."""

PUBLISHED = {
    "mu_earth": "398600.4418 km^3/s^2",  # IERS Conventions (2010), table 1.1, geocentric, TCG-compatible
    "R_earth": "6378.137 km",  # WGS 84 (NGA.STND.0036), equatorial radius
    "sidereal_day": "86164.0905 s",  # Explanatory Supplement to the Astronomical Almanac (2013), mean
    "mu_sun": "1.3271244e20 m^3/s^2",  # IAU 2015 Resolution B3, nominal solar mass parameter
    "au": "149597870700 m",  # IAU 2012 Resolution B2, exact
    "sidereal_year": "31558149.76 s",  # Explanatory Supplement to the Astronomical Almanac (2013), J2000.0
    "c_light": "299792458 m/s",  # SI, exact
    "g_standard": "9.80665 m/s^2",  # CGPM 1901, exact
    "G_newton": "6.67430e-11 m^3/kg/s^2",  # CODATA 2018
}

CUSTOMARY = {
    "R_earth": ("6371 km", "6378 km", "6400 km"),  # mean radius (IUGG); equatorial, cut; school books
    "sidereal_day": ("24 h",),  # the mean solar day
    "sidereal_year": ("365 day", "365.25 day"),  # the common and the Julian year
    "c_light": ("3e8 m/s",),
    "g_standard": ("9.8 m/s^2", "9.81 m/s^2", "10 m/s^2"),
    "mu_earth": ("398600 km^3/s^2", "3.986e5 km^3/s^2", "4e5 km^3/s^2"),
    "au": ("1.5e8 km", "1.496e8 km"),
    "G_newton": ("6.67e-11 m^3/kg/s^2", "6.673e-11 m^3/kg/s^2"),
}
"""Values of constants that textbooks use instead of the published ones.

A printed number that agrees with one of these values is called imprecise instead of wrong.
"""
