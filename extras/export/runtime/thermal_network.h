/* A thermal network in C99: no allocation, no library besides libm. Its numbers stand in thermal_network_data.h.

   thermal_state s;  thermal_work w;
   thermal_begin(&s, &w, 20.0, u);              every temperature 20 degC, inputs u[THERMAL_SIGNALS]
   thermal_step(&s, &w, 1.0, u);                one second; inputs run straight from those before to u
   thermal_hold(&s, &w, u);                     inputs jump to u
   thermal_outputs(&s, y);                      y[THERMAL_OUTPUTS], degC

   The work arrays hold nothing between calls: several models of one thread may share them. */
#ifndef THERMAL_NETWORK_H
#define THERMAL_NETWORK_H

#ifndef THERMAL_REAL
#define THERMAL_REAL double
#endif
typedef THERMAL_REAL thermal_real;

#include "thermal_network_sizes.h"

enum { THERMAL_OK, THERMAL_NO_STEP, THERMAL_NO_REST };

/* x: temperatures (degC) and amplitudes of shapes; u: inputs, then boundary temperatures; next: the step wanted (s). */
typedef struct {
    thermal_real x[THERMAL_STATES], u[THERMAL_SIGNALS], next, time;
} thermal_state;

typedef struct {
    thermal_real z0[THERMAL_STATES + THERMAL_BOUNDARIES + 1], z1[THERMAL_STATES + THERMAL_BOUNDARIES + 1];
    thermal_real v0[THERMAL_ROWS + 1], v1[THERMAL_ROWS + 1];
    thermal_real tau0[THERMAL_TERMS + 1][4], tau1[THERMAL_TERMS + 1][4];
    thermal_real f0[THERMAL_FACTORS + 1], fm[THERMAL_FACTORS + 1], f1[THERMAL_FACTORS + 1], df[THERMAL_FACTORS + 1];
    thermal_real u0[THERMAL_SIGNALS + 1], u1[THERMAL_SIGNALS + 1], um[THERMAL_SIGNALS + 1];
    thermal_real F0[THERMAL_STATES], F1[THERMAL_STATES], Ft[THERMAL_STATES];
    thermal_real w0[THERMAL_STATES], w1[THERMAL_STATES], w2[THERMAL_STATES], error[THERMAL_STATES];
    thermal_real G[THERMAL_STATES][THERMAL_STATES], W[THERMAL_STATES][THERMAL_STATES];
    int pivot[THERMAL_STATES];
} thermal_work;

int thermal_begin(thermal_state *s, thermal_work *w, thermal_real degC, const thermal_real *u);
int thermal_hold(thermal_state *s, thermal_work *w, const thermal_real *u);
int thermal_step(thermal_state *s, thermal_work *w, thermal_real seconds, const thermal_real *u);
/* Bring states without capacity to their balance: after x or u were set from outside. */
int thermal_rest(thermal_state *s, thermal_work *w);
void thermal_outputs(const thermal_state *s, thermal_real *y);
/* Watts into every state at the present inputs: F in C dx/dt = F. */
void thermal_flow(const thermal_state *s, thermal_work *w, thermal_real *F);

#endif
