/* C dx/dt = F(x, u(t)) by a Rosenbrock method of order three with three stages, L-stable and stiffly accurate, in steps
   as long as their estimated error allows (Hairer and Wanner 1996, sec. IV.7 and IV.8); where none stands, implicit Euler
   with the coefficients of the start, which no stiffness upsets. */
#include <math.h>
#include <string.h>
#include "thermal_network.h"
#include "thermal_network_data.h"

#define N THERMAL_STATES
#define NB THERMAL_BOUNDARIES
#define NZ (THERMAL_STATES + THERMAL_BOUNDARIES + 1)
#define NE THERMAL_TERMS
#define NV THERMAL_ROWS
typedef thermal_real real;

static const real G_ = (real)0.43586652150845899941601945119356;
static const real SIGMA = (real)5.670374419e-8, ZERO_C = (real)273.15, SMOOTH = (real)0.01;
enum { CONSTANT, POWER, RADIATION, LINEAR, TABLE, FILM, INVERSE, STREAM };
enum { POWERED, STRAIGHT, POSITIVE, TABULATED, MAPPED };
enum { MOST_TRIES = 12, MOST_ITERATIONS = 50 };

static real least(real a, real b) { return a < b ? a : b; }
static real most(real a, real b) { return a > b ? a : b; }
static real size_of(real a) { return a < 0 ? -a : a; }

/* Index k of the piece with x[k] <= at < x[k + 1]. */
static int segment(const real *x, int n, real at) {
    int low = 0, high = n - 1;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (x[middle] <= at) low = middle; else high = middle;
    }
    return low;
}

static real share_of(const real *x, int k, real at) { return most(0, least(1, (at - x[k]) / (x[k + 1] - x[k]))); }

static real tabulated(const real *x, const real *y, int n, real at) {
    int k = segment(x, n, at);
    return n < 2 ? y[0] : y[k] + share_of(x, k, at) * (y[k + 1] - y[k]);
}

static real function_at(int k, const real *u) {
    const int *d = FUNCTION[k];
    const real *a = FUNCTION_A[k], in = u[d[1]];
    const real *x = FUNCTION_X + d[3], *x2 = x + d[4], *y = FUNCTION_Y + d[6];
    real at = d[7] ? size_of(in) : in;
    if (d[0] == POWERED) return (real)pow((double)size_of(in / a[0]), (double)a[1]);
    if (d[0] == STRAIGHT) return a[0] + a[1] * in;
    if (d[0] == POSITIVE) return a[0] * in > 0 ? 1 : 0;
    if (d[0] == TABULATED) return tabulated(x, y, d[4], at);
    {
        real other = d[7] ? size_of(u[d[2]]) : u[d[2]];
        int i = segment(x, d[4], at), j = segment(x2, d[5], other);
        real p = share_of(x, i, at), q = share_of(x2, j, other);
        const real *low = y + i * d[5] + j, *high = low + d[5];
        return (1 - p) * ((1 - q) * low[0] + q * low[1]) + p * ((1 - q) * high[0] + q * high[1]);
    }
}

/* Input factors of all terms. */
static void factors(const real *u, real *f) {
    for (int e = 0; e < NE; e++) {
        f[e] = 0;
        for (int k = PRODUCT_START[e]; k < PRODUCT_START[e + 1]; k++) {
            real one = PRODUCT[k];
            for (int i = FUNCTION_START[k]; i < FUNCTION_START[k + 1]; i++) one *= function_at(i, u);
            f[e] += one;
        }
    }
    for (int k = NE; k < THERMAL_FACTORS; k++) f[k] = SEEN[k - NE] < 0 ? SEEN_SIZE[k - NE] : size_of(u[SEEN[k - NE]]);
}

static void film(const real *x, const real *y, int nd, real hot, real cold, real *out) {
    real side = hot >= cold ? 1 : -1, at = (hot + cold) / 2, wide, d = least(size_of(hot - cold), x[nd - 1]);
    real place = least(most((at - FILM_FIRST) / FILM_STEP, 0), FILMS - 1), share, cool, warm, one, two, by_d;
    int j = (int)place < FILMS - 2 ? (int)place : FILMS - 2, k = segment(x, nd, d);
    const real *low = y + j * nd + k, *high = low + nd;
    wide = x[k + 1] - x[k];
    cool = (low[1] - low[0]) / wide;
    warm = (high[1] - high[0]) / wide;
    one = low[0] + cool * (d - x[k]);
    two = high[0] + warm * (d - x[k]);
    share = place - j;
    by_d = size_of(hot - cold) >= x[nd - 1] ? 0 : cool + share * (warm - cool);
    out[0] = one + share * (two - one);
    out[1] = out[2] = place > 0 && place < FILMS - 1 ? (two - one) / FILM_STEP / 2 : 0;
    out[1] += side * by_d;
    out[2] -= side * by_d;
}

/* A film by Reynolds number and temperature: nt totals with shifts, then numbers, then values, one total after the other;
   onto what leaves a cell where `stretch` is above 0, beyond still air where it is below: its film comes next, the exponent last. */
static void stream(const real *x, const real *y, int n, int nt, real stretch, real size, real hot, real cold, real *out) {
    int nd = stretch < 0 ? (int)-stretch : 0, nn = (n - (nd > 0) - FILMS * nd - nt) / (1 + nt), i, j;
    real u = most(size, LEAST), total = hot + cold, at = least(most(total, x[0]), x[nt - 1]);
    real wide, share, drift, place, high, up, cool, warm, one, two, by_y, by_T, by_u, h;
    const real *number = x + nt, *low;
    i = segment(x, nt, at);
    wide = x[i + 1] - x[i];
    share = (at - x[i]) / wide;
    drift = (y[i + 1] - y[i]) / wide;
    place = (real)log((double)u) - y[i] - drift * (at - x[i]);
    j = segment(number, nn, place);
    high = number[j + 1] - number[j];
    up = most(place, number[0]) - number[j];
    low = y + nt + nn + i * nn + j;
    cool = (low[1] - low[0]) / high;
    warm = (low[nn + 1] - low[nn]) / high;
    one = low[0] + cool * up;
    two = low[nn] + warm * up;
    by_y = place > number[0] && size > LEAST ? cool + share * (warm - cool) : 0;
    h = one + share * (two - one);
    by_T = total == at ? (two - one) / wide - drift * by_y : 0;
    by_u = by_y / u;
    if (nd > 0) {
        real s[3], m, p, q;
        double e = (double)x[n - 1];
        film(x + n - 1 - FILMS * nd, y + n - 1 - FILMS * nd, nd, hot, cold, s);
        m = (real)pow(pow((double)h, e) + pow((double)s[0], e), 1.0 / e);
        p = m > 0 ? (real)pow((double)(h / m), e - 1.0) : 0;
        q = m > 0 ? (real)pow((double)(s[0] / m), e - 1.0) : 1;
        out[0] = m - s[0];
        out[1] = p * by_T + (q - 1) * s[1];
        out[2] = p * by_T + (q - 1) * s[2];
        out[3] = p * by_u;
        return;
    }
    if (stretch > 0) {
        real units = h * stretch / u, full = (real)expm1((double)FULL_UNITS);
        real moves = size > LEAST ? 1 : 0;
        if (units <= FULL_UNITS) {
            real g = (real)exp((double)units);
            by_u = g * by_u + moves * ((real)expm1((double)units) - units * g) / stretch;
            by_T *= g;
            h = (real)expm1((double)units) * u / stretch;
        } else if (units < full) {
            h = full * u / stretch;
            by_T = 0;
            by_u = moves * full / stretch;
        }
    }
    out[0] = h;
    out[1] = out[2] = by_T;
    out[3] = by_u;
}

/* Temperature law of term e: its value, d/dhot, d/dcold, d/dsize of the input that it sees. */
static void law(int e, real hot, real cold, const real *f, real *out) {
    real a = LAW_A[e], b = LAW_B[e], d = hot - cold;
    const real *x = POINT_X + POINT_START[e], *y = POINT_Y + POINT_START[e];
    int n = POINT_END[e] - POINT_START[e];
    out[0] = 1;
    out[1] = out[2] = out[3] = 0;
    if (LAW[e] == POWER) {
        real s = d * d + SMOOTH * SMOOTH;
        out[0] = (real)pow((double)s, 0.5 * (double)a);
        out[1] = a * out[0] / s * d;
        out[2] = -out[1];
    } else if (LAW[e] == RADIATION) {
        real h = hot + ZERO_C, c = cold + ZERO_C;
        out[0] = SIGMA * (h * h + c * c) * (h + c);
        out[1] = SIGMA * (3 * h * h + 2 * h * c + c * c);
        out[2] = SIGMA * (3 * c * c + 2 * h * c + h * h);
    } else if (LAW[e] == LINEAR) {
        out[0] = 1 + a * (hot - b);
        out[1] = a;
    } else if (LAW[e] == INVERSE) {
        out[0] = 1 / (1 + a * (hot - b));
        out[1] = -a * out[0] * out[0];
    } else if (LAW[e] == TABLE) {
        int with_sign = x[0] < 0;
        real at = with_sign ? d : size_of(d);
        int k = segment(x, n, at);
        out[0] = tabulated(x, y, n, at);
        if (at > x[0] && at < x[n - 1]) out[1] = (y[k + 1] - y[k]) / (x[k + 1] - x[k]) * (d < 0 && !with_sign ? -1 : 1);
        out[2] = -out[1];
    } else if (LAW[e] == FILM) {
        film(x, y, (int)a, hot, cold, out);
    } else if (LAW[e] == STREAM) {
        stream(x, y, n, (int)a, b, f[PLACE[e]], hot, cold, out);
    }
}

/* v: rows of all patterns at z, then the temperatures that laws see. */
static void patterns(const real *z, real *v) {
    for (int r = 0; r < NV; r++) {
        v[r] = 0;
        for (int i = ENTRY_START[r]; i < ENTRY_START[r + 1]; i++) v[r] += ENTRY_WEIGHT[i] * z[ENTRY_AT[i]];
    }
}

/* F = -K0 z - sum of all terms. */
static void flow(const real *z, const real *f, real (*tau)[4], real *v, real *F) {
    patterns(z, v);
    for (int i = 0; i < N; i++) {
        real sum = 0;
        for (int j = 0; j < NZ; j++) sum += K0[i][j] * z[j];
        F[i] = -sum;
    }
    for (int e = 0; e < NE; e++) {
        law(e, v[HOT[e]], v[COLD[e]], f, tau[e]);
        for (int r = ROW_FIRST[e]; r < ROW_END[e]; r++) F[ROW[r]] -= f[e] * tau[e][0] * v[r];
    }
}

/* G = -dF/dx; without how coefficients turn with temperature where `frozen`. */
static void jacobian(const real *f, real (*tau)[4], const real *v, int frozen, real (*G)[N]) {
    for (int i = 0; i < N; i++) memcpy(G[i], K0[i], N * sizeof(real));
    for (int e = 0; e < NE; e++) {
        for (int r = ROW_FIRST[e]; r < ROW_END[e]; r++) {
            for (int i = ENTRY_START[r]; i < ENTRY_START[r + 1]; i++)
                if (ENTRY_AT[i] < N) G[ROW[r]][ENTRY_AT[i]] += f[e] * tau[e][0] * ENTRY_WEIGHT[i];
        }
        for (int side = 0; side < 2 && !frozen; side++) {
            int seen = side ? COLD[e] : HOT[e];
            for (int i = ENTRY_START[seen]; i < ENTRY_START[seen + 1]; i++) {
                real by = f[e] * ENTRY_WEIGHT[i] * tau[e][side + 1];
                if (ENTRY_AT[i] >= N) continue;
                for (int r = ROW_FIRST[e]; r < ROW_END[e]; r++) G[ROW[r]][ENTRY_AT[i]] += v[r] * by;
            }
        }
    }
}

/* LU in place, rows swapped where the diagonal is below a tenth of its column; 0 if singular. */
static int lu(real (*A)[N], int *pivot) {
    for (int k = 0; k < N; k++) {
        int best = k;
        for (int i = k + 1; i < N; i++) if (size_of(A[i][k]) > size_of(A[best][k])) best = i;
        if (size_of(A[k][k]) >= size_of(A[best][k]) / 10) best = k;
        pivot[k] = best;
        if (!(size_of(A[best][k]) > 0)) return 0;
        for (int j = 0; best != k && j < N; j++) {
            real kept = A[k][j];
            A[k][j] = A[best][j];
            A[best][j] = kept;
        }
        for (int i = k + 1; i < N; i++) {
            if (A[i][k] == 0) continue;
            A[i][k] /= A[k][k];
            for (int j = k + 1; j < N; j++) A[i][j] -= A[i][k] * A[k][j];
        }
    }
    return 1;
}

static void solve(real (*A)[N], const int *pivot, real *b) {
    for (int i = 0; i < N; i++) {
        real kept = b[i];
        b[i] = b[pivot[i]];
        b[pivot[i]] = kept;
    }
    for (int i = 1; i < N; i++) for (int j = 0; j < i; j++) b[i] -= A[i][j] * b[j];
    for (int i = N - 1; i >= 0; i--) {
        for (int j = i + 1; j < N; j++) b[i] -= A[i][j] * b[j];
        b[i] /= A[i][i];
    }
}

static void shifted(real by, thermal_work *w) {
    for (int i = 0; i < N; i++) {
        for (int j = 0; j < N; j++) w->W[i][j] = by * w->G[i][j];
        w->W[i][i] += C[i];
    }
}

static void state_of(const real *x, const real *u, real *z) {
    memcpy(z, x, N * sizeof(real));
    for (int b = 0; b < NB; b++) z[N + b] = u[THERMAL_INPUTS + b];
    z[NZ - 1] = 1;
}

/* F along time at the start of the step, per second; boundaries move by (u1 - u0) / h. */
static void along_time(thermal_work *w, real h) {
    real *z = w->z1, *v = w->v1;
    for (int i = 0; i < NZ; i++) z[i] = 0;
    for (int b = 0; b < NB; b++) z[N + b] = (w->u1[THERMAL_INPUTS + b] - w->u0[THERMAL_INPUTS + b]) / h;
    patterns(z, v);
    for (int i = 0; i < N; i++) {
        w->Ft[i] = 0;
        for (int b = 0; b < NB; b++) w->Ft[i] -= K0[i][N + b] * z[N + b];
    }
    for (int e = 0; e < NE; e++) {
        real turn = w->tau0[e][1] * v[HOT[e]] + w->tau0[e][2] * v[COLD[e]];
        real change = w->f0[e] * (turn + w->df[PLACE[e]] * w->tau0[e][3]) + w->df[e] * w->tau0[e][0];
        for (int r = ROW_FIRST[e]; r < ROW_END[e]; r++)
            w->Ft[ROW[r]] -= w->f0[e] * w->tau0[e][0] * v[r] + change * w->v0[r];
    }
}

/* A step from z0 (F0 known) to z1; its error over what is allowed. */
static real rosenbrock(thermal_work *w, real h) {
    const real c21 = (real)THERMAL_C21, c31 = (real)THERMAL_C31, c32 = (real)THERMAL_C32, slope2 = (real)THERMAL_SLOPE2;
    real gh = G_ * h, low, high, worst = 0;
    shifted(gh, w);
    if (!lu(w->W, w->pivot)) return HUGE_VAL;
    along_time(w, h);
    for (int i = 0; i < N; i++) w->w0[i] = gh * (w->F0[i] + gh * w->Ft[i]);
    solve(w->W, w->pivot, w->w0);
    state_of(w->z0, w->u1, w->z1);
    for (int i = 0; i < N; i++) w->z1[i] += w->w0[i] / G_;
    flow(w->z1, w->f1, w->tau1, w->v1, w->F1);
    for (int i = 0; i < N; i++) w->w1[i] = gh * (w->F1[i] + slope2 * h * w->Ft[i]) + G_ * c21 * C[i] * w->w0[i];
    solve(w->W, w->pivot, w->w1);
    for (int i = 0; i < N; i++) w->w2[i] = gh * w->F1[i] + G_ * C[i] * (c31 * w->w0[i] + c32 * w->w1[i]);
    solve(w->W, w->pivot, w->w2);
    for (int i = 0; i < N; i++) w->z1[i] += w->w2[i];
    flow(w->z1, w->f1, w->tau1, w->v1, w->F1);
    for (int i = 0; i < N; i++)
        w->error[i] = gh * w->F1[i] - G_ * C[i] * ((real)THERMAL_END1 * w->w0[i] + (real)THERMAL_END2 * w->w1[i] + (real)THERMAL_END3 * w->w2[i]);
    solve(w->W, w->pivot, w->error);
    low = high = w->z1[NZ - 2];
    for (int i = 0; i < NZ - 1; i++) {
        if (i < N && !NODE[i]) continue;
        low = least(low, w->z1[i]);
        high = most(high, w->z1[i]);
    }
    for (int i = 0; i < N; i++) {
        if (!(size_of(w->error[i]) < (real)1e30)) return HUGE_VAL;
        worst = most(worst, UNIT[i] * size_of(w->error[i]));
    }
    return worst / ((real)THERMAL_ERROR_K + (real)THERMAL_ERROR_SHARE * (high - low));
}

/* Implicit Euler with the coefficients of the start. */
static int euler(thermal_work *w, real h) {
    state_of(w->z0, w->u1, w->z1);
    flow(w->z1, w->f1, w->tau1, w->v1, w->F1);
    jacobian(w->f1, w->tau1, w->v1, 1, w->G);
    shifted(h, w);
    if (!lu(w->W, w->pivot)) return 0;
    for (int i = 0; i < N; i++) w->w0[i] = h * w->F1[i];
    solve(w->W, w->pivot, w->w0);
    for (int i = 0; i < N; i++) w->z1[i] += w->w0[i];
    return 1;
}

static void between(const real *a, const real *b, real share, real *out) {
    for (int i = 0; i < THERMAL_SIGNALS; i++) out[i] = a[i] + share * (b[i] - a[i]);
}

int thermal_rest(thermal_state *s, thermal_work *w) {
    const real close = sizeof(real) < 8 ? (real)1e-3 : (real)THERMAL_REST_K;
    int bare = 0;
    for (int i = 0; i < N; i++) bare |= C[i] == 0;
    if (!bare) return THERMAL_OK;
    factors(s->u, w->f0);
    for (int k = 0; k < MOST_ITERATIONS; k++) {
        real largest = 0;
        state_of(s->x, s->u, w->z0);
        flow(w->z0, w->f0, w->tau0, w->v0, w->F0);
        jacobian(w->f0, w->tau0, w->v0, 0, w->G);
        for (int i = 0; i < N; i++) {
            memcpy(w->W[i], w->G[i], N * sizeof(real));
            if (C[i] == 0) continue;
            w->F0[i] = 0;
            for (int j = 0; j < N; j++) w->W[i][j] = i == j;
        }
        if (!lu(w->W, w->pivot)) return THERMAL_NO_REST;
        solve(w->W, w->pivot, w->F0);
        for (int i = 0; i < N; i++) {
            s->x[i] += w->F0[i];
            largest = most(largest, size_of(w->F0[i]));
        }
        if (largest < close) return THERMAL_OK;
        if (!(largest < (real)1e30)) return THERMAL_NO_REST;
    }
    return THERMAL_NO_REST;
}

int thermal_begin(thermal_state *s, thermal_work *w, thermal_real degC, const thermal_real *u) {
    for (int i = 0; i < N; i++) s->x[i] = NODE[i] ? degC : 0;
    s->next = (real)1e30;
    s->time = 0;
    memcpy(s->u, u, sizeof s->u);
    return thermal_rest(s, w);
}

int thermal_hold(thermal_state *s, thermal_work *w, const thermal_real *u) {
    int jumps = memcmp(s->u, u, sizeof s->u) != 0;
    memcpy(s->u, u, sizeof s->u);
    return jumps ? thermal_rest(s, w) : THERMAL_OK;
}

int thermal_step(thermal_state *s, thermal_work *w, thermal_real seconds, const thermal_real *u) {
    real done = 0, begin[THERMAL_SIGNALS + 1];
    memcpy(begin, s->u, sizeof s->u);
    while (done < seconds * (real)(1 - 1e-6)) {
        real left = seconds - done, wanted = s->next, h = left, size = 2;
        int tries;
        between(begin, u, done / seconds, w->u0);
        state_of(s->x, w->u0, w->z0);
        factors(w->u0, w->f0);
        flow(w->z0, w->f0, w->tau0, w->v0, w->F0);
        jacobian(w->f0, w->tau0, w->v0, 0, w->G);
        for (tries = 0; tries < MOST_TRIES && size > 1; tries++) {
            h = left / most(1, (real)ceil((double)(left * (real)(1 - 1e-6) / wanted)));
            between(begin, u, (done + h) / seconds, w->u1);
            between(begin, u, (done + h / 2) / seconds, w->um);
            factors(w->u1, w->f1);
            factors(w->um, w->fm);
            for (int e = 0; e < THERMAL_FACTORS; e++) w->df[e] = (4 * w->fm[e] - 3 * w->f0[e] - w->f1[e]) / h;
            size = rosenbrock(w, h);
            if (size > 1) wanted = h * most(least((real)0.8 * (real)pow((double)size, -1.0 / 3.0), (real)0.5), (real)0.05);
        }
        if (size > 1 && !euler(w, h)) return THERMAL_NO_STEP;
        memcpy(s->x, w->z1, sizeof s->x);
        for (int i = 0; i < N; i++) if (!(size_of(s->x[i]) < (real)1e6)) return THERMAL_NO_STEP;
        s->next = h * least(most((real)0.9 * (real)pow((double)most(size, (real)1e-9), -1.0 / 3.0), (real)0.2), 8);
        done += h;
    }
    memcpy(s->u, u, sizeof s->u);
    s->time += seconds;
    return THERMAL_OK;
}

void thermal_outputs(const thermal_state *s, thermal_real *y) {
    for (int r = 0; r < THERMAL_OUTPUTS; r++) {
        y[r] = 0;
        for (int i = OUTPUT_START[r]; i < OUTPUT_START[r + 1]; i++) {
            int at = OUTPUT_AT[i];
            y[r] += OUTPUT_WEIGHT[i] * (at < N ? s->x[at] : s->u[THERMAL_INPUTS + at - N]);
        }
    }
}

void thermal_flow(const thermal_state *s, thermal_work *w, thermal_real *F) {
    factors(s->u, w->f0);
    state_of(s->x, s->u, w->z0);
    flow(w->z0, w->f0, w->tau0, w->v0, F);
}
