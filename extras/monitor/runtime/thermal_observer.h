/* A square-root Kalman filter beside the network: all temperatures and the missing heat from the sensors at hand.

   thermal_observer o;  thermal_observer_work w;
   thermal_observer_begin(&o, &w, u, y);        inputs u[THERMAL_GIVEN], first readings y[THERMAL_SENSORS] (NAN: none)
   thermal_observer_step(&o, &w, 1.0, u, y);    one second later; inputs run straight from those before to u
   thermal_observer_outputs(&o, T);             T[THERMAL_OUTPUTS], degC

   Compile thermal_observer.c alone: it takes thermal_network.c in. The work arrays hold nothing between calls. */
#ifndef THERMAL_OBSERVER_H
#define THERMAL_OBSERVER_H

#include "thermal_network.h"
#include "thermal_observer_sizes.h"

/* Of the covariance and what else lives from call to call, but for temperatures. */
#ifndef THERMAL_COVARIANCE
#define THERMAL_COVARIANCE float
#endif
typedef THERMAL_COVARIANCE thermal_covariance;

#define THERMAL_REDUCED (THERMAL_SLOW + THERMAL_BODIES)
#define THERMAL_KINDS (THERMAL_SENSORS + THERMAL_BODIES)

enum { THERMAL_USED, THERMAL_LOST, THERMAL_FROZEN, THERMAL_DRIFTING };

/* A reading's history: how long none came, only good ones came, the last has stood, and any has stood before. */
typedef struct {
    thermal_covariance missing, good, same, longest, last, then[THERMAL_SENSORS + 1];
    int dropped;
} thermal_sensor;

/* q: missing heat (W), q_sd; fails: probability that it is more than the table of doubt allows; S: root of the
   covariance; error, score, information: of the tests for one drifting sensor; drift: its amplitude (K) when dropped. */
typedef struct {
    thermal_state s;
    thermal_real lagged[THERMAL_SENSORS + 1];
    thermal_covariance q[THERMAL_BODIES + 1], q_sd[THERMAL_BODIES + 1], fails[THERMAL_BODIES + 1], drift[THERMAL_SENSORS + 1];
    thermal_covariance S[THERMAL_REDUCED][THERMAL_REDUCED], error[THERMAL_REDUCED][THERMAL_KINDS];
    thermal_covariance score[THERMAL_KINDS], information[THERMAL_KINDS];
    thermal_sensor sensors[THERMAL_SENSORS + 1];
} thermal_observer;

typedef struct {
    thermal_work network;
    thermal_real G[THERMAL_STATES][THERMAL_STATES], first[THERMAL_STATES], begin[THERMAL_FACTORS + 1];
    thermal_real end[THERMAL_FACTORS + 1];
    double along[THERMAL_STATES][THERMAL_SLOW + 1], A[THERMAL_REDUCED + THERMAL_BODIES][THERMAL_REDUCED];
    double change[THERMAL_REDUCED], h[THERMAL_REDUCED], phi[THERMAL_REDUCED], gain[THERMAL_REDUCED];
    double right[THERMAL_STATES], signature[THERMAL_KINDS], chance[THERMAL_KINDS];
} thermal_observer_work;

int thermal_observer_begin(thermal_observer *o, thermal_observer_work *w, const thermal_real *u, const thermal_real *y);
int thermal_observer_step(
    thermal_observer *o, thermal_observer_work *w, thermal_real seconds, const thermal_real *u, const thermal_real *y);
void thermal_observer_outputs(const thermal_observer *o, thermal_real *T);

#endif
