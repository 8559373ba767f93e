/* The capsule by the classic Runge-Kutta method in fixed steps; Newton's method meets the events.
 *
 * It answers requests from standard input as benches/peers.rs says; for the tolerance stands the
 * step in seconds. A step on which a guard falls through zero is taken again, so long that it ends
 * there.
 */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "capsule.h"

/* The unit circle's point at the drive's phase. */
typedef struct {
    double cos, sin;
} Phase;

static inline Phase phase_at(double angle) { return (Phase){cos(angle), sin(angle)}; }

static inline Phase turned(Phase by, Phase from) {
    return (Phase){from.cos * by.cos - from.sin * by.sin, from.sin * by.cos + from.cos * by.sin};
}

/* One step of length h, given the rates at its start and the drive in its middle and at its end. */
static inline void step(const Case *of, Mode mode, double h, double middle, double last,
                        const double *y, const double *k1, double *end) {
    double k2[STATES], k3[STATES], k4[STATES], at[STATES];
    for (int i = 0; i < STATES; i++) at[i] = y[i] + 0.5 * h * k1[i];
    field(of, mode, middle, at, k2);
    for (int i = 0; i < STATES; i++) at[i] = y[i] + 0.5 * h * k2[i];
    field(of, mode, middle, at, k3);
    for (int i = 0; i < STATES; i++) at[i] = y[i] + h * k3[i];
    field(of, mode, last, at, k4);
    for (int i = 0; i < STATES; i++)
        end[i] = y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
}

/* A step of a length of its own from time t. */
static void odd_step(const Case *of, Mode mode, double t, double h, const double *y,
                     const double *k1, double *end) {
    double middle = of->p_d * cos(of->omega * (t + 0.5 * h));
    double last = of->p_d * cos(of->omega * (t + h));
    step(of, mode, h, middle, last, y, k1, end);
}

/* When a guard that falls within h is zero: Newton's method, kept between two bounds. */
static double length_to(const Case *of, Mode mode, int which, double t, double h, const double *y,
                        const double *k1, double *end) {
    double low = 0.0, high = h, slope, rate[STATES], at = 0.5 * h;
    for (int turn = 0; turn < 60; turn++) {
        odd_step(of, mode, t, at, y, k1, end);
        field(of, mode, of->p_d * cos(of->omega * (t + at)), end, rate);
        double value = guard(of, mode, which, end, rate, &slope);
        if (value > 0.0)
            low = at;
        else
            high = at;
        double next = at - value / slope;
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        if (fabs(next - at) < 1e-15) return at;
        at = next;
    }
    odd_step(of, mode, t, at, y, k1, end);
    return at;
}

/* Follows a case from rest to `end`; returns the number of events. */
static long follow(const Case *of, double end, double dt, double *y) {
    Mode mode = {0.0, 0.0};
    /* Over whole steps the phase is turned by half a step twice, much cheaper than a cosine. */
    Phase now = {1.0, 0.0}, half = phase_at(0.5 * of->omega * dt);
    /* Time is counted from the last odd step: adding up whole steps would drift from the phase. */
    double t = 0.0, since = 0.0, rate[STATES], next[STATES], slope;
    long events = 0, whole = 0;
    for (int i = 0; i < STATES; i++) y[i] = 0.0;
    while (t < end) {
        double h = fmin(dt, end - t);
        field(of, mode, of->p_d * now.cos, y, rate);
        Phase middle = turned(half, now), last = turned(half, middle);
        if (h == dt)
            step(of, mode, h, of->p_d * middle.cos, of->p_d * last.cos, y, rate, next);
        else
            odd_step(of, mode, t, h, y, rate, next);
        int which = -1;
        for (int candidate = 0; candidate < 2; candidate++) {
            if (guard(of, mode, candidate, next, rate, &slope) < 0.0) {
                h = length_to(of, mode, candidate, t, h, y, rate, next);
                which = candidate;
            }
        }
        for (int i = 0; i < STATES; i++) y[i] = next[i];
        if (h == dt) {
            t = since + (double)++whole * dt;
            now = last;
        } else {
            t = since = h < end - t ? t + h : end;
            whole = 0;
            now = phase_at(of->omega * t);
        }
        if (which >= 0) {
            mode = switched(of, mode, which, y);
            events++;
        }
    }
    return events;
}

static double processor_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Follows the cases of a request, read from standard input, and prints the answer. */
static int answer(int cycles, double dt, double seconds, int count) {
    Case *cases = malloc(sizeof(Case) * (size_t)count);
    double (*ends)[STATES] = malloc(sizeof(double[STATES]) * (size_t)count);
    long *events = malloc(sizeof(long) * (size_t)count), passes = 0;
    for (int i = 0; i < count; i++)
        if (scanf("%lf %lf %lf %lf", &cases[i].k2, &cases[i].omega, &cases[i].p_d,
                  &cases[i].delta) != 4)
            return 1;
    double start = processor_seconds(), spent = 0.0;
    for (; passes == 0 || spent < seconds; passes++, spent = processor_seconds() - start)
        for (int i = 0; i < count; i++)
            events[i] = follow(&cases[i], cycles * (2.0 * 3.14159265358979323846) / cases[i].omega,
                               dt, ends[i]);
    printf("{\"seconds\": %.9f, \"passes\": %ld, \"ends\": [", spent, passes);
    for (int i = 0; i < count; i++)
        printf("%s[%.17g, %.17g, %.17g, %.17g, %ld]", i ? ", " : "", ends[i][R], ends[i][Y1],
               ends[i][X2], ends[i][Y2], events[i]);
    printf("]}\n");
    fflush(stdout);
    free(cases), free(ends), free(events);
    return 0;
}

int main(void) {
    int cycles, count, failed = 0;
    double dt, seconds;
    while (!failed && scanf("%d %lf %lf %d", &cycles, &dt, &seconds, &count) == 4)
        failed = answer(cycles, dt, seconds, count);
    return failed;
}
