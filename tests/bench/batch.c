/* RK4 for many motions of the polar orbit under constant controls: a column of y for each, in place. */

void advance(double h, long steps, long count, double *restrict y, const double *restrict u, const double *restrict p)
{
    double *restrict r_at = y, *restrict v_at = y + count, *restrict a_at = y + 2 * count, *restrict w_at = y + 3 * count;
    for (long i = 0; i < steps; i++)
        for (long j = 0; j < count; j++) {
            const double r = r_at[j], v = v_at[j], w = w_at[j], u1 = u[j], u2 = u[count + j];
            const double sigma = p[j], omega = p[count + j], mu = omega * omega * sigma * sigma * sigma, half = 0.5 * h;
            const double i1 = 1.0 / r, v1 = r * w * w + u1 - i1 * i1 * mu, w1 = i1 * (u2 - 2.0 * v * w);
            const double r2 = r + half * v, s2 = v + half * v1, o2 = w + half * w1;
            const double i2 = 1.0 / r2, v2 = r2 * o2 * o2 + u1 - i2 * i2 * mu, w2 = i2 * (u2 - 2.0 * s2 * o2);
            const double r3 = r + half * s2, s3 = v + half * v2, o3 = w + half * w2;
            const double i3 = 1.0 / r3, v3 = r3 * o3 * o3 + u1 - i3 * i3 * mu, w3 = i3 * (u2 - 2.0 * s3 * o3);
            const double r4 = r + h * s3, s4 = v + h * v3, o4 = w + h * w3;
            const double i4 = 1.0 / r4, v4 = r4 * o4 * o4 + u1 - i4 * i4 * mu, w4 = i4 * (u2 - 2.0 * s4 * o4);
            const double sixth = h / 6.0;
            r_at[j] = r + sixth * (v + 2.0 * (s2 + s3) + s4);
            v_at[j] = v + sixth * (v1 + 2.0 * (v2 + v3) + v4);
            a_at[j] += sixth * (w + 2.0 * (o2 + o3) + o4);
            w_at[j] = w + sixth * (w1 + 2.0 * (w2 + w3) + w4);
        }
}
