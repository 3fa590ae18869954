#include "diagnose/fault_text.h"

#include <math.h>

static const char *const fault_id[] = {[FAULT_GAIN] = "sensor_gain",
                                       [FAULT_SIGN] = "sensor_sign",
                                       [FAULT_SWAP] = "sensor_swap",
                                       [FAULT_POSITION] = "sensor_position",
                                       [FAULT_DUPLICATE] = "duplicate_channel",
                                       [FAULT_DEAD] = "duplicate_channel"};

/* A negative gain is a wrong sign. */
static enum sensor_fault_kind kind_of(const struct sensor_fault *fault)
{
    return fault->kind == FAULT_GAIN && fault->value < 0 ? FAULT_SIGN : fault->kind;
}

static int has_value(enum sensor_fault_kind kind)
{
    return kind == FAULT_GAIN || kind == FAULT_POSITION;
}

static const char *describe(struct pool *pool, enum sensor_fault_kind kind, double value, const int *id)
{
    switch (kind) {
    case FAULT_GAIN:
        return pool_format(pool, "sensor %d reads %.3g times what it should; its components are divided by that", id[0], value);
    case FAULT_SIGN:
        return pool_format(pool, "sensor %d has the wrong sign; it is turned", id[0]);
    case FAULT_SWAP:
        return pool_format(pool, "sensors %d and %d are exchanged; they are put back", id[0], id[1]);
    case FAULT_POSITION:
        return pool_format(pool, "sensor %d sits %.3g mm further %s than stated; it is moved", id[0], 1e3 * fabs(value),
                           value > 0 ? "right" : "left");
    case FAULT_DUPLICATE:
        return pool_format(pool, "sensor %d records what sensor %d records; it is left out", id[0], id[1]);
    default:
        return pool_format(pool, "sensor %d is dead; it is left out", id[0]);
    }
}

int fault_finding(struct pool *pool, const struct sensor_fault *fault, const int *id, rotid_data_finding *finding)
{
    enum sensor_fault_kind kind = kind_of(fault);
    int two = fault->other >= 0;
    *finding = (rotid_data_finding){.id = fault_id[kind],
                                    .nsensors = 1 + two,
                                    .sensors = POOL_ARRAY(pool, int, 2),
                                    .value = has_value(kind) ? fault->value : NAN,
                                    .std = fault->std,
                                    .chi2_drop = fault->chi2_drop};
    if (!finding->sensors)
        return ROTID_ERROR_MEMORY;
    finding->sensors[0] = id[fault->sensor];
    finding->sensors[1] = two ? id[fault->other] : 0;
    finding->text = describe(pool, kind, fault->value, finding->sensors);
    return finding->text ? ROTID_OK : ROTID_ERROR_MEMORY;
}

const char *fault_target(struct pool *pool, const rotid_data_finding *finding)
{
    return !finding->nsensors      ? ""
           : finding->nsensors > 1 ? pool_format(pool, "sensors %d,%d", finding->sensors[0], finding->sensors[1])
                                   : pool_format(pool, "sensor %d", finding->sensors[0]);
}

struct correction fault_correction(const struct sensor_fault *fault, const int *id)
{
    enum sensor_fault_kind kind = kind_of(fault);
    int two = fault->other >= 0;
    return (struct correction){.id = fault_id[kind],
                               .nsensor = 1 + two,
                               .sensor = {id[fault->sensor], two ? id[fault->other] : 0},
                               .value = has_value(kind) ? fault->value : 1};
}

#define NORMAL_95 1.96

static rotid_cause_value sized(const char *name, const char *unit, double value, double std, double neutral)
{
    int as_stated = value == neutral && !isfinite(std);
    double half = as_stated ? NAN : NORMAL_95 * std;
    return (rotid_cause_value){name, unit, value, as_stated ? NAN : std, {value - half, value + half}, 0};
}

int line_finding(struct pool *pool, const struct line_fault *fault, rotid_data_finding *finding)
{
    const struct sensor_line *line = &fault->line;
    *finding = (rotid_data_finding){.id = "sensor_line",
                                    .value = NAN,
                                    .std = NAN,
                                    .chi2_drop = fault->chi2_drop,
                                    .nparameters = 3,
                                    .parameters = POOL_ARRAY(pool, rotid_cause_value, 3)};
    if (!finding->parameters)
        return ROTID_ERROR_MEMORY;
    finding->parameters[0] = sized("shift", "m", line->shift, fault->shift_std, 0);
    finding->parameters[1] = sized("scale", "1", line->scale, fault->scale_std, 1);
    finding->parameters[2] = sized("flip", "1", line->flip, NAN, line->flip);
    const char *text =
        line->flip ? "the positions of all sensors count from the other end" : "the positions of all sensors are off";
    if (line->scale != 1)
        text =
            pool_format(pool, "%s, their distances are %.5g +- %.2g times the stated ones", text, line->scale, fault->scale_std);
    if (text && line->shift != 0)
        text = pool_format(pool, "%s, their origin is off by %+.3g +- %.2g mm", text, 1e3 * line->shift, 1e3 * fault->shift_std);
    finding->text = text ? pool_format(pool, "%s; all of them are moved", text) : NULL;
    return finding->text ? ROTID_OK : ROTID_ERROR_MEMORY;
}

struct correction line_correction(const struct sensor_line *line)
{
    return (struct correction){.id = "sensor_line", .value = line->shift, .more = {line->scale, line->flip}};
}
