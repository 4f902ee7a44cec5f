/* FMI 2.0, co-simulation. Types as in the standard's fmi2TypesPlatform.h and fmi2FunctionTypes.h. */
#include "fmu.h"

typedef void *component;
typedef unsigned reference;

EXPORT const char *fmi2GetTypesPlatform(void) { return "default"; }
EXPORT const char *fmi2GetVersion(void) { return "2.0"; }

EXPORT component fmi2Instantiate(const char *name, int type, const char *guid, const char *resources,
                                 const void *callbacks, int visible, int logging) {
    (void)name, (void)resources, (void)callbacks, (void)visible, (void)logging;
    return type == 1 ? fmu_new(guid) : NULL;
}
EXPORT void fmi2FreeInstance(component c) { free(c); }
EXPORT int fmi2SetDebugLogging(component c, int on, size_t n, const char *const *what) {
    (void)c, (void)on, (void)n, (void)what;
    return OK;
}
EXPORT int fmi2SetupExperiment(component c, int relative, double tolerance, double start, int ends, double stop) {
    (void)relative, (void)tolerance, (void)ends, (void)stop;
    ((fmu_instance *)c)->now.begin = start;
    return OK;
}
EXPORT int fmi2EnterInitializationMode(component c) { (void)c; return OK; }
EXPORT int fmi2ExitInitializationMode(component c) { return fmu_initialised(c); }
EXPORT int fmi2Terminate(component c) { (void)c; return OK; }
EXPORT int fmi2Reset(component c) { fmu_reset(c); return OK; }
EXPORT int fmi2GetReal(component c, const reference *vr, size_t n, double *value) { return fmu_get(c, vr, n, value); }
EXPORT int fmi2SetReal(component c, const reference *vr, size_t n, const double *value) { return fmu_set(c, vr, n, value); }

EXPORT int fmi2SetRealInputDerivatives(component c, const reference *vr, size_t n, const int *order, const double *value) {
    for (size_t i = 0; i < n; i++) {
        if (order[i] != 1 || vr[i] >= FIRST_OUTPUT) return ERROR;
        ((fmu_instance *)c)->now.slope[vr[i]] = (thermal_real)value[i];
    }
    return OK;
}
EXPORT int fmi2DoStep(component c, double time, double step, int keeps) {
    (void)time, (void)keeps;
    return fmu_step(c, step);
}

EXPORT int fmi2GetFMUstate(component c, void **state) {
    free(*state);
    return fmu_keep(&((fmu_instance *)c)->now, sizeof(fmu_values), state);
}
EXPORT int fmi2SetFMUstate(component c, void *state) { return fmu_write(state, &((fmu_instance *)c)->now, sizeof(fmu_values)); }
EXPORT int fmi2FreeFMUstate(component c, void **state) { (void)c; return fmu_forget(state); }
EXPORT int fmi2SerializedFMUstateSize(component c, void *state, size_t *size) {
    (void)c, (void)state;
    *size = sizeof(fmu_values);
    return OK;
}
EXPORT int fmi2SerializeFMUstate(component c, void *state, char *to, size_t size) { (void)c; return fmu_write(state, to, size); }
EXPORT int fmi2DeSerializeFMUstate(component c, const char *from, size_t size, void **state) {
    (void)c;
    return fmu_keep(from, size, state);
}
EXPORT int fmi2CancelStep(component c) { (void)c; return ERROR; }
EXPORT int fmi2GetRealStatus(component c, int kind, double *value) {
    *value = ((fmu_instance *)c)->now.begin + (double)((fmu_instance *)c)->now.s.time;
    return kind == 2 ? OK : DISCARD;
}
EXPORT int fmi2GetBooleanStatus(component c, int kind, int *value) {
    (void)c;
    *value = 0;
    return kind == 3 ? OK : DISCARD;
}
UNSUPPORTED(fmi2GetInteger)
UNSUPPORTED(fmi2GetBoolean)
UNSUPPORTED(fmi2GetString)
UNSUPPORTED(fmi2SetInteger)
UNSUPPORTED(fmi2SetBoolean)
UNSUPPORTED(fmi2SetString)
UNSUPPORTED(fmi2GetDirectionalDerivative)
UNSUPPORTED(fmi2GetRealOutputDerivatives)
UNSUPPORTED(fmi2GetStatus)
UNSUPPORTED(fmi2GetIntegerStatus)
UNSUPPORTED(fmi2GetStringStatus)
