/* A whole record, to hold the code against the simulation it was made from. */
#include <string.h>
#include "thermal_network.h"

#ifdef _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

/* time[n], u[n][THERMAL_SIGNALS], x0[THERMAL_STATES] -> y[n][THERMAL_OUTPUTS]; a time given twice is a jump. */
EXPORT int thermal_run(int n, const double *time, const double *u, const double *x0, double *y) {
    static thermal_state s;
    static thermal_work w;
    thermal_real now[THERMAL_SIGNALS + 1], out[THERMAL_OUTPUTS + 1];
    int status = THERMAL_OK;
    for (int t = 0; t < n && status == THERMAL_OK; t++) {
        for (int i = 0; i < THERMAL_SIGNALS; i++) now[i] = (thermal_real)u[t * THERMAL_SIGNALS + i];
        if (t == 0) {
            thermal_begin(&s, &w, 0, now);
            for (int i = 0; i < THERMAL_STATES; i++) s.x[i] = (thermal_real)x0[i];
            status = thermal_rest(&s, &w);
        } else if (time[t] > time[t - 1]) {
            status = thermal_step(&s, &w, (thermal_real)(time[t] - time[t - 1]), now);
        } else {
            status = thermal_hold(&s, &w, now);
        }
        thermal_outputs(&s, out);
        for (int i = 0; i < THERMAL_OUTPUTS; i++) y[t * THERMAL_OUTPUTS + i] = (double)out[i];
    }
    return status;
}
