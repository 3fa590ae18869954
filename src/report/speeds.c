/* Tables of the machine in operation. */
#include "report/report.h"
#include "running/running.h"

static struct table *table_of_critical_speeds(struct pool *pool, const rotid_speeds *s)
{
    struct table *t =
        table_open(pool, s->harmonic == 1 ? "CRITICAL SPEEDS: Im lambda = speed"
                                          : pool_text(pool, "CRITICAL SPEEDS: Im lambda = %g times the speed", s->harmonic));
    for (int i = 0; i < s->ncritical_speeds; i++) {
        const rotid_critical_speed *c = &s->critical_speeds[i];
        number_column(t, "no.", NULL, SHOW_COUNT, c->number);
        number_column(t, "critical speed", "rpm", SHOW_FIXED(1), c->speed_rpm);
        number_column(t, "from", "rpm", SHOW_FIXED(0), c->ci95[0]);
        number_column(t, "to", "rpm", SHOW_FIXED(0), c->ci95[1]);
        text_column(t, "whirl", SHOW_TEXT, c->whirl);
        number_column(t, "log decrement", NULL, SHOW_DIGITS(3), c->log_decrement);
        number_column(t, "amplification", NULL, SHOW_DIGITS(3), c->amplification);
        number_column(t, "margin", "%", SHOW_SIGNED(1), 100 * c->margin.value);
        number_column(t, "required", "%", SHOW_FIXED(1), 100 * c->margin.required);
        number_column(t, "probability", NULL, SHOW_CHANCE(3), c->margin.probability);
    }
    return t;
}

struct table *table_of_runup(struct pool *pool, int count, const rotid_runup_speed *list)
{
    struct table *t = table_open(pool, count && list[0].holdout ? "RUN-UP, held out: measured critical speeds beside the model's"
                                                                : "RUN-UP: measured critical speeds beside the model's");
    for (int i = 0; i < count; i++) {
        number_column(t, "no.", NULL, SHOW_COUNT, list[i].number);
        text_column(t, "whirl", SHOW_TEXT, list[i].whirl);
        number_column(t, "measured", "rpm", SHOW_FIXED(1), list[i].measured_rpm);
        number_column(t, "std", "rpm", SHOW_DIGITS(3), list[i].measured_std);
        number_column(t, "predicted", "rpm", SHOW_FIXED(1), list[i].predicted_rpm);
        number_column(t, "std of it", "rpm", SHOW_DIGITS(3), list[i].predicted_std);
        number_column(t, "z", NULL, SHOW_SIGNED(1), list[i].z);
    }
    return t;
}

static struct table *table_of_torsion(struct pool *pool, const rotid_speeds *s)
{
    struct table *t = table_open(pool, "TORSION: natural frequencies of the machine, and the speeds that excite them");
    for (int i = 0; i < s->ntorsion; i++) {
        const rotid_torsional_frequency *own = &s->torsion[i];
        number_column(t, "no.", NULL, SHOW_COUNT, own->number);
        number_column(t, "frequency", "Hz", SHOW_FIXED(2), own->frequency_hz);
        number_column(t, "std", "Hz", SHOW_DIGITS(3), own->std_hz > 0 ? own->std_hz : (double)NAN);
        number_column(t, "1x", "rpm", SHOW_FIXED(0), 60 * own->frequency_hz);
        number_column(t, "2x", "rpm", SHOW_FIXED(0), 30 * own->frequency_hz);
        for (int e = 0; e < s->nexcitation; e++)
            if (s->excitation[e].hz > 0)
                number_column(t, pool_text(pool, "from %s", s->excitation[e].name), "%", SHOW_SIGNED(1),
                              100 * (own->frequency_hz / s->excitation[e].hz - 1));
    }
    return t;
}

static struct table *table_of_shares(struct pool *pool, const rotid_speeds *s)
{
    struct table *t = table_open(pool, "VARIANCE: share of each source in that of the critical speed");
    for (int i = 0; i < s->ncritical_speeds && s->critical_speeds[i].nvariance_shares; i++) {
        number_column(t, "no.", NULL, SHOW_COUNT, i + 1);
        for (int j = 0; j < s->critical_speeds[i].nvariance_shares; j++)
            number_column(t, s->critical_speeds[i].variance_shares[j].source, "%", SHOW_FIXED(1),
                          100 * s->critical_speeds[i].variance_shares[j].share);
    }
    return t;
}

static struct table *table_of_sensitivities(struct pool *pool, const rotid_speeds *s)
{
    struct table *t =
        table_open(pool, "SENSITIVITY: of a critical speed, its log decrement and its peak, by each uncertain number");
    for (int i = 0; i < s->ncritical_speeds; i++)
        for (int j = 0; j < s->critical_speeds[i].nsensitivities; j++) {
            const rotid_speed_sensitivity *one = &s->critical_speeds[i].sensitivities[j];
            number_column(t, "no.", NULL, SHOW_COUNT, i + 1);
            text_column(t, "parameter", SHOW_TEXT, one->parameter);
            number_column(t, "d ln speed", NULL, SHOW_SIGNED(4), one->speed);
            number_column(t, "d log decrement", NULL, SHOW_SIGNED(4), one->log_decrement);
            number_column(t, "d ln amplitude", NULL, SHOW_SIGNED(3), one->amplitude);
        }
    return t;
}

static struct table *table_of_peaks(struct pool *pool, const rotid_speeds *s)
{
    struct table *t = table_open(pool, "UNBALANCE RESPONSE: amplitudes zero to peak, amplification by half power");
    for (int i = 0; i < s->ncritical_speeds; i++)
        for (int p = 0; p < s->critical_speeds[i].npeaks; p++) {
            const rotid_response_peak *peak = &s->critical_speeds[i].peaks[p];
            number_column(t, "critical speed", NULL, SHOW_COUNT, i + 1);
            text_column(t, "probe", SHOW_TEXT, peak->probe);
            number_column(t, "peak", "rpm", SHOW_FIXED(1), peak->speed_rpm);
            number_column(t, "amplitude", "um", SHOW_DIGITS(4), 1e6 * peak->amplitude_m);
            number_column(t, "amplification", NULL, SHOW_DIGITS(3), peak->amplification);
        }
    return t;
}

static struct table *table_of_loads(struct pool *pool, const rotid_speeds *s)
{
    struct table *t =
        table_open(pool, pool_text(pool, "BEARING LOADS: weight %.5g N, sag %.4g mm", s->weight_n, 1000 * s->sag_m));
    for (int i = 0; i < s->nbearing_loads; i++) {
        const rotid_bearing_load *load = &s->bearing_loads[i];
        text_column(t, "bearing", SHOW_TEXT, load->bearing ? load->bearing : pool_text(pool, "%d", i + 1));
        number_column(t, "position", "m", SHOW_FIXED(4), load->position_m);
        number_column(t, "load x", "N", SHOW_DIGITS(5), load->load_x_n);
        number_column(t, "load y", "N", SHOW_DIGITS(5), load->load_y_n);
    }
    return t;
}

static void campbell_rows(struct table *t, const rotid_campbell_speed *at)
{
    for (int j = 0; j < at->nmodes; j++) {
        const rotid_campbell_mode *m = &at->modes[j];
        number_column(t, "speed", "rpm", SHOW_FIXED(1), at->speed_rpm);
        number_column(t, "mode", NULL, SHOW_COUNT, m->mode);
        number_column(t, "frequency", "Hz", SHOW_FIXED(3), m->frequency_hz);
        number_column(t, "from", "Hz", SHOW_FIXED(3), m->ci95[0]);
        number_column(t, "to", "Hz", SHOW_FIXED(3), m->ci95[1]);
        number_column(t, "damping ratio", NULL, SHOW_DIGITS(4) | DETAIL, m->damping_ratio);
        number_column(t, "log decrement", NULL, SHOW_DIGITS(4), m->log_decrement);
        number_column(t, "decrement from", NULL, SHOW_DIGITS(4), m->log_decrement_ci95[0]);
        number_column(t, "decrement to", NULL, SHOW_DIGITS(4), m->log_decrement_ci95[1]);
        text_column(t, "whirl", SHOW_TEXT, m->whirl);
    }
}

/* The modes at the first speed of the Campbell diagram from the highest running speed on, or at its last one. */
static struct table *table_of_stability(struct pool *pool, const rotid_speeds *s)
{
    int at = 0;
    while (at + 1 < s->ncampbell && !(s->campbell[at].speed_rpm >= s->high_rpm))
        at++;
    struct table *t =
        table_open(pool, s->ncampbell ? pool_text(pool, "STABILITY: modes at %.6g rpm", s->campbell[at].speed_rpm) : "STABILITY");
    if (s->ncampbell)
        campbell_rows(t, &s->campbell[at]);
    return t;
}

struct table *table_of_campbell(struct pool *pool, const rotid_speeds *s)
{
    struct table *t = table_open(pool, "Campbell diagram");
    for (int i = 0; i < s->ncampbell; i++)
        campbell_rows(t, &s->campbell[i]);
    return t;
}

struct table *table_of_response(struct pool *pool, const rotid_speeds *s)
{
    struct table *t = table_open(pool, "Unbalance response");
    for (int p = 0; p < s->nunbalance; p++)
        for (int i = 0; i < s->unbalance[p].nspeed_rpm; i++) {
            text_column(t, "probe", SHOW_TEXT, s->unbalance[p].probe);
            number_column(t, "speed", "rpm", SHOW_FIXED(1), s->unbalance[p].speed_rpm[i]);
            number_column(t, "amplitude", "m", SHOW_DIGITS(5), s->unbalance[p].amplitude_m[i]);
            number_column(t, "from", "m", SHOW_DIGITS(5), s->unbalance[p].from_m[i]);
            number_column(t, "to", "m", SHOW_DIGITS(5), s->unbalance[p].to_m[i]);
            number_column(t, "phase", "deg", SHOW_FIXED(2), s->unbalance[p].phase_deg[i]);
        }
    return t;
}

/* A sentence on the margin of a critical speed that has one. */
static const char *judgement(struct pool *pool, const rotid_critical_speed *c, const rotid_speeds *s)
{
    const struct machine range = {.low = s->low_rpm * RPM, .high = s->high_rpm * RPM};
    double judged = c->npeaks ? speeds_peak(&range, c)->speed_rpm : c->speed_rpm;
    const rotid_variance_share *most = c->nvariance_shares ? &c->variance_shares[0] : NULL;
    for (int i = 1; i < c->nvariance_shares; i++)
        most = c->variance_shares[i].share > most->share ? &c->variance_shares[i] : most;
    const char *band = isfinite(c->ci95[0]) ? pool_text(pool, " (%.0f to %.0f)", c->ci95[0], c->ci95[1]) : "",
               *peak = c->npeaks ? pool_text(pool, ", peak at %.0f rpm", judged) : "",
               *where = c->margin.value < 0 ? "inside the running range"
                                            : pool_text(pool, "%.0f %% %s the running range", 100 * c->margin.value,
                                                        judged < s->low_rpm ? "below" : "above"),
               *kept = "";
    if (isfinite(c->margin.required) && isfinite(c->margin.probability))
        kept = pool_text(pool, ": the margin of %.0f %% is kept with probability %.2f", 100 * c->margin.required,
                         c->margin.probability);
    else if (isfinite(c->margin.required))
        kept = pool_text(pool, ": the margin of %.0f %% is %skept", 100 * c->margin.required,
                         c->margin.value >= c->margin.required ? "" : "not ");
    const char *doubt =
        most ? pool_text(pool, "; %.0f %% of the variance of the critical speed: %s", 100 * most->share, most->source) : "";
    return pool_text(pool, "Critical speed %d, %s, %.0f rpm%s%s, %s%s%s", c->number, c->whirl, c->speed_rpm, band, peak, where,
                     kept, doubt);
}

/* From which speed on the machine is unstable, or that it is stable. */
static const char *stability(struct pool *pool, const rotid_speeds *s)
{
    if (!isfinite(s->stability.onset_rpm))
        return pool_text(pool, "No mode is unstable up to %.0f rpm", s->campbell[s->ncampbell - 1].speed_rpm);
    return s->stability.mode == ROTID_NONE
               ? pool_text(pool, "Unstable from %.1f rpm on: the bearings do not hold the rotor, which moves away without whirl",
                           s->stability.onset_rpm)
               : pool_text(pool, "Mode %d is unstable from %.1f rpm on", s->stability.mode, s->stability.onset_rpm);
}

/* The judged critical speed with the least margin, NULL where none is judged. */
static const rotid_critical_speed *nearest(const rotid_speeds *s)
{
    const rotid_critical_speed *least = NULL;
    for (int i = 0; i < s->ncritical_speeds; i++) {
        const rotid_critical_speed *c = &s->critical_speeds[i];
        if (isfinite(c->margin.value) && (!least || c->margin.value < least->margin.value))
            least = c;
    }
    return least;
}

struct shown shown_of_speeds(struct pool *pool, const rotid_speeds *s, int all)
{
    struct shown shown = {.said.pool = pool,
                          .table = {table_of_critical_speeds(pool, s), table_of_stability(pool, s),
                                    table_of_runup(pool, s->nrunup, s->runup), table_of_torsion(pool, s),
                                    table_of_shares(pool, s), table_of_peaks(pool, s), table_of_loads(pool, s),
                                    all ? table_of_sensitivities(pool, s) : NULL}};
    const rotid_critical_speed *least = nearest(s);
    if (least)
        reasons_say(&shown.said, "%s", judgement(pool, least, s));
    for (const rotid_critical_speed *c = s->critical_speeds; c < s->critical_speeds + s->ncritical_speeds; c++)
        if (isfinite(c->margin.value) && c != least)
            reasons_say(&shown.said, "%s", judgement(pool, c, s));
    if (s->ncampbell)
        reasons_say(&shown.said, "%s", stability(pool, s));
    if (isfinite(s->stability.probability_stable))
        reasons_say(&shown.said, "Stable at %.0f rpm with probability %.3f", s->high_rpm, s->stability.probability_stable);
    return shown;
}

void screen_speeds(const struct screen *to, const struct result *result)
{
    const struct shown shown = shown_of_speeds(to->pool, result->speeds, to->verbose);
    screen_shown(to, &shown);
}
