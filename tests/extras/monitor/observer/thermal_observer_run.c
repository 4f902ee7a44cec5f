/* A whole record, to hold the observer in C against the one it was made from. */
#include "thermal_observer.c"

#ifdef _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

EXPORT int thermal_observer_bytes(void) { return (int)sizeof(thermal_observer); }

/* time[n], u[n][THERMAL_GIVEN], y[n][THERMAL_SENSORS] -> T[n][THERMAL_OUTPUTS], q[n][THERMAL_BODIES], dropped[n][..] */
EXPORT int thermal_observer_run(
    int n, const double *time, const double *u, const double *y, double *T, double *q, double *dropped) {
    static thermal_observer o;
    static thermal_observer_work w;
    thermal_real out[THERMAL_OUTPUTS + 1];
    int status = THERMAL_OK;
    for (int t = 0; t < n && status == THERMAL_OK; t++) {
        const double *given = u + t * THERMAL_GIVEN, *read = y + t * THERMAL_SENSORS;
        status = t ? thermal_observer_step(&o, &w, time[t] - time[t - 1], given, read)
                   : thermal_observer_begin(&o, &w, given, read);
        thermal_observer_outputs(&o, out);
        for (int i = 0; i < THERMAL_OUTPUTS; i++) T[t * THERMAL_OUTPUTS + i] = out[i];
        for (int i = 0; i < THERMAL_BODIES; i++) q[t * THERMAL_BODIES + i] = o.q[i];
        for (int j = 0; j < THERMAL_SENSORS; j++) dropped[t * THERMAL_SENSORS + j] = o.sensors[j].dropped;
    }
    return status;
}
