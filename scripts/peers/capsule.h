/* The capsule of Table 1 in the Filippov reading: its field, its guards, and what events do. */
#include <math.h>

enum { R, Y1, X2, Y2, STATES };
static const double M1 = 0.11, M2 = 0.53, K1 = 1420.0, C = 3.89, V_S = 0.3;
static const double NORMAL_LOAD = (0.11 + 0.53) * 9.81;
#define BREAK_AWAY (0.66 * NORMAL_LOAD)
#define SLIDING (0.33 * NORMAL_LOAD)

typedef struct {
    double k2, omega, p_d, delta;
} Case;

/* The stiffness of contact is 0 or k2; slip is -1, 0 or 1. */
typedef struct {
    double contact, slip;
} Mode;

static inline double force(const Case *of, Mode mode, const double *y) {
    return (K1 + mode.contact) * y[R] - mode.contact * of->delta + C * (y[Y1] - y[Y2]);
}

static inline void field(const Case *of, Mode mode, double drive, const double *y, double *rate) {
    double f = force(of, mode, y);
    rate[R] = y[Y1] - y[Y2];
    rate[Y1] = (drive - f) * (1.0 / M1);
    rate[X2] = y[Y2];
    rate[Y2] = 0.0;
    if (mode.slip != 0.0)
        rate[Y2] =
            (f - mode.slip * SLIDING * (1.0 + exp(mode.slip * y[Y2] * (-1.0 / V_S)))) * (1.0 / M2);
}

/* Guard `which`: 0 contact, 1 friction. Positive before its event; its rate is stored too. */
static inline double guard(const Case *of, Mode mode, int which, const double *y,
                           const double *rate, double *slope) {
    if (which == 0) {
        double side = mode.contact > 0.0 ? 1.0 : -1.0;
        *slope = side * rate[R];
        return side * (y[R] - of->delta);
    }
    if (mode.slip != 0.0) {
        *slope = mode.slip * rate[Y2];
        return mode.slip * y[Y2];
    }
    double f = force(of, mode, y), f_rate = (K1 + mode.contact) * rate[R] + C * rate[Y1];
    *slope = f > 0.0 ? -f_rate : f_rate;
    return BREAK_AWAY - fabs(f);
}

/* Obeys the event of a guard; the force that decides is computed once. */
static Mode switched(const Case *of, Mode mode, int which, double *y) {
    if (which == 0) {
        mode.contact = of->k2 - mode.contact;
        y[R] = of->delta;
        return mode;
    }
    if (mode.slip != 0.0) y[Y2] = 0.0;
    double f = force(of, mode, y);
    if (mode.slip == 0.0)
        mode.slip = f > 0.0 ? 1.0 : -1.0;
    else
        mode.slip = -mode.slip * f > BREAK_AWAY ? -mode.slip : 0.0;
    return mode;
}
