/* See thermal_observer.h. The mean goes by a Rosenbrock method of order two, L-stable (Hairer and Wanner 1996, IV.7), its
   linearisation by implicit Euler on the slow states; time update by Householder reflections, measurement update by Potter's method, one reading at a time. */
#include "thermal_network.c"
#include "thermal_observer.h"
#include "thermal_observer_data.h"

enum { NS = THERMAL_SLOW, NQ = THERMAL_BODIES, NR = THERMAL_REDUCED, NY = THERMAL_SENSORS, NK = THERMAL_KINDS };

static double largest(double a, double b) { return a > b ? a : b; }

/* The network's inputs: those given, and the missing heat. */
static void all_signals(const thermal_observer *o, const thermal_real *u, thermal_real *all) {
    for (int i = 0; i < THERMAL_GIVEN; i++) all[GIVEN_SIGNAL[i]] = u[i];
    for (int i = 0; i < NQ; i++) all[HEAT_SIGNAL[i]] = o->q[i];
}

/* All states that follow the slow ones at once, a column per slow state; w->network.G as of the last step. */
static int balance(thermal_observer_work *w) {
    thermal_work *v = &w->network;
    int fast = N > NS, slow[N];
    for (int i = 0; i < N; i++) slow[i] = 0;
    for (int j = 0; j < NS; j++) slow[SLOW[j]] = 1;
    for (int i = 0; i < N; i++) for (int j = 0; j < N; j++) v->W[i][j] = slow[i] ? i == j : v->G[i][j];
    if (fast && !lu(v->W, v->pivot)) return 0;
    for (int j = 0; j < NS; j++) {
        for (int i = 0; i < N; i++) v->w0[i] = i == SLOW[j];
        if (fast) solve(v->W, v->pivot, v->w0);
        for (int i = 0; i < N; i++) w->along[i][j] = v->w0[i];
    }
    return 1;
}

/* A column of deviations over h seconds, driven by heat; the matrix is factored. */
static void propagated(thermal_observer_work *w, double h, const double *column, const double *heat) {
    thermal_work *v = &w->network;
    for (int i = 0; i < N; i++) v->w0[i] = 0;
    for (int i = 0; i < NQ; i++) v->w0[BODY_STATE[i]] += (thermal_real)(h * heat[i]);
    for (int j = 0; j < NS; j++) v->w0[SLOW[j]] += (thermal_real)(C[SLOW[j]] * column[j]);
    solve(v->W, v->pivot, v->w0);
    for (int j = 0; j < NS; j++) w->right[j] = v->w0[SLOW[j]];
}

/* R' of A = Q R into S: Householder reflections of (NR + NQ) x NR. */
static void triangular(thermal_observer *o, thermal_observer_work *w) {
    const int rows = NR + NQ;
    for (int k = 0; k < NR; k++) {
        double norm = 0, dot;
        for (int i = k; i < rows; i++) norm += w->A[i][k] * w->A[i][k];
        norm = sqrt(norm);
        if (norm == 0) continue;
        if (w->A[k][k] > 0) norm = -norm;
        double first = w->A[k][k] - norm, square = first * first;
        for (int i = k + 1; i < rows; i++) square += w->A[i][k] * w->A[i][k];
        for (int j = k + 1; j < NR; j++) {
            dot = first * w->A[k][j];
            for (int i = k + 1; i < rows; i++) dot += w->A[i][k] * w->A[i][j];
            dot *= 2 / square;
            w->A[k][j] -= dot * first;
            for (int i = k + 1; i < rows; i++) w->A[i][j] -= dot * w->A[i][k];
        }
        w->A[k][k] = norm;
        for (int i = k + 1; i < rows; i++) w->A[i][k] = 0;
    }
    for (int i = 0; i < NR; i++) for (int j = 0; j < NR; j++) o->S[i][j] = (thermal_covariance)(j <= i ? w->A[j][i] : 0);
}

/* Covariance and hypotheses over h seconds; w->network.G is -dF/dx at its start. */
static int covariance(thermal_observer *o, thermal_observer_work *w, double h) {
    thermal_work *v = &w->network;
    double keeps = exp(-h / NOISE_S), column[THERMAL_SLOW + 1], heat[THERMAL_BODIES + 1];
    for (int i = 0; i < N; i++) for (int j = 0; j < N; j++) v->W[i][j] = (thermal_real)(h * v->G[i][j]);
    for (int j = 0; j < NS; j++) v->W[SLOW[j]][SLOW[j]] += C[SLOW[j]];
    if (!lu(v->W, v->pivot)) return 0;
    for (int k = 0; k < NR; k++) {
        for (int j = 0; j < NS; j++) column[j] = o->S[j][k];
        for (int i = 0; i < NQ; i++) heat[i] = o->S[NS + i][k];
        propagated(w, h, column, heat);
        for (int j = 0; j < NS; j++) w->A[k][j] = w->right[j];
        for (int i = 0; i < NQ; i++) w->A[k][NS + i] = keeps * heat[i];
    }
    for (int k = 0; k < NK; k++) {
        for (int j = 0; j < NS; j++) column[j] = o->error[j][k];
        for (int i = 0; i < NQ; i++) heat[i] = o->error[NS + i][k] + (k == NY + i);
        propagated(w, h, column, heat);
        for (int j = 0; j < NS; j++) o->error[j][k] = (thermal_covariance)w->right[j];
        for (int i = 0; i < NQ; i++) o->error[NS + i][k] *= (thermal_covariance)keeps;
    }
    for (int k = 0; k < NQ; k++) {
        for (int j = 0; j < NR; j++) w->A[NR + k][j] = 0;
        for (int i = 0; i < NQ; i++) w->A[NR + k][NS + i] = sqrt(1 - keeps * keeps) * NOISE_ROOT[i][k];
    }
    triangular(o, w);
    for (int i = 0; i < NQ; i++) o->q[i] *= (thermal_covariance)keeps;
    return 1;
}

/* Step i of count, h seconds each, between the signals `begin` and `all`, whose factors are in the work arrays. */
static int predict(
    thermal_observer *o, thermal_observer_work *w, real h, int i, int count, const real *begin, real *all) {
    const real gamma = (real)(1.0 - sqrt(0.5)), share = ((real)i + (real)0.5) / (real)count;
    thermal_work *v = &w->network;
    real *x = o->s.x;
    between(begin, all, share, v->um);
    for (int e = 0; e < THERMAL_FACTORS; e++) v->f0[e] = w->begin[e] + share * (w->end[e] - w->begin[e]);
    state_of(x, v->um, v->z0);
    flow(v->z0, v->f0, v->tau0, v->v0, v->F0);
    jacobian(v->f0, v->tau0, v->v0, 0, v->G);
    memcpy(w->G, v->G, sizeof w->G);
    shifted(gamma * h, v);
    if (!lu(v->W, v->pivot)) return THERMAL_NO_STEP;
    memcpy(w->first, v->F0, sizeof w->first);
    solve(v->W, v->pivot, w->first);
    for (int k = 0; k < N; k++) v->z0[k] = x[k] + h * w->first[k];
    flow(v->z0, v->f0, v->tau0, v->v0, v->F0);
    for (int k = 0; k < N; k++) v->w0[k] = v->F0[k] - 2 * C[k] * w->first[k];
    solve(v->W, v->pivot, v->w0);
    for (int k = 0; k < N; k++) {
        x[k] += h * ((real)1.5 * w->first[k] + (real)0.5 * v->w0[k]);
        if (!(size_of(x[k]) < (real)1e30)) return THERMAL_NO_STEP;
    }
    memcpy(v->G, w->G, sizeof w->G);
    return covariance(o, w, h) ? THERMAL_OK : THERMAL_NO_STEP;
}

/* Whether a reading is to be used; sd: of its innovation. */
static int taken(thermal_observer *o, int j, double reading, double expected, double sd, double seconds) {
    thermal_sensor *t = &o->sensors[j];
    int good = reading >= COLDEST_C && reading <= HOTTEST_C && fabs(reading - expected) <= OUTLIER_SD * sd, moved = 0;
    t->missing = good ? 0 : t->missing + (thermal_covariance)seconds;
    t->good = good ? t->good + (thermal_covariance)seconds : 0;
    if ((thermal_covariance)reading == t->last) {
        t->same += (thermal_covariance)seconds;
    } else {
        t->longest = (thermal_covariance)largest(t->longest, t->same);
        t->same = 0;
        t->last = (thermal_covariance)reading;
        for (int i = 0; i < NY; i++) t->then[i] = (thermal_covariance)o->lagged[i];
    }
    for (int i = 0; i < NY; i++) moved |= fabs(o->lagged[i] - t->then[i]) > MOVED_SD * SENSOR_SD[i];
    if (t->dropped) {
        if (t->dropped != THERMAL_DRIFTING && t->good >= BACK_AFTER_S && (t->dropped != THERMAL_FROZEN || t->same == 0))
            t->dropped = THERMAL_USED;
    } else if (t->missing >= largest(LOST_AFTER_S, 3 * seconds)) {
        t->dropped = THERMAL_LOST;
    } else if (t->same >= largest(FROZEN_AFTER_S, LONGER_RUN * t->longest) && moved) {
        t->dropped = THERMAL_FROZEN;
    }
    return good && !t->dropped;
}

/* What sensor j sees of the slow states. */
static void seen(const thermal_observer_work *w, int j, double *h) {
    for (int k = 0; k < NR; k++) h[k] = 0;
    for (int e = SENSOR_START[j]; e < SENSOR_START[j + 1]; e++)
        if (SENSOR_AT[e] < N) for (int k = 0; k < NS; k++) h[k] += SENSOR_WEIGHT[e] * w->along[SENSOR_AT[e]][k];
}

static void update(thermal_observer *o, thermal_observer_work *w, int j, double reading, double seconds) {
    double r = SENSOR_SD[j] * SENSOR_SD[j] * largest(HELD_FOR_S / seconds, 1), expected = o->lagged[j], total = r, through;
    seen(w, j, w->h);
    for (int k = 0; k < NS; k++) expected += w->h[k] * w->change[k];
    for (int k = 0; k < NR; k++) {
        w->phi[k] = 0;
        for (int i = 0; i < NS; i++) w->phi[k] += o->S[i][k] * w->h[i];
        total += w->phi[k] * w->phi[k];
    }
    if (!taken(o, j, reading, expected, sqrt(total), seconds)) return;
    for (int i = 0; i < NR; i++) {
        through = 0;
        for (int k = 0; k < NR; k++) through += o->S[i][k] * w->phi[k];
        for (int k = 0; k < NR; k++) o->S[i][k] -= (thermal_covariance)(through * w->phi[k] / (total + sqrt(r * total)));
        w->gain[i] = through / total;
    }
    for (int k = 0; k < NK; k++) {
        double sees = k == j;
        for (int i = 0; i < NS; i++) sees += w->h[i] * o->error[i][k];
        o->score[k] += (thermal_covariance)(sees * (reading - expected) / total);
        o->information[k] += (thermal_covariance)(sees * sees / total);
        for (int i = 0; i < NR; i++) o->error[i][k] -= (thermal_covariance)(w->gain[i] * sees);
    }
    for (int i = 0; i < NR; i++) w->change[i] += w->gain[i] * (reading - expected);
}

static double evidence(const thermal_observer *o, int k, double variance) {
    double V = o->information[k];
    return 0.5 * variance * o->score[k] * o->score[k] / (1 + variance * V) - 0.5 * log1p(variance * V);
}

/* Drop a sensor that drifts, and begin anew without it. */
static void judge(thermal_observer *o, thermal_observer_work *w) {
    double top = 0, most = 0, sum, best = 0;
    int worst = -1;
    for (int k = 0; k < NK; k++) {
        double own = ALLOWED_SD[k] * ALLOWED_SD[k], wide = SPREAD_SD[k] * SPREAD_SD[k] + own;
        w->chance[k] = evidence(o, k, wide) - evidence(o, k, own);
        most = largest(most, w->chance[k]);
    }
    for (int k = 0; k < NK; k++) {
        w->chance[k] = LOG_PRIOR[k] + w->chance[k] / (TEMPER_BY + TEMPER_PER_NAT * most);
        top = largest(top, w->chance[k]);
    }
    sum = exp(-top);
    for (int k = 0; k < NK; k++) sum += w->chance[k] = exp(w->chance[k] - top);
    for (int k = 0; k < NY; k++) if (w->chance[k] / sum > best) best = w->chance[worst = k] / sum;
    if (worst < 0 || best <= SURE_FROM) return;
    double own = ALLOWED_SD[worst] * ALLOWED_SD[worst], wide = SPREAD_SD[worst] * SPREAD_SD[worst] + own;
    o->drift[worst] = (thermal_covariance)(o->score[worst] / (o->information[worst] + 1 / wide));
    o->sensors[worst].dropped = THERMAL_DRIFTING;
    memset(o->S, 0, sizeof o->S);
    memset(o->error, 0, sizeof o->error);
    memset(o->score, 0, sizeof o->score);
    memset(o->information, 0, sizeof o->information);
    for (int i = 0; i < NS; i++) o->S[i][i] = (thermal_covariance)fabs(o->drift[worst]);
    for (int i = 0; i < NQ; i++) {
        o->q[i] = 0;
        for (int k = 0; k < NQ; k++) o->S[NS + i][NS + k] = (thermal_covariance)NOISE_ROOT[i][k];
    }
}

static void readings(thermal_observer *o, thermal_observer_work *w, const thermal_real *y, double seconds, int first) {
    state_of(o->s.x, o->s.u, w->network.z0);
    for (int j = 0; j < NY; j++) {
        double shows = 0, keeps = first || LAG_S[j] <= 0 ? 0 : exp(-seconds / LAG_S[j]);
        for (int e = SENSOR_START[j]; e < SENSOR_START[j + 1]; e++) shows += SENSOR_WEIGHT[e] * w->network.z0[SENSOR_AT[e]];
        o->lagged[j] = (thermal_real)(first ? shows : shows + keeps * (o->lagged[j] - shows));
    }
    for (int i = 0; i < NR; i++) w->change[i] = 0;
    for (int j = 0; j < NY; j++) update(o, w, j, y[j] - SENSOR_BIAS[j], seconds);
    for (int i = 0; i < N; i++) for (int k = 0; k < NS; k++) o->s.x[i] += (thermal_real)(w->along[i][k] * w->change[k]);
    for (int i = 0; i < NQ; i++) o->q[i] += (thermal_covariance)w->change[NS + i];
    for (int j = 0; j < NY; j++) {
        seen(w, j, w->h);
        for (int k = 0; k < NS; k++) o->lagged[j] += (thermal_real)(w->h[k] * w->change[k]);
    }
    for (int i = 0; i < NQ; i++) {
        double square = 0;
        for (int k = 0; k < NR; k++) square += (double)o->S[NS + i][k] * o->S[NS + i][k];
        o->q_sd[i] = (thermal_covariance)sqrt(square);
        o->fails[i] = (thermal_covariance)(0.5 * erfc(-(fabs(o->q[i]) - DOUBT_SD * TABLE_SD[i]) / largest(o->q_sd[i], 1e-9) / sqrt(2.0)));
    }
    judge(o, w);
}

int thermal_observer_begin(thermal_observer *o, thermal_observer_work *w, const thermal_real *u, const thermal_real *y) {
    thermal_real all[THERMAL_SIGNALS + 1];
    double sum = 0, square = 0, known = 0, mean = 0;
    memset(o, 0, sizeof *o);
    all_signals(o, u, all);
    for (int j = 0; j < NY; j++) {
        int used = y[j] == y[j];
        for (int i = j + 1; i < NY; i++) if (SENSOR_STATE[i] == SENSOR_STATE[j] && y[i] == y[i]) used = 0;
        if (!used) continue;
        double first = y[j] - SENSOR_BIAS[j];
        mean += first;
        sum += first;
        square += first * first;
        known++;
    }
    for (int b = 0; b < NB; b++) {
        double T = all[THERMAL_INPUTS + b];
        sum += T;
        square += T * T;
        if (!known) mean += T / NB;
    }
    if (known) mean /= known;
    square = largest(square / (known + NB) - sum / (known + NB) * sum / (known + NB), 0);
    thermal_begin(&o->s, &w->network, (thermal_real)mean, all);
    for (int i = 0; i < NS; i++) o->S[i][i] = (thermal_covariance)sqrt(START_K * START_K + square);
    for (int j = 0; j < NY; j++) {
        o->sensors[j].last = (thermal_covariance)NAN;
        if (y[j] != y[j]) continue;
        o->s.x[SENSOR_STATE[j]] = y[j] - (real)SENSOR_BIAS[j];
        for (int i = 0; i < NS; i++) if (SENSOR_STATE[j] == SLOW[i]) o->S[i][i] = START_K;
    }
    for (int i = 0; i < NQ; i++) for (int k = 0; k < NQ; k++) o->S[NS + i][NS + k] = (thermal_covariance)NOISE_ROOT[i][k];
    for (int i = 0; i < N; i++) for (int k = 0; k < NS; k++) w->along[i][k] = i == SLOW[k];
    int status = thermal_rest(&o->s, &w->network);
    readings(o, w, y, 1, 1);
    return status;
}

int thermal_observer_step(
    thermal_observer *o, thermal_observer_work *w, thermal_real seconds, const thermal_real *u, const thermal_real *y) {
    thermal_real all[THERMAL_SIGNALS + 1], begin[THERMAL_SIGNALS + 1];
    int count = (int)ceil((double)seconds / LONGEST_S - 1e-9);
    if (count < 1) count = 1;
    all_signals(o, u, all);
    memcpy(begin, o->s.u, sizeof o->s.u);
    for (int i = 0; i < NQ; i++) begin[HEAT_SIGNAL[i]] = all[HEAT_SIGNAL[i]];
    factors(begin, w->begin);
    factors(all, w->end);
    for (int k = 0; k < count; k++) {
        int status = predict(o, w, seconds / count, k, count, begin, all);
        if (status) return status;
    }
    memcpy(o->s.u, all, sizeof o->s.u);
    if (!balance(w)) return THERMAL_NO_STEP;
    for (int k = 0; k < NK; k++) {
        o->score[k] *= (thermal_covariance)exp(-seconds / FORGETS_AFTER_S);
        o->information[k] *= (thermal_covariance)exp(-seconds / FORGETS_AFTER_S);
    }
    readings(o, w, y, seconds, 0);
    return THERMAL_OK;
}

void thermal_observer_outputs(const thermal_observer *o, thermal_real *T) { thermal_outputs(&o->s, T); }
