/* What is required, and whether it holds. */
#include <math.h>

#include "power.h"

#define CLEAR_DROP   30.0 /* from here an effect has to be reported */
#define CLEAR_MARGIN 15.0 /* from here a name has to be right */
#define CLEAR_LEFT   60.0 /* outside the catalogue: no cause comes nearer to the data */

enum {
    REPORTED,
    NAMED,
    NOT_WRONG,
    NO_ALARM,
    NOISE_NO_NAME,
    COVERAGE,
    OUTSIDE_NO_NAME,
    DIAGNOSED,
    REQUIRED, /* the others are shown beside them */
    REFITTED = REQUIRED,
    ONE_NO_WRONG,
    PAIR_NO_WRONG,
    PAIR_ONE,
    DATA_FOUND,
    DATA_NO_NAME,
    SOUND_DATA,
    COLOURED_NO_NAME,
    LINES
};

static const struct {
    const char *text;
    double least, most;
} table[LINES] = {
    [REPORTED] = {"an effect worth a drop of 30 is reported", 0.95, 1},
    [NAMED] = {"margin of 15: named, or one of two", 0.95, 1},
    [NOT_WRONG] = {"smaller margin: no wrong name", 0.95, 1},
    [NO_ALARM] = {"nothing hidden: adequate", 0.95, 1},
    [NOISE_NO_NAME] = {"noise stated wrongly: no name", 0.95, 1},
    [COVERAGE] = {"95 % intervals hold the truth", 0.90, 0.99},
    [OUTSIDE_NO_NAME] = {"outside the catalogue, 60 left: no name", 0.90, 1},
    [DIAGNOSED] = {"a diagnosis at all", 1, 1},
    [REFITTED] = {"drop of 30: the true cause is refitted", 0, 1},
    [ONE_NO_WRONG] = {"one effect: no wrong name", 0, 1},
    [PAIR_NO_WRONG] = {"two effects: no wrong name", 0, 1},
    [PAIR_ONE] = {"two effects, drop of 30: one is found", 0, 1},
    [DATA_FOUND] = {"fault of the data worth 60 is found", 0, 1},
    [DATA_NO_NAME] = {"fault of the data: no physical name", 0, 1},
    [SOUND_DATA] = {"sound data are not accused", 0, 1},
    [COLOURED_NO_NAME] = {"correlated noise, nothing hidden: adequate", 0, 1},
};

void power_interval(struct power_share share, double *lower, double *upper)
{
    const double z = 1.959963984540054;
    double n = share.count, p = n > 0 ? share.right / n : 0;
    double centre = n > 0 ? (p + z * z / (2 * n)) / (1 + z * z / n) : 0.5;
    double half = n > 0 ? z * sqrt(p * (1 - p) / n + z * z / (4 * n * n)) / (1 + z * z / n) : 0.5;
    *lower = fmax(0, centre - half);
    *upper = fmin(1, centre + half);
}

static void add(struct power_share *share, int right)
{
    share->count++;
    share->right += right;
}

static void add_physical(const struct hidden_score *s, struct power_share share[LINES])
{
    int wrong = s->outcome == HIDDEN_WRONG;
    add(&share[ONE_NO_WRONG], !wrong);
    if (s->drop >= CLEAR_DROP) {
        add(&share[REPORTED], s->reported);
        add(&share[REFITTED], isfinite(s->margin));
    }
    if (s->margin >= CLEAR_MARGIN)
        add(&share[NAMED], s->outcome == HIDDEN_RIGHT || (s->outcome == HIDDEN_IN_SET && s->nset <= 2));
    else if (s->reported)
        add(&share[NOT_WRONG], !wrong);
}

static void add_case(const struct hidden_score *s, struct power_share share[LINES])
{
    int wrong = s->outcome == HIDDEN_WRONG;
    add(&share[DIAGNOSED], s->outcome != HIDDEN_FAILED);
    if (s->outcome == HIDDEN_FAILED)
        return;
    for (int v = 0; v < s->nvalue; v++)
        add(&share[COVERAGE], hidden_covers(&s->value[v]));
    if (s->class != HIDDEN_DATA && s->class != HIDDEN_NOISE)
        add(&share[SOUND_DATA], !s->accused);
    switch (s->class) {
    case HIDDEN_NOTHING:
        add(&share[s->coloured ? COLOURED_NO_NAME : NO_ALARM], s->outcome == HIDDEN_SILENT);
        break;
    case HIDDEN_PHYSICAL:
        add_physical(s, share);
        break;
    case HIDDEN_PAIR:
        add(&share[PAIR_NO_WRONG], !wrong);
        if (s->drop >= CLEAR_DROP)
            add(&share[PAIR_ONE], s->found > 0 && !wrong);
        break;
    case HIDDEN_DATA:
        add(&share[DATA_NO_NAME], s->names == 0);
        if (s->drop >= CLEAR_LEFT)
            add(&share[DATA_FOUND], s->outcome == HIDDEN_RIGHT);
        break;
    case HIDDEN_NOISE:
        add(&share[NOISE_NO_NAME], s->names == 0);
        break;
    case HIDDEN_OUTSIDE:
        if (s->left >= CLEAR_LEFT)
            add(&share[OUTSIDE_NO_NAME], !wrong);
        break;
    }
}

int power_requirements(FILE *out, int count, const struct power_result *result)
{
    struct power_share share[LINES] = {{0, 0}};
    int bad = 0;
    for (int i = 0; i < count; i++)
        if (result[i].done)
            add_case(&result[i].score, share);
    fprintf(out, "\nrequired\n");
    for (int i = 0; i < LINES; i++) {
        double lower, upper, part = share[i].count ? (double)share[i].right / share[i].count : 0;
        power_interval(share[i], &lower, &upper);
        int holds = part >= table[i].least && lower <= table[i].most; /* few cases may all be right */
        if (i == REQUIRED)
            fprintf(out, "beside that\n");
        if (!share[i].count) {
            fprintf(out, "  %-44s no case\n", table[i].text);
            continue;
        }
        fprintf(out, "  %-44s %4d of %-4d %5.1f %% (%.1f to %.1f)", table[i].text, share[i].right, share[i].count, 100 * part,
                100 * lower, 100 * upper);
        if (i < REQUIRED && table[i].most < 1)
            fprintf(out, "  required %.0f to %.0f %%  %s", 100 * table[i].least, 100 * table[i].most, holds ? "PASS" : "FAIL");
        else if (i < REQUIRED)
            fprintf(out, "  required %.0f %%  %s", 100 * table[i].least, holds ? "PASS" : "FAIL");
        fprintf(out, "\n");
        bad |= i < REQUIRED && !holds;
    }
    return bad;
}
