/* An instance of the model in an FMU. Values by reference: signals, then outputs, then first temperatures of the nodes
   (THERMAL_NODES), then the time. */
#ifndef THERMAL_FMU_H
#define THERMAL_FMU_H
#include <stdlib.h>
#include <string.h>
#include "thermal_network.h"
#include "thermal_network_fmu.h"

#ifdef _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

enum { OK, WARNING, DISCARD, ERROR, FATAL };
enum { FIRST_OUTPUT = THERMAL_SIGNALS, FIRST_NODE = FIRST_OUTPUT + THERMAL_OUTPUTS, TIME = FIRST_NODE + THERMAL_NODES };

typedef struct {
    thermal_state s;
    thermal_real in[THERMAL_SIGNALS + 1], slope[THERMAL_SIGNALS + 1], start[THERMAL_NODES + 1];
    double begin;
    int begun;
} fmu_values;

typedef struct {
    fmu_values now;
    thermal_work w;
} fmu_instance;

static void fmu_reset(fmu_instance *m) {
    memset(&m->now, 0, sizeof m->now);
    for (int i = 0; i < THERMAL_SIGNALS; i++) m->now.in[i] = (thermal_real)START_SIGNAL[i];
    for (int i = 0; i < THERMAL_NODES; i++) m->now.start[i] = (thermal_real)START_NODE[i];
}

static fmu_instance *fmu_new(const char *token) {
    fmu_instance *m = token && strcmp(token, FMU_TOKEN) == 0 ? calloc(1, sizeof(fmu_instance)) : NULL;
    if (m) fmu_reset(m);
    return m;
}

static int fmu_begin(fmu_instance *m) {
    int status = thermal_begin(&m->now.s, &m->w, m->now.start[0], m->now.in);
    for (int i = 0; i < THERMAL_NODES; i++) m->now.s.x[NODE_STATE[i]] = m->now.start[i];
    m->now.begun = 1;
    return status || thermal_rest(&m->now.s, &m->w) ? ERROR : OK;
}

static int fmu_get(fmu_instance *m, const unsigned *vr, size_t n, double *value) {
    thermal_real y[THERMAL_OUTPUTS + 1];
    int status = m->now.begun == 2 ? (thermal_hold(&m->now.s, &m->w, m->now.in) ? ERROR : OK) : fmu_begin(m);
    thermal_outputs(&m->now.s, y);
    for (size_t i = 0; i < n; i++) {
        unsigned at = vr[i];
        if (at > TIME) return ERROR;
        value[i] = at < FIRST_OUTPUT ? (double)m->now.in[at]
                 : at < FIRST_NODE ? (double)y[at - FIRST_OUTPUT]
                 : at < TIME ? (double)m->now.start[at - FIRST_NODE] : m->now.begin + (double)m->now.s.time;
    }
    return status;
}

static int fmu_set(fmu_instance *m, const unsigned *vr, size_t n, const double *value) {
    for (size_t i = 0; i < n; i++) {
        unsigned at = vr[i];
        if (at < FIRST_OUTPUT) m->now.in[at] = (thermal_real)value[i];
        else if (at >= FIRST_NODE && at < TIME && m->now.begun < 2) m->now.start[at - FIRST_NODE] = (thermal_real)value[i];
        else return ERROR;
    }
    return OK;
}

static int fmu_step(fmu_instance *m, double seconds) {
    if (!(seconds > 0)) return ERROR;
    if (thermal_hold(&m->now.s, &m->w, m->now.in)) return ERROR;
    for (int i = 0; i < THERMAL_SIGNALS; i++) m->now.in[i] += m->now.slope[i] * (thermal_real)seconds;
    return thermal_step(&m->now.s, &m->w, (thermal_real)seconds, m->now.in) ? ERROR : OK;
}

static int fmu_initialised(fmu_instance *m) {
    int status = fmu_begin(m);
    m->now.begun = 2;
    return status;
}

/* The values apart from their instance: a state of the standard, and its bytes. */
static int fmu_keep(const void *values, size_t size, void **state) {
    *state = size == sizeof(fmu_values) ? malloc(size) : NULL;
    if (*state) memcpy(*state, values, size);
    return *state ? OK : ERROR;
}

static int fmu_forget(void **state) {
    free(*state);
    *state = NULL;
    return OK;
}

static int fmu_write(const void *values, void *to, size_t size) {
    if (size < sizeof(fmu_values)) return ERROR;
    memcpy(to, values, sizeof(fmu_values));
    return OK;
}

#define UNSUPPORTED(name) EXPORT int name() { return ERROR; }
#endif
