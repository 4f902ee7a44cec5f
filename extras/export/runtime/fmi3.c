/* FMI 3.0, co-simulation. Types as in the standard's fmi3PlatformTypes.h and fmi3FunctionTypes.h. */
#include <stdbool.h>
#include <stdint.h>
#include "fmu.h"

typedef void *instance;
typedef uint32_t reference;

EXPORT const char *fmi3GetVersion(void) { return "3.0"; }

EXPORT instance fmi3InstantiateCoSimulation(
    const char *name, const char *token, const char *resources, bool visible, bool logging, bool events, bool early,
    const reference *required, size_t n, void *environment, void *log, void *update) {
    (void)name, (void)resources, (void)visible, (void)logging, (void)events, (void)early, (void)required, (void)n;
    (void)environment, (void)log, (void)update;
    return fmu_new(token);
}
EXPORT instance fmi3InstantiateModelExchange(
    const char *name, const char *token, const char *resources, bool visible, bool logging, void *environment, void *log) {
    (void)name, (void)token, (void)resources, (void)visible, (void)logging, (void)environment, (void)log;
    return NULL;
}
EXPORT instance fmi3InstantiateScheduledExecution(
    const char *name, const char *token, const char *resources, bool visible, bool logging, void *environment, void *log,
    void *clock, void *lock, void *unlock) {
    (void)name, (void)token, (void)resources, (void)visible, (void)logging, (void)environment, (void)log, (void)clock;
    (void)lock, (void)unlock;
    return NULL;
}
EXPORT void fmi3FreeInstance(instance c) { free(c); }
EXPORT int fmi3SetDebugLogging(instance c, bool on, size_t n, const char *const *what) {
    (void)c, (void)on, (void)n, (void)what;
    return OK;
}
EXPORT int fmi3EnterInitializationMode(instance c, bool defined, double tolerance, double start, bool ends, double stop) {
    (void)defined, (void)tolerance, (void)ends, (void)stop;
    ((fmu_instance *)c)->now.begin = start;
    return OK;
}
EXPORT int fmi3ExitInitializationMode(instance c) { return fmu_initialised(c); }
EXPORT int fmi3Terminate(instance c) { (void)c; return OK; }
EXPORT int fmi3Reset(instance c) { fmu_reset(c); return OK; }
EXPORT int fmi3EnterStepMode(instance c) { (void)c; return OK; }
EXPORT int fmi3EnterConfigurationMode(instance c) { (void)c; return OK; }
EXPORT int fmi3ExitConfigurationMode(instance c) { (void)c; return OK; }

EXPORT int fmi3GetFloat64(instance c, const reference *vr, size_t n, double *value, size_t m) {
    return m == n ? fmu_get(c, vr, n, value) : ERROR;
}
EXPORT int fmi3SetFloat64(instance c, const reference *vr, size_t n, const double *value, size_t m) {
    return m == n ? fmu_set(c, vr, n, value) : ERROR;
}
EXPORT int fmi3DoStep(instance c, double time, double step, bool keeps, bool *event, bool *stop, bool *early, double *last) {
    int status = fmu_step(c, step);
    (void)keeps;
    *event = *stop = *early = false;
    *last = time + (status == OK ? step : 0);
    return status;
}

EXPORT int fmi3GetFMUState(instance c, void **state) {
    free(*state);
    return fmu_keep(&((fmu_instance *)c)->now, sizeof(fmu_values), state);
}
EXPORT int fmi3SetFMUState(instance c, void *state) { return fmu_write(state, &((fmu_instance *)c)->now, sizeof(fmu_values)); }
EXPORT int fmi3FreeFMUState(instance c, void **state) { (void)c; return fmu_forget(state); }
EXPORT int fmi3SerializedFMUStateSize(instance c, void *state, size_t *size) {
    (void)c, (void)state;
    *size = sizeof(fmu_values);
    return OK;
}
EXPORT int fmi3SerializeFMUState(instance c, void *state, uint8_t *to, size_t size) { (void)c; return fmu_write(state, to, size); }
EXPORT int fmi3DeserializeFMUState(instance c, const uint8_t *from, size_t size, void **state) {
    (void)c;
    return fmu_keep(from, size, state);
}
#define BOTH(type) UNSUPPORTED(fmi3Get##type) UNSUPPORTED(fmi3Set##type)
BOTH(Float32)
BOTH(Int8)
BOTH(UInt8)
BOTH(Int16)
BOTH(UInt16)
BOTH(Int32)
BOTH(UInt32)
BOTH(Int64)
BOTH(UInt64)
BOTH(Boolean)
BOTH(String)
BOTH(Binary)
BOTH(Clock)
BOTH(IntervalDecimal)
BOTH(IntervalFraction)
BOTH(ShiftDecimal)
BOTH(ShiftFraction)
UNSUPPORTED(fmi3EnterEventMode)
UNSUPPORTED(fmi3EnterContinuousTimeMode)
UNSUPPORTED(fmi3EvaluateDiscreteStates)
UNSUPPORTED(fmi3UpdateDiscreteStates)
UNSUPPORTED(fmi3CompletedIntegratorStep)
UNSUPPORTED(fmi3SetTime)
UNSUPPORTED(fmi3SetContinuousStates)
UNSUPPORTED(fmi3GetContinuousStates)
UNSUPPORTED(fmi3GetContinuousStateDerivatives)
UNSUPPORTED(fmi3GetNominalsOfContinuousStates)
UNSUPPORTED(fmi3GetEventIndicators)
UNSUPPORTED(fmi3GetNumberOfEventIndicators)
UNSUPPORTED(fmi3GetNumberOfContinuousStates)
UNSUPPORTED(fmi3GetDirectionalDerivative)
UNSUPPORTED(fmi3GetAdjointDerivative)
UNSUPPORTED(fmi3GetOutputDerivatives)
UNSUPPORTED(fmi3GetNumberOfVariableDependencies)
UNSUPPORTED(fmi3GetVariableDependencies)
UNSUPPORTED(fmi3ActivateModelPartition)
