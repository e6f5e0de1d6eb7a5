/* The polar orbit as one writes it in C by hand: RK4, running cost by Simpson's rule, Hermite midpoints, all written out.
 * The same work as `forward` of generated/polar_orbit.py, on the same arrays. */

typedef struct { double r, r_dot, theta, theta_dot; } state;

static state rates(state x, double u1, double u2, double mu)
{
    const double inv_r = 1.0 / x.r;
    const state f = { x.r_dot, x.r * x.theta_dot * x.theta_dot - mu * inv_r * inv_r + u1, x.theta_dot,
                      (u2 - 2.0 * x.r_dot * x.theta_dot) * inv_r };
    return f;
}

static state along(state x, double h, state f)
{
    const state y = { x.r + h * f.r, x.r_dot + h * f.r_dot, x.theta + h * f.theta, x.theta_dot + h * f.theta_dot };
    return y;
}

static double arrival(double y, double sixth, double k1, double k2, double k3, double k4)
{
    return y + sixth * (k1 + 2.0 * (k2 + k3) + k4);
}

static double midpoint(double y0, double y1, double h, double f0, double f1)
{
    return 0.5 * (y0 + y1) + 0.125 * h * (f0 - f1);
}

/* Rows one after another: u two of steps + 1, u_mid two of steps, x four of steps + 1, x_mid four of steps;
 * p = (sigma, omega, c1, c2, ...). Returns the integral of the running cost. */
double forward(long steps, const double *times, const double *x0, const double *u, const double *u_mid, const double *p,
               double *restrict x, double *restrict x_mid)
{
    const double mu = p[1] * p[1] * p[0] * p[0] * p[0], c1 = 0.5 * p[2], c2 = 0.5 * p[3];
    const double *u1 = u, *u2 = u1 + steps + 1, *u1_mid = u_mid, *u2_mid = u1_mid + steps;
    double *x1 = x, *x2 = x1 + steps + 1, *x3 = x2 + steps + 1, *x4 = x3 + steps + 1;
    double *m1 = x_mid, *m2 = m1 + steps, *m3 = m2 + steps, *m4 = m3 + steps;
    state y = { x0[0], x0[1], x0[2], x0[3] };
    state k1 = rates(y, u1[0], u2[0], mu);
    double total = 0.0, l1 = c1 * u1[0] * u1[0] + c2 * u2[0] * u2[0];

    x1[0] = y.r, x2[0] = y.r_dot, x3[0] = y.theta, x4[0] = y.theta_dot;
    for (long i = 0; i < steps; i++) {
        const double h = times[i + 1] - times[i], sixth = h / 6.0;
        const state k2 = rates(along(y, 0.5 * h, k1), u1_mid[i], u2_mid[i], mu);
        const state k3 = rates(along(y, 0.5 * h, k2), u1_mid[i], u2_mid[i], mu);
        const state k4 = rates(along(y, h, k3), u1[i + 1], u2[i + 1], mu);
        const state z = { arrival(y.r, sixth, k1.r, k2.r, k3.r, k4.r),
                          arrival(y.r_dot, sixth, k1.r_dot, k2.r_dot, k3.r_dot, k4.r_dot),
                          arrival(y.theta, sixth, k1.theta, k2.theta, k3.theta, k4.theta),
                          arrival(y.theta_dot, sixth, k1.theta_dot, k2.theta_dot, k3.theta_dot, k4.theta_dot) };
        const state f = rates(z, u1[i + 1], u2[i + 1], mu);
        const double l2 = c1 * u1_mid[i] * u1_mid[i] + c2 * u2_mid[i] * u2_mid[i];
        const double l3 = c1 * u1[i + 1] * u1[i + 1] + c2 * u2[i + 1] * u2[i + 1];
        x1[i + 1] = z.r, x2[i + 1] = z.r_dot, x3[i + 1] = z.theta, x4[i + 1] = z.theta_dot;
        m1[i] = midpoint(y.r, z.r, h, k1.r, f.r);
        m2[i] = midpoint(y.r_dot, z.r_dot, h, k1.r_dot, f.r_dot);
        m3[i] = midpoint(y.theta, z.theta, h, k1.theta, f.theta);
        m4[i] = midpoint(y.theta_dot, z.theta_dot, h, k1.theta_dot, f.theta_dot);
        total += sixth * (l1 + 4.0 * l2 + l3);
        y = z, k1 = f, l1 = l3;
    }
    return total;
}
